/** How a hand holds an instrument: all a device has to say. */

import type { Vector } from "../vector";

export interface HandlePose {
  readonly handle: Vector; // position [m]
  readonly roll: number; // about the shaft [rad]
  readonly jaw: number; // 0 closed to 1 open
  readonly present: boolean;
}

export function samePose(a: HandlePose, b: HandlePose): boolean {
  return (
    a.handle.every((value, axis) => value === b.handle[axis]) &&
    a.roll === b.roll &&
    a.jaw === b.jaw &&
    a.present === b.present
  );
}
