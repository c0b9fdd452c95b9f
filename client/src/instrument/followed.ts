/**
 * Instruments that the trainer's own device moves, drawn from its frames.
 *
 * A turn of the page that brings a frame draws the instrument exactly as the frame has it, on the tissue of the same
 * frame. A turn that brings none, on a display faster than the stream, carries it on as it moved between the two
 * newest frames, for one such interval at most. Drawing between the two newest instead would show the hand a whole
 * interval late, and on a page that draws no faster than frames come it would smooth nothing in exchange. The price:
 * where a hand stops at once, its instrument is drawn too far for the fraction of an interval.
 */

import { add, clamp, scale, subtract, unit, type Vector } from "../vector";
import type { Frame, InstrumentState } from "../wire/frame";
import type { Drawn } from "./drawn";

const LONGEST = 0.05; // between two frames, beyond which the motion between them says nothing of what follows [s]

type Both = readonly [InstrumentState, InstrumentState];

export class Followed {
  private before: Both | null = null;
  private newest: Both | null = null;
  private interval = 0; // between both, of the trainer's time [s]
  private time = 0; // of the newest [s]
  private taken = 0; // when the newest came [ms]

  /** Take a frame. @param now [ms]. */
  take(frame: Frame, now: number): void {
    this.interval = frame.time - this.time;
    this.before = this.interval > 0 && this.interval <= LONGEST ? this.newest : null;
    this.newest = frame.instruments;
    this.time = frame.time;
    this.taken = now;
  }

  /** Forget what was seen: another trainer's time follows. */
  clear(): void {
    this.before = this.newest = null;
  }

  /** Return both instruments as they are to be drawn, null before the first frame. @param now [ms]. */
  drawn(now: number): readonly [Drawn, Drawn] | null {
    if (!this.newest) return null;
    const ahead = this.before ? clamp((now - this.taken) / 1000 / this.interval, 0, 1) : 0;
    const on = (side: 0 | 1): Drawn => carried(this.before?.[side], (this.newest as Both)[side], ahead);
    return [on(0), on(1)];
  }
}

/** Draw an instrument as a frame has it. */
export function asSeen(state: InstrumentState): Drawn {
  const { tip, direction, roll, jaw, present, holding } = state;
  return { tip, direction: unit(direction), roll, jaw, present, holding };
}

/** Carry an instrument on by a share of what it moved from one state to the next. */
function carried(from: InstrumentState | undefined, to: InstrumentState, ahead: number): Drawn {
  const { present, holding } = to;
  if (!from?.present || ahead === 0) {
    return asSeen(to);
  }
  return {
    tip: vector(from.tip, to.tip, ahead),
    direction: unit(vector(from.direction, to.direction, ahead)),
    roll: to.roll + ahead * (to.roll - from.roll),
    jaw: clamp(to.jaw + ahead * (to.jaw - from.jaw), 0, 1),
    present,
    holding,
  };
}

function vector(from: Vector, to: Vector, ahead: number): Vector {
  return add(to, scale(subtract(to, from), ahead));
}
