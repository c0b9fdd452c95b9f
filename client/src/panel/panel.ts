/** What stands beside the picture: forces, the servo's figures, the hand in use. */

import type { Frame } from "../wire/frame";
import type { Asked, Hello } from "../wire/messages";
import { byId, say } from "./element";
import { ForceBar } from "./force-bar";
import { Notices } from "./notices";
import { showSteering } from "./steering";

const REFRESH = 100; // ten times a second is what a reader can follow [ms]

export class Panel {
  readonly notices = new Notices(byId("notice", HTMLElement));
  private readonly rate = byId("rate", HTMLElement);
  private readonly missed = byId("missed", HTMLElement);
  private readonly tick = byId("tick", HTMLElement);
  private bars: readonly ForceBar[] = [];
  private names: readonly string[] = ["left hand", "right hand"];
  private shown = -Infinity; // [ms]

  greet(hello: Hello): void {
    const layers = hello.tissue.layers.map((layer) => layer.name).join(", ");
    say(byId("tissue", HTMLElement), `${hello.tissue.name}: ${layers}`);
    say(byId("linear", HTMLElement), `The mark is the end of the linear range, ${hello.linear_force_n.toPrecision(2)} N.`);
    this.bars = hello.instruments.map((shape) => new ForceBar(`${shape.name}, ${shape.tip}`, hello.linear_force_n));
    byId("bars", HTMLDivElement).replaceChildren(...this.bars.map((bar) => bar.element));
    const watching = hello.steered_by === "trainer";
    this.names = hello.instruments.map((shape) => (watching ? "moved by the trainer" : `${shape.name} hand: ${shape.tip}`));
    showSteering(hello.steered_by);
  }

  /** Show on the bars what force is asked for; null asks for none. */
  ask(asked: Asked | null): void {
    this.bars.forEach((bar, side) => bar.ask(asked?.least_n[side] ?? 0, asked?.most_n[side] ?? 0));
  }

  /** Say which instrument mouse and keyboard move. */
  active(side: 0 | 1): void {
    say(byId("active", HTMLElement), this.names[side] ?? "");
  }

  /** Show a frame's figures. @param now [ms]. */
  update(frame: Frame, now: number): void {
    if (now - this.shown < REFRESH) return;
    this.shown = now;
    frame.instruments.forEach((state, side) => this.bars[side]?.update(state));
    say(this.rate, `${frame.rate.toFixed(0)} Hz`);
    say(this.missed, String(frame.missedTicks));
    say(this.tick, `${frame.tickP50.toFixed(0)}, ${frame.tickP99.toFixed(0)} µs`);
    this.notices.status(frame.status, now);
  }
}
