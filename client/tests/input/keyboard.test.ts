import { describe, expect, it } from "vitest";

import { ActiveHand, LEFT, RIGHT } from "../../src/input/device";
import { Keyboard } from "../../src/input/keyboard";
import { reach } from "../../src/instrument/fulcrum";
import { hands, LEFT_PORT, LENGTH, RIGHT_PORT, VIEW } from "../sample";

describe("the keyboard", () => {
  it.each(["ArrowRight", "KeyD"])("moves the right handle right with %s, so the tip goes left", (code) => {
    const keyboard = new Keyboard(new ActiveHand());
    expect(keyboard.press(code, false, false)).toBe(true);
    const [left, right] = keyboard.poses(hands(), VIEW, 0.1);
    expect(left).toBeNull();
    const start = hands()[1].pose.handle;
    expect((right?.handle[0] ?? 0) - start[0]).toBeCloseTo(0.003, 4); // on an arc about the port
    const shaft = { port: RIGHT_PORT, length: LENGTH };
    expect(reach(right?.handle ?? start, shaft).tip[0]).toBeLessThan(reach(start, shaft).tip[0]);
  });

  it("moves up the view, in along the shaft, and turns", () => {
    const keyboard = new Keyboard(new ActiveHand());
    for (const code of ["KeyW", "KeyX"]) keyboard.press(code, false, false);
    const [, right] = keyboard.poses(hands(), VIEW, 0.1);
    expect(right?.handle[2]).toBeGreaterThan(hands()[1].pose.handle[2]);
    expect(right?.roll).toBeCloseTo(0.2, 12);
    keyboard.releaseAll();
    keyboard.press("KeyQ", false, false);
    const [, pushed] = keyboard.poses(hands(), VIEW, 0.1);
    const shaft = { port: RIGHT_PORT, length: LENGTH };
    const start = hands()[1].pose.handle;
    expect(reach(pushed?.handle ?? start, shaft).inside).toBeCloseTo(reach(start, shaft).inside + 0.003, 12);
  });

  it("is slower with Shift and still when keys are let go", () => {
    const keyboard = new Keyboard(new ActiveHand());
    keyboard.press("ArrowRight", true, false);
    const [, right] = keyboard.poses(hands(), VIEW, 0.1);
    expect((right?.handle[0] ?? 0) - hands()[1].pose.handle[0]).toBeCloseTo(0.00075, 5); // on an arc
    keyboard.release("ArrowRight", false);
    expect(keyboard.poses(hands(), VIEW, 0.1)).toEqual([null, null]);
  });

  it("changes hands with Tab, but lets Shift and Tab go back through the page", () => {
    const told: number[] = [];
    const active = new ActiveHand((side) => told.push(side));
    const keyboard = new Keyboard(active);
    expect(keyboard.press("Tab", true, false)).toBe(false);
    expect(keyboard.press("Tab", false, false)).toBe(true);
    expect(keyboard.press("Tab", false, true)).toBe(true); // held down: once is enough
    expect(told).toEqual([LEFT]);
    keyboard.press("ArrowLeft", false, false);
    const [left, right] = keyboard.poses(hands(), VIEW, 0.1);
    expect(right).toBeNull();
    expect(reach(left?.handle ?? [0, 0, 0], { port: LEFT_PORT, length: LENGTH }).tip[0]).toBeGreaterThan(0.02);
  });

  it("closes the jaw with Space, goes on closing when hands change, and opens it again", () => {
    const active = new ActiveHand();
    const keyboard = new Keyboard(active);
    const both = hands();
    keyboard.press("Space", false, false);
    active.swap();
    for (let i = 0; i < 10; i++) {
      const [left, right] = keyboard.poses(both, VIEW, 0.05);
      if (left) both[0] = { ...both[0], pose: left };
      if (right) both[1] = { ...both[1], pose: right };
    }
    expect([both[0].pose.jaw, both[1].pose.jaw]).toEqual([1, 0]);
    expect(keyboard.poses(both, VIEW, 0.05)).toEqual([null, null]);
    active.swap();
    expect(active.side).toBe(RIGHT);
    keyboard.press("Space", false, false);
    expect(keyboard.poses(both, VIEW, 0.05)[1]?.jaw).toBeCloseTo(0.2, 12);
  });

  it("closes a jaw again that was asked to open and is not there yet", () => {
    const keyboard = new Keyboard(new ActiveHand());
    const both = hands();
    const after = (turns: number): number => {
      keyboard.press("Space", false, false);
      for (let i = 0; i < turns; i++) {
        const right = keyboard.poses(both, VIEW, 0.05)[RIGHT];
        if (right) both[RIGHT] = { ...both[RIGHT], pose: right };
      }
      return both[RIGHT].pose.jaw;
    };
    expect(after(10)).toBe(0);
    expect(after(2)).toBeGreaterThan(0);
    expect(after(10)).toBe(0);
  });

  it("leaves other keys to the page", () => {
    expect(new Keyboard(new ActiveHand()).press("F5", false, false)).toBe(false);
  });

  it("leaves every key to the page while a device of the trainer's own steers", () => {
    const active = new ActiveHand();
    const keyboard = new Keyboard(active);
    active.steers = false;
    for (const code of ["Tab", "Space", "ArrowLeft", "KeyQ"]) expect(keyboard.press(code, false, false)).toBe(false);
    expect(active.side).toBe(RIGHT);
    active.steers = true;
    expect(keyboard.poses(hands(), VIEW, 0.1)).toEqual([null, null]); // nothing was kept for later
  });
});
