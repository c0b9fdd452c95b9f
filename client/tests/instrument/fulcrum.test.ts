import { describe, expect, it } from "vitest";

import { handleFor, keepPossible, reach, slide } from "../../src/instrument/fulcrum";
import { norm, subtract, type Vector } from "../../src/vector";
import { LENGTH, RIGHT_PORT } from "../sample";

const SHAFT = { port: RIGHT_PORT, length: LENGTH };
const TIP: Vector = [0.04, 0.03, 0.005];
const HANDLE = handleFor(TIP, SHAFT);
const EXACT = 12; // digits; double precision over lengths of a third of a metre

function close(a: Vector, b: Vector): void {
  a.forEach((value, axis) => expect(value).toBeCloseTo(b[axis] as number, EXACT));
}

describe("the fulcrum", () => {
  it("has the tip on the line through handle and port, a shaft's length away", () => {
    const { tip, direction, inside } = reach([0, 0, 0.2], { port: [0, 0, 0.1], length: 0.3 });
    close(tip, [0, 0, -0.1]);
    close(direction, [0, 0, -1]);
    expect(inside).toBeCloseTo(0.2, EXACT);
  });

  it("goes back from a tip to its handle", () => {
    close(reach(HANDLE, SHAFT).tip, TIP);
  });

  it("sends the tip the other way, by the lever", () => {
    const shaft = { port: [0, 0, 0.1] as Vector, length: 0.3 };
    const step = 1e-6; // small enough that what is left of the second order is 1e-12
    const { tip } = reach([step, 0, 0.3], shaft);
    expect(tip[0] / step).toBeCloseTo(-0.1 / 0.2, 9);
  });

  it("slides along itself", () => {
    const { tip } = reach(slide(HANDLE, RIGHT_PORT, 0.01), SHAFT);
    expect(norm(subtract(tip, TIP))).toBeCloseTo(0.01, EXACT);
    expect(tip[2]).toBeLessThan(TIP[2]);
  });
});

describe("a pose is kept possible", () => {
  const pose = { handle: HANDLE, roll: 0, jaw: 1, present: true };

  it("as it is, where it is", () => {
    close(keepPossible(pose, SHAFT, -0.01).handle, HANDLE);
  });

  it("with the tip above the floor", () => {
    const deep = { ...pose, handle: slide(HANDLE, RIGHT_PORT, 0.05) };
    const { tip } = reach(keepPossible(deep, SHAFT, -0.01).handle, SHAFT);
    expect(tip[2]).toBeCloseTo(-0.01, EXACT);
  });

  it("with the tip beyond the port however far the hand draws back", () => {
    const far = { ...pose, handle: slide(HANDLE, RIGHT_PORT, -0.5) };
    expect(reach(keepPossible(far, SHAFT, -0.01).handle, SHAFT).inside).toBeCloseTo(0.005, EXACT);
  });

  it("with the handle outside, even in the port itself", () => {
    const { handle } = keepPossible({ ...pose, handle: RIGHT_PORT }, SHAFT, -10);
    expect(norm(subtract(RIGHT_PORT, handle))).toBeCloseTo(0.02, EXACT);
  });

  it("within the turns and openings the trainer takes", () => {
    const wild = keepPossible({ ...pose, roll: 1e6, jaw: -3 }, SHAFT, -0.01);
    expect(Math.abs(wild.roll)).toBeLessThan(2 * Math.PI);
    expect(wild.jaw).toBe(0);
  });
});
