/**
 * When a pose goes out: when it changed, at most 90 times a second for each instrument, and twice a second at rest,
 * for the trainer hangs up after ten silent seconds. Two instruments and as many acknowledgements stay well below
 * the 400 messages a second it allows, on a display of any rate.
 */

import { type HandlePose, samePose } from "../instrument/pose";

const LEAST_GAP = 1000 / 90; // [ms]
const MOST_GAP = 500; // [ms]
const SLACK = 1; // display frames come a little early at times [ms]

export class Sending {
  private sequence = 0;
  private last: HandlePose | null = null;
  private at = -Infinity;

  /** Return the sequence number under which a pose is to be sent now, or null. Time in [ms]. */
  due(pose: HandlePose, now: number): number | null {
    const gap = now - this.at + SLACK;
    const changed = this.last === null || !samePose(this.last, pose);
    if (gap < (changed ? LEAST_GAP : MOST_GAP)) return null;
    this.last = pose;
    this.at = now;
    this.sequence += 1;
    return this.sequence;
  }

  /** Begin anew, with a new connection. */
  clear(): void {
    this.sequence = 0;
    this.last = null;
    this.at = -Infinity;
  }
}
