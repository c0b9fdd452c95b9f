/** Mouse, pen or finger: the handle follows it across the view; the wheel slides or turns, the button squeezes. */

import { slide } from "../instrument/fulcrum";
import type { HandlePose } from "../instrument/pose";
import { across, type ActiveHand, type Device, type Hand, NEITHER, onSide, type View } from "./device";

const NOTCH = 100; // what most browsers report for one notch of a wheel [px]
const SLIDE = 0.002; // for one notch [m]
const TURN = Math.PI / 12; // for one notch [rad]
const JAW = 6.0; // openings in a second

export class Mouse implements Device {
  private right = 0; // [px]
  private up = 0; // [px]
  private inwards = 0; // [px]
  private wheel = 0; // [m]
  private roll = 0; // [rad]
  private squeezing = false;
  private releasing = false;

  constructor(private readonly active: ActiveHand) {}

  /** Take a movement over the picture [px]; with `deep` up and down mean in and out. */
  move(right: number, down: number, deep: boolean): void {
    if (!this.active.steers) return;
    if (deep) {
      this.inwards -= down;
      return;
    }
    this.right += right;
    this.up -= down;
  }

  /** Take a turn of the wheel [px]: away from the user is inwards; with `turning` it rolls the shaft. */
  scroll(down: number, turning: boolean): void {
    if (!this.active.steers) return;
    if (turning) this.roll += (down / NOTCH) * TURN;
    else this.wheel -= (down / NOTCH) * SLIDE;
  }

  squeeze(down: boolean): void {
    if (!this.active.steers) return;
    if (this.squeezing && !down) this.releasing = true;
    this.squeezing = down;
  }

  poses(
    hands: readonly [Hand, Hand],
    view: View,
    seconds: number,
  ): readonly [HandlePose | null, HandlePose | null] {
    const side = this.active.side;
    const hand = hands[side];
    const moved = this.right !== 0 || this.up !== 0 || this.inwards !== 0 || this.wheel !== 0 || this.roll !== 0;
    if (!moved && !this.squeezing && !this.releasing) return NEITHER;
    let handle = across(hand.pose.handle, hand.port, view, this.right * view.pixel, this.up * view.pixel);
    handle = slide(handle, hand.port, this.inwards * view.pixel + this.wheel);
    const jaw = this.jaw(hand.pose.jaw, JAW * seconds);
    const pose = { ...hand.pose, handle, roll: hand.pose.roll + this.roll, jaw };
    this.right = this.up = this.inwards = this.wheel = this.roll = 0;
    return onSide(side, pose);
  }

  private jaw(jaw: number, step: number): number {
    if (this.squeezing) return Math.max(jaw - step, 0);
    if (!this.releasing) return jaw;
    const opened = Math.min(jaw + step, 1);
    if (opened === 1) this.releasing = false;
    return opened;
  }
}
