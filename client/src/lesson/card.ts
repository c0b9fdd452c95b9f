/** The score card: the score, what to do better, how it went in pictures, and every metric with its unit. */

import { byId, make } from "../panel/element";
import type { Attempt, ScoreCard, TaskLevel } from "../wire/rest";
import { figure } from "./figure";
import type { Offer } from "./task-panel";
import { shown } from "./value";

const FIGURES = [
  ["time", 249, "Where the time went, step by step, beside the scripted expert"],
  ["forces", 425, "The force on each tip over time, and what the steps asked for"],
  ["paths", 470, "The ways of both tips over the tissue, seen from above"],
] as const;
const NAMED: Readonly<Record<string, string>> = { errors: "mistakes" }; // as the rest of the page calls them
const FIRST = ["time", "errors", "peak_force", "time_over_limit"]; // the others are folded away

export class CardView {
  private readonly dialog = byId("card", HTMLDialogElement);
  private readonly body = byId("card-body", HTMLDivElement);

  /** Show an attempt's card. @param task it was an attempt at. @param offers what can be done next. */
  open(attempt: Attempt, task: TaskLevel, offers: readonly Offer[]): void {
    const card = attempt.card;
    if (!card) return;
    const verdict = make("p", "verdict");
    verdict.dataset["passed"] = String(card.passed);
    verdict.append(make("strong", "score", card.score.toFixed(0)), ` of 100, ${card.passed ? "passed" : "not passed"}`);
    const advice = make("ul", "advice");
    advice.append(...card.advice.map((words) => make("li", "", words)));
    this.body.replaceChildren(
      make("p", "note", `${attempt.trainee}: ${task.title}, level ${task.level}, attempt ${attempt.id}`),
      verdict,
      make("p", "note", `${task.pass_score.toFixed(0)} passes. These scores have not been validated on people yet.`),
      make("h3", "", "What to do better"),
      advice,
      this.buttons(offers),
      ...FIGURES.map(([name, height, alt]) => figure(`/api/attempts/${attempt.id}/figures/${name}.svg`, height, alt)),
      make("h3", "", "In figures"),
      make("p", "note", skipped(card)),
      metrics(card, (name) => FIRST.includes(name)),
      others(card),
    );
    if (!this.dialog.open) this.dialog.showModal();
    this.dialog.scrollTop = 0;
  }

  close(): void {
    this.dialog.close();
  }

  private buttons(offers: readonly Offer[]): HTMLElement {
    const row = make("div", "buttons");
    for (const [at, [words, act]] of offers.entries()) {
      const button = make("button", at === 0 ? "first" : "", words);
      button.type = "button";
      button.addEventListener("click", () => {
        this.close();
        act();
      });
      row.append(button);
    }
    return row;
  }
}

function skipped(card: ScoreCard): string {
  const time = card.skipped_s;
  if (time === 0) return "The tissue kept the clock's time throughout.";
  return `The servo skipped ${time.toFixed(3)} s; the tissue's clock, by which you are timed, stood still for so long.`;
}

function others(card: ScoreCard): HTMLElement {
  const folded = make("details");
  folded.append(
    make("summary", "", "All metrics"),
    metrics(card, (name) => !FIRST.includes(name)),
    make("p", "note", "What each means, and what it cannot tell, stands in the documentation under scores."),
  );
  return folded;
}

function metrics(card: ScoreCard, wanted: (name: string) => boolean): HTMLTableElement {
  const table = make("table", "metrics");
  const body = table.createTBody();
  for (const [name, { value, unit }] of Object.entries(card.metrics).filter(([each]) => wanted(each))) {
    const row = body.insertRow();
    const head = make("th", "", NAMED[name] ?? name.replaceAll("_", " "));
    head.scope = "row";
    row.append(head, make("td", "", `${shown(value)}${unit === "1" ? "" : ` ${unit}`}`));
  }
  return table;
}
