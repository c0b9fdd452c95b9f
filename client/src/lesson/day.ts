/**
 * A trainee's day at the page: choose a task, see how it is done, do it, read the score card, look at it again,
 * see how practice goes. What it needs of the rest of the page is in `Stage`.
 */

import type { Line } from "../scene/lettering";
import type { Asked, Guiding, Hello } from "../wire/messages";
import { type Attempt, type AttemptRow, get, post, type TaskLevel, type Trainee } from "../wire/rest";
import { CardView } from "./card";
import { type Choice, Choose } from "./choose";
import { Film } from "./film";
import { HistoryView } from "./history";
import { Questions } from "./questions";
import type { Replay } from "./replay";
import { type Offer, TaskPanel } from "./task-panel";
import { beforehand, ready, result, underWay } from "./told";
import { forget, isOurs, remember, type UnderWay } from "./under-way";

const FREE = "Free practice: press, slide on and lift the tissue, as long as you like. Nothing is recorded.";
const NO_LESSONS = "Free practice: press, slide on and lift the tissue. There is no task to follow.";
const NOT_SAID = "Waiting for the trainer.";
const LOST = "The trainer does not answer.";
const START_AGAIN =
  "Start the trainer again with trocar train and open the address that it prints: port and token are others each time. " +
  "If only the connection broke, this page goes on by itself when it is there again.";
const LOST_ATTEMPT = "The attempt does not go on.";
const KEPT = "If the trainer was stopped, what was done of the attempt is kept, as interrupted. ";
const FILMING = "The scripted expert is being filmed.";
const COMPARING = "Both attempts are being computed again.";
const HOW_LONG = "That takes some seconds, and the first time on a machine a minute or more.";

/** What a lesson asks of the page. */
export interface Stage {
  readonly replay: Replay;
  /** Show what a step asks for, in the scene and on the bars; null asks for nothing. */
  ask(asked: Asked | null): void;
  /** Write on the board that eyes in a headset see. */
  write(lines: readonly Line[]): void;
  /** Say a sentence at the top of the page. */
  say(level: "info" | "warning", words: string): void;
  /** Put the hands where they begin and bring the keyboard to the picture. */
  begin(): void;
  /** Show another tissue than the live one; null shows the live one again. */
  show(hello: Hello | null): void;
}

export class Day {
  private readonly panel = new TaskPanel();
  private readonly card = new CardView();
  private readonly history = new HistoryView(
    (attempt) => void this.safely(() => this.open(attempt)),
    (error) => this.fail(error),
  );
  private readonly questions = new Questions();
  private readonly choose = new Choose((choice) => this.brief(choice));
  private tasks: readonly TaskLevel[] = [];
  private chosen: Choice | null = null; // at this page, whoever else is at an attempt
  private on: UnderWay | null = null;
  private beginning = false;
  private waiting = false;
  private offered = false;
  private settled = false; // the trainer has said what is on

  constructor(private readonly stage: Stage) {
    this.panel.say(NOT_SAID, []);
  }

  /** Take the trainer's greeting. */
  greet(hello: Hello): void {
    this.offered = hello.lessons;
  }

  /** The trainer has said what is on; where that was no attempt, there is none. */
  settle(): void {
    this.settled = true;
    if (!this.on && !this.beginning) this.rest();
  }

  /** The connection is lost: nothing is known of what was on. */
  lose(): void {
    if (!this.settled) return;
    if (this.on || this.beginning) this.panel.stop(LOST_ATTEMPT, KEPT + START_AGAIN);
    else this.panel.stop(LOST, START_AGAIN);
    this.settled = false;
    this.on = null;
    this.stage.ask(null);
    this.stage.write([["trouble", LOST]]);
  }

