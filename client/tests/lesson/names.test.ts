import { describe, expect, it } from "vitest";

import { asKept, troubleWith } from "../../src/lesson/names";

describe("a trainee's name", () => {
  it.each(["Ada", "  Zoe\u0308 ", "Ng\u1ecdc Anh", "\u0410\u0434\u0430", "\u5c0f\u660e", "Expert", "x".repeat(80)])("may be %j", (name) => {
    expect(troubleWith(name)).toBe("");
  });

  it.each([
    ["", "Write your name"],
    ["   ", "Write your name"],
    ["x".repeat(81), "shorter"],
    ["A\u200bda", "nobody can see"],
    ["A\u202eda", "nobody can see"],
    ["A\tda", "nobody can see"],
    ["A\u00a0da", "nobody can see"],
    ["A\u2028da", "nobody can see"],
    ["Scripted  Expert", "A program"],
    [" scripted novice", "A program"],
  ])("may not be %j", (name, words) => {
    expect(troubleWith(name)).toContain(words);
  });

  it("is kept without space round it, an accented letter as one character", () => {
    expect(asKept("  Zoe\u0308 ")).toBe("Zo\u00eb");
  });
});
