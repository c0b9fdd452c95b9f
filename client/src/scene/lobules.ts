/** Lobules of fat: rounded cells round scattered points, on a square that repeats. */

import { random } from "./noise";

const CELLS = 13; // across the square

/** Return how far inside its lobule each point is: 0 on a border, 1 in the middle. */
export function makeLobules(seed: number): (u: number, v: number) => number {
  const next = random(seed);
  const points = Array.from({ length: CELLS * CELLS }, () => [next(), next()] as const);
  return (u, v) => {
    const [x, y] = [u * CELLS, v * CELLS];
    const [i, j] = [Math.floor(x), Math.floor(y)];
    let nearest = Infinity;
    let second = Infinity;
    for (let column = i - 1; column <= i + 1; column++) {
      for (let row = j - 1; row <= j + 1; row++) {
        const at = wrap(row) * CELLS + wrap(column);
        const [dx, dy] = points[at] as readonly [number, number];
        const distance = Math.hypot(column + dx - x, row + dy - y);
        if (distance < nearest) [nearest, second] = [distance, nearest];
        else if (distance < second) second = distance;
      }
    }
    return Math.min((second - nearest) * 1.6, 1);
  };
}

function wrap(index: number): number {
  return ((index % CELLS) + CELLS) % CELLS;
}
