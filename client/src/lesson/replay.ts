/** An attempt looked at again, beside the scripted expert's: two pictures, one timeline. */

import { byId, say } from "../panel/element";
import { Picture } from "../scene/picture";
import type { Look } from "../scene/scope";
import type { Choice } from "../scene/sharpness";
import { Theatre } from "../scene/theatre";
import type { Vector } from "../vector";
import type { Frame } from "../wire/frame";
import type { Asked } from "../wire/messages";
import { asSeen } from "../instrument/followed";
import { Clock, type Film, sameStep } from "./film";

/** What the page's picture shows in place of live tissue, and the other picture beside it. */
export class Replay {
  private readonly screen = byId("screen", HTMLDivElement);
  private readonly strip = byId("film", HTMLDivElement);
  private readonly slider = byId("film-time", HTMLInputElement);
  private readonly told = byId("film-told", HTMLElement);
  private readonly play = byId("film-play", HTMLButtonElement);
  private readonly speed = byId("film-speed", HTMLSelectElement);
  private readonly along = byId("film-along", HTMLSelectElement);
  private readonly ticks = byId("film-ticks", HTMLDivElement);
  private readonly beside: { theatre: Theatre; picture: Picture };
  private clock = new Clock(0);
  private film: Film | null = null;
  private other: Film | null = null;
  private closed: () => void = () => undefined;

  constructor() {
    const theatre = new Theatre();
    this.beside = { theatre, picture: new Picture(byId("beside-canvas", HTMLCanvasElement), theatre) };
    this.slider.addEventListener("input", () => {
      this.clock.running = false;
      this.clock.time = Number(this.slider.value);
    });
    this.play.addEventListener("click", () => {
      if (this.clock.time >= this.clock.end) this.clock.time = 0;
      this.clock.running = !this.clock.running;
    });
    this.speed.addEventListener("change", () => (this.clock.speed = Number(this.speed.value)));
    byId("film-close", HTMLButtonElement).addEventListener("click", () => this.close());
  }

  /** Draw the other picture as sharply as the page's own. */
  set choice(choice: Choice) {
    this.beside.picture.choice = choice;
  }

  /** Show a film. @param other is shown beside it; null for none. @param closed told when it is over. */
  open(film: Film, other: Film | null, captions: readonly [string, string], closed: () => void): void {
    this.close();
    this.film = film;
    this.other = other;
    this.closed = closed;
    this.clock = new Clock(film.duration);
    this.clock.speed = Number(this.speed.value);
    this.slider.max = film.duration.toFixed(2);
    this.screen.dataset["shows"] = other ? "both" : "film";
    this.strip.hidden = false;
    byId("beside", HTMLDivElement).hidden = !other;
    byId("film-along-row", HTMLElement).hidden = !other;
    say(byId("caption", HTMLElement), captions[0]);
    say(byId("beside-caption", HTMLElement), captions[1]);
    if (other) this.beside.theatre.build(other.sheet.hello);
    this.mark(film);
    this.play.focus();
  }

  close(): void {
    if (!this.film) return;
    this.film = this.other = null;
    this.strip.hidden = true;
    byId("beside", HTMLDivElement).hidden = true;
    delete this.screen.dataset["shows"];
    say(byId("caption", HTMLElement), "");
    this.closed();
  }

  /** What is shown, if a film is. */
  get showing(): Film | null {
    return this.film;
  }

  /** What was to be done at the time that is shown. */
  get asked(): Asked | null {
    return this.film?.asked(this.clock.time) ?? null;
  }

  /** Let time pass and return the frame to be shown in the page's own picture. @param seconds since the last turn. */
  turn(seconds: number, now: number, look: Look, centre: Vector): Frame | null {
    const film = this.film;
    if (!film) return null;
    const ready = film.at(this.clock.time);
    if (ready) this.clock.pass(seconds); // a film waits for its first frame
    this.tell();
    if (this.other) this.showBeside(this.other, film, now, look, centre);
    return ready;
  }

  private showBeside(other: Film, film: Film, now: number, look: Look, centre: Vector): void {
    const { theatre, picture } = this.beside;
    const time = this.along.value === "step" ? sameStep(this.clock.time, film, other) : this.clock.time;
    const frame = other.at(Math.min(time, other.duration));
    if (!frame) return;
    theatre.mark(other.asked(time)?.marks ?? []);
    theatre.deform(frame);
    theatre.place([asSeen(frame.instruments[0]), asSeen(frame.instruments[1])]);
    picture.aim(look);
    picture.draw(now, centre);
  }

  private tell(): void {
    const { time, end, running } = this.clock;
    if (running) this.slider.value = time.toFixed(2);
    const words = `${time.toFixed(1)} of ${end.toFixed(1)} s`;
    say(this.told, words);
    this.slider.setAttribute("aria-valuetext", words);
    say(this.play, running ? "Pause" : "Play");
  }

  /** Mark on the timeline where steps ended and mistakes were made. */
  private mark(film: Film): void {
    const tick = (time: number, kind: string, words: string): HTMLElement => {
      const made = document.createElement("span");
      made.className = kind;
      made.title = words;
      made.style.left = `${((100 * time) / Math.max(film.duration, 1e-3)).toFixed(2)}%`;
      return made;
    };
    const steps = film.sheet.steps_s;
    const shown = steps.length > 40 ? [] : steps; // a line of many points is one stretch
    this.ticks.replaceChildren(
      ...shown.map((time, k) => tick(time, "step", `step ${k + 1} done`)),
      ...film.sheet.mistakes.map((each) => tick(each.time_s, "mistake", each.words)),
    );
  }
}
