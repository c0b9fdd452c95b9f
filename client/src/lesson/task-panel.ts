/** The panel's task: what it asks for, how the attempt goes, and what can be done next. */

import { byId, make, say } from "../panel/element";
import type { Guiding } from "../wire/messages";
import type { TaskLevel } from "../wire/rest";
import { StepList } from "./steps";
import { Waiting } from "./waiting";

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
  private readonly offers = make("div", "offers");
  private readonly waiting = new Waiting();
  private steps: StepList | null = null;
  private task: TaskLevel | null = null;

  constructor() {
    this.hint.setAttribute("role", "status");
    this.bar.append(this.left);
    this.bar.setAttribute("aria-hidden", "true"); // the same stands beside it in words
  }

  /** Show words alone, as while there is free practice. */
  say(words: string, offers: readonly Offer[]): void {
    say(this.now, "");
    this.task = this.steps = null;
    this.body.replaceChildren(make("p", "note", words), this.offers);
    this.offer(offers);
  }

  /** Show that nothing goes on, and why. */
  stop(title: string, words: string): void {
    this.say(words, []);
    this.body.prepend(make("p", "task-title", title));
  }

  /** Show what a task asks for. */
  brief(task: TaskLevel, trainee: string, offers: readonly Offer[]): void {
    say(this.now, "");
    this.task = task;
    this.steps = new StepList(task);
    this.body.replaceChildren(
      make("p", "task-title", titleOf(task)),
      make("p", "note", `${trainee}. ${task.purpose}`),
      this.offers,
      this.waiting.element,
      this.steps.element,
      make("p", "note", rules(task)),
    );
    this.offer(offers);
  }

  /** Show how an attempt goes. @param whose says so. */
  begin(task: TaskLevel, whose: string): void {
    this.task = task;
    this.steps = new StepList(task);
    say(this.hint, "Get ready.");
    say(this.wrong, "");
    this.body.replaceChildren(
      make("p", "task-title", titleOf(task)),
      make("p", "note", whose),
      this.time,
      this.bar,
      this.hint,
      this.wrong,
      this.steps.element,
      this.offers,
    );
    this.offer([]);
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
    if (marking) this.offer([]); // there is nothing left to end
  }

  /** Offer what can be done next. @param asking a question that the buttons answer. */
  offer(offers: readonly Offer[], asking = ""): void {
    const focused = this.offers.contains(document.activeElement);
    const row = make("div", "buttons");
    for (const [at, [words, act]] of offers.entries()) {
      const button = make("button", at === 0 ? "first" : "", words);
      button.type = "button";
      button.addEventListener("click", act);
      row.append(button);
    }
    this.offers.replaceChildren(...(asking ? [make("p", "", asking)] : []), row);
    if (focused) row.querySelector("button")?.focus();
  }

  /** Say what is being computed and how long that takes, while nothing else can be done; empty words end it. */
  wait(words: string, howLong: string): void {
    this.waiting.show(`${words} ${howLong}`.trim());
    say(this.now, words);
    for (const button of this.offers.querySelectorAll("button")) button.disabled = words !== "";
  }
}

function titleOf(task: TaskLevel): string {
  return `${task.title}, level ${task.level}`;
}

function rules(task: TaskLevel): string {
  return (
    `More than ${task.force_limit_n} N on a tip counts as a mistake. ` +
    `There are ${task.cutoff_s.toFixed(0)} s; the scripted expert needs ${task.expert_time_s.toFixed(0)} s. ` +
    `A score of ${task.pass_score.toFixed(0)} passes.`
  );
}
