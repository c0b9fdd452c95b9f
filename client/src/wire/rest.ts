/** The trainer's REST interface: what it tells, and a sentence for the user where it refuses. */

import type { Asked, Hello } from "./messages";

/** The trainer did not do what was asked; the message is a sentence for the user. */
export class Refused extends Error {}

/** A task at one level. */
export interface TaskLevel {
  readonly name: string;
  readonly title: string;
  readonly level: number;
  readonly purpose: string;
  readonly steps: number;
  readonly list: readonly { readonly words: string; readonly steps: number }[];
  readonly force_limit_n: number;
  readonly cutoff_s: number;
  readonly expert_time_s: number;
  readonly pass_score: number;
  readonly pass_source: string;
}

export interface Trainee {
  readonly id: number;
  readonly name: string;
  readonly attempts: number;
}

/** An attempt as a list shows it. */
export interface AttemptRow {
  readonly id: number;
  readonly trainee: string;
  readonly task: string;
  readonly level: number;
  readonly status: "running" | "finished" | "interrupted";
  readonly reason: string | null;
  readonly began: string;
  readonly duration_s: number;
  readonly score: number | null;
  readonly passed: boolean | null;
}

export interface ScoreCard {
  readonly score: number;
  readonly passed: boolean;
  readonly completed: boolean;
  readonly duration_s: number;
  readonly skipped_s: number;
  readonly metrics: Readonly<Record<string, { readonly value: number; readonly unit: string }>>;
  readonly mistakes: readonly { readonly time_s: number; readonly step: number; readonly words: string }[];
  readonly advice: readonly string[];
}

/** An attempt with its card. */
export interface Attempt extends AttemptRow {
  readonly card: ScoreCard | null;
}

export interface FilmSheet {
  readonly frames: number;
  readonly every_s: number;
  readonly frame_bytes: number;
  readonly most_frames: number;
  readonly steps_s: readonly number[];
  readonly mistakes: readonly { readonly time_s: number; readonly words: string }[];
  readonly parts: readonly (Asked & { readonly end_s: number })[];
  readonly hello: Hello;
}

export interface History {
  readonly attempts: readonly { readonly id: number; readonly score: number; readonly passed: boolean }[];
  readonly proficient_after: number | null;
  readonly remains: string;
}

export interface Questionnaire {
  readonly groups: readonly string[];
  readonly items: Readonly<Record<string, string>>;
  readonly scale: Readonly<Record<string, string>>;
}

/** Ask for something, out of JSON. */
export async function get<Kind>(path: string): Promise<Kind> {
  return (await (await asked(path)).json()) as Kind;
}

/** Tell something, and return what comes back. */
export async function post<Kind>(path: string, body: object): Promise<Kind> {
  const headers = { "Content-Type": "application/json" };
  return (await (await asked(path, { method: "POST", headers, body: JSON.stringify(body) })).json()) as Kind;
}

/** Ask for bytes. */
export async function bytes(path: string): Promise<ArrayBuffer> {
  return (await asked(path)).arrayBuffer();
}

async function asked(path: string, how?: RequestInit): Promise<Response> {
  let answer: Response;
  try {
    answer = await fetch(path, how);
  } catch {
    throw new Refused("The trainer does not answer.");
  }
  if (answer.ok) return answer;
  if (answer.status === 401) throw new Refused("The trainer does not know this page any more. Open the address that it printed.");
  const told: unknown = await answer.json().catch(() => null);
  const detail = typeof told === "object" && told !== null ? (Reflect.get(told, "detail") as unknown) : null;
  throw new Refused(typeof detail === "string" ? sentence(detail) : `The trainer answered ${answer.status}.`);
}

function sentence(words: string): string {
  const begun = words.charAt(0).toUpperCase() + words.slice(1);
  return /[.!?]$/.test(begun) ? begun : `${begun}.`;
}
