/**
 * A device moves instruments: given where the handles are it says where they shall be. It knows neither tissue nor
 * picture nor network; `keepPossible` is applied to what it answers.
 */

import type { HandlePose } from "../instrument/pose";
import { add, clamp, dot, norm, scale, subtract, unit, type Vector } from "../vector";

export const LEFT = 0;
export const RIGHT = 1;
export type Side = typeof LEFT | typeof RIGHT;

/** One instrument as a device finds it. */
export interface Hand {
  readonly pose: HandlePose;
  readonly port: Vector; // [m]
}

/** The view a hand moves across. */
export interface View {
  readonly right: Vector; // unit vector
  readonly up: Vector; // unit vector
  readonly forward: Vector; // unit vector
  readonly pixel: number; // what one pixel of the picture spans at the tissue [m]
}

export interface Device {
  /** The hands are put where they begin: what was asked of them before is over. */
  begin?(): void;

  /**
   * Return the pose of each instrument, null for one this device leaves alone.
   *
   * @param hands left and right as they are.
   * @param seconds since the last call.
   */
  poses(
    hands: readonly [Hand, Hand],
    view: View,
    seconds: number,
  ): readonly [HandlePose | null, HandlePose | null];
}

const LEAST_ALONG = 0.35; // cosine between shaft and view, below which a hand is not carried further in depth

/**
 * Move a handle across the view, to the right and up [m], while the shaft only turns about its port: the hand gives
 * way along the line of sight so that nothing slides in or out, and on the picture the tip goes exactly the other way.
 */
export function across(handle: Vector, port: Vector, view: View, right: number, up: number): Vector {
  if (right === 0 && up === 0) return handle;
  const shaft = subtract(port, handle);
  const direction = unit(shaft);
  const asked = add(scale(view.right, right), scale(view.up, up));
  const along = dot(view.forward, direction);
  const safe = along < 0 ? clamp(along, -1, -LEAST_ALONG) : clamp(along, LEAST_ALONG, 1);
  const moved = add(add(handle, asked), scale(view.forward, -dot(asked, direction) / safe));
  return subtract(port, scale(unit(subtract(port, moved)), norm(shaft)));
}

/** Which instrument mouse and keyboard move; both share it. */
export class ActiveHand {
  side: Side = RIGHT;
  steers = true; // false while a device of the trainer's own moves the instruments: hands here then do nothing

  constructor(private readonly told: (side: Side) => void = () => undefined) {}

  swap(): void {
    if (!this.steers) return;
    this.side = this.side === LEFT ? RIGHT : LEFT;
    this.told(this.side);
  }
}

/** Put one answer on its side. */
export function onSide(side: Side, pose: HandlePose): readonly [HandlePose | null, HandlePose | null] {
  return side === LEFT ? [pose, null] : [null, pose];
}

export const NEITHER = [null, null] as const;
