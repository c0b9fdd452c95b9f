/**
 * A sheet's triangles where links are cut: a triangle that a cut passes is parted half-way along its cut sides, and each
 * part goes with the nodes that it belongs to, so that a slit opens as its flanks go apart.
 */

const EAST = 1; // bits of a node: the link ahead along x
const NORTH = 2; // ahead along y
const NORTH_EAST = 4; // ahead along both

/** A part's corner that is no node. */
export interface Corner {
  readonly owner: number; // the node it goes with
  readonly x: number; // at rest [m]
  readonly y: number;
}

export interface Torn {
  readonly index: number[]; // of triangles; from nx ny on, corners
  readonly corners: Corner[];
}

/** Return the triangles of a sheet. @param size [m]. @param cut of each node, x fastest. */
export function tear(size: readonly [number, number], nx: number, ny: number, cut: Uint8Array): Torn {
  const index: number[] = [];
  const corners: Corner[] = [];
  const x = (node: number): number => (size[0] * (node % nx)) / (nx - 1);
  const y = (node: number): number => (size[1] * Math.floor(node / nx)) / (ny - 1);
  const corner = (owner: number, ...all: number[]): number => {
    const mean = (of: (node: number) => number): number => all.reduce((sum, node) => sum + of(node), 0) / all.length;
    corners.push({ owner, x: mean(x), y: mean(y) });
    return nx * ny + corners.length - 1;
  };
  const part = (a: number, b: number, c: number, gone: readonly [boolean, boolean, boolean]): void => {
    const [ab, bc, ca] = gone;
    const count = Number(ab) + Number(bc) + Number(ca);
    if (count < 2) index.push(a, b, c);
    else if (count === 3) {
      for (const [one, next, last] of [[a, b, c], [b, c, a], [c, a, b]] as const) {
        const [to, middle, from] = [corner(one, one, next), corner(one, a, b, c), corner(one, one, last)];
        index.push(one, to, middle, one, middle, from);
      }
    } else {
      const [one, next, last] = !bc ? [a, b, c] : !ca ? [b, c, a] : [c, a, b]; // one has both its sides cut
      index.push(one, corner(one, one, next), corner(one, one, last));
      const [near, far] = [corner(next, next, one), corner(last, last, one)];
      index.push(next, last, far, next, far, near);
    }
  };
  const isCut = (node: number, way: number): boolean => ((cut[node] as number) & way) !== 0;
  for (let j = 0; j < ny - 1; j++) {
    for (let i = 0; i < nx - 1; i++) {
      const at = j * nx + i;
      const slant = isCut(at, NORTH_EAST);
      part(at, at + 1, at + nx + 1, [isCut(at, EAST), isCut(at + 1, NORTH), slant]);
      part(at, at + nx + 1, at + nx, [slant, isCut(at + nx, EAST), isCut(at, NORTH)]);
    }
  }
  return { index, corners };
}
