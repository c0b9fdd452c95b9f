/** Points and directions in the block's frame [m]: x and y along the block, z out of the tissue. */

export type Vector = readonly [number, number, number];

export function add(a: Vector, b: Vector): Vector {
  return [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
}

export function subtract(a: Vector, b: Vector): Vector {
  return [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
}

export function scale(a: Vector, factor: number): Vector {
  return [a[0] * factor, a[1] * factor, a[2] * factor];
}

export function dot(a: Vector, b: Vector): number {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

export function cross(a: Vector, b: Vector): Vector {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}

export function norm(a: Vector): number {
  return Math.hypot(a[0], a[1], a[2]);
}

/** Return the direction of a vector; throws where it has none. */
export function unit(a: Vector): Vector {
  const length = norm(a);
  if (!(length > 0)) throw new RangeError("a vector of length zero has no direction");
  return scale(a, 1 / length);
}

/** Turn a vector about a unit axis by an angle [rad], right-handed (Rodrigues' formula). */
export function turn(a: Vector, axis: Vector, angle: number): Vector {
  const cos = Math.cos(angle);
  const along = dot(axis, a) * (1 - cos);
  return add(add(scale(a, cos), scale(cross(axis, a), Math.sin(angle))), scale(axis, along));
}

export function clamp(value: number, low: number, high: number): number {
  return Math.min(Math.max(value, low), high);
}
