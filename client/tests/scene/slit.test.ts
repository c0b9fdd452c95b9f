import { describe, expect, it } from "vitest";

import { tear } from "../../src/scene/slit";
import { Surface } from "../../src/scene/surface";
import { readFrame } from "../../src/wire/frame";
import { bytes, FRAME } from "../wire/golden";

const SIZE = [0.004, 0.003] as const;
const [NX, NY] = [5, 4];
const EAST = 0; // planes of what is cut
const NORTH = 1;
const BOTH = 2;
const NODES = NX * NY;

/** Cut between the second and the third row of nodes, from column to column, at a share of the way between them. */
function across(from: number, to: number, share = 0.4): Uint8Array {
  const cut = new Uint8Array(3 * NODES);
  for (let i = from; i <= to; i++) {
    cut[NORTH * NODES + NX + i] = Math.round(255 * share);
    if (i < to) cut[BOTH * NODES + NX + i] = Math.round(255 * share);
  }
  return cut;
}

function areas(index: readonly number[], at: (corner: number) => readonly [number, number]): number[] {
  const found: number[] = [];
  for (let k = 0; k < index.length; k += 3) {
    const [[ax, ay], [bx, by], [cx, cy]] = [at(index[k]!), at(index[k + 1]!), at(index[k + 2]!)] as const;
    found.push((((bx - ax) * (cy - ay) - (cx - ax) * (by - ay)) / 2) * 1e6);
  }
  return found;
}

function places(cut: Uint8Array) {
  const torn = tear(SIZE, NX, NY, cut);
  const at = (corner: number): readonly [number, number] => {
    if (corner < NX * NY) return [1e-3 * (corner % NX), 1e-3 * Math.floor(corner / NX)];
    const { x, y } = torn.corners[corner - NX * NY]!;
    return [x, y];
  };
  return { torn, at };
}

describe("a sheet that is cut", () => {
  it("is whole where nothing is", () => {
    const { torn } = places(new Uint8Array(3 * NODES));
    expect(torn.corners).toEqual([]);
    expect(torn.index.length).toBe(3 * 2 * (NX - 1) * (NY - 1));
  });

  it("loses nothing at a closed slit, and faces upwards everywhere", () => {
    for (const cut of [across(1, 3), across(0, 4), across(0, 4, 0.1), across(1, 3, 1), new Uint8Array(3 * NODES).fill(100)]) {
      const { torn, at } = places(cut);
      const found = areas(torn.index, at);
      expect(found.every((area) => area > -1e-9)).toBe(true);
      expect(found.reduce((sum, area) => sum + area, 0)).toBeCloseTo(12, 9); // 4 mm by 3 mm
    }
  });

  it("falls apart along a cut from side to side, and hangs together past a shorter one", () => {
    const reach = (cut: Uint8Array): Set<number> => {
      const { torn, at } = places(cut);
      const seen = new Set([0]); // corners at one place that belong to other nodes are not joined
      for (let more = true; more; ) {
        more = false;
        for (let k = 0; k < torn.index.length; k += 3) {
          const three = torn.index.slice(k, k + 3);
          if (three.some((one) => seen.has(one)) && three.some((one) => !seen.has(one))) {
            for (const one of three) seen.add(one);
            more = true;
          }
        }
      }
      expect(at(0)).toEqual([0, 0]);
      return seen;
    };
    expect(reach(across(0, 4)).has(NX * NY - 1)).toBe(false);
    expect(reach(across(1, 3)).has(NX * NY - 1)).toBe(true);
  });

  it("is parted where the cut went, not half-way between its nodes", () => {
    const { torn } = places(across(0, 4, 0.2));
    expect(torn.corners.length).toBeGreaterThan(0);
    for (const { y } of torn.corners) expect(y).toBeCloseTo(1.2e-3, 9);
    const slanted = new Uint8Array(3 * NODES); // one corner of a square, off
    slanted[EAST * NODES + NX + 1] = 204;
    slanted[BOTH * NODES + NX + 1] = 102;
    const found = places(slanted).torn.corners.map(({ x, y }) => [1e3 * x, 1e3 * y]);
    for (const [x, y] of found) expect([[1.8, 1], [1.4, 1.4]]).toContainEqual([expect.closeTo(x!, 6), expect.closeTo(y!, 6)]);
    expect(found.length).toBe(4);
  });

  it("opens as its flanks go apart", () => {
    const surface = new Surface(SIZE, NX, NY);
    const cut = across(0, 4);
    const moved = new Float32Array(2 * NX * NY);
    moved.fill(5e-4, NX * NY + 2 * NX); // the far half, away from the near one
    const frame = { ...readFrame(bytes(FRAME)), layers: 1, nx: NX, ny: NY, heights: new Float32Array(NX * NY) };
    surface.update({ ...frame, inPlane: moved, cut });
    const position = surface.geometry.getAttribute("position");
    const rows = new Set<string>();
    for (let at = NX * NY; at < position.count; at++) rows.add(position.getY(at).toFixed(6));
    expect([...rows].sort()).toEqual(["0.001400", "0.001900"]);
    const before = surface.geometry.index;
    surface.update({ ...frame, inPlane: moved, cut: cut.slice() });
    expect(surface.geometry.index).toBe(before); // the same cut tears nothing anew
  });
});
