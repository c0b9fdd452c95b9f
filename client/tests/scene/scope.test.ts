import { describe, expect, it } from "vitest";

import { Scope } from "../../src/scene/scope";
import { dot, norm, scale, subtract, unit, type Vector, add } from "../../src/vector";

const PORT: Vector = [0.03, -0.07, 0.11];
const TARGET: Vector = [0.03, 0.03, 0];

describe("the endoscope", () => {
  it.each([0, 30] as const)("of %i degrees looks at the target from home, upright", (angle) => {
    const scope = new Scope(PORT, TARGET);
    scope.choose(angle);
    const { eye, forward, up } = scope.look();
    const distance = norm(subtract(TARGET, eye));
    const met = add(eye, scale(forward, distance));
    expect(norm(subtract(met, TARGET))).toBeLessThan(1e-12);
    expect(dot(forward, up)).toBeCloseTo(0, 12);
    expect(norm(up)).toBeCloseTo(1, 12);
    expect(up[2]).toBeGreaterThan(0);
    expect(Math.abs(up[0])).toBeLessThan(1e-12);
  });

  it("of 30 degrees looks 30 degrees off its axis, wherever it is turned", () => {
    const scope = new Scope(PORT, TARGET);
    scope.choose(30);
    for (let k = 0; k < 12; k++) {
      scope.move(0.05, -0.03, 0.5, 0);
      const { eye, forward } = scope.look();
      const axis = unit(subtract(eye, PORT));
      expect(dot(axis, forward)).toBeCloseTo(Math.cos(Math.PI / 6), 12);
    }
  });

  it("keeps the horizon when a 30 degree scope is turned, and turns the picture of a 0 degree one", () => {
    const oblique = new Scope(PORT, TARGET);
    oblique.choose(30);
    oblique.move(0, 0, 1, 0);
    expect(oblique.look().up[2]).toBeGreaterThan(0.5);
    const straight = new Scope(PORT, TARGET);
    const before = straight.look();
    straight.move(0, 0, Math.PI / 2, 0);
    const after = straight.look();
    expect(dot(before.up, after.up)).toBeCloseTo(0, 12);
    expect(dot(before.forward, after.forward)).toBeCloseTo(1, 12);
  });

  it("turns about its port: the eye stays on a ball, and pan right looks right", () => {
    const scope = new Scope(PORT, TARGET);
    const before = norm(subtract(scope.look().eye, PORT));
    scope.move(0.2, 0.1, 0, 0);
    const { eye, forward } = scope.look();
    expect(norm(subtract(eye, PORT))).toBeCloseTo(before, 12);
    expect(forward[0]).toBeGreaterThan(0.1);
    expect(forward[2]).toBeGreaterThan(unit(subtract(TARGET, PORT))[2]);
  });

  it("slides in, but not into the tissue", () => {
    const scope = new Scope(PORT, TARGET);
    scope.move(0, 0, 0, 1);
    expect(norm(subtract(scope.look().eye, TARGET))).toBeCloseTo(0.02, 12);
    scope.move(0, 0, 0, -1);
    expect(norm(subtract(scope.look().eye, PORT))).toBeCloseTo(0.005, 12);
  });
});