  /** Take what the trainer says of the attempt that is under way. */
  take(guiding: Guiding): void {
    const goesOn = guiding.state === "running" || guiding.state === "marking";
    if (!this.on && !this.beginning && goesOn) void this.safely(() => this.takeUp(guiding.attempt));
    const on = this.on;
    if (guiding.attempt !== on?.number) return;
    this.panel.update(guiding);
    this.stage.ask(guiding.state === "running" ? guiding : null);
    this.stage.write(underWay(guiding));
    if (goesOn) return;
    this.on = null;
    if (on.isOurs && guiding.state === "finished") void this.safely(() => this.open(guiding.attempt));
    else {
      this.rest();
      if (on.isOurs) this.fail(new Error(`The attempt was interrupted: ${guiding.reason}.`));
      else this.stage.say("info", `${on.whose} is over.`);
    }
  }

  /** Begin what was chosen, or do it again: both triggers were squeezed. */
  squeezed(): void {
    const choice = this.chosen;
    if (choice && this.settled && !this.on && !this.beginning && !this.waiting) void this.safely(() => this.begin(choice));
  }

  /** Take up an attempt that another page began, or this one before it was loaded again. */
  private async takeUp(number: number): Promise<void> {
    const on: UnderWay = { number, isOurs: false, whose: "The attempt" };
    this.on = on;
    const row = await get<AttemptRow>(`/api/attempts/${number}`);
    const task = await this.taskOf(row);
    if (this.on !== on) return; // it is over meanwhile, or the connection
    on.isOurs = isOurs(row);
    on.whose = `${row.trainee}'s attempt`;
    if (on.isOurs) this.chosen = { trainee: row.trainee, task };
    this.panel.begin(task, on.isOurs ? on.whose : `${row.trainee} is at it, on another page.`);
    this.offerEnd(on);
  }

  private async taskOf(row: AttemptRow): Promise<TaskLevel> {
    if (this.tasks.length === 0) this.tasks = await get<TaskLevel[]>("/api/tasks");
    const task = this.tasks.find((each) => each.name === row.task && each.level === row.level);
    if (!task) throw new Error(`There is no task ${row.task} at level ${row.level} any more.`);
    return task;
  }

  /** Offer to end an attempt; one that another page began only after a question. */
  private offerEnd(on: UnderWay): void {
    const end = (): void => void this.safely(() => this.end(on));
    if (on.isOurs) {
      this.panel.offer([["End the attempt", end]]);
      return;
    }
    const asking = `${on.whose} would end as it stands, and be marked so. Its page may still be open.`;
    const answers: Offer[] = [
      ["Let it go on", () => this.offerEnd(on)],
      ["End it", end],
    ];
    this.panel.offer([[`End ${on.whose}`, () => this.panel.offer(answers, asking)]]);
  }

  private async end(on: UnderWay): Promise<void> {
    this.panel.offer([]);
    try {
      await post(`/api/attempts/${on.number}/end`, {});
    } catch (error) {
      if (this.on === on) this.offerEnd(on);
      throw error;
    }
  }

  /** Show what can be done while no attempt is under way. */
  private rest(): void {
    if (this.chosen) this.brief(this.chosen);
    else this.free();
  }

  private free(): void {
    this.chosen = null;
    this.stage.write([]);
    if (!this.offered) this.panel.say(NO_LESSONS, []);
    else this.panel.say(FREE, [["Choose a task", () => void this.safely(() => this.offer())]]);
  }

  private async offer(): Promise<void> {
    const [tasks, trainees, rows] = await Promise.all([
      get<TaskLevel[]>("/api/tasks"),
      get<Trainee[]>("/api/trainees"),
      get<AttemptRow[]>("/api/attempts"),
    ]);
    this.tasks = tasks;
    this.choose.open(tasks, trainees, rows);
  }

  private brief(choice: Choice): void {
    this.chosen = choice;
    if (this.on || !this.settled) return; // the panel shows what is on, or that nothing is
    this.stage.replay.close();
    const { task, trainee } = choice;
    this.stage.write(beforehand(task));
    this.panel.brief(task, trainee, [
      ["Begin", () => void this.safely(() => this.begin(choice))],
      ["Watch the expert", () => void this.safely(() => this.watch(task))],
      ["History", () => void this.safely(() => this.history.open(trainee, this.tasks, task))],
      ["Another task", () => void this.safely(() => this.offer())],
      ["Free practice", () => this.free()],
    ]);
  }

