/** An organ as it is seen: the surface that tools press, and the faces beside and below it, which stay as they are. */

import { BufferAttribute, BufferGeometry, Color, FrontSide, Group, Mesh } from "three";

import type { Frame } from "../wire/frame";
import type { Hello, OrganShape } from "../wire/messages";
import type { ContactShade } from "./contact-shade";
import { type Maps, TILE } from "./skin-texture";
import { Surface } from "./surface";
import { wetMaterial } from "./wet";

const TINT = new Color(0.92, 0.5, 0.42); // of a liver under its capsule, against skin

export class Organ {
  readonly group = new Group();
  private readonly surface: Surface;

  constructor(hello: Hello, shape: OrganShape, maps: Maps, shade: ContactShade) {
    const [nx, ny] = hello.grid;
    this.surface = new Surface(hello.tissue.size_m, nx, ny, shape);
    const wet = wetMaterial(maps, { tint: TINT, film: 1, relief: 0.6, side: FrontSide, shade });
    wet.vertexColors = true; // what is pressed in is darker
    this.add(new Mesh(this.surface.geometry, wet));
    this.add(new Mesh(sides(shape), wetMaterial(maps, { tint: TINT, film: 1, relief: 0.6, side: FrontSide, shade })));
  }

  update(frame: Frame): void {
    this.surface.update(frame);
  }

  private add(mesh: Mesh): void {
    mesh.receiveShadow = true;
    mesh.frustumCulled = false; // its bounds change with every frame
    this.group.add(mesh);
  }
}

function sides(shape: OrganShape): BufferGeometry {
  const geometry = new BufferGeometry();
  const corners = new Float32Array(shape.corners_m.flat());
  geometry.setAttribute("position", new BufferAttribute(corners, 3));
  geometry.setIndex(shape.faces.flat());
  geometry.setAttribute("normal", new BufferAttribute(new Float32Array(shape.normals.flat()), 3));
  const uv = new Float32Array((2 * corners.length) / 3);
  for (let at = 0; at < corners.length / 3; at++) {
    const [x, y, z] = [0, 1, 2].map((axis) => corners[3 * at + axis] as number) as [number, number, number];
    uv.set([(x + 0.3 * z) / TILE, (y + z) / TILE], 2 * at);
  }
  geometry.setAttribute("uv", new BufferAttribute(uv, 2));
  return geometry;
}
