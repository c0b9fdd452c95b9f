/** The keys that move the endoscope while they are held. */

import type { Scope } from "../scene/scope";

const SWING = 0.5; // [rad/s]
const TURN = 1.2; // [rad/s]
const ZOOM = 0.04; // [m/s]

/** What a key does: pan, tilt, turn, zoom. */
const KEYS: Readonly<Record<string, readonly [number, number, number, number]>> = {
  KeyJ: [-1, 0, 0, 0],
  KeyL: [1, 0, 0, 0],
  KeyI: [0, 1, 0, 0],
  KeyK: [0, -1, 0, 0],
  KeyU: [0, 0, -1, 0],
  KeyO: [0, 0, 1, 0],
  Equal: [0, 0, 0, 1],
  NumpadAdd: [0, 0, 0, 1],
  Minus: [0, 0, 0, -1],
  NumpadSubtract: [0, 0, 0, -1],
};

export class ScopeKeys {
  private readonly held = new Set<string>();

  press(code: string): boolean {
    if (!(code in KEYS)) return false;
    this.held.add(code);
    return true;
  }

  release(code: string): void {
    this.held.delete(code);
  }

  releaseAll(): void {
    this.held.clear();
  }

  move(scope: Scope, seconds: number): void {
    for (const code of this.held) {
      const [pan, tilt, turn, zoom] = KEYS[code] as readonly [number, number, number, number];
      scope.move(pan * SWING * seconds, tilt * SWING * seconds, turn * TURN * seconds, zoom * ZOOM * seconds);
    }
  }
}
