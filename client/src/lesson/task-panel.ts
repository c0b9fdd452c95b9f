/** The panel's task: what it asks for, how the attempt goes, and what can be done next. */

import { byId, make, say } from "../panel/element";
import type { Guiding } from "../wire/messages";
import type { TaskLevel } from "../wire/rest";
import { StepList } from "./steps";

/** A button of the panel and what it does. */
export type Offer = readonly [words: string, act: () => void];

export class TaskPanel {
  private readonly body = byId("task", HTMLDivElement);
  private readonly hint = make("p", "hint");
  private readonly now = byId("told-now", HTMLElement); // the same over the picture, where the eyes are
  private readonly time = make("p", "time");
  private readonly wrong = make("p", "wrong");
  private readonly bar = make("div", "time-bar");
  private readonly left = make("div", "time-left");
  private readonly offers = make("div", "buttons");
  private steps: StepList | null = null;
  private task: TaskLevel | null = null;

  constructor() {
    this.hint.setAttribute("role", "status");
    this.bar.append(this.left);
    this.bar.setAttribute("aria-hidden", "true"); // the same stands beside it in words
  }

  /** Show that there is free practice. */
  free(words: string, offers: readonly Offer[]): void {
    say(this.now, "");
    this.task = this.steps = null;
    this.body.replaceChildren(make("p", "note", words), this.offers);
    this.offer(offers);
  }

  /** Show what a task asks for. */
  brief(task: TaskLevel, trainee: string, offers: readonly Offer[]): void {
    this.task = task;
    this.steps = new StepList(task);
    this.body.replaceChildren(
      make("p", "task-title", `${task.title}, level ${task.level}`),
      make("p", "note", `${trainee}. ${task.purpose}`),
      this.offers,
      this.steps.element,
      make("p", "note", rules(task)),
    );
    this.offer(offers);
  }

  /** Show how an attempt goes. */
  begin(task: TaskLevel, offers: readonly Offer[]): void {
    this.task = task;
    this.steps = new StepList(task);
    say(this.hint, "Get ready.");
    say(this.wrong, "");
    this.body.replaceChildren(
      make("p", "task-title", `${task.title}, level ${task.level}`),
      this.time,
      this.bar,
      this.hint,
      this.wrong,
      this.steps.element,
      this.offers,
    );
    this.offer(offers);
  }

  /** Show the newest guidance. */
  update(guiding: Guiding): void {
    const task = this.task;
    if (!task || !this.steps) return;
    this.steps.show(guiding.step);
    const marking = guiding.state !== "running";
    say(this.time, `${guiding.time_s.toFixed(0)} s of ${task.cutoff_s.toFixed(0)} s`);
    this.left.style.transform = `scaleX(${(guiding.left_s / task.cutoff_s).toFixed(3)})`;
    const hint = marking ? "The attempt is over; it is being marked." : guiding.hint;
    say(this.hint, hint);
    say(this.now, guiding.state === "running" || guiding.state === "marking" ? hint : "");
    const mistakes = guiding.mistakes === 1 ? "1 mistake" : `${guiding.mistakes} mistakes`;
    const trouble = guiding.reason && guiding.state !== "finished" ? ` ${guiding.reason}.` : "";
    say(this.wrong, (guiding.mistakes ? `${mistakes}: ${guiding.mistake}.` : "") + trouble);
  }

  offer(offers: readonly Offer[]): void {
    this.offers.replaceChildren(
      ...offers.map(([words, act], at) => {
        const button = make("button", at === 0 ? "first" : "", words);
        button.type = "button";
        button.addEventListener("click", act);
        return button;
      }),
    );
  }
}

function rules(task: TaskLevel): string {
  return (
    `More than ${task.force_limit_n} N on a tip counts as a mistake. ` +
    `There are ${task.cutoff_s.toFixed(0)} s; the scripted expert needs ${task.expert_time_s.toFixed(0)} s. ` +
    `A score of ${task.pass_score.toFixed(0)} passes.`
  );
}
