/** The list of what a task asks for, with what is done, what is on and what is still to come. */

import { make } from "../panel/element";
import type { TaskLevel } from "../wire/rest";

export class StepList {
  readonly element = make("ol", "steps");
  private readonly lines: { readonly first: number; readonly after: number; readonly item: HTMLLIElement }[] = [];

  constructor(task: TaskLevel) {
    let first = 0;
    for (const { words, steps } of task.list) {
      const item = make("li", "", words);
      this.lines.push({ first, after: first + steps, item });
      this.element.append(item);
      first += steps;
    }
    this.show(-1);
  }

  /** Show which step is on, from 0; before the attempt it is -1. */
  show(step: number): void {
    for (const { first, after, item } of this.lines) {
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
