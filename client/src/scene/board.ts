/** What to do now, written on a board behind the tissue, for eyes in a headset that do not see the page. */

import { CanvasTexture, Mesh, MeshBasicMaterial, PlaneGeometry, SRGBColorSpace } from "three";

import type { Hello } from "../wire/messages";

const WIDTH = 0.16; // [m]
const ACROSS = 1024; // [pixels]
const DOWN = 384;

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
    const material = new MeshBasicMaterial({ map: this.texture, toneMapped: false });
    this.mesh = new Mesh(new PlaneGeometry(WIDTH, (WIDTH * DOWN) / ACROSS), material);
    this.mesh.rotation.x = (70 * Math.PI) / 180; // it leans back, towards the eyes
    this.mesh.visible = false;
  }

  greet(hello: Hello): void {
    const [a, b] = hello.tissue.size_m;
    this.mesh.position.set(a / 2, b + 0.035, 0.045);
  }

  /** Show it, or not. */
  show(shown: boolean): void {
    this.mesh.visible = shown && this.written !== "";
  }

  /** Write what to do, what would bring it nearer and how it stands; three empty lines leave it empty. */
  write(lines: readonly [string, string, string]): void {
    const text = lines.join("\n").trim();
    if (text === this.written) return;
    this.written = text;
    const paper = this.canvas.getContext("2d");
    if (!paper) return;
    paper.fillStyle = "#14191e";
    paper.fillRect(0, 0, ACROSS, DOWN);
    paper.fillStyle = "#e8edf1";
    paper.font = "40px system-ui, sans-serif";
    let down = 64;
    for (const line of wrapped(paper, lines[0], ACROSS - 64)) {
      paper.fillText(line, 32, down);
      down += 50;
    }
    paper.fillStyle = "#ffb020";
    paper.font = "600 54px system-ui, sans-serif";
    paper.fillText(lines[1], 32, Math.max(down + 30, 260));
    paper.fillStyle = "#b3c0ca";
    paper.font = "36px system-ui, sans-serif";
    paper.fillText(lines[2], 32, DOWN - 30);
    this.texture.needsUpdate = true;
  }
}

function wrapped(paper: CanvasRenderingContext2D, text: string, width: number): string[] {
  const lines: string[] = [""];
  for (const word of text.split(" ")) {
    const longer = `${lines.at(-1)} ${word}`.trim();
    if (paper.measureText(longer).width <= width) lines[lines.length - 1] = longer;
    else lines.push(word);
  }
  return lines;
}
