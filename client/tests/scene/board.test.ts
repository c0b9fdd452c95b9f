import { describe, expect, it } from "vitest";

import { placed } from "../../src/scene/board";
import { hollow } from "../../src/scene/cavity";
import { norm, subtract } from "../../src/vector";
import { hello } from "../sample";

describe("the board", () => {
  it("is as wide as it may be with its corners out of the wall, and stands over the tissue", () => {
    const { width, middle, corner } = placed(hello());
    const { centre, free } = hollow(hello());
    const reach = norm(subtract(corner, centre));
    expect(reach).toBeLessThan(free);
    expect(reach).toBeGreaterThan(0.95 * free);
    expect(width).toBeGreaterThan(0.14);
    expect(2 * middle[2] - corner[2]).toBeCloseTo(0.006);
  });

  it("is no wider than is good to read where there is room", () => {
    const far = hello().instruments.map((shape) => ({ ...shape, port_m: [0.4, 0, 0.4] as const }));
    expect(placed({ ...hello(), instruments: far }).width).toBe(0.19);
  });
});
