/** An instrument as it is drawn: what the page's hands and the trainer's frames can both say of it. */

import type { Vector } from "../vector";
import type { Reach } from "./fulcrum";
import type { HandlePose } from "./pose";

export interface Drawn {
  readonly tip: Vector; // [m]
  readonly direction: Vector; // unit vector from handle to tip
  readonly roll: number; // about the shaft [rad]
  readonly jaw: number; // 0 closed to 1 open
  readonly present: boolean;
  readonly holding: boolean; // its jaw is closed on tissue
}

/** Draw an instrument where a hand of this page holds it; whether it holds tissue only the trainer knows. */
export function asHeld(pose: HandlePose, reach: Reach, holding: boolean): Drawn {
  const { roll, jaw, present } = pose;
  return { tip: reach.tip, direction: reach.direction, roll, jaw, present, holding };
}
