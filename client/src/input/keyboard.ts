/** The keyboard alone: both instruments, one at a time, at steady speeds while a key is held. */

import { slide } from "../instrument/fulcrum";
import type { HandlePose } from "../instrument/pose";
import { across, type ActiveHand, type Device, type Hand, LEFT, NEITHER, onSide, type Side, type View } from "./device";

const SPEED = 0.03; // of the handle [m/s]
const SLOW = 0.25; // with Shift held
const TURN = 2.0; // [rad/s]
const JAW = 4.0; // openings in a second

/** Keys that move, by physical position (KeyboardEvent.code), so that they lie alike on every layout. */
const MOVES: Readonly<Record<string, readonly [number, number]>> = {
  ArrowLeft: [-1, 0],
  KeyA: [-1, 0],
  ArrowRight: [1, 0],
  KeyD: [1, 0],
  ArrowUp: [0, 1],
  KeyW: [0, 1],
  ArrowDown: [0, -1],
  KeyS: [0, -1],
};
const SLIDES: Readonly<Record<string, number>> = { KeyQ: 1, KeyE: -1 };
const TURNS: Readonly<Record<string, number>> = { KeyZ: -1, KeyX: 1 };

export class Keyboard implements Device {
  private readonly held = new Set<string>();
  private slow = false;
  private readonly open: [boolean, boolean] = [true, true]; // what Space asked for last
  private readonly reached: [number, number] = [1, 1]; // the jaw where that was last fulfilled

  constructor(private readonly active: ActiveHand) {}

  /** Take a key that went down; returns whether it was one of ours. */
  press(code: string, shift: boolean, repeat: boolean): boolean {
    if (!this.active.steers) return false;
    this.slow = shift;
    if (code === "Tab" && !shift) {
      if (!repeat) this.active.swap();
      return true;
    }
    if (code === "Space") {
      if (!repeat) {
        const side = this.active.side;
        this.open[side] = !this.open[side];
        this.reached[side] = Number.NaN; // asked for again before it was there, it must still get there
      }
      return true;
    }
    if (!(code in MOVES || code in SLIDES || code in TURNS)) return false;
    this.held.add(code);
    return true;
  }

  release(code: string, shift: boolean): void {
    this.slow = shift;
    this.held.delete(code);
  }

  /** Let all keys go, as when the picture loses the focus. */
  releaseAll(): void {
    this.held.clear();
  }

  begin(): void {
    this.open.fill(true);
    this.reached.fill(1);
  }

  poses(
    hands: readonly [Hand, Hand],
    view: View,
    seconds: number,
  ): readonly [HandlePose | null, HandlePose | null] {
    const side = this.active.side;
    const moved = this.moved(hands[side], view, seconds);
    const jaw = ([0, 1] as const).map((each) => this.jaw(hands[each], each, seconds));
    if (!moved && jaw.every((value) => value === null)) return NEITHER;
    const other: Side = side === LEFT ? 1 : 0;
    const pose = { ...(moved ?? hands[side].pose), jaw: jaw[side] ?? hands[side].pose.jaw };
    const otherJaw = jaw[other] ?? null;
    const answer: [HandlePose | null, HandlePose | null] = [...onSide(side, pose)];
    if (otherJaw !== null) answer[other] = { ...hands[other].pose, jaw: otherJaw };
    return answer;
  }

  private moved(hand: Hand, view: View, seconds: number): HandlePose | null {
    if (this.held.size === 0) return null;
    const step = SPEED * (this.slow ? SLOW : 1) * seconds;
    let { handle, roll } = hand.pose;
    for (const code of this.held) {
      const move = MOVES[code];
      if (move) handle = across(handle, hand.port, view, move[0] * step, move[1] * step);
      handle = slide(handle, hand.port, (SLIDES[code] ?? 0) * step);
      roll += (TURNS[code] ?? 0) * TURN * seconds;
    }
    return { ...hand.pose, handle, roll };
  }

  /** Close or open towards what Space last asked for; null once there, so that other devices may squeeze. */
  private jaw(hand: Hand, side: Side, seconds: number): number | null {
    const wanted = this.reached[side];
    const open = this.open[side] ? 1 : 0;
    if (wanted === open) return null;
    const step = JAW * seconds;
    const jaw = open ? Math.min(hand.pose.jaw + step, 1) : Math.max(hand.pose.jaw - step, 0);
    if (jaw === open) this.reached[side] = open;
    return jaw;
  }
}
