/** The list of what a task asks for, with what is done, what is on and what is still to come. */

import { make, say } from "../panel/element";
import type { TaskLevel } from "../wire/rest";

const MOST_COUNTED = 12; // the many points of a line are one thing to do

export class StepList {
  readonly element = make("ol", "steps");
  private readonly lines: { readonly first: number; readonly after: number; readonly item: HTMLLIElement; readonly count: HTMLElement }[] = [];

  constructor(task: TaskLevel) {
    let first = 0;
    for (const { words, steps } of task.list) {
      const item = make("li", "", words);
      const count = make("span", "count");
      if (steps > 1 && steps <= MOST_COUNTED) item.append(" ", count);
      this.lines.push({ first, after: first + steps, item, count });
      this.element.append(item);
      first += steps;
    }
    this.show(-1);
  }

  /** Show which step is on, from 0; before the attempt it is -1. */
  show(step: number): void {
    for (const { first, after, item, count } of this.lines) {
      const done = Math.min(Math.max(step - first, 0), after - first);
      say(count, step < 0 ? `(${after - first} places)` : `(${done} of ${after - first})`);
      const state = step >= after ? "done" : step >= first ? "now" : "next";
      if (item.dataset["state"] === state) continue;
      item.dataset["state"] = state;
      if (state === "now") {
        item.setAttribute("aria-current", "step");
        item.scrollIntoView({ block: "nearest" });
      } else item.removeAttribute("aria-current");
    }
  }
}
