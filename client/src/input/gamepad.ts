/** A gamepad in the standard layout: a stick and a trigger for each hand. */

import { slide } from "../instrument/fulcrum";
import type { HandlePose } from "../instrument/pose";
import { across, type Device, type Hand, NEITHER, type Side, type View } from "./device";

const SPEED = 0.04; // of the handle at full stick [m/s]
const TURN = 2.0; // [rad/s]
const DEAD = 0.12; // of a stick's way, within which worn sticks wander
const BEGUN = 0.02; // of a trigger's way

/** Button numbers of the W3C Gamepad standard layout, left hand then right. */
const BUTTONS = [
  { trigger: 6, inwards: 4, outwards: 13, turnLeft: 14, turnRight: 15 }, // L2, L1, pad down, pad left, pad right
  { trigger: 7, inwards: 5, outwards: 0, turnLeft: 2, turnRight: 1 }, // R2, R1, A, X, B
] as const;

/** What this needs of the browser's Gamepad. */
export interface Pad {
  readonly connected: boolean;
  readonly mapping: string;
  readonly axes: readonly number[];
  readonly buttons: readonly { readonly value: number; readonly pressed: boolean }[];
}

export class GamepadDevice implements Device {
  private readonly squeezed: [boolean, boolean] = [false, false];

  /** @param pads the pads there are now; the browser's `navigator.getGamepads`. */
  constructor(private readonly pads: () => readonly (Pad | null)[]) {}

  poses(
    hands: readonly [Hand, Hand],
    view: View,
    seconds: number,
  ): readonly [HandlePose | null, HandlePose | null] {
    const pad = this.pads().find((each) => each?.connected && each.mapping === "standard");
    if (!pad) return NEITHER;
    return [this.pose(pad, 0, hands[0], view, seconds), this.pose(pad, 1, hands[1], view, seconds)];
  }

  private pose(pad: Pad, side: Side, hand: Hand, view: View, seconds: number): HandlePose | null {
    const keys = BUTTONS[side];
    const value = (button: number): number => pad.buttons[button]?.value ?? 0;
    const right = beyondDead(pad.axes[2 * side] ?? 0);
    const up = -beyondDead(pad.axes[2 * side + 1] ?? 0);
    const inwards = value(keys.inwards) - value(keys.outwards);
    const turning = value(keys.turnRight) - value(keys.turnLeft);
    const trigger = value(keys.trigger);
    const squeezed = trigger > BEGUN;
    const letGo = this.squeezed[side] && !squeezed;
    this.squeezed[side] = squeezed;
    if (!right && !up && !inwards && !turning && !squeezed && !letGo) return null;
    const step = SPEED * seconds;
    const moved = across(hand.pose.handle, hand.port, view, right * step, up * step);
    return {
      ...hand.pose,
      handle: slide(moved, hand.port, inwards * step),
      roll: hand.pose.roll + turning * TURN * seconds,
      jaw: squeezed || letGo ? 1 - trigger : hand.pose.jaw,
    };
  }
}

/** Cut the middle of a stick's way off and stretch the rest, so that motion begins gently. */
function beyondDead(value: number): number {
  const beyond = Math.max(Math.abs(value) - DEAD, 0) / (1 - DEAD);
  return Math.sign(value) * beyond;
}
