/**
 * The fulcrum: a straight shaft of length L through a port p, the handle at h.
 *
 *     d = (p - h)/|p - h|,   tip = h + L d
 *
 * The hand goes left and the tip right, scaled by (L - |p - h|)/|p - h|. The trainer computes the same from the same
 * pose, so the page can draw an instrument at its own rate.
 */

import { add, clamp, norm, scale, subtract, type Vector, unit } from "../vector";
import type { HandlePose } from "./pose";

const LEAST_OUTSIDE = 0.02; // of shaft between handle and port: the handle's own size [m]
const LEAST_INSIDE = 0.005; // of shaft beyond the port, so that a tip stays in the cavity [m]
const MOST_ROLL = 300; // the trainer refuses more than a thousand turns [rad]

export interface Shaft {
  readonly port: Vector; // [m]
  readonly length: number; // from handle to tip [m]
}

export interface Reach {
  readonly direction: Vector; // unit vector from handle to tip
  readonly tip: Vector; // [m]
  readonly inside: number; // length of shaft beyond the port [m]
}

/** Place the tip of a shaft whose handle is at h [m]. */
export function reach(handle: Vector, shaft: Shaft): Reach {
  const outwards = subtract(shaft.port, handle);
  const direction = unit(outwards);
  return {
    direction,
    tip: add(handle, scale(direction, shaft.length)),
    inside: shaft.length - norm(outwards),
  };
}

/** Return where the handle is when the tip is at a point [m]: the same lever, from the other end. */
export function handleFor(tip: Vector, shaft: Shaft): Vector {
  return subtract(tip, scale(unit(subtract(tip, shaft.port)), shaft.length));
}

/**
 * Keep a pose possible: the handle outside, the tip beyond the port and not below the floor the tissue lies on.
 *
 * @param floor z of what holds the tissue from below [m].
 */
export function keepPossible(pose: HandlePose, shaft: Shaft, floor: number): HandlePose {
  const outwards = subtract(shaft.port, pose.handle);
  const direction = norm(outwards) > 1e-6 ? unit(outwards) : ([0, 0, -1] as const);
  let inside = clamp(shaft.length - norm(outwards), LEAST_INSIDE, shaft.length - LEAST_OUTSIDE);
  if (direction[2] < 0) inside = Math.min(inside, Math.max((floor - shaft.port[2]) / direction[2], LEAST_INSIDE));
  const handle = subtract(shaft.port, scale(direction, shaft.length - inside));
  const roll = Math.abs(pose.roll) > MOST_ROLL ? pose.roll % (2 * Math.PI) : pose.roll;
  return { handle, roll, jaw: clamp(pose.jaw, 0, 1), present: pose.present };
}

/** Push the handle along its shaft, towards the port where the distance [m] is positive. */
export function slide(handle: Vector, port: Vector, distance: number): Vector {
  return add(handle, scale(unit(subtract(port, handle)), distance));
}
