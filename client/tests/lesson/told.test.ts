import { describe, expect, it } from "vitest";

import { beforehand, result, underWay } from "../../src/lesson/told";
import type { Guiding } from "../../src/wire/messages";
import type { ScoreCard, TaskLevel } from "../../src/wire/rest";

const TASK: TaskLevel = {
  name: "palpate",
  title: "Palpate six points",
  level: 1,
  purpose: "To press as hard as is meant.",
  steps: 6,
  list: [],
  force_limit_n: 0.07,
  cutoff_s: 96,
  expert_time_s: 32,
  pass_score: 75,
  pass_source: "",
};
const CARD: ScoreCard = {
  score: 81.6,
  passed: true,
  completed: true,
  duration_s: 40,
  skipped_s: 0,
  metrics: {},
  mistakes: [],
  advice: ["Be quicker.", "Press less.", "Look."],
};
const RUNNING: Guiding = {
  type: "guiding",
  attempt: 4,
  state: "running",
  step: 1,
  words: "Press the mark.",
  marks: [],
  least_n: [0, 0],
  most_n: [0, 0],
  hint: "Softer.",
  mistakes: 0,
  mistake: "",
  time_s: 9,
  left_s: 87.2,
  reason: "",
};

describe("what eyes in a headset are told", () => {
  it("is how it went, what to do better and how to go on", () => {
    expect(result(CARD, TASK)).toEqual([
      ["passed", "82 of 100, passed"],
      ["words", "Be quicker."],
      ["words", "Press less."],
      ["hint", "Squeeze both triggers to try again."],
      ["note", "75 passes. Leave the headset for card and replay."],
    ]);
    expect(result({ ...CARD, score: 74.4, passed: false }, TASK)[0]).toEqual(["failed", "74 of 100, not passed"]);
  });

  it("is what to do while an attempt is under way, with the mistakes", () => {
    expect(underWay(RUNNING)).toEqual([
      ["words", "Press the mark."],
      ["hint", "Softer."],
      ["note", "87 s left, 0 mistakes"],
    ]);
    expect(underWay({ ...RUNNING, mistakes: 1, mistake: "used too much force" }).at(-1)).toEqual([
      "note",
      "87 s left, 1 mistake: used too much force",
    ]);
  });

  it("is what hinders the recording, but not why an attempt is over", () => {
    const full = { ...RUNNING, reason: "the disk is full" };
    expect(underWay(full)).toContainEqual(["trouble", "the disk is full."]);
    expect(underWay({ ...full, state: "marking" })).toContainEqual(["trouble", "the disk is full."]);
    expect(underWay({ ...RUNNING, state: "finished", reason: "every step was done" })).toEqual([
      ["title", "The attempt is over."],
      ["words", "It is being marked."],
    ]);
  });

  it("says first why an attempt came to nothing", () => {
    const lines = beforehand(TASK, "The attempt was interrupted: the servo ended.");
    expect(lines[0]).toEqual(["trouble", "The attempt was interrupted: the servo ended."]);
    expect(beforehand(TASK)).toContainEqual(["words", TASK.purpose]);
    for (const each of [lines, beforehand(TASK)]) expect(each).toContainEqual(["hint", "Squeeze both triggers to begin."]);
  });
});
