/** What is said while something is being computed that may take a minute: a sentence, and a sign that it goes on. */

import { make, say } from "../panel/element";

export class Waiting {
  readonly element = make("div", "waiting");
  private readonly words = make("p");
  private readonly since = make("p", "note");
  private ticking = 0;

  constructor() {
    this.words.setAttribute("role", "status");
    this.since.setAttribute("aria-hidden", "true"); // nobody wants every second read out
    const moving = make("progress");
    moving.setAttribute("aria-label", "It is being computed");
    this.element.append(this.words, moving, this.since);
    this.element.hidden = true;
  }

  /** Show what is waited for; an empty sentence ends it. */
  show(words: string): void {
    clearInterval(this.ticking);
    this.element.hidden = !words;
    say(this.words, words);
    const began = performance.now();
    const tell = (): void => say(this.since, `${((performance.now() - began) / 1000).toFixed(0)} s so far`);
    if (!words) return;
    tell();
    this.ticking = window.setInterval(tell, 1000);
  }
}
