/** What eyes in a headset are told of a lesson: what the page says, as few words as a board takes. */

import type { Line } from "../scene/lettering";
import type { Guiding } from "../wire/messages";
import type { ScoreCard, TaskLevel } from "../wire/rest";

const MOST_ADVICE = 2; // the most useful comes first; the page has it all

/** Before an attempt. @param trouble why the last one came to nothing; empty if it did not. */
export function beforehand(task: TaskLevel, trouble = ""): Line[] {
  return [
    ...(trouble ? [["trouble", trouble] as const] : []),
    ["title", titleOf(task)],
    ...(trouble ? [] : [["words", task.purpose] as const]),
    ["hint", "Squeeze both triggers to begin."],
    ["note", `The scripted expert needs ${task.expert_time_s.toFixed(0)} s. A score of ${task.pass_score.toFixed(0)} passes.`],
  ];
}

/** While an attempt is being set up. */
export function ready(task: TaskLevel): Line[] {
  return [
    ["title", titleOf(task)],
    ["hint", "Get ready."],
  ];
}

/** While it is under way, and until it is marked. */
export function underWay(guiding: Guiding): Line[] {
  const trouble: Line[] = guiding.reason ? [["trouble", `${guiding.reason}.`]] : [];
  if (guiding.state !== "running") {
    return [["title", "The attempt is over."], ["words", "It is being marked."], ...(guiding.state === "marking" ? trouble : [])];
  }
  const mistakes = guiding.mistakes === 1 ? "1 mistake" : `${guiding.mistakes} mistakes`;
  const last = guiding.mistakes ? `: ${guiding.mistake}` : "";
  return [
    ["words", guiding.words],
    ["hint", guiding.hint],
    ...trouble,
    ["note", `${guiding.left_s.toFixed(0)} s left, ${mistakes}${last}`],
  ];
}

/** When it is marked: the score, whether it passed, what to do better and what to do to go on. */
export function result(card: ScoreCard, task: TaskLevel): Line[] {
  const verdict = `${card.score.toFixed(0)} of 100, ${card.passed ? "passed" : "not passed"}`;
  return [
    [card.passed ? "passed" : "failed", verdict],
    ...card.advice.slice(0, MOST_ADVICE).map((words) => ["words", words] as const),
    ["hint", "Squeeze both triggers to try again."],
    ["note", `${task.pass_score.toFixed(0)} passes. Leave the headset for card and replay.`],
  ];
}

function titleOf(task: TaskLevel): string {
  return `${task.title}, level ${task.level}`;
}
