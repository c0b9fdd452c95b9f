/** What to do now, or how it went, written on a board behind the tissue, for eyes in a headset that do not see the page. */

import { CanvasTexture, Mesh, MeshBasicMaterial, PlaneGeometry, SRGBColorSpace } from "three";

import type { Hello } from "../wire/messages";
import { letter, type Line } from "./lettering";

const WIDTH = 0.19; // [m]
const ACROSS = 1024; // [pixels]
const DOWN = 512;
const BEHIND = 0.035; // the tissue [m]
const ABOVE = 0.056; // its middle over the tissue [m]
const SHARP = 8; // samples along a slanted view

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
    this.mesh.rotation.x = (70 * Math.PI) / 180; // it leans back, towards the eyes
    this.mesh.visible = false;
  }

  greet(hello: Hello): void {
    const [a, b] = hello.tissue.size_m;
    this.mesh.position.set(a / 2, b + BEHIND, ABOVE);
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
