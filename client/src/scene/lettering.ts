/** How lines are put on a board: each in its manner, wrapped, and all of them smaller where they would not fit. */

/** What a line is to its reader. */
export type Manner = "title" | "words" | "hint" | "passed" | "failed" | "trouble" | "note";
export type Line = readonly [manner: Manner, text: string];

/** One piece of text, in pixels from the upper left corner to where its baseline begins. */
export interface Piece {
  readonly text: string;
  readonly font: string;
  readonly colour: string;
  readonly right: number;
  readonly down: number;
}

const MANNERS: Readonly<Record<Manner, { readonly weight: number; readonly size: number; readonly colour: string }>> = {
  title: { weight: 600, size: 46, colour: "#e8edf1" },
  words: { weight: 400, size: 42, colour: "#e8edf1" },
  hint: { weight: 600, size: 54, colour: "#ffb020" },
  passed: { weight: 700, size: 78, colour: "#8fdc9f" },
  failed: { weight: 700, size: 78, colour: "#e69f00" },
  trouble: { weight: 600, size: 42, colour: "#ff8f7a" },
  note: { weight: 400, size: 36, colour: "#b3c0ca" },
};
const MARGIN = 36; // [px]
const LEADING = 1.22; // from baseline to baseline, of the size
const APART = 0.4; // between lines that are two things, of the size
const SMALLER = 0.94;
const SMALLEST = 0.3; // of the sizes above: nobody reads less, and no sentence of ours needs it

/**
 * Put lines on a board [px]; a note that comes last stands at its foot.
 *
 * @param measure width of a text in a font [px].
 */
export function letter(
  lines: readonly Line[],
  width: number,
  height: number,
  measure: (font: string, text: string) => number,
): Piece[] {
  for (let scale = 1; ; scale *= SMALLER) {
    const pieces: Piece[] = [];
    let down = MARGIN;
    let foot = 0;
    for (const [at, [manner, text]] of lines.entries()) {
      const { weight, size, colour } = MANNERS[manner];
      const font = `${weight} ${Math.round(size * scale)}px system-ui, sans-serif`;
      if (at > 0) down += APART * size * scale;
      foot = pieces.length;
      for (const part of wrapped(text, width - 2 * MARGIN, (each) => measure(font, each))) {
        down += LEADING * size * scale;
        pieces.push({ text: part, font, colour, right: MARGIN, down: down - 0.3 * size * scale });
      }
    }
    const left = height - MARGIN - down;
    if (left < 0 && scale > SMALLEST) continue;
    if (left <= 0 || lines.at(-1)?.[0] !== "note") return pieces;
    return pieces.map((piece, at) => (at < foot ? piece : { ...piece, down: piece.down + left }));
  }
}

function wrapped(text: string, width: number, measure: (text: string) => number): string[] {
  const lines: string[] = [""];
  for (const word of text.split(" ")) {
    const longer = `${lines.at(-1)} ${word}`.trim();
    if (measure(longer) <= width) lines[lines.length - 1] = longer;
    else lines.push(word);
  }
  return lines;
}
