/** Two tracked controllers of a headset: each is the handle itself, in the grip's own space. */

import type { HandlePose } from "../instrument/pose";
import type { Vector } from "../vector";
import type { Device, Hand, Side, View } from "./device";

/** A controller as the scene finds it, in the block's frame. */
export interface Controller {
  readonly position: Vector; // of the grip [m]
  readonly twist: number; // of the grip about its own long axis [rad]
  readonly trigger: number; // 0 to 1
}

export class HeadsetDevice implements Device {
  private readonly started: [number | null, number | null] = [null, null]; // roll minus twist when it came

  /** @param controllers left and right where tracked now, or null. */
  constructor(private readonly controllers: () => readonly [Controller | null, Controller | null]) {}

  poses(
    hands: readonly [Hand, Hand],
    _view: View,
    _seconds: number,
  ): readonly [HandlePose | null, HandlePose | null] {
    const [left, right] = this.controllers();
    return [this.pose(0, left, hands[0]), this.pose(1, right, hands[1])];
  }

  private pose(side: Side, controller: Controller | null, hand: Hand): HandlePose | null {
    if (!controller) {
      this.started[side] = null;
      return null;
    }
    const offset = this.started[side] ?? hand.pose.roll - controller.twist;
    this.started[side] = offset;
    // The twist jumps by a turn at half a turn; take the roll nearest to the one before.
    const turns = Math.round((hand.pose.roll - controller.twist - offset) / (2 * Math.PI));
    return {
      handle: controller.position,
      roll: controller.twist + offset + turns * 2 * Math.PI,
      jaw: 1 - controller.trigger,
      present: true,
    };
  }
}

const SQUEEZED = 0.8; // of a trigger
const LONG = 0.6; // both triggers are squeezed on purpose when for so long [s]

/** Both triggers squeezed for a while: the word "begin" of somebody who does not see the page. */
export class Squeeze {
  private lasted = 0; // [s]; infinite once it was said, until a trigger is let go

  /** @param said told once for each squeeze. */
  constructor(private readonly said: () => void) {}

  take(controllers: readonly [Controller | null, Controller | null], seconds: number): void {
    if (!controllers.every((each) => each !== null && each.trigger > SQUEEZED)) {
      this.lasted = 0;
      return;
    }
    this.lasted += seconds;
    if (this.lasted < LONG || this.lasted === Infinity) return;
    this.lasted = Infinity;
    this.said();
  }
}
