/** The tissue as it is seen: its wet upper face, and every layer where the block is cut at its sides. */

import { Color, FrontSide, Group, Mesh } from "three";

import type { Frame } from "../wire/frame";
import type { Hello } from "../wire/messages";
import type { ContactShade } from "./contact-shade";
import { CutFace } from "./cut-face";
import { type Look, makeMaps, type Maps, WET } from "./skin-texture";
import { Surface } from "./surface";
import { wetMaterial } from "./wet";

/** Looks of cut layers from the top down; a deeper one takes the last. */
const CUT: readonly Look[] = [
  { ...WET, base: [214, 150, 132], patch: [188, 110, 98], vesselShare: 0 },
  { ...WET, base: [222, 158, 150], patch: [190, 98, 96], pale: [240, 214, 202], vesselShare: 0.4 },
  {
    base: [250, 226, 158],
    patch: [244, 208, 136],
    pale: [252, 236, 190],
    vessel: [150, 50, 44],
    vesselShare: 0.35,
    lobules: 1,
  },
];

export class Block {
  readonly group = new Group();
  private readonly surface: Surface;
  private readonly cuts: CutFace[] = [];

  constructor(hello: Hello, maps: Maps, shade: ContactShade) {
    const [nx, ny] = hello.grid;
    const size = hello.tissue.size_m;
    this.surface = new Surface(size, nx, ny);
    const wet = wetMaterial(maps, { tint: new Color(1, 1, 1), film: 0.9, relief: 1, side: FrontSide, shade });
    wet.vertexColors = true; // hollows are darker
    this.add(new Mesh(this.surface.geometry, wet));
    let top = 0;
    hello.tissue.layers.forEach((layer, k) => {
      const cut = new CutFace(size, nx, ny, k, top, top - layer.thickness_m);
      const look = CUT[Math.min(k, CUT.length - 1)] as Look;
      const material = wetMaterial(makeMaps(look, 40 + k, 256), {
        tint: new Color(1.1, 1.05, 1.0).multiplyScalar(look.lobules > 0 ? 1.4 : 1),
        film: 0.6,
        relief: 0.8,
        side: FrontSide,
        shade,
      });
      this.add(new Mesh(cut.geometry, material));
      this.cuts.push(cut);
      top -= layer.thickness_m;
    });
  }

  update(frame: Frame): void {
    this.surface.update(frame);
    for (const cut of this.cuts) cut.update(frame);
  }

  private add(mesh: Mesh): void {
    mesh.receiveShadow = true;
    mesh.frustumCulled = false; // its bounds change with every frame
    this.group.add(mesh);
  }
}
