/** The surface of the tissue: the newest frame's displacement at the grid's nodes, drawn as it is, cut as it is. */

import { BufferAttribute, BufferGeometry } from "three";

import type { Frame } from "../wire/frame";
import type { OrganShape } from "../wire/messages";
import { TILE } from "./skin-texture";
import { type Corner, tear } from "./slit";

const NEARBY = 0.005; // how far round a node its surroundings are looked at [m]
const SHUT_OFF = 3.2; // light lost for a hollow as deep as that is wide, against light kept

export class Surface {
  readonly geometry = new BufferGeometry();
  private readonly rest: readonly (number | null)[]; // heights of an organ's nodes, null where there is no surface
  private readonly rim: ReadonlySet<number>; // nodes drawn to an organ's outline
  private readonly places: Float64Array; // of all nodes at rest, x and y [m]
  private position: Float32Array;
  private normal: Float32Array;
  private shade: Float32Array; // how much of its light a node gets, three equal colours
  private corners: readonly Corner[] = []; // beside the nodes, where the sheet is cut
  private cut: Uint8Array | null = null; // as it is drawn

  /**
   * @param size of the tissue's rectangle [m]. @param nx nodes along x, from edge to edge. @param ny nodes along y.
   * @param shape of an organ's surface at rest; null for a level one, with nodes at even distances.
   */
  constructor(
    private readonly size: readonly [number, number],
    private readonly nx: number,
    private readonly ny: number,
    shape: Pick<OrganShape, "rest_m" | "rim" | "rim_m"> | null = null,
  ) {
    this.rest = shape?.rest_m ?? [];
    this.rim = new Set(shape?.rim);
    this.places = evenly(size, nx, ny);
    shape?.rim.forEach((node, k) => this.places.set(shape.rim_m[k] as readonly [number, number], 2 * node));
    const count = nx * ny;
    this.position = new Float32Array(3 * count);
    this.normal = new Float32Array(3 * count);
    this.shade = new Float32Array(3 * count).fill(1);
    const uv = new Float32Array(2 * count);
    for (let at = 0; at < count; at++) {
      const [x, y] = this.place(at);
      this.position.set([x, y, this.height(at)], 3 * at);
      this.normal.set([0, 0, 1], 3 * at);
      uv.set([x / TILE, y / TILE], 2 * at); // the texture belongs to the tissue and moves with it
    }
    this.offer(uv);
    this.geometry.setIndex(triangles(nx, ny, (at) => this.isDrawn(at)));
    if (shape) this.turnNormals();
  }

  private isDrawn(at: number): boolean {
    return this.rest.length === 0 || this.rest[at] !== null;
  }

  /** Where a node is at rest, seen from above [m]. */
  private place(at: number): readonly [number, number] {
    return [this.places[2 * at] as number, this.places[2 * at + 1] as number];
  }

  private height(at: number): number {
    return this.rest[at] ?? 0;
  }

  /** Move every node to where the frame has it. */
  update(frame: Frame): void {
    if (frame.cut && !same(frame.cut, this.cut)) this.tear(frame.cut);
    const { position } = this;
    const count = this.nx * this.ny;
    for (let at = 0; at < count; at++) {
      const [x, y] = this.place(at);
      position[3 * at] = x + (frame.inPlane?.[at] ?? 0);
      position[3 * at + 1] = y + (frame.inPlane?.[count + at] ?? 0);
      position[3 * at + 2] = this.height(at) + (frame.heights[at] as number);
    }
    this.turnNormals();
    this.shadeHollows(frame.heights);
    this.corners.forEach((corner, k) => this.followOwner(corner, count + k));
    for (const name of ["position", "normal", "color"]) this.geometry.getAttribute(name).needsUpdate = true;
  }

  /** Draw other triangles from now on: those of a sheet that is cut so. */
  private tear(cut: Uint8Array): void {
    const { index, corners } = tear(this.size, this.nx, this.ny, cut);
    const count = this.nx * this.ny + corners.length;
    const longer = (values: Float32Array, width: number): Float32Array => {
      const found = new Float32Array(width * count);
      found.set(values.subarray(0, Math.min(values.length, width * this.nx * this.ny)));
      return found;
    };
    this.position = longer(this.position, 3);
    this.normal = longer(this.normal, 3);
    this.shade = longer(this.shade, 3);
    const uv = longer(this.geometry.getAttribute("uv").array as Float32Array, 2);
    corners.forEach((corner, k) => uv.set([corner.x / TILE, corner.y / TILE], 2 * (this.nx * this.ny + k)));
    this.corners = corners;
    this.cut = cut.slice();
    this.geometry.dispose(); // its buffers had another length
    this.offer(uv);
    this.geometry.setIndex(index);
  }

  private offer(uv: Float32Array): void {
    this.geometry.setAttribute("position", new BufferAttribute(this.position, 3));
    this.geometry.setAttribute("normal", new BufferAttribute(this.normal, 3));
    this.geometry.setAttribute("color", new BufferAttribute(this.shade, 3));
    this.geometry.setAttribute("uv", new BufferAttribute(uv, 2));
  }

