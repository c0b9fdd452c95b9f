/** The attempt that is under way, and whether this page began it: also before it was loaded again, in the same tab. */

import type { AttemptRow } from "../wire/rest";

const BEGUN = "trocar-begun"; // under which a tab remembers what it began last

type Begun = Pick<AttemptRow, "trainee" | "task" | "level">;

export interface UnderWay {
  readonly number: number; // of its record
  isOurs: boolean;
  whose: string; // it is, to begin a sentence with
}

/** Remember that this page begins an attempt. @param number of its record; null until the trainer has given one. */
export function remember({ trainee, task, level }: Begun, number: number | null): void {
  sessionStorage.setItem(BEGUN, JSON.stringify([number, trainee, task, level]));
}

/** Forget it: the trainer refused. */
export function forget(): void {
  sessionStorage.removeItem(BEGUN);
}

/** Whether this page began an attempt: the one of that number, or the one it asked for when it was loaded again. */
export function isOurs(row: AttemptRow): boolean {
  const kept = sessionStorage.getItem(BEGUN);
  const of = (number: number | null): string => JSON.stringify([number, row.trainee, row.task, row.level]);
  return kept === of(row.id) || kept === of(null);
}
