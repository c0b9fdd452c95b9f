/** The dialog of what was done so far: attempts, learning curve, CUSUM, and what remains to proficiency. */

import { byId, make } from "../panel/element";
import { type AttemptRow, get, type History, type TaskLevel } from "../wire/rest";
import { figure } from "./figure";

const MOST_ROWS = 50; // newest first; the command line lists them all

export class HistoryView {
  private readonly dialog = byId("history", HTMLDialogElement);
  private readonly charts = byId("history-charts", HTMLDivElement);
  private readonly list = byId("history-list", HTMLDivElement);
  private readonly choice = byId("history-task", HTMLSelectElement);
  private trainee = "";
  private tasks: readonly TaskLevel[] = [];

  /** @param look shows an attempt's card. @param failed told what went wrong. */
  constructor(
    private readonly look: (attempt: number) => void,
    private readonly failed: (error: Error) => void,
  ) {
    this.choice.addEventListener("change", () => void this.draw());
    byId("history-close", HTMLButtonElement).addEventListener("click", () => this.dialog.close());
  }

  /** Show a trainee's history. @param shown the task it begins with. */
  async open(trainee: string, tasks: readonly TaskLevel[], shown: TaskLevel): Promise<void> {
    this.trainee = trainee;
    this.tasks = tasks;
    this.choice.replaceChildren(
      ...tasks.map((task) => new Option(`${task.title}, level ${task.level}`, `${task.name} ${task.level}`)),
    );
    this.choice.value = `${shown.name} ${shown.level}`;
    byId("history-title", HTMLElement).textContent = `What ${trainee} has done`;
    if (!this.dialog.open) this.dialog.showModal();
    await this.draw();
  }

  private async draw(): Promise<void> {
    const task = this.tasks.find((each) => `${each.name} ${each.level}` === this.choice.value);
    if (!task) return;
    const asked = new URLSearchParams({ trainee: this.trainee, task: task.name, level: String(task.level) });
    try {
      const [history, rows] = await Promise.all([
        get<History>(`/api/history?${asked}`),
        get<AttemptRow[]>(`/api/attempts?${asked}`),
      ]);
      const remains = standing(history);
      this.charts.replaceChildren(
        make("p", "", remains),
        figure(`/api/history/figures/learning.svg?${asked}`, 290, `Learning curve: score against attempt. ${remains}`),
        figure(`/api/history/figures/cusum.svg?${asked}`, 360, "CUSUM chart: whether failures are more than chance explains"),
      );
      this.list.replaceChildren(...(rows.length ? [this.table(rows)] : []));
    } catch (error) {
      this.failed(error as Error);
    }
  }

  private table(rows: readonly AttemptRow[]): HTMLTableElement {
    const table = make("table", "attempts");
    const caption = rows.length > MOST_ROWS ? `The newest ${MOST_ROWS} of ${rows.length} attempts` : "Attempts";
    table.createCaption().textContent = `${caption}, newest first`;
    const head = table.createTHead().insertRow();
    head.append(...["began", "time", "score", "more"].map((words) => make("th", "", words)));
    const body = table.createTBody();
    for (const row of rows.toReversed().slice(0, MOST_ROWS)) {
      const score = row.score === null ? row.status : `${row.score.toFixed(0)}${row.passed ? ", passed" : ""}`;
      const line = body.insertRow();
      line.append(
        make("td", "", new Date(row.began).toLocaleString()),
        make("td", "", `${row.duration_s.toFixed(1)} s`),
        make("td", "", score),
      );
      const last = line.insertCell();
      if (row.status !== "finished") {
        last.textContent = row.reason ?? "";
        continue;
      }
      const button = make("button", "", "Score card");
      button.type = "button";
      button.setAttribute("aria-label", `Score card of attempt ${row.id}`);
      button.addEventListener("click", () => {
        this.dialog.close();
        this.look(row.id);
      });
      last.append(button);
    }
    return table;
  }
}

function standing(history: History): string {
  if (history.proficient_after !== null) return `Proficient since attempt ${history.proficient_after} at this task.`;
  if (history.attempts.length > 0) return `To proficiency there remains: ${history.remains}.`;
  return "No attempt has been finished yet. Two passes in a row make proficient.";
}
