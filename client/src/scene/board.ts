/** What to do now, or how it went, written on a board behind the tissue, for eyes in a headset that do not see the page. */

import { CanvasTexture, Mesh, MeshBasicMaterial, PlaneGeometry, SRGBColorSpace } from "three";

import { add, norm, subtract, type Vector } from "../vector";
import type { Hello } from "../wire/messages";
import { hollow } from "./cavity";
import { letter, type Line } from "./lettering";

const WIDTH = 0.19; // where the cavity has room for it [m]
const ACROSS = 1024; // [pixels]
const DOWN = 512;
const BEHIND = 0.025; // its middle, the tissue [m]
const ABOVE = 0.006; // its lower edge over the tissue [m]
const LEANS = (70 * Math.PI) / 180; // back, towards the eyes; upright is 90 degrees
const SHARP = 8; // samples along a slanted view

/** Return the board's width and middle [m]: as large as it may be without its corners in the cavity's wall. */
export function placed(hello: Hello): { readonly width: number; readonly middle: Vector; readonly corner: Vector } {
  const [a, b] = hello.tissue.size_m;
  const { centre, free } = hollow(hello);
  for (let width = WIDTH; ; width *= 0.98) {
    const up = (0.5 * width * DOWN) / ACROSS;
    const middle: Vector = [a / 2, b + BEHIND, ABOVE + up * Math.sin(LEANS)];
    const corner = add(middle, [width / 2, up * Math.cos(LEANS), up * Math.sin(LEANS)]);
    if (norm(subtract(corner, centre)) < free || width < 0.5 * WIDTH) return { width, middle, corner };
  }
}

export class Board {
  readonly mesh: Mesh;
  private readonly canvas = document.createElement("canvas");
  private readonly texture: CanvasTexture;
  private written = "";

  constructor() {
    this.canvas.width = ACROSS;
    this.canvas.height = DOWN;
    this.texture = new CanvasTexture(this.canvas);
    this.texture.colorSpace = SRGBColorSpace;
    this.texture.anisotropy = SHARP;
    const material = new MeshBasicMaterial({ map: this.texture, toneMapped: false });
    this.mesh = new Mesh(new PlaneGeometry(WIDTH, (WIDTH * DOWN) / ACROSS), material);
    this.mesh.rotation.x = LEANS;
    this.mesh.visible = false;
  }

  greet(hello: Hello): void {
    const { width, middle } = placed(hello);
    this.mesh.scale.setScalar(width / WIDTH);
    this.mesh.position.set(...middle);
  }

  /** Show it, or not. */
  show(shown: boolean): void {
    this.mesh.visible = shown && this.written !== "";
  }

  /** Write these lines in place of what was there; none leave it empty. */
  write(lines: readonly Line[]): void {
    const text = JSON.stringify(lines);
    if (text === this.written) return;
    this.written = lines.length > 0 ? text : "";
    const paper = this.canvas.getContext("2d");
    if (!paper) return;
    paper.fillStyle = "#14191e";
    paper.fillRect(0, 0, ACROSS, DOWN);
    const measure = (font: string, words: string): number => {
      paper.font = font;
      return paper.measureText(words).width;
    };
    for (const piece of letter(lines, ACROSS, DOWN, measure)) {
      paper.font = piece.font;
      paper.fillStyle = piece.colour;
      paper.fillText(piece.text, piece.right, piece.down);
    }
    this.texture.needsUpdate = true;
  }
}
