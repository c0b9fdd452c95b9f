/**
 * A sheet's triangles where links are cut: a triangle that a cut passes is parted where its sides were crossed, and each
 * part goes with the nodes that it belongs to, so that a slit opens as its flanks go apart.
 */

const MOST = 255; // of a link's length, in what a frame tells

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

interface Place {
  readonly x: number; // at rest [m]
  readonly y: number;
}

/**
 * Return the triangles of a sheet.
 * @param size [m]. @param nx nodes along x. @param ny nodes along y.
 * @param cut how far along them links are cut, 0 of those that hold: to the node ahead along x, along y, along both.
 */
export function tear(size: readonly [number, number], nx: number, ny: number, cut: Uint8Array): Torn {
  const index: number[] = [];
  const corners: Corner[] = [];
  const node = (at: number): Place => ({
    x: (size[0] * (at % nx)) / (nx - 1),
    y: (size[1] * Math.floor(at / nx)) / (ny - 1),
  });
  const corner = (owner: number, { x, y }: Place): number => nx * ny + corners.push({ owner, x, y }) - 1;
  /** Where a link is cut, if it is: `way` is the plane it stands in. */
  const crossing = (from: number, to: number, way: number): Place | null => {
    const share = (cut[way * nx * ny + from] as number) / MOST;
    return share > 0 ? between(node(from), node(to), share) : null;
  };
  const part = (a: number, b: number, c: number, ab: Place | null, bc: Place | null, ca: Place | null): void => {
    if (ab && bc && ca) {
      const middle = { x: (ab.x + bc.x + ca.x) / 3, y: (ab.y + bc.y + ca.y) / 3 };
      for (const [one, ahead, behind] of [[a, ab, ca], [b, bc, ab], [c, ca, bc]] as const) {
        const centre = corner(one, middle);
        index.push(one, corner(one, ahead), centre, one, centre, corner(one, behind));
      }
    } else if (ab && ca) split(a, b, c, ab, ca);
    else if (bc && ab) split(b, c, a, bc, ab);
    else if (ca && bc) split(c, a, b, ca, bc);
    else index.push(a, b, c);
  };
  /** Part the corner `one` from the two others, between the places where its sides are cut. */
  const split = (one: number, next: number, last: number, ahead: Place, behind: Place): void => {
    index.push(one, corner(one, ahead), corner(one, behind));
    const [near, far] = [corner(next, ahead), corner(last, behind)];
    index.push(next, last, far, next, far, near);
  };
  for (let j = 0; j < ny - 1; j++) {
    for (let i = 0; i < nx - 1; i++) {
      const at = j * nx + i;
      const slant = crossing(at, at + nx + 1, 2);
      part(at, at + 1, at + nx + 1, crossing(at, at + 1, 0), crossing(at + 1, at + nx + 1, 1), slant);
      part(at, at + nx + 1, at + nx, slant, crossing(at + nx, at + nx + 1, 0), crossing(at, at + nx, 1));
    }
  }
  return { index, corners };
}

function between(one: Place, other: Place, share: number): Place {
  return { x: one.x + share * (other.x - one.x), y: one.y + share * (other.y - one.y) };
}
