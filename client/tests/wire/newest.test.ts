import { describe, expect, it } from "vitest";

import { Newest } from "../../src/wire/newest";
import { frame } from "./golden";

describe("the newest frame", () => {
  it("is taken and acknowledged, and what it replaced is not", () => {
    const acknowledged: number[] = [];
    const frames = new Newest((sequence) => acknowledged.push(sequence));
    frames.put(frame(1));
    frames.put(frame(2));
    expect(acknowledged).toEqual([]);
    expect(frames.take()?.sequence).toBe(2);
    expect(frames.take()).toBeNull();
    expect(acknowledged).toEqual([2]);
    expect(frames.skipped).toBe(1);
  });

  it("is never replaced by an older one", () => {
    const frames = new Newest(() => undefined);
    frames.put(frame(5));
    frames.put(frame(4));
    expect(frames.take()?.sequence).toBe(5);
    frames.put(frame(5));
    expect(frames.take()).toBeNull();
  });

  it("lets a page of any pace draw from a server that waits for acknowledgements", () => {
    let known = 0;
    let sent = 0;
    const frames = new Newest((sequence) => {
      known = sequence;
    });
    let drawn = 0;
    let last = 0;
    for (let tick = 0; tick < 900; tick++) {
      if (sent - known < 2) frames.put(frame(++sent));
      if (tick % 7 === 0) {
        const taken = frames.take();
        if (taken) {
          drawn += 1;
          expect(taken.sequence).toBeGreaterThan(last);
          expect(sent - taken.sequence).toBe(0); // nothing newer was waiting
          last = taken.sequence;
        }
      }
      expect(sent - known).toBeLessThanOrEqual(2);
    }
    expect(drawn).toBe(Math.ceil(900 / 7));
  });

  it("begins anew with a new connection", () => {
    const frames = new Newest(() => undefined);
    frames.put(frame(70));
    frames.clear();
    expect(frames.take()).toBeNull();
    frames.put(frame(1));
    expect(frames.take()?.sequence).toBe(1);
  });
});
