import { describe, expect, it } from "vitest";

import { across, ActiveHand, type View } from "../../src/input/device";
import { GamepadDevice, type Pad } from "../../src/input/gamepad";
import { type Controller, HeadsetDevice } from "../../src/input/headset";
import { Mouse } from "../../src/input/mouse";
import { reach } from "../../src/instrument/fulcrum";
import { dot, norm, subtract, type Vector } from "../../src/vector";
import { hands, LENGTH, RIGHT_PORT, VIEW } from "../sample";

const SHAFT = { port: RIGHT_PORT, length: LENGTH };
const START = hands()[1].pose.handle;
const ARC = 3.7; // digits: a hand on a 0.19 m arc about the port leaves the straight line by 0.1 mm in 5 mm

/** How far a handle moved to the right and up the view [m]. */
function seen(handle: Vector = START): [number, number] {
  const moved = subtract(handle, START);
  return [dot(moved, VIEW.right), dot(moved, VIEW.up)];
}

describe("moving across the view", () => {
  it("sends the tip exactly the other way on the picture, without sliding", () => {
    const step = 1e-6; // [m]; the second order is then 1e-11
    for (const [right, up] of [[step, 0], [0, step], [-step, step]] as const) {
      const before = reach(START, SHAFT);
      const after = reach(across(START, RIGHT_PORT, VIEW, right, up), SHAFT);
      expect(after.inside).toBeCloseTo(before.inside, 12);
      const moved = subtract(after.tip, before.tip);
      const lever = before.inside / (LENGTH - before.inside);
      expect(dot(moved, VIEW.right)).toBeCloseTo(-lever * right, 10);
      expect(dot(moved, VIEW.up)).toBeCloseTo(-lever * up, 10);
    }
  });

  it("stays bounded where the shaft lies across the line of sight", () => {
    const aside: View = { ...VIEW, right: [0, 0.8, -0.6], forward: [-1, 0, 0] };
    const moved = subtract(across([0.2, -0.02, 0.3], [0.2, 0, 0.1], aside, 0.001, 0), [0.2, -0.02, 0.3]);
    expect(norm(moved)).toBeLessThan(0.004);
  });
});

describe("the mouse", () => {
  it("carries the handle with it across the view, once", () => {
    const mouse = new Mouse(new ActiveHand());
    mouse.move(30, -10, false);
    const [left, right] = mouse.poses(hands(), VIEW, 0.02);
    expect(left).toBeNull();
    expect(seen(right?.handle)[0]).toBeCloseTo(30e-4, ARC);
    expect(seen(right?.handle)[1]).toBeCloseTo(10e-4, ARC);
    expect(mouse.poses(hands(), VIEW, 0.02)).toEqual([null, null]);
  });

  it("slides with the wheel or with Shift, and turns with Ctrl", () => {
    const mouse = new Mouse(new ActiveHand());
    const inside = reach(START, SHAFT).inside;
    mouse.scroll(-100, false);
    const [, wheeled] = mouse.poses(hands(), VIEW, 0.02);
    expect(reach(wheeled?.handle ?? START, SHAFT).inside).toBeCloseTo(inside + 0.002, 12);
    mouse.move(0, -10, true);
    const [, shifted] = mouse.poses(hands(), VIEW, 0.02);
    expect(reach(shifted?.handle ?? START, SHAFT).inside).toBeCloseTo(inside + 0.001, 12);
    mouse.scroll(100, true);
    const [, turned] = mouse.poses(hands(), VIEW, 0.02);
    expect(turned?.roll).toBeCloseTo(Math.PI / 12, 12);
    turned?.handle.forEach((value, axis) => expect(value).toBeCloseTo(START[axis] as number, 12));
  });

  it("squeezes while the button is down and lets go after", () => {
    const mouse = new Mouse(new ActiveHand());
    const both = hands();
    const step = (): number => {
      const [, right] = mouse.poses(both, VIEW, 0.05);
      if (right) both[1] = { ...both[1], pose: right };
      return both[1].pose.jaw;
    };
    mouse.squeeze(true);
    expect(step()).toBeCloseTo(0.7, 12);
    for (let i = 0; i < 5; i++) step();
    expect(step()).toBe(0);
    mouse.squeeze(false);
    for (let i = 0; i < 5; i++) step();
    expect(step()).toBe(1);
    expect(mouse.poses(both, VIEW, 0.05)).toEqual([null, null]);
  });

  it("keeps nothing of what it does while a device of the trainer's own steers", () => {
    const active = new ActiveHand();
    const mouse = new Mouse(active);
    active.steers = false;
    mouse.move(30, -10, false);
    mouse.scroll(-100, false);
    mouse.squeeze(true);
    active.swap();
    active.steers = true;
    expect(active.side).toBe(1);
    expect(mouse.poses(hands(), VIEW, 0.02)).toEqual([null, null]);
  });
});

