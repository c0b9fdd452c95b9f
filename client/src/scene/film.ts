/** A film as it is seen: taut over a dark tray, which shows where it is cut. */

import { BufferAttribute, BufferGeometry, Color, DoubleSide, Group, Mesh, MeshPhongMaterial } from "three";

import type { Frame } from "../wire/frame";
import type { Hello } from "../wire/messages";
import type { ContactShade } from "./contact-shade";
import { makeMaps, WET } from "./skin-texture";
import { Surface } from "./surface";
import { wetMaterial } from "./wet";

const SILICONE = { ...WET, base: [226, 178, 148], patch: [220, 168, 138], pale: [232, 188, 160], vesselShare: 0 } as const;
const RIM = 0.0025; // by which the tray is wider than the film, on each side [m]

export class Film {
  readonly group = new Group();
  private readonly surface: Surface;

  constructor(hello: Hello, shade: ContactShade) {
    const [nx, ny] = hello.grid;
    this.surface = new Surface(hello.tissue.size_m, nx, ny);
    const maps = makeMaps(SILICONE, 40, 256);
    const wet = wetMaterial(maps, { tint: new Color(1, 1, 1), film: 0.5, relief: 0.3, side: DoubleSide, shade });
    wet.vertexColors = true; // hollows are darker
    const film = new Mesh(this.surface.geometry, wet);
    film.receiveShadow = true;
    film.frustumCulled = false; // its bounds change with every frame
    this.group.add(film, new Mesh(tray(hello.tissue.size_m, hello.under_m), DARK));
  }

  update(frame: Frame): void {
    this.surface.update(frame);
  }
}

const DARK = new MeshPhongMaterial({ color: new Color(0.012, 0.014, 0.018), specular: new Color(0.05, 0.05, 0.05), side: DoubleSide });

/** Bottom and walls under the film, and a rim round it. */
function tray([a, b]: readonly [number, number], depth: number): BufferGeometry {
  const outline = (by: number, z: number): number[] => [-by, -by, z, a + by, -by, z, a + by, b + by, z, -by, b + by, z];
  const places = [...outline(0, -depth), ...outline(0, 0), ...outline(RIM, 0), ...outline(RIM, -depth)];
  const index = [0, 1, 2, 0, 2, 3];
  for (let ring = 0; ring < 3; ring++) {
    for (let side = 0; side < 4; side++) {
      const [low, next] = [4 * ring + side, 4 * ring + ((side + 1) % 4)];
      index.push(low, next, next + 4, low, next + 4, low + 4);
    }
  }
  const shared = new BufferGeometry();
  shared.setAttribute("position", new BufferAttribute(new Float32Array(places), 3));
  shared.setIndex(index);
  const geometry = shared.toNonIndexed(); // edges are sharp
  geometry.computeVertexNormals();
  return geometry;
}
