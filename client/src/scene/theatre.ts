/** Everything there is to see, in the block's own frame (z out of the tissue, metres). */

import { Color, Group, Scene } from "three";

import type { Drawn } from "../instrument/drawn";
import type { Frame } from "../wire/frame";
import type { Hello, InstrumentShape, TaskMark } from "../wire/messages";
import { Block } from "./block";
import { Board } from "./board";
import { makeCavity } from "./cavity";
import { ContactShade } from "./contact-shade";
import { Film } from "./film";
import { Instrument } from "./instrument";
import type { Line } from "./lettering";
import { Lamp } from "./lamp";
import { Marks } from "./marks";
import { Organ } from "./organ";
import { makePort } from "./port";
import { makeMaps, WET } from "./skin-texture";

const SCOPE_RADIUS = 0.005; // [m]

export class Theatre {
  readonly scene = new Scene();
  readonly lamp: Lamp;
  private readonly content = new Group();
  private tissue: Block | Film | Organ | null = null;
  private instruments: readonly Instrument[] = [];
  private scopePort = new Group();
  private readonly marks = new Marks();
  private readonly board = new Board();
  private readonly shade = new ContactShade();
  private readonly maps = makeMaps(WET, 3, 512);

  constructor() {
    this.scene.background = new Color(0x050202);
    this.lamp = new Lamp(this.scene);
    this.scene.add(this.content);
  }

  /** Build what a greeting describes, in place of what was there. */
  build(hello: Hello): void {
    this.content.clear();
    const [a, b] = hello.tissue.size_m;
    if (hello.shape) this.tissue = new Organ(hello, hello.shape, this.maps, this.shade);
    else if (hello.under_m > 0) this.tissue = new Film(hello, this.shade);
    else this.tissue = new Block(hello, this.maps, this.shade);
    this.content.add(this.tissue.group, makeCavity(hello, this.maps, this.shade));
    this.instruments = hello.instruments.map((shape: InstrumentShape) => {
      const instrument = new Instrument(shape);
      this.content.add(instrument.group, makePort(shape.port_m, [a / 2, b / 2, hello.camera.target_m[2]], shape.shaft_radius_m));
      return instrument;
    });
    this.scopePort = makePort(hello.camera.port_m, hello.camera.target_m, SCOPE_RADIUS);
    this.content.add(this.scopePort, this.marks.group, this.board.mesh);
    this.marks.greet(hello);
    this.board.greet(hello);
  }

  /** Write on the board that eyes in a headset see. */
  write(lines: readonly Line[]): void {
    this.board.write(lines);
  }

  /** Draw these marks on the tissue and no others. */
  mark(marks: readonly TaskMark[]): void {
    this.marks.show(marks);
  }

  /** Show the tissue as the newest frame has it. */
  deform(frame: Frame): void {
    this.tissue?.update(frame);
    this.marks.drape(frame);
  }

  /** Show what only eyes in a headset need, and leave out what would stand before them. */
  immerse(immersed: boolean): void {
    this.scopePort.visible = !immersed;
    this.board.show(immersed);
  }

  /** Show both instruments where they are drawn now. */
  place(drawn: readonly [Drawn, Drawn]): void {
    this.instruments.forEach((instrument, at) => {
      const side = at as 0 | 1;
      instrument.place(drawn[side], side, this.shade);
    });
  }
}
