import { describe, expect, it } from "vitest";

import { HEADER } from "../../src/wire/contract";
import { frameSequence, readFrame } from "../../src/wire/frame";
import { fromHalf } from "../../src/wire/half";
import { WireError } from "../../src/wire/messages";
import { bytes, FRAME } from "./golden";

describe("a frame", () => {
  const frame = readFrame(bytes(FRAME));

  it("gives the header", () => {
    expect(frame).toMatchObject({
      sequence: 9,
      tick: 2 ** 33 + 7,
      time: 12.5,
      poseSequence: [41, 42],
      rate: 999.5,
      missedTicks: 3,
      tickP50: 24.5,
      tickP99: 61,
      status: { alive: true, degraded: false, beyondLinear: true, forcesCut: false },
      layers: 1,
      nx: 2,
      ny: 2,
    });
  });

  it("gives both instruments", () => {
    const [left, right] = frame.instruments;
    expect(left).toMatchObject({ roll: 0.25, jaw: 0.5, present: true, touching: false, holding: false });
    expect(right).toMatchObject({ roll: 0.5, jaw: 0.5, present: true, touching: true, holding: true });
    expect(right.force).toEqual([0, 0.125, 1]);
    expect(right.handleForce).toEqual([0, -0.0625, 0.25]);
    // float32 keeps seven digits
    expect(left.tip[0]).toBeCloseTo(0.01, 8);
    expect(left.direction[2]).toBeCloseTo(-0.8, 6);
    expect(left.depth).toBeCloseTo(0.003, 8);
  });

  it("gives heights in metres, x fastest, and the top face's in-plane displacement", () => {
    // float16 keeps three digits of a displacement
    const expected = [0, -1.5e-3, 2.5e-4, -6e-3];
    expected.forEach((height, at) => expect(frame.heights[at]).toBeCloseTo(height, 6));
    expect(frame.inPlane).toHaveLength(8);
    expect(frame.inPlane?.[0]).toBeCloseTo(1e-3, 6);
    expect(frame.inPlane?.[7]).toBeCloseTo(-1e-3, 6);
  });

  it("gives what is cut of a sheet, and nothing of what cannot be", () => {
    expect(frame.cut).toBeNull();
    const plain = new Uint8Array(bytes(FRAME));
    const cut = new Uint8Array([...plain, 0, 2, 0, 4, 0, 128, 0, 0, 255, 0, 0, 1]);
    new DataView(cut.buffer).setUint32(HEADER.cut, 1, true);
    expect([...(readFrame(cut.buffer).cut as Uint8Array)]).toEqual([0, 2, 0, 4, 0, 128, 0, 0, 255, 0, 0, 1]);
    expect(readFrame(cut.buffer).inPlane).toEqual(frame.inPlane);
    expect(() => readFrame(cut.slice(0, -1).buffer)).toThrow(WireError);
  });

  it("is refused when it is no such frame", () => {
    expect(() => readFrame(bytes(FRAME).slice(0, 200))).toThrow(WireError);
    expect(() => frameSequence(new ArrayBuffer(64))).toThrow(WireError);
    expect(() => frameSequence(new ArrayBuffer(8))).toThrow("too short");
  });
});

describe("a half", () => {
  it.each([
    [0x0000, 0],
    [0x3c00, 1],
    [0xc000, -2],
    [0x3555, 1365 / 4096],
    [0x0001, 2 ** -24],
    [0x03ff, 1023 * 2 ** -24],
    [0x7bff, 65504],
    [0x7c00, Infinity],
    [0xfc00, -Infinity],
  ])("of bits %i is %f", (bits, value) => {
    expect(fromHalf(Uint16Array.of(bits), 1)[0]).toBe(value);
  });

  it("knows what is not a number", () => {
    expect(fromHalf(Uint16Array.of(0x7e00), 1)[0]).toBeNaN();
  });
});
