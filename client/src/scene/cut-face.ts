/** One layer where the block is cut: a band along all four sides, from the layer's upper face to the next one's. */

import { BufferAttribute, BufferGeometry } from "three";

import type { Frame } from "../wire/frame";
import { TILE } from "./skin-texture";

interface Rim {
  readonly node: number; // of the grid
  readonly x: number; // at rest [m]
  readonly y: number;
  readonly along: number; // of the rim, from its beginning [m]
  readonly outwards: readonly [number, number];
}

export class CutFace {
  readonly geometry = new BufferGeometry();
  private readonly position: Float32Array;
  private readonly rim: readonly Rim[];
  private readonly count: number;

  /**
   * @param layer which, 0 the top one.
   * @param top rest height of its upper face [m].
   * @param bottom rest height of its lower face [m].
   */
  constructor(
    size: readonly [number, number],
    private readonly nx: number,
    private readonly ny: number,
    private readonly layer: number,
    private readonly top: number,
    private readonly bottom: number,
  ) {
    this.rim = sides(size, nx, ny);
    this.count = this.rim.length;
    this.position = new Float32Array(6 * this.count);
    const normal = new Float32Array(6 * this.count);
    const uv = new Float32Array(4 * this.count);
    const index: number[] = [];
    this.rim.forEach((point, k) => {
      for (const row of [0, 1]) {
        const at = row * this.count + k;
        this.position.set([point.x, point.y, row ? bottom : top], 3 * at);
        normal.set([...point.outwards, 0], 3 * at);
        uv.set([point.along / TILE, (row ? bottom : top) / TILE], 2 * at);
      }
      const following = this.rim[k + 1];
      if (following && following.outwards === point.outwards) {
        index.push(this.count + k, this.count + k + 1, k + 1, this.count + k, k + 1, k);
      }
    });
    this.geometry.setAttribute("position", new BufferAttribute(this.position, 3));
    this.geometry.setAttribute("normal", new BufferAttribute(normal, 3));
    this.geometry.setAttribute("uv", new BufferAttribute(uv, 2));
    this.geometry.setIndex(index);
  }

  /** Move both edges of the band; the bottom of the lowest layer lies still. */
  update(frame: Frame): void {
    const plane = this.nx * this.ny;
    const top = frame.heights.subarray(this.layer * plane);
    const below = this.layer + 1 < frame.layers ? frame.heights.subarray((this.layer + 1) * plane) : null;
    const sideways = this.layer === 0 ? frame.inPlane : null; // only the top face's is known
    this.rim.forEach((point, k) => {
      this.position[3 * k] = point.x + (sideways?.[point.node] ?? 0);
      this.position[3 * k + 1] = point.y + (sideways?.[plane + point.node] ?? 0);
      this.position[3 * k + 2] = this.top + (top[point.node] as number);
      this.position[3 * (this.count + k) + 2] = this.bottom + (below?.[point.node] ?? 0);
    });
    this.geometry.getAttribute("position").needsUpdate = true;
  }
}

/** The nodes of all four sides, anticlockwise from above; a corner belongs to two sides and comes twice. */
function sides(size: readonly [number, number], nx: number, ny: number): Rim[] {
  const rim: Rim[] = [];
  const walk = (steps: number, at: (k: number) => readonly [number, number], outwards: readonly [number, number]) => {
    const start = rim.length > 0 ? (rim[rim.length - 1] as Rim).along : 0;
    for (let k = 0; k < steps; k++) {
      const [i, j] = at(k);
      const x = (size[0] * i) / (nx - 1);
      const y = (size[1] * j) / (ny - 1);
      const [fromI, fromJ] = at(0);
      const along = Math.hypot(x - (size[0] * fromI) / (nx - 1), y - (size[1] * fromJ) / (ny - 1));
      rim.push({ node: j * nx + i, x, y, along: start + along, outwards });
    }
  };
  walk(nx, (k) => [k, 0], [0, -1]);
  walk(ny, (k) => [nx - 1, k], [1, 0]);
  walk(nx, (k) => [nx - 1 - k, ny - 1], [0, 1]);
  walk(ny, (k) => [0, ny - 1 - k], [-1, 0]);
  return rim;
}