  /** Move a corner as its node went. */
  private followOwner({ owner, x, y }: Corner, at: number): void {
    const { position, normal, shade } = this;
    const [restX, restY] = this.place(owner);
    position[3 * at] = (position[3 * owner] as number) + x - restX;
    position[3 * at + 1] = (position[3 * owner + 1] as number) + y - restY;
    position[3 * at + 2] = position[3 * owner + 2] as number;
    normal.copyWithin(3 * at, 3 * owner, 3 * owner + 3);
    shade.copyWithin(3 * at, 3 * owner, 3 * owner + 3);
  }

  /** Darken what is pressed in: a node sunk below those around it is shut off from light its surroundings send back. */
  private shadeHollows(heights: Float32Array): void {
    const { nx, ny, shade } = this;
    const reach = Math.max(1, Math.round((NEARBY * (nx - 1)) / this.size[0]));
    for (let j = 0; j < ny; j++) {
      for (let i = 0; i < nx; i++) {
        const height = (column: number, row: number): number =>
          heights[inside(row, ny) * nx + inside(column, nx)] as number;
        const around = height(i - reach, j) + height(i + reach, j) + height(i, j - reach) + height(i, j + reach);
        const below = Math.max(around / 4 - height(i, j), 0) / NEARBY;
        shade.fill(1 / (1 + SHUT_OFF * below), 3 * (j * nx + i), 3 * (j * nx + i) + 3);
      }
    }
  }

  /** Normals across the differences to the neighbours, one-sided at the edges. */
  private turnNormals(): void {
    const { nx, ny, position, normal } = this;
    const between = (a: number, b: number, axis: number): number =>
      (position[3 * b + axis] as number) - (position[3 * a + axis] as number);
    for (let j = 0; j < ny; j++) {
      for (let i = 0; i < nx; i++) {
        const at = j * nx + i;
        const west = i > 0 && this.isDrawn(at - 1) ? at - 1 : at;
        const east = i < nx - 1 && this.isDrawn(at + 1) ? at + 1 : at;
        const south = j > 0 && this.isDrawn(at - nx) ? at - nx : at;
        const north = j < ny - 1 && this.isDrawn(at + nx) ? at + nx : at;
        const [ax, ay, az] = [between(west, east, 0), between(west, east, 1), between(west, east, 2)];
        const [bx, by, bz] = [between(south, north, 0), between(south, north, 1), between(south, north, 2)];
        const x = ay * bz - az * by;
        const y = az * bx - ax * bz;
        const z = ax * by - ay * bx;
        const length = Math.hypot(x, y, z) || 1;
        normal[3 * at] = x / length;
        normal[3 * at + 1] = y / length;
        normal[3 * at + 2] = z / length;
      }
    }
    for (const at of this.rim) this.turnAsNeighbours(at);
  }

  /** Give a node of the rim, which may lie next to another, the mean normal of the nodes within it. */
  private turnAsNeighbours(at: number): void {
    const { nx, ny, normal } = this;
    const sum: [number, number, number] = [0, 0, 0];
    for (const dj of [-1, 0, 1]) {
      for (const di of [-1, 0, 1]) {
        const [i, j] = [(at % nx) + di, Math.floor(at / nx) + dj];
        const other = j * nx + i;
        if (i < 0 || j < 0 || i >= nx || j >= ny || this.rim.has(other) || !this.isDrawn(other)) continue;
        for (const axis of [0, 1, 2] as const) sum[axis] += normal[3 * other + axis] as number;
      }
    }
    const length = Math.hypot(...sum) || 1;
    for (const axis of [0, 1, 2] as const) normal[3 * at + axis] = sum[axis] / length;
  }
}

function evenly(size: readonly [number, number], nx: number, ny: number): Float64Array {
  const places = new Float64Array(2 * nx * ny);
  for (let j = 0; j < ny; j++) {
    for (let i = 0; i < nx; i++) {
      places.set([(size[0] * i) / (nx - 1), (size[1] * j) / (ny - 1)], 2 * (j * nx + i));
    }
  }
  return places;
}

function same(one: Uint8Array, other: Uint8Array | null): boolean {
  return other !== null && one.length === other.length && one.every((value, k) => value === other[k]);
}

function inside(index: number, count: number): number {
  return Math.min(Math.max(index, 0), count - 1);
}

function triangles(nx: number, ny: number, isDrawn: (at: number) => boolean): number[] {
  const index: number[] = [];
  for (let j = 0; j < ny - 1; j++) {
    for (let i = 0; i < nx - 1; i++) {
      const at = j * nx + i;
      if (![at, at + 1, at + nx + 1, at + nx].every(isDrawn)) continue;
      index.push(at, at + 1, at + nx + 1, at, at + nx + 1, at + nx);
    }
  }
  return index;
}
