/** Small vessels under a wet surface: branching walks on a square that repeats. */

import { random } from "./noise";

interface Walker {
  x: number; // [texels]
  y: number;
  heading: number; // [rad]
  radius: number; // [texels]
  left: number; // steps
}

const TRUNKS = 4;
const STRAIGHTNESS = 0.085; // spread of the heading in one step [rad]
const BRANCHING = 0.013; // chance in a step
const THINNEST = 0.45; // [texels]

/**
 * Draw vessels.
 *
 * @param size of the square [texels].
 * @returns how much vessel each texel shows, 0 to 1, size x size.
 */
export function vessels(size: number, seed: number): Float32Array {
  const next = random(seed);
  const shown = new Float32Array(size * size);
  const walkers: Walker[] = [];
  for (let i = 0; i < TRUNKS; i++) {
    const radius = (1.1 + 1.3 * next()) * (size / 512);
    walkers.push({ x: next() * size, y: next() * size, heading: next() * 2 * Math.PI, radius, left: size });
  }
  for (let walker = walkers.pop(); walker; walker = walkers.pop()) {
    while (walker.left-- > 0 && walker.radius > THINNEST) {
      stamp(shown, size, walker);
      walker.heading += (next() + next() - 1) * 2 * STRAIGHTNESS;
      walker.x += Math.cos(walker.heading);
      walker.y += Math.sin(walker.heading);
      walker.radius *= 0.9985;
      if (next() < BRANCHING) {
        const side = next() < 0.5 ? -1 : 1;
        const radius = walker.radius * (0.5 + 0.25 * next());
        const heading = walker.heading + side * (0.35 + 0.6 * next());
        walkers.push({ ...walker, radius, heading, left: Math.floor(size * (0.15 + 0.35 * next())) });
      }
    }
  }
  return shown;
}

function stamp(shown: Float32Array, size: number, walker: Walker): void {
  const reach = Math.ceil(walker.radius + 1);
  for (let dy = -reach; dy <= reach; dy++) {
    for (let dx = -reach; dx <= reach; dx++) {
      const x = Math.floor(walker.x) + dx;
      const y = Math.floor(walker.y) + dy;
      const distance = Math.hypot(x + 0.5 - walker.x, y + 0.5 - walker.y);
      const cover = Math.min(Math.max(walker.radius + 0.5 - distance, 0), 1);
      const at = (((y % size) + size) % size) * size + (((x % size) + size) % size);
      shown[at] = Math.max(shown[at] as number, cover);
    }
  }
}
