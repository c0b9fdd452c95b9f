/** An attempt to be looked at again: its frames, fetched a few seconds at a time as they are needed, and a clock. */

import { clamp } from "../vector";
import { type Frame, readFrame } from "../wire/frame";
import type { Asked } from "../wire/messages";
import { bytes, type FilmSheet, get } from "../wire/rest";

const KEPT = 8; // reels, of four seconds each

export class Film {
  private readonly reels = new Map<number, ArrayBuffer>();
  private readonly awaited = new Set<number>();
  private shown: { readonly number: number; readonly frame: Frame } | null = null;

  private constructor(
    private readonly path: string,
    readonly sheet: FilmSheet,
    private readonly failed: (error: Error) => void,
  ) {}

  /** Fetch a film's sheet. @param failed told when frames cannot be fetched later. */
  static async open(path: string, failed: (error: Error) => void): Promise<Film> {
    return new Film(path, await get<FilmSheet>(path), failed);
  }

  /** How long it lasts [s]. */
  get duration(): number {
    return this.sheet.frames * this.sheet.every_s;
  }

  /** Return the frame of a time [s], or the last one shown while it is being fetched; null before the first. */
  at(time: number): Frame | null {
    const number = clamp(Math.round(time / this.sheet.every_s) - 1, 0, this.sheet.frames - 1);
    if (this.shown?.number === number) return this.shown.frame;
    const size = this.sheet.most_frames;
    const reel = this.reel(Math.floor(number / size));
    if (number % size > size / 2) this.reel(Math.floor(number / size) + 1);
    if (reel) {
      const start = (number % size) * this.sheet.frame_bytes;
      this.shown = { number, frame: readFrame(reel.slice(start, start + this.sheet.frame_bytes)) };
    }
    return this.shown?.frame ?? null;
  }

  /** Return what was to be done at a time [s]. */
  asked(time: number): Asked | null {
    return this.sheet.parts.find((part) => time <= part.end_s) ?? null;
  }

  private reel(number: number): ArrayBuffer | null {
    const first = number * this.sheet.most_frames;
    const found = this.reels.get(number);
    if (found || first >= this.sheet.frames || this.awaited.has(number)) return found ?? null;
    this.awaited.add(number);
    bytes(`${this.path}/frames?first=${first}&count=${this.sheet.most_frames}`)
      .then((reel) => this.keep(number, reel), this.failed)
      .finally(() => this.awaited.delete(number));
    return null;
  }

  private keep(number: number, reel: ArrayBuffer): void {
    this.reels.set(number, reel);
    const oldest = this.reels.keys().next();
    if (this.reels.size > KEPT && !oldest.done) this.reels.delete(oldest.value);
  }
}

/** The time of one film at which it does the same as another at a time: the same share of the same step. */
export function sameStep(time: number, from: Film, to: Film): number {
  const [ends, others] = [from.sheet.steps_s, to.sheet.steps_s];
  const step = ends.findIndex((end) => time < end);
  const at = step < 0 ? ends.length : step;
  if (at >= others.length) return to.duration;
  const [begin, begins] = [ends[at - 1] ?? 0, others[at - 1] ?? 0];
  const [end, other] = [ends[at] ?? from.duration, others[at] as number];
  return begins + (other - begins) * clamp((time - begin) / Math.max(end - begin, 1e-6), 0, 1);
}

/** Time that passes, stands or is set. */
export class Clock {
  time = 0; // [s]
  speed = 1;
  running = true;

  constructor(readonly end: number) {}

  /** Let time pass [s]; at the end it stands. */
  pass(seconds: number): void {
    if (!this.running) return;
    this.time = Math.min(this.time + seconds * this.speed, this.end);
    if (this.time === this.end) this.running = false;
  }
}