  private async watch(task: TaskLevel): Promise<void> {
    const film = await this.wait(FILMING, () => this.film(`/api/tasks/${task.name}/${task.level}/film`));
    this.stage.show(film.sheet.hello);
    this.stage.replay.open(film, null, ["The scripted expert", ""], () => this.stage.show(null));
    this.stage.say("info", `The scripted expert at ${task.title.toLowerCase()}, level ${task.level}.`);
  }

  private async begin(choice: Choice): Promise<void> {
    if (this.on) throw new Error(`${this.on.whose} is still under way. Wait until it is over.`);
    const { task, trainee } = choice;
    const begun = { trainee, task: task.name, level: task.level };
    const whose = `${trainee}'s attempt`;
    this.stage.replay.close();
    this.panel.begin(task, whose);
    this.stage.write(ready(task));
    this.stage.begin();
    this.card.close();
    this.beginning = true;
    remember(begun, null);
    try {
      const row = await post<AttemptRow>("/api/attempts", begun);
      remember(begun, row.id);
      if (!this.settled) return; // the connection was lost meanwhile; with the next one it is taken up
      this.on = { number: row.id, isOurs: true, whose };
      this.panel.begin(task, whose);
      this.offerEnd(this.on);
    } catch (error) {
      forget();
      this.brief(choice);
      throw error;
    } finally {
      this.beginning = false;
    }
  }

  private async open(number: number): Promise<void> {
    const attempt = await get<Attempt>(`/api/attempts/${number}`);
    const task = await this.taskOf(attempt);
    const choice = { trainee: attempt.trainee, task };
    this.brief(choice);
    if (attempt.card && !this.on) this.stage.write(result(attempt.card, task));
    const offers: Offer[] = [
      ["Try again", () => void this.safely(() => this.begin(choice))],
      ["Look at it again, beside the expert", () => void this.safely(() => this.compare(attempt, task))],
      ["History", () => void this.safely(() => this.history.open(attempt.trainee, this.tasks, task))],
      ["Say what you think", () => void this.safely(() => this.questions.open(attempt.trainee, attempt.id))],
      ["Close", () => undefined],
    ];
    this.card.open(attempt, task, offers);
  }

  private async compare(attempt: Attempt, task: TaskLevel): Promise<void> {
    const [mine, theirs] = await this.wait(COMPARING, () =>
      Promise.all([
        this.film(`/api/attempts/${attempt.id}/film`),
        this.film(`/api/tasks/${task.name}/${task.level}/film`),
      ]),
    );
    this.stage.show(mine.sheet.hello);
    const captions = [`${attempt.trainee}, attempt ${attempt.id}`, "The scripted expert"] as const;
    this.stage.replay.open(mine, theirs, captions, () => this.stage.show(null));
    this.stage.say("info", `${captions[0]}, beside the scripted expert.`);
  }

  private film(path: string): Promise<Film> {
    return Film.open(path, (error) => this.fail(error));
  }

  /** Do something that may take a minute, and say so until it is done. */
  private async wait<Kind>(words: string, act: () => Promise<Kind>): Promise<Kind> {
    this.waiting = true;
    this.panel.wait(words, HOW_LONG);
    try {
      return await act();
    } finally {
      this.waiting = false;
      this.panel.wait("", "");
    }
  }

  private async safely(act: () => Promise<unknown>): Promise<void> {
    try {
      await act();
    } catch (error) {
      this.fail(error as Error);
    }
  }

  /** Say what went wrong, on the page and, where no attempt is under way, on the board. */
  private fail(error: Error): void {
    this.stage.say("warning", error.message);
    if (this.chosen && this.settled && !this.on) this.stage.write(beforehand(this.chosen.task, error.message));
  }
}
