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

const FREE = "Free practice: press, slide on and lift the tissue, as long as you like. Nothing is recorded.";
const NO_LESSONS = "Free practice: press, slide on and lift the tissue. There is no task to follow.";

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
  private readonly questions = new Questions(() => this.stage.say("info", "Thank you: your answers are kept."));
  private readonly choose = new Choose((choice) => this.brief(choice));
  private tasks: readonly TaskLevel[] = [];
  private chosen: Choice | null = null;
  private attempt = 0; // number of the one that is under way; 0 if none is
  private beginning = false;
  private offered = false;

  constructor(private readonly stage: Stage) {
    this.panel.free(NO_LESSONS, []);
  }

  /** Take the trainer's greeting. */
  greet(hello: Hello): void {
    if (hello.lessons === this.offered) return;
    this.offered = hello.lessons;
    this.free();
  }

  /** Take what the trainer says of the attempt that is under way. */
  take(guiding: Guiding): void {
    if (this.attempt === 0 && !this.beginning && guiding.state === "running") void this.safely(() => this.takeUp(guiding.attempt));
    if (guiding.attempt !== this.attempt) return;
    this.panel.update(guiding);
    this.stage.ask(guiding.state === "running" ? guiding : null);
    this.stage.write(underWay(guiding));
    if (guiding.state === "running" || guiding.state === "marking") return;
    this.attempt = 0;
    if (guiding.state === "finished") void this.safely(() => this.open(guiding.attempt));
    else {
      if (this.chosen) this.brief(this.chosen);
      this.fail(new Error(`The attempt was interrupted: ${guiding.reason}.`));
    }
  }

  /** Begin what was chosen, or do it again: both triggers were squeezed. */
  squeezed(): void {
    const choice = this.chosen;
    if (choice && this.attempt === 0 && !this.beginning) void this.safely(() => this.begin(choice));
  }

  /** Take up an attempt that another page began, or this one before it was loaded again. */
  private async takeUp(number: number): Promise<void> {
    this.attempt = number;
    const row = await get<AttemptRow>(`/api/attempts/${number}`);
    const task = await this.taskOf(row);
    this.chosen = { trainee: row.trainee, task };
    this.panel.begin(task, []);
    this.offerEnd();
  }

  private async taskOf(row: AttemptRow): Promise<TaskLevel> {
    if (this.tasks.length === 0) this.tasks = await get<TaskLevel[]>("/api/tasks");
    const task = this.tasks.find((each) => each.name === row.task && each.level === row.level);
    if (!task) throw new Error(`There is no task ${row.task} at level ${row.level} any more.`);
    return task;
  }

  private offerEnd(): void {
    this.panel.offer([["End the attempt", () => void this.safely(() => post(`/api/attempts/${this.attempt}/end`, {}))]]);
  }

  private free(): void {
    this.chosen = null;
    this.stage.write([]);
    if (!this.offered) this.panel.free(NO_LESSONS, []);
    else this.panel.free(FREE, [["Choose a task", () => void this.safely(() => this.offer())]]);
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
    this.stage.replay.close();
    this.chosen = choice;
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
    this.stage.say("info", "Fetching the expert's attempt, a few seconds the first time.");
    const film = await this.film(`/api/tasks/${task.name}/${task.level}/film`);
    this.stage.show(film.sheet.hello);
    this.stage.replay.open(film, null, ["The scripted expert", ""], () => this.stage.show(null));
    this.stage.say("info", `The scripted expert at ${task.title.toLowerCase()}, level ${task.level}.`);
  }

  private async begin(choice: Choice): Promise<void> {
    const { task, trainee } = choice;
    this.stage.replay.close();
    this.panel.begin(task, []);
    this.stage.write(ready(task));
    this.stage.begin();
    this.card.close();
    this.beginning = true;
    try {
      const row = await post<AttemptRow>("/api/attempts", { trainee, task: task.name, level: task.level });
      this.attempt = row.id;
    } catch (error) {
      this.brief(choice);
      throw error;
    } finally {
      this.beginning = false;
    }
    this.offerEnd();
  }

  private async open(number: number): Promise<void> {
    const attempt = await get<Attempt>(`/api/attempts/${number}`);
    const task = await this.taskOf(attempt);
    const choice = { trainee: attempt.trainee, task };
    this.brief(choice);
    if (attempt.card) this.stage.write(result(attempt.card, task));
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
    this.stage.say("info", "Fetching both attempts, a few seconds.");
    const [mine, theirs] = await Promise.all([
      this.film(`/api/attempts/${attempt.id}/film`),
      this.film(`/api/tasks/${task.name}/${task.level}/film`),
    ]);
    this.stage.show(mine.sheet.hello);
    const captions = [`${attempt.trainee}, attempt ${attempt.id}`, "The scripted expert"] as const;
    this.stage.replay.open(mine, theirs, captions, () => this.stage.show(null));
    this.stage.say("info", `${captions[0]}, beside the scripted expert.`);
  }

  private film(path: string): Promise<Film> {
    return Film.open(path, (error) => this.fail(error));
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
    if (this.chosen && this.attempt === 0) this.stage.write(beforehand(this.chosen.task, error.message));
  }
}
