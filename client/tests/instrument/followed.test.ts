import { describe, expect, it } from "vitest";

import { asHeld } from "../../src/instrument/drawn";
import { Followed } from "../../src/instrument/followed";
import { norm } from "../../src/vector";
import { type Frame, type InstrumentState, readFrame } from "../../src/wire/frame";
import { bytes, FRAME } from "../wire/golden";

const INTERVAL = 0.01; // between frames [s]
const STEP = 1e-3; // of the tip in one [m]

/** The k-th frame of instruments that move evenly: tips along x, shafts turning, jaws closing. */
function frame(k: number, changes: Partial<InstrumentState> = {}): Frame {
  const golden = readFrame(bytes(FRAME));
  const state = (at: 0 | 1): InstrumentState => ({
    ...golden.instruments[at],
    tip: [STEP * k, 0.02, -0.001],
    direction: [Math.sin(0.1 * k), 0, -Math.cos(0.1 * k)],
    roll: 0.2 * k,
    jaw: Math.max(1 - 0.3 * k, 0),
    present: true,
    holding: false,
    ...changes,
  });
  return { ...golden, time: INTERVAL * k, instruments: [state(0), state(1)] };
}

function followed(...frames: readonly [Frame, number][]): Followed {
  const made = new Followed();
  for (const [each, now] of frames) made.take(each, now);
  return made;
}

describe("instruments the trainer moves", () => {
  it("are not drawn before the first frame", () => {
    expect(new Followed().drawn(0)).toBeNull();
  });

  it("are drawn exactly as a frame has them in the turn that brings it", () => {
    const [left] = followed([frame(1), 100], [frame(2), 110]).drawn(110) ?? [];
    expect(left).toMatchObject({ tip: [2 * STEP, 0.02, -0.001], roll: 0.4, jaw: 0.4, present: true, holding: false });
  });

  it("are carried on between frames as they moved, and no further than one interval", () => {
    const instruments = followed([frame(1), 100], [frame(2), 110]);
    const half = instruments.drawn(115)?.[1];
    expect(half?.tip[0]).toBeCloseTo(2.5 * STEP, 12);
    expect(half?.roll).toBeCloseTo(0.5, 12);
    expect(half?.jaw).toBeCloseTo(0.25, 12);
    expect(norm(half?.direction ?? [0, 0, 0])).toBeCloseTo(1, 12);
    const late = instruments.drawn(10_000)?.[1];
    expect(late?.tip[0]).toBeCloseTo(3 * STEP, 12);
    expect(late?.jaw).toBeCloseTo(0.1, 12);
  });

  it("never open wider than open nor close further than closed", () => {
    expect(followed([frame(3), 0], [frame(4), 10]).drawn(20)?.[0].jaw).toBe(0);
  });

  it("stand still where the time between frames says nothing of the motion", () => {
    const standing = (...times: number[]): number | undefined => {
      const frames = times.map((time, k) => [{ ...frame(k), time }, 10 * k] as [Frame, number]);
      return followed(...frames).drawn(1000)?.[0].tip[0];
    };
    expect(standing(0, 0)).toBe(STEP); // the servo stands still
    expect(standing(5, 0.001)).toBe(STEP); // it began anew
    expect(standing(0, 2)).toBe(STEP); // the connection was lost for a while
    expect(standing(0, 0.01)).toBeCloseTo(2 * STEP, 12); // none of these
  });

  it("come into the picture where they are, not from where they were before", () => {
    const came = followed([frame(1, { present: false }), 0], [frame(2), 10]).drawn(20)?.[0];
    expect(came?.tip[0]).toBe(2 * STEP);
    const gone = followed([frame(1), 0], [frame(2, { present: false }), 10]).drawn(10)?.[0];
    expect(gone?.present).toBe(false);
  });

  it("are forgotten with the connection", () => {
    const instruments = followed([frame(1), 0]);
    instruments.clear();
    expect(instruments.drawn(10)).toBeNull();
  });
});

describe("an instrument a hand of the page holds", () => {
  it("is where the hand has it, and holds tissue when the trainer says so", () => {
    const pose = { handle: [0, 0, 0.2], roll: 1, jaw: 0.5, present: true } as const;
    const reach = { tip: [0.01, 0.02, 0], direction: [0, 0, -1], inside: 0.1 } as const;
    expect(asHeld(pose, reach, true)).toEqual({
      tip: reach.tip,
      direction: reach.direction,
      roll: 1,
      jaw: 0.5,
      present: true,
      holding: true,
    });
  });
});
