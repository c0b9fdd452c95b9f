import { Matrix4, Vector3 } from "three";
import { describe, expect, it } from "vitest";

import { CutFace } from "../../src/scene/cut-face";
import { beforeTheHead } from "../../src/scene/immersion";
import { Noise, random } from "../../src/scene/noise";
import { Sharpness } from "../../src/scene/sharpness";
import { Surface } from "../../src/scene/surface";
import { vessels } from "../../src/scene/vessels";
import { type Frame, readFrame } from "../../src/wire/frame";
import { bytes, FRAME } from "../wire/golden";

const SIZE = [0.06, 0.04] as const;

function bent(nx: number, ny: number, height: (x: number, y: number) => number, inPlane = false): Frame {
  const heights = new Float32Array(2 * nx * ny);
  for (let j = 0; j < ny; j++) {
    for (let i = 0; i < nx; i++) {
      const z = height((SIZE[0] * i) / (nx - 1), (SIZE[1] * j) / (ny - 1));
      heights[j * nx + i] = z;
      heights[nx * ny + j * nx + i] = z / 2;
    }
  }
  const moved = inPlane ? new Float32Array(2 * nx * ny).fill(1e-3) : null;
  return { ...readFrame(bytes(FRAME)), layers: 2, nx, ny, heights, inPlane: moved };
}

describe("the surface", () => {
  it("is drawn one to one: each node where the frame has it", () => {
    const surface = new Surface(SIZE, 7, 5);
    surface.update(bent(7, 5, (x, y) => x * y, true));
    const position = surface.geometry.getAttribute("position");
    for (const at of [0, 9, 34]) {
      const x = (SIZE[0] * (at % 7)) / 6;
      const y = (SIZE[1] * Math.floor(at / 7)) / 4;
      // float32, of lengths below 0.1 m
      expect(position.getX(at)).toBeCloseTo(x + 1e-3, 8);
      expect(position.getY(at)).toBeCloseTo(y + 1e-3, 8);
      expect(position.getZ(at)).toBeCloseTo(x * y, 8);
    }
  });

  it("has normals across a slope, out of the tissue", () => {
    const surface = new Surface(SIZE, 7, 5);
    surface.update(bent(7, 5, (x) => -0.75 * x));
    const normal = surface.geometry.getAttribute("normal");
    for (let at = 0; at < 35; at++) {
      expect(normal.getX(at)).toBeCloseTo(0.6, 5);
      expect(normal.getY(at)).toBeCloseTo(0, 5);
      expect(normal.getZ(at)).toBeCloseTo(0.8, 5);
    }
  });

  it("begins at an organ's heights and leaves out what is beside it", () => {
    const rest = Array.from({ length: 35 }, (_, at) => (at % 7 === 0 ? null : -0.001 * (at % 7) ** 2));
    const surface = new Surface(SIZE, 7, 5, { rest_m: rest, rim: [15], rim_m: [[0.004, 0.021]] });
    const position = surface.geometry.getAttribute("position");
    expect(position.getZ(9)).toBeCloseTo(-0.004, 8);
    expect(surface.geometry.index?.count).toBe(5 * 4 * 6); // a column of cells has a corner beside the organ
    surface.update(bent(7, 5, () => -0.002));
    expect(position.getZ(9)).toBeCloseTo(-0.006, 8);
    expect([position.getX(15), position.getY(15)].map((place) => place.toFixed(6))).toEqual(["0.004000", "0.021000"]);
    expect(surface.geometry.getAttribute("normal").getX(8)).toBeGreaterThan(0.2); // one-sided where there is no neighbour
    expect(surface.geometry.getAttribute("color").getX(9)).toBeCloseTo(1, 5); // a dome has no hollows of its own
  });

  it("is darker in a hollow and nowhere brighter than flat", () => {
    const surface = new Surface(SIZE, 31, 21);
    surface.update(bent(31, 21, (x, y) => -0.004 * Math.exp(-((x - 0.03) ** 2 + (y - 0.02) ** 2) / 5e-5)));
    const shade = surface.geometry.getAttribute("color");
    expect(shade.getX(10 * 31 + 15)).toBeLessThan(0.75);
    expect(shade.getX(0)).toBeCloseTo(1, 5);
    for (let at = 0; at < shade.count; at++) expect(shade.getX(at)).toBeLessThanOrEqual(1);
  });

  it("faces outwards everywhere", () => {
    const surface = new Surface(SIZE, 4, 3);
    expect(facing(surface.geometry, () => new Vector3(0, 0, 1))).toBe(true);
  });
});

