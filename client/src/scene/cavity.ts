/** The dark cavity round the tissue: a bed it lies on, and a wall blown up to where the ports are. */

import { BackSide, BufferAttribute, Color, FrontSide, Group, Mesh, RingGeometry, SphereGeometry } from "three";

import { norm, subtract, type Vector } from "../vector";
import type { Hello } from "../wire/messages";
import type { ContactShade } from "./contact-shade";
import { mix, Noise, smoothstep } from "./noise";
import { type Maps, TILE } from "./skin-texture";
import { bySoftware } from "./software";
import { wetMaterial } from "./wet";

const SWELL = 0.012; // height of what bulges beside the tissue [m]
const MARGIN = 0.004; // round the block where the bed is flat [m]
const RUFFLE = 0.006; // of the wall [m]

/** Make bed and wall; the wall passes through the ports, as an abdomen's does. */
export function makeCavity(hello: Hello, maps: Maps, shade: ContactShade): Group {
  const [a, b] = hello.tissue.size_m;
  const { centre, radius } = hollow(hello);
  const depth = -centre[2];
  const group = new Group();
  group.add(makeBed(a, b, depth, radius, maps, shade), makeWall(centre, radius * 1.02, maps, shade));
  return group;
}

/** The sphere that the wall is about, as far as its ruffles leave it free; all in metres. */
export function hollow(hello: Hello): { readonly centre: Vector; readonly radius: number; readonly free: number } {
  const [a, b] = hello.tissue.size_m;
  const depth = hello.tissue.layers.reduce((sum, layer) => sum + layer.thickness_m, hello.under_m);
  const centre: Vector = [a / 2, b / 2, -depth];
  const ports = [...hello.instruments.map((shape) => shape.port_m), hello.camera.port_m];
  const radius = Math.max(...ports.map((port) => norm(subtract(port, centre))), 0.75 * Math.hypot(a, b));
  return { centre, radius, free: radius - RUFFLE };
}

function makeBed(a: number, b: number, depth: number, radius: number, maps: Maps, shade: ContactShade): Mesh {
  const noise = new Noise(7);
  const [around, across] = bySoftware() ? [60, 28] : [120, 56]; // pieces
  const geometry = new RingGeometry(0.1 * Math.min(a, b), radius, around, across); // its hole lies under the block
  const position = geometry.getAttribute("position");
  const uv = geometry.getAttribute("uv");
  for (let i = 0; i < position.count; i++) {
    const x = position.getX(i) + a / 2;
    const y = position.getY(i) + b / 2;
    const outside = Math.hypot(Math.max(-x, x - a, 0), Math.max(-y, y - b, 0));
    const bulge = noise.sum(x / (2 * radius) + 0.5, y / (2 * radius) + 0.5, 5, 3);
    const rise = smoothstep(MARGIN, MARGIN + 0.03, outside);
    const rim = smoothstep(0.3 * radius, radius, outside) * 0.35 * radius;
    position.setXYZ(i, x, y, -depth - 2e-4 + rise * (SWELL * (0.55 + 1.3 * bulge)) + rim);
    uv.setXY(i, x / TILE + 0.31, y / TILE + 0.17);
  }
  geometry.computeVertexNormals();
  const tint = new Color().setRGB(0.50, 0.30, 0.24);
  const mesh = new Mesh(geometry, wetMaterial(maps, { tint, film: 0.45, relief: 1, side: FrontSide, shade }));
  mesh.receiveShadow = true;
  return mesh;
}

function makeWall(centre: Vector, radius: number, maps: Maps, shade: ContactShade): Mesh {
  const noise = new Noise(11);
  const geometry = new SphereGeometry(radius, 64, 48, 0, 2 * Math.PI, 0, 0.56 * Math.PI).rotateX(Math.PI / 2);
  const position = geometry.getAttribute("position");
  const lining = new Float32Array(3 * position.count);
  for (let i = 0; i < position.count; i++) {
    const scale = 1 / radius;
    const [x, y, z] = [position.getX(i) * scale, position.getY(i) * scale, position.getZ(i) * scale];
    const wave = noise.sum(x + 0.3 * z + 2, y - 0.2 * z + 2, 4, 3);
    const stretch = 1 + (RUFFLE / radius) * wave;
    position.setXYZ(i, x * radius * stretch, y * radius * stretch, z * radius * stretch);
    const fat = smoothstep(-0.1, 0.5, noise.sum(x - z + 5, y + z + 5, 3, 3)); // yellow fat shines through the lining
    lining.set([mix(0.5, 0.72, fat), mix(0.24, 0.5, fat), mix(0.2, 0.3, fat)], 3 * i);
  }
  geometry.setAttribute("color", new BufferAttribute(lining, 3));
  geometry.computeVertexNormals();
  const uv = geometry.getAttribute("uv");
  const around = Math.round((2 * Math.PI * radius) / TILE);
  for (let i = 0; i < uv.count; i++) uv.setXY(i, uv.getX(i) * around, uv.getY(i) * Math.round(around / 2));
  const material = wetMaterial(maps, { tint: new Color(1, 1, 1), film: 0.5, relief: 1, side: BackSide, shade });
  material.vertexColors = true;
  const mesh = new Mesh(geometry, material);
  mesh.position.set(...centre);
  mesh.receiveShadow = true;
  return mesh;
}
