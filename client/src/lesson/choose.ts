/** The dialog in which a trainee says who it is, what to do and how hard it shall be. */

import { byId, make, say } from "../panel/element";
import type { AttemptRow, TaskLevel, Trainee } from "../wire/rest";
import { asKept, troubleWith } from "./names";

const NAME = "trocar-trainee"; // under which the page remembers who trained here last

export interface Choice {
  readonly trainee: string;
  readonly task: TaskLevel;
}

export class Choose {
  private readonly dialog = byId("choose", HTMLDialogElement);
  private readonly name = byId("trainee", HTMLInputElement);
  private readonly trouble = byId("choose-trouble", HTMLElement);
  private readonly list = byId("task-list", HTMLDivElement);
  private readonly known = byId("trainees", HTMLDataListElement);
  private tasks: readonly TaskLevel[] = [];
  private rows: readonly AttemptRow[] = [];
  private task = "";
  private level = 1;

  /** @param chosen told what was chosen. */
  constructor(chosen: (choice: Choice) => void) {
    const last = localStorage.getItem(NAME) ?? "";
    if (!troubleWith(last)) this.name.value = last;
    this.name.addEventListener("input", () => {
      if (this.trouble.textContent) this.tellTrouble();
      this.tellBest();
    });
    byId("choose-form", HTMLFormElement).addEventListener("submit", (event) => {
      event.preventDefault();
      const task = this.tasks.find((each) => each.name === this.task && each.level === this.level);
      if (!task) return;
      if (this.tellTrouble()) {
        this.name.focus();
        return;
      }
      localStorage.setItem(NAME, this.trainee);
      this.dialog.close();
      chosen({ trainee: this.trainee, task });
    });
    byId("choose-cancel", HTMLButtonElement).addEventListener("click", () => this.dialog.close());
  }

  /** Who trains, as far as it was said. */
  get trainee(): string {
    return asKept(this.name.value);
  }

  open(tasks: readonly TaskLevel[], trainees: readonly Trainee[], rows: readonly AttemptRow[]): void {
    this.tasks = tasks;
    this.rows = rows;
    this.task ||= tasks[0]?.name ?? "";
    const names = trainees.map((each) => each.name).filter((name) => !troubleWith(name));
    this.known.replaceChildren(...names.map((name) => new Option(name, name)));
    this.list.replaceChildren(...tasks.filter((each) => each.level === 1).map((each) => this.card(each)));
    this.tellBest();
    this.dialog.showModal();
  }

  private card(first: TaskLevel): HTMLElement {
    const card = make("fieldset", "task-card");
    card.dataset["task"] = first.name;
    card.append(make("legend", "", first.title), make("p", "note", first.purpose));
    const levels = make("div", "levels");
    for (const task of this.tasks.filter((each) => each.name === first.name)) {
      const label = make("label");
      const radio = make("input");
      radio.type = "radio";
      radio.name = "task";
      radio.value = `${task.name} ${task.level}`;
      radio.checked = task.name === this.task && task.level === this.level;
      radio.addEventListener("change", () => {
        this.task = task.name;
        this.level = task.level;
      });
      const best = make("span", "best");
      best.dataset["of"] = radio.value;
      label.append(radio, `Level ${task.level}`, best);
      levels.append(label);
    }
    card.append(levels);
    return card;
  }

  /** Say what is wrong with the name, and return whether anything is. */
  private tellTrouble(): boolean {
    const words = troubleWith(this.name.value);
    say(this.trouble, words);
    this.name.setAttribute("aria-invalid", String(words !== ""));
    return words !== "";
  }

  /** Say beside each level how the trainee fared with it so far. */
  private tellBest(): void {
    for (const best of this.list.querySelectorAll<HTMLElement>(".best")) {
      const rows = this.rows.filter(
        (row) => row.trainee === this.trainee && row.score !== null && `${row.task} ${row.level}` === best.dataset["of"],
      );
      const score = Math.max(...rows.map((row) => row.score ?? 0));
      const passed = rows.some((row) => row.passed);
      best.textContent = rows.length ? `best ${score.toFixed(0)}${passed ? ", passed" : ""}` : "";
    }
  }
}
