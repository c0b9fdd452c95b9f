/** The force on one instrument's tip: a bar with the linear range marked, and the same in words. */

import type { InstrumentState } from "../wire/frame";
import { norm } from "../vector";
import { make, say } from "./element";

const SPAN = 2; // full bar, in linear ranges: the mark stands in the middle
const LEAST_SPAN = 0.4; // of a bar where the linear range ends early [N]: what hands do must still be seen

export class ForceBar {
  readonly element = make("div", "bar");
  private readonly value = make("span", "", "0.000 N");
  private readonly track = make("div", "track");
  private readonly fill = make("div", "fill");
  private readonly band = make("div", "band");
  private readonly said = make("p", "said");
  private readonly full: number; // [N]
  private least = 0; // [N]
  private most = 0; // [N]; 0 where no force is asked for
  private shown: readonly [force: number, doing: string] = [0, ""];

  /** @param title such as "left: grasper". @param linear the linear range ends here [N]. */
  constructor(
    title: string,
    private readonly linear: number,
  ) {
    this.full = Math.max(SPAN * linear, LEAST_SPAN);
    const head = make("div", "bar-head");
    head.append(make("span", "", title), this.value);
    this.track.setAttribute("role", "meter");
    this.track.setAttribute("aria-label", `Force, ${title}`);
    this.track.setAttribute("aria-valuemin", "0");
    this.track.setAttribute("aria-valuemax", this.full.toFixed(3));
    this.band.hidden = true;
    const mark = make("div", "mark");
    mark.style.left = `${((100 * linear) / this.full).toFixed(2)}%`;
    this.track.append(this.fill, this.band, mark);
    this.element.append(head, this.track, this.said);
    this.show(0, "");
  }

  /** Show what force is asked for [N]; no most asks for none. */
  ask(least: number, most: number): void {
    if (least === this.least && most === this.most) return;
    [this.least, this.most] = [least, most];
    this.band.hidden = most === 0;
    const share = (force: number): string => `${Math.min((100 * force) / (this.full), 100).toFixed(2)}%`;
    this.band.style.left = share(least);
    this.band.style.right = `calc(100% - ${share(most)})`;
    this.show(...this.shown); // no frame may come that would
  }

  /** Show what a frame says. */
  update(state: InstrumentState): void {
    const force = norm(state.force);
    const doing = state.holding ? "holding tissue" : state.touching ? "touching" : state.present ? "free" : "not in the hand";
    this.show(force, doing);
  }

  private show(force: number, doing: string): void {
    this.shown = [force, doing];
    const beyond = force > this.linear;
    const text = `${force.toFixed(3)} N`;
    say(this.value, text);
    const asked = this.most ? `, asked ${this.least ? `${this.least} to` : "at most"} ${this.most} N` : "";
    say(this.said, (beyond ? `${doing}, beyond the linear range` : doing) + asked);
    this.element.dataset["asked"] = !this.most ? "" : force > this.most ? "over" : force < this.least ? "under" : "within";
    this.element.dataset["beyond"] = String(beyond);
    this.fill.style.transform = `scaleX(${Math.min(force / (this.full), 1).toFixed(3)})`;
    this.track.setAttribute("aria-valuenow", Math.min(force, this.full).toFixed(3));
    this.track.setAttribute("aria-valuetext", beyond ? `${text}, beyond the linear range` : text);
  }
}
