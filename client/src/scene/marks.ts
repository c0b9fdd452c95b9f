/** What a step asks for, drawn on the tissue: a ring round each place and a ribbon along a line, left blue, right orange. */

import { BufferAttribute, BufferGeometry, Color, DoubleSide, Group, Mesh, MeshBasicMaterial } from "three";

import { clamp } from "../vector";
import type { Frame } from "../wire/frame";
import type { Hello, TaskMark } from "../wire/messages";

const COLOURS = { left: new Color(0x58b4ff), right: new Color(0xffb020) } as const;
const ABOVE = 2e-4; // the surface, so that it is not swallowed [m]
const BREADTH = 5e-4; // of a ring or a ribbon [m]
const ROUND = 48; // corners of a ring
const LINE = 8; // so many marks of a hand are a line, not places

type Place = readonly [number, number];

/** A strip of triangles between two rows of places, as high as the tissue under it. */
class Strip {
  readonly mesh: Mesh;
  private readonly position: BufferAttribute;

  constructor(places: readonly (readonly [Place, Place])[], colour: Color, strength: number) {
    const geometry = new BufferGeometry();
    this.position = new BufferAttribute(new Float32Array(places.flat().flatMap(([x, y]) => [x, y, ABOVE])), 3);
    geometry.setAttribute("position", this.position);
    geometry.setIndex(places.slice(1).flatMap((_, k) => [2 * k, 2 * k + 1, 2 * k + 3, 2 * k, 2 * k + 3, 2 * k + 2]));
    const material = new MeshBasicMaterial({ color: colour, transparent: true, opacity: strength, side: DoubleSide });
    material.toneMapped = false;
    this.mesh = new Mesh(geometry, material);
    this.mesh.frustumCulled = false; // it moves with every frame
  }

  drape(height: (x: number, y: number) => number): void {
    for (let k = 0; k < this.position.count; k++) {
      this.position.setZ(k, height(this.position.getX(k), this.position.getY(k)) + ABOVE);
    }
    this.position.needsUpdate = true;
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    (this.mesh.material as MeshBasicMaterial).dispose();
  }
}

export class Marks {
  readonly group = new Group();
  private strips: Strip[] = [];
  private shown = "";
  private size: readonly [number, number] = [1, 1];
  private rest: readonly (number | null)[] = [];

  greet(hello: Hello): void {
    this.size = hello.tissue.size_m;
    this.rest = hello.shape?.rest_m ?? [];
  }

  /** Show these marks and no others. */
  show(marks: readonly TaskMark[]): void {
    const key = JSON.stringify(marks);
    if (key === this.shown) return;
    this.shown = key;
    for (const strip of this.strips) {
      strip.dispose();
      this.group.remove(strip.mesh);
    }
    this.strips = (["left", "right"] as const).flatMap((hand) => stripsOf(marks.filter((mark) => mark.hand === hand)));
    for (const strip of this.strips) this.group.add(strip.mesh);
  }

  /** Lay them on the tissue as a frame has it. */
  drape(frame: Frame): void {
    const { nx, ny, heights } = frame;
    const height = (x: number, y: number): number => {
      const column = clamp((x / this.size[0]) * (nx - 1), 0, nx - 1.001);
      const row = clamp((y / this.size[1]) * (ny - 1), 0, ny - 1.001);
      const [i, j] = [Math.floor(column), Math.floor(row)];
      const [u, v] = [column - i, row - j];
      const at = (di: number, dj: number): number => {
        const node = (j + dj) * nx + i + di;
        return (this.rest[node] ?? 0) + (heights[node] as number);
      };
      return (1 - v) * ((1 - u) * at(0, 0) + u * at(1, 0)) + v * ((1 - u) * at(0, 1) + u * at(1, 1));
    };
    for (const strip of this.strips) strip.drape(height);
  }
}

function stripsOf(marks: readonly TaskMark[]): Strip[] {
  const first = marks[0];
  if (!first) return [];
  const colour = COLOURS[first.hand];
  if (marks.length < LINE) return marks.map((mark) => ring(mark.place_m, mark.radius_m, colour));
  const next = ring(first.place_m, first.radius_m, colour);
  return [ribbon(marks.map((mark) => mark.place_m), colour), next];
}

function ring(place: Place, radius: number, colour: Color): Strip {
  const corners = Array.from({ length: ROUND + 1 }, (_, k) => (2 * Math.PI * k) / ROUND);
  const at = (angle: number, from: number): Place => [place[0] + from * Math.cos(angle), place[1] + from * Math.sin(angle)];
  return new Strip(corners.map((angle) => [at(angle, radius - BREADTH), at(angle, radius)] as const), colour, 0.9);
}

function ribbon(places: readonly Place[], colour: Color): Strip {
  const sides = places.map((place, k): readonly [Place, Place] => {
    const [a, b] = [places[Math.max(k - 1, 0)] as Place, places[Math.min(k + 1, places.length - 1)] as Place];
    const length = Math.hypot(b[0] - a[0], b[1] - a[1]) || 1;
    const [x, y] = [(-(b[1] - a[1]) / length) * (BREADTH / 2), ((b[0] - a[0]) / length) * (BREADTH / 2)];
    return [[place[0] - x, place[1] - y], [place[0] + x, place[1] + y]];
  });
  return new Strip(sides, colour, 0.9);
}
