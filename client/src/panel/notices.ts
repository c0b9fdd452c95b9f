/** The one sentence at the top: how connection and servo fare, read out when it changes. */

import type { Status } from "../wire/frame";
import type { Connection } from "../wire/link";
import type { Notice } from "../wire/messages";
import { say } from "./element";

type Level = Notice["level"];

const KEPT = 8000; // a notice stays at least this long [ms]

export class Notices {
  private notice: Notice | null = null;
  private until = 0; // [ms]
  private connection: readonly [Level, string] = ["info", "Connecting to the trainer."];
  private servo: readonly [Level, string] = ["info", ""];

  constructor(private readonly element: HTMLElement) {}

  connected(state: Connection, reason: string): void {
    this.connection = sentence(state, reason);
    if (state !== "open") this.notice = null;
    this.show(performance.now());
  }

  take(notice: Notice): void {
    this.notice = notice;
    this.until = performance.now() + KEPT;
    this.show(performance.now());
  }

  status(status: Status, now: number): void {
    this.servo = trouble(status);
    this.show(now);
  }

  private show(now: number): void {
    // What stops everything is said first; a notice outlives its time until something else is to be said.
    let [level, text] = this.connection;
    if (level === "info") {
      if (this.notice && (now < this.until || !this.servo[1])) [level, text] = [this.notice.level, this.notice.text];
      else if (this.servo[1]) [level, text] = this.servo;
    }
    this.element.dataset["level"] = level;
    say(this.element, text);
  }
}

function sentence(state: Connection, reason: string): readonly [Level, string] {
  const because = reason ? ` (${reason})` : "";
  switch (state) {
    case "connecting":
      return ["info", "Connecting to the trainer."];
    case "open":
      return ["info", "Connected."];
    case "lost":
      return ["stopped", `The trainer does not answer${because}; the picture stands still. Trying again.`];
    case "refused":
      return ["stopped", reason];
  }
}

function trouble(status: Status): readonly [Level, string] {
  if (!status.alive) return ["stopped", "The tissue stands still: its servo has stopped, and there is no force."];
  if (status.forcesCut) return ["stopped", "Forces are cut, and the tissue is left alone."];
  if (status.degraded) return ["warning", "This machine does not hold the tissue's full rate."];
  if (status.beyondLinear) return ["warning", "A force is beyond the linear range; what you feel is not validated there."];
  return ["info", ""];
}
