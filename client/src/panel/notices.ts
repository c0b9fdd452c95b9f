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
    if (state !== "open") {
      this.notice = null; // of what was, as is what the servo's last frame warned of
      this.servo = ["info", ""];
    }
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
    const [level, text] = this.said(now);
    this.element.dataset["level"] = level;
    say(this.element, text);
  }

  /** Trouble with the connection comes first, then a servo that stopped, then a new notice, then what the servo warns of. */
  private said(now: number): readonly [Level, string] {
    if (this.connection[0] !== "info") return this.connection;
    const servo = this.servo[1] ? this.servo : null;
    const notice = this.notice && ([this.notice.level, this.notice.text] as const);
    if (!servo || !notice) return notice ?? servo ?? this.connection;
    const heard = servo[0] !== "stopped" || notice[0] === "stopped";
    return now < this.until && heard ? notice : servo;
  }
}

const GONE =
  "The trainer does not answer. If it was stopped, start it again with trocar train and open the address that it prints.";

function sentence(state: Connection, reason: string): readonly [Level, string] {
  switch (state) {
    case "connecting":
      return ["info", "Connecting to the trainer."];
    case "open":
      return ["info", "Connected."];
    case "lost":
      return ["stopped", reason ? `The trainer ended the connection: ${reason}. Trying again.` : GONE];
    case "refused":
      return ["stopped", reason];
  }
}

function trouble(status: Status): readonly [Level, string] {
  if (!status.alive) return ["stopped", "The tissue stands still: its servo has stopped, and there is no force."];
  if (status.forcesCut) return ["stopped", "The trainer lost touch with its servo: forces are off."];
  if (status.degraded) return ["warning", "This machine does not hold the tissue's full rate."];
  if (status.beyondLinear) return ["warning", "A force is beyond the linear range; what you feel is not validated there."];
  return ["info", ""];
}
