/**
 * The endoscope: a rigid scope through its own port, which it turns about and slides through. A 30 degree scope looks
 * beside its axis, and turning it about the axis (the light post) turns where it looks while the camera head keeps
 * the horizon; a 0 degree scope looks along its axis, and turning it turns the picture.
 */

import { add, clamp, cross, dot, norm, scale, subtract, turn, unit, type Vector } from "../vector";

export const FIELD = 72; // full angle of view of the round picture [degrees], as common 10 mm scopes have
const WORKING_DISTANCE = 0.07; // from eye to target at the start [m]
const NEAREST = 0.02; // to the target [m]
const LEAST_INSIDE = 0.005; // of the scope beyond its port [m]
const MOST_SWING = 0.9; // from the line port to target [rad]

export type ScopeAngle = 0 | 30;

export interface Look {
  readonly eye: Vector; // [m]
  readonly forward: Vector;
  readonly up: Vector;
}

export class Scope {
  private pan = 0; // [rad]
  private tilt = 0; // [rad]
  private roll = 0; // [rad]
  private depth = 0; // of the scope beyond its port [m]
  private angle: ScopeAngle = 0;

  /** @param port [m]. @param target what it looks at when at home [m]. */
  constructor(
    private readonly port: Vector,
    private readonly target: Vector,
  ) {
    this.home();
  }

  get viewAngle(): ScopeAngle {
    return this.angle;
  }

  /** Where around the rim a 30 degree scope looks to: clockwise from the top [rad]. */
  get rim(): number {
    return this.angle === 0 ? 0 : this.roll + Math.PI;
  }

  /** Change the scope; the new one looks at the target again. */
  choose(angle: ScopeAngle): void {
    this.angle = angle;
    this.home();
  }

  /** Look at the target from the working distance. */
  home(): void {
    const distance = norm(subtract(this.target, this.port));
    this.depth = clamp(distance - WORKING_DISTANCE, LEAST_INSIDE, distance);
    this.pan = this.roll = 0;
    // A scope that looks down by its angle is held up by it, less what the target's nearness takes back (law of sines).
    const angle = (this.angle * Math.PI) / 180;
    this.tilt = angle - Math.asin((this.depth / distance) * Math.sin(Math.PI - angle));
  }

  /** Move the scope: angles [rad], depth [m] into the body. */
  move(pan: number, tilt: number, roll: number, depth: number): void {
    const distance = norm(subtract(this.target, this.port));
    this.pan = clamp(this.pan + pan, -MOST_SWING, MOST_SWING);
    this.tilt = clamp(this.tilt + tilt, -MOST_SWING, MOST_SWING);
    this.roll = (this.roll + roll) % (2 * Math.PI);
    this.depth = clamp(this.depth + depth, LEAST_INSIDE, distance - NEAREST);
  }

  /** Where the eye is and where it looks. */
  look(): Look {
    const ahead = unit(subtract(this.target, this.port));
    const upright: Vector = Math.abs(ahead[2]) < 0.99 ? [0, 0, 1] : [0, 1, 0];
    const up0 = unit(subtract(upright, scale(ahead, dot(upright, ahead))));
    const axis = turn(turn(ahead, cross(ahead, up0), this.tilt), up0, -this.pan);
    const right = unit(cross(axis, up0));
    const up = cross(right, axis);
    const eye = add(this.port, scale(axis, this.depth));
    if (this.angle === 0) return { eye, forward: axis, up: turn(up, axis, this.roll) };
    const sideways = turn(scale(up, -1), axis, this.roll);
    const angle = (this.angle * Math.PI) / 180;
    const forward = add(scale(axis, Math.cos(angle)), scale(sideways, Math.sin(angle)));
    return { eye, forward, up: unit(subtract(up, scale(forward, dot(up, forward)))) };
  }
}
