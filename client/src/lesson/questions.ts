/** The questionnaire: what a trainee thinks of the trainer, from 1, disagree, to 5, agree. */

import { byId, make } from "../panel/element";
import { get, post, type Questionnaire } from "../wire/rest";

export class Questions {
  private readonly dialog = byId("questions", HTMLDialogElement);
  private readonly form = byId("questions-form", HTMLFormElement);
  private readonly items = byId("questions-items", HTMLDivElement);
  private readonly group = byId("questions-group", HTMLSelectElement);
  private readonly trouble = byId("questions-trouble", HTMLElement);
  private readonly thanks = byId("questions-thanks", HTMLDivElement);
  private trainee = "";
  private attempt: number | null = null;

  constructor() {
    for (const id of ["questions-cancel", "questions-close"]) {
      byId(id, HTMLButtonElement).addEventListener("click", () => this.dialog.close());
    }
    this.form.addEventListener("submit", (event) => {
      event.preventDefault();
      void this.send();
    });
  }

  /** Ask. @param attempt after which; null after a course. */
  async open(trainee: string, attempt: number | null): Promise<void> {
    this.trainee = trainee;
    this.attempt = attempt;
    const asked = await get<Questionnaire>("/api/questionnaire");
    this.group.replaceChildren(...asked.groups.map((name) => new Option(name, name)));
    this.items.replaceChildren(...Object.entries(asked.items).map(([item, words]) => question(item, words, asked)));
    this.trouble.textContent = "";
    this.thank(false);
    this.dialog.showModal();
  }

  /** Show thanks in place of the questions: here nothing else is said that could hide them. */
  private thank(kept: boolean): void {
    this.form.hidden = kept;
    this.thanks.hidden = !kept;
    if (kept) byId("questions-close", HTMLButtonElement).focus();
  }

  private async send(): Promise<void> {
    const values = Object.fromEntries(
      [...new FormData(this.form).entries()].filter(([item]) => item !== "group").map(([item, value]) => [item, Number(value)]),
    );
    if (Object.keys(values).length === 0) {
      this.trouble.textContent = "Answer one question at least.";
      return;
    }
    try {
      await post("/api/answers", { trainee: this.trainee, attempt: this.attempt, group: this.group.value, values });
    } catch (error) {
      this.trouble.textContent = (error as Error).message;
      return;
    }
    this.thank(true);
  }
}

function question(item: string, words: string, asked: Questionnaire): HTMLElement {
  const made = make("fieldset", "question");
  made.append(make("legend", "", words));
  for (const [value, meaning] of Object.entries(asked.scale)) {
    const label = make("label");
    const radio = make("input");
    radio.type = "radio";
    radio.name = item;
    radio.value = value;
    label.append(radio, `${value} ${meaning}`);
    made.append(label);
  }
  return made;
}
