import { describe, expect, it } from "vitest";

import type { HandlePose } from "../../src/instrument/pose";
import { writePose } from "../../src/wire/pose";
import { Sending } from "../../src/wire/sending";
import { hex, POSE } from "./golden";

const POSED: HandlePose = { handle: [0.125, -0.25, 0.5], roll: -1.5, jaw: 0.75, present: true };

describe("a pose", () => {
  it("is written as the trainer writes it", () => {
    expect(hex(writePose(1, 258, POSED))).toBe(POSE);
  });

  it("says whether a headset's controller is the handle", () => {
    const flags = (pose: HandlePose, tracked: boolean): number =>
      new DataView(writePose(0, 1, pose, tracked)).getUint32(12, true);
    expect([flags(POSED, false), flags(POSED, true), flags({ ...POSED, present: false }, true)]).toEqual([1, 3, 2]);
  });

  it("never opens a jaw wider than open", () => {
    const view = new DataView(writePose(0, 1, { ...POSED, jaw: 1.25 }));
    expect(view.getFloat32(44, true)).toBe(1);
  });
});

describe("sending", () => {
  it("sends a change at most ninety times a second and rest twice a second", () => {
    const sending = new Sending();
    let changing = 0;
    for (let now = 0; now < 1000; now += 1000 / 240) {
      if (sending.due({ ...POSED, roll: now }, now) !== null) changing += 1;
    }
    expect(changing).toBeGreaterThan(75);
    expect(changing).toBeLessThanOrEqual(100); // 90, and what the slack lets through
    const still = { ...POSED };
    let resting = 0;
    for (let now = 2000; now < 12_000; now += 1000 / 60) if (sending.due(still, now) !== null) resting += 1;
    expect(resting).toBeGreaterThanOrEqual(19); // ten seconds, two each; the trainer hangs up after ten silent ones
    expect(resting).toBeLessThanOrEqual(21);
  });

  it("numbers poses upwards and begins anew when told to", () => {
    const sending = new Sending();
    expect([sending.due(POSED, 0), sending.due(POSED, 5), sending.due(POSED, 600)]).toEqual([1, null, 2]);
    sending.clear();
    expect(sending.due(POSED, 601)).toBe(1);
  });
});