function pad(axes: number[], pressed: Record<number, number> = {}): Pad {
  const buttons = Array.from({ length: 17 }, (_, k) => ({ value: pressed[k] ?? 0, pressed: (pressed[k] ?? 0) > 0.5 }));
  return { connected: true, mapping: "standard", axes, buttons };
}

describe("a gamepad", () => {
  it("moves each hand with its stick, up meaning up", () => {
    const device = new GamepadDevice(() => [null, pad([-1, 0, 0, -1])]);
    const [left, right] = device.poses(hands(), VIEW, 0.1);
    expect((left?.handle[0] ?? 0) - hands()[0].pose.handle[0]).toBeCloseTo(-0.004, ARC);
    expect(seen(right?.handle)[1]).toBeCloseTo(0.004, ARC);
  });

  it("rests while its sticks only wander", () => {
    const device = new GamepadDevice(() => [pad([0.1, -0.1, 0.05, 0.11])]);
    expect(device.poses(hands(), VIEW, 0.1)).toEqual([null, null]);
  });

  it("squeezes as far as the trigger is drawn, opens when it is let go, then leaves the jaw alone", () => {
    let now = pad([0, 0, 0, 0], { 7: 0.75 });
    const device = new GamepadDevice(() => [now]);
    expect(device.poses(hands(), VIEW, 0.1)[1]?.jaw).toBe(0.25);
    now = pad([0, 0, 0, 0]);
    expect(device.poses(hands(), VIEW, 0.1)[1]?.jaw).toBe(1);
    expect(device.poses(hands(), VIEW, 0.1)).toEqual([null, null]);
  });

  it("slides and turns by its buttons", () => {
    const device = new GamepadDevice(() => [pad([0, 0, 0, 0], { 5: 1, 1: 1 })]);
    const [left, right] = device.poses(hands(), VIEW, 0.1);
    expect(left).toBeNull();
    expect(reach(right?.handle ?? START, SHAFT).inside).toBeCloseTo(reach(START, SHAFT).inside + 0.004, 12);
    expect(right?.roll).toBeCloseTo(0.2, 12);
  });

  it("is not guessed at when its layout is not the standard one", () => {
    const device = new GamepadDevice(() => [{ ...pad([1, 1, 1, 1]), mapping: "" }]);
    expect(device.poses(hands(), VIEW, 0.1)).toEqual([null, null]);
  });
});

describe("a headset", () => {
  it("makes each controller a handle, in the hand while it is tracked", () => {
    const right: Controller = { position: [0.2, -0.1, 0.3], twist: 0.4, trigger: 0.25 };
    const device = new HeadsetDevice(() => [null, right]);
    expect(device.poses(hands(), VIEW, 0.01)).toEqual([
      null,
      { handle: [0.2, -0.1, 0.3], roll: 0, jaw: 0.75, present: true },
    ]);
  });

  it("turns the shaft by what the fist turned, through half a turn and on", () => {
    let twist = 3.0;
    const device = new HeadsetDevice(() => [null, { position: [0, 0, 0.3], twist, trigger: 0 }]);
    const both = hands();
    for (twist of [3.0, 3.1, -3.1, -3.0]) {
      const [, right] = device.poses(both, VIEW, 0.01);
      if (right) both[1] = { ...both[1], pose: right };
    }
    expect(both[1].pose.roll).toBeCloseTo(2 * Math.PI - 6, 12);
  });
});
