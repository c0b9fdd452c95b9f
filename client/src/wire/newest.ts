/**
 * The newest frame and no other: what waits is replaced by what comes, so a slow page skips states instead of
 * falling behind. A frame is acknowledged when it is taken to be drawn; that acknowledges those before it too, and
 * the trainer, which has at most two on their way, may send the next.
 */

import { type Frame, frameSequence, readFrame } from "./frame";

export class Newest {
  private waiting: ArrayBuffer | null = null;
  private last = 0;
  skipped = 0;

  /** @param acknowledge told the sequence number of each frame that is taken. */
  constructor(private readonly acknowledge: (sequence: number) => void) {}

  /** Keep a frame that came, in place of one nobody took; one older than what is known is dropped. */
  put(buffer: ArrayBuffer): void {
    const sequence = frameSequence(buffer);
    if (sequence <= this.last) return;
    if (this.waiting) this.skipped += 1;
    this.waiting = buffer;
    this.last = sequence;
  }

  /** Take the newest frame, or null where none came since the last. */
  take(): Frame | null {
    const buffer = this.waiting;
    if (!buffer) return null;
    this.waiting = null;
    const frame = readFrame(buffer);
    this.acknowledge(frame.sequence);
    return frame;
  }

  /** Forget everything: sequence numbers begin anew with a new connection. */
  clear(): void {
    this.waiting = null;
    this.last = 0;
  }
}
