/** Smooth noise that repeats, and folds, strands and vessels made of it: every texture here comes from code. */

/** Return a generator of repeatable random numbers in 0 to 1 (xorshift, G. Marsaglia, 2003). */
export function random(seed: number): () => number {
  let state = (seed * 0x9e3779b9 + 1) | 1;
  return () => {
    state ^= state << 13;
    state ^= state >>> 17;
    state ^= state << 5;
    return (state >>> 0) / 2 ** 32;
  };
}

/** Noise of unit period: a lattice of random gradients (K. Perlin, 2002), about -0.7 to 0.7. */
export class Noise {
  private readonly angle = new Float32Array(4096);

  constructor(seed: number) {
    const next = random(seed);
    for (let i = 0; i < this.angle.length; i++) this.angle[i] = next() * 2 * Math.PI;
  }

  /** @param cells lattice cells in one period, a whole number. */
  at(u: number, v: number, cells: number): number {
    const x = u * cells;
    const y = v * cells;
    const i = Math.floor(x);
    const j = Math.floor(y);
    const s = x - i;
    const t = y - j;
    const a = fade(s);
    const b = fade(t);
    const low = mix(this.corner(i, j, s, t, cells), this.corner(i + 1, j, s - 1, t, cells), a);
    const high = mix(this.corner(i, j + 1, s, t - 1, cells), this.corner(i + 1, j + 1, s - 1, t - 1, cells), a);
    return mix(low, high, b);
  }

  /** Sum octaves, each of twice the frequency and half the height. */
  sum(u: number, v: number, cells: number, octaves: number): number {
    let total = 0;
    for (let k = 0; k < octaves; k++) total += this.at(u + 0.37 * k, v + 0.61 * k, cells << k) / (1 << k);
    return total;
  }

  private corner(i: number, j: number, s: number, t: number, cells: number): number {
    const column = ((i % cells) + cells) % cells;
    const row = ((j % cells) + cells) % cells;
    const angle = this.angle[(column * 131 + row * 977 + cells * 29) & 4095] as number;
    return Math.cos(angle) * s + Math.sin(angle) * t;
  }
}

export function mix(a: number, b: number, t: number): number {
  return a + (b - a) * t;
}

export function smoothstep(low: number, high: number, x: number): number {
  const t = Math.min(Math.max((x - low) / (high - low), 0), 1);
  return t * t * (3 - 2 * t);
}

function fade(t: number): number {
  return t * t * t * (t * (6 * t - 15) + 10);
}