describe("a cut face", () => {
  it("hangs between its layer's upper face and the next one's, all round, facing outwards", () => {
    const cut = new CutFace(SIZE, 4, 3, 0, 0, -0.002);
    cut.update(bent(4, 3, () => 0.001));
    const position = cut.geometry.getAttribute("position");
    const half = position.count / 2;
    expect(half).toBe(2 * (4 + 3));
    for (let k = 0; k < half; k++) {
      expect(position.getZ(k)).toBeCloseTo(0.001, 8);
      expect(position.getZ(half + k)).toBeCloseTo(-0.002 + 0.0005, 8);
    }
    const normal = cut.geometry.getAttribute("normal");
    expect(facing(cut.geometry, (at) => new Vector3().fromBufferAttribute(normal, at))).toBe(true);
  });

  it("lies still where the lowest layer lies on its bed", () => {
    const cut = new CutFace(SIZE, 4, 3, 1, -0.002, -0.01);
    cut.update(bent(4, 3, () => 0.001));
    expect(cut.geometry.getAttribute("position").getZ(20)).toBeCloseTo(-0.01, 8);
  });
});

/** Whether every triangle of a geometry turns its front to a direction at its first corner. */
function facing(geometry: Surface["geometry"], outwards: (at: number) => Vector3): boolean {
  const position = geometry.getAttribute("position");
  const index = geometry.getIndex();
  if (!index) return false;
  for (let k = 0; k < index.count; k += 3) {
    const [a, b, c] = [0, 1, 2].map((n) => new Vector3().fromBufferAttribute(position, index.getX(k + n))) as [
      Vector3,
      Vector3,
      Vector3,
    ];
    if (b.sub(a).cross(c.sub(a)).dot(outwards(index.getX(k))) <= 0) return false;
  }
  return true;
}

describe("textures from code", () => {
  it("repeat without a seam and the same each time", () => {
    const noise = new Noise(3);
    expect(noise.sum(0.2, 1.3, 5, 4)).toBeCloseTo(noise.sum(1.2, 0.3, 5, 4), 6);
    expect(random(5)()).toBe(random(5)());
    expect(random(5)()).not.toBe(random(6)());
    const shown = vessels(256, 1);
    const share = shown.reduce((sum, cover) => sum + cover, 0) / shown.length;
    expect(share).toBeGreaterThan(0.005); // lines, neither none nor everywhere
    expect(share).toBeLessThan(0.3);
  });
});

describe("sharpness", () => {
  it("falls while frames are slow, rises when they have long been smooth, and obeys a choice", () => {
    const sharpness = new Sharpness();
    for (let i = 0; i < 20; i++) sharpness.take(100);
    expect(sharpness.share).toBe(0.35);
    for (let i = 0; i < 6000; i++) sharpness.take(16.7);
    expect(sharpness.share).toBe(0.5);
    sharpness.choice = "sharp";
    expect(sharpness.share).toBe(1);
  });
});

describe("in the headset", () => {
  it("the block lies before and below the head, level, turned to the user", () => {
    const head = new Matrix4().makeRotationY(0.7).setPosition(1, 1.6, -2);
    const rig = beforeTheHead(new Float32Array(head.elements), [0.03, 0.02, 0]);
    const seen = new Vector3(1, 1.6, -2).applyMatrix4(rig);
    // float32 poses of a few metres
    expect(seen.x).toBeCloseTo(0.03, 5);
    expect(seen.y).toBeCloseTo(0.02 - 0.38, 5);
    expect(seen.z).toBeCloseTo(0.44, 5);
    expect(new Vector3(0, 1, 0).transformDirection(rig).z).toBeCloseTo(1, 6);
  });
});
