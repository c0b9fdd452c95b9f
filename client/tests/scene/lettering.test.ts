import { describe, expect, it } from "vitest";

import { letter, type Line } from "../../src/scene/lettering";

const WIDTH = 1000;
const HEIGHT = 400;
const size = (font: string): number => Number(/(\d+)px/.exec(font)?.[1]);
const measure = (font: string, text: string): number => 0.6 * size(font) * text.length; // a wide letter's share

function lettered(...lines: Line[]): ReturnType<typeof letter> {
  return letter(lines, WIDTH, HEIGHT, measure);
}

describe("lettering", () => {
  it("keeps every word, in order, and the board's edges", () => {
    const long = "go over the mark before you come down, and stop when the bar is at its mark. ".repeat(8).trim();
    const pieces = lettered(["failed", "12 of 100, not passed"], ["words", long], ["note", "75 passes."]);
    expect(pieces.map((piece) => piece.text).join(" ")).toBe(`12 of 100, not passed ${long} 75 passes.`);
    for (const { text, font, right, down } of pieces) {
      expect(right).toBeGreaterThan(0);
      expect(right + measure(font, text)).toBeLessThan(WIDTH);
      expect(down - size(font)).toBeGreaterThan(0);
      expect(down + 0.3 * size(font)).toBeLessThan(HEIGHT);
    }
  });

  it("never puts one line on another", () => {
    const pieces = lettered(["title", "Palpate"], ["words", "press ".repeat(60).trim()], ["hint", "Hold it so."]);
    pieces.slice(1).forEach(({ font, down }, at) => expect(down - (pieces[at]?.down ?? 0)).toBeGreaterThan(0.99 * size(font)));
  });

  it("writes as large as it may, and a note that comes last at the foot", () => {
    const [hint, note] = lettered(["hint", "Hold it so."], ["note", "87 s left"]);
    expect(size(hint?.font ?? "")).toBe(54);
    expect(note?.down).toBeGreaterThan(HEIGHT - 60);
    expect(lettered(["hint", "Hold it so."])[0]?.down).toBe(hint?.down);
  });

  it("leaves an empty board empty", () => {
    expect(lettered()).toEqual([]);
  });
});
