import { describe, expect, it } from "vitest";

import type { Device } from "../../src/input/device";
import { Hands } from "../../src/instrument/hands";
import { hello, VIEW } from "../sample";

describe("the hands", () => {
  it("begin where the trainer says", () => {
    const hands = new Hands(hello());
    expect(hands.reach(0).tip[0]).toBeCloseTo(0.02, 12);
    expect(hands.reach(1).tip[0]).toBeCloseTo(0.04, 12);
  });

  it("move what a device moves and nothing else", () => {
    const hands = new Hands(hello());
    const [left, right] = hands.poses;
    const device: Device = { poses: () => [null, { ...right, roll: 1 }] };
    hands.move(device, VIEW, 0.01);
    expect(hands.poses[0]).toBe(left);
    expect(hands.poses[1].roll).toBe(1);
  });

  it("keep what a device answers possible", () => {
    const hands = new Hands(hello());
    const device: Device = { poses: ([left]) => [{ ...left.pose, jaw: 7 }, null] };
    hands.move(device, VIEW, 0.01);
    expect(hands.poses[0].jaw).toBe(1);
  });
});
