/** Every key and button there is, as tables of the help dialog. */

import { byId, make } from "./element";

type Rows = readonly (readonly [string, string])[];

/** What moves instruments is left out while a device of the trainer's own does. */
const OF_HANDS = "of-hands";

const TABLES: readonly (readonly [string, Rows, string?])[] = [
  [
    "Keyboard, instruments",
    [
      ["Tab", "the other hand (Escape leaves the picture, Tab then goes on through the page)"],
      ["← ↑ ↓ →  or  A W S D", "move the handle across the view; Shift for slow"],
      ["Q  E", "slide in, slide out"],
      ["Z  X", "turn the shaft"],
      ["Space", "close or open the jaw"],
    ],
    OF_HANDS,
  ],
  [
    "Keyboard, endoscope",
    [
      ["J  L", "pan left, pan right"],
      ["I  K", "tilt up, tilt down"],
      ["U  O", "turn the scope: the picture at 0°, the direction of view at 30°"],
      ["+  −", "closer, farther"],
      ["0  3", "take the 0° or the 30° scope"],
      ["C", "look at the tissue again"],
      ["R", "tissue to rest"],
      ["H", "this page"],
    ],
  ],
  [
    "Mouse, pen or finger on the picture",
    [
      ["move", "move the handle of the active hand across the view"],
      ["wheel, or Shift and move", "slide in and out"],
      ["Ctrl and wheel", "turn the shaft"],
      ["left button", "squeeze the jaw shut"],
      ["right button", "the other hand"],
    ],
    OF_HANDS,
  ],
  [
    "Gamepad",
    [
      ["left and right stick", "move the left and the right handle"],
      ["L1, pad down; R1, A", "slide in, slide out"],
      ["pad left and right; X, B", "turn the shaft"],
      ["L2, R2", "squeeze the jaw shut"],
    ],
    OF_HANDS,
  ],
  [
    "Headset",
    [
      ["controllers", "each is a handle, held in the fist"],
      ["trigger", "squeeze the jaw shut"],
      ["both triggers, for a moment", "begin the task that was chosen, or do it again"],
    ],
    OF_HANDS,
  ],
];

/** Fill the dialog and return what opens it. */
export function makeHelp(): () => void {
  const dialog = byId("help", HTMLDialogElement);
  byId("help-keys", HTMLDivElement).append(...TABLES.map(([title, rows, kind]) => table(title, rows, kind)));
  return () => {
    if (!dialog.open) dialog.showModal();
  };
}

function table(title: string, rows: Rows, kind = ""): HTMLTableElement {
  const made = make("table", kind);
  made.createCaption().textContent = title;
  const body = made.createTBody();
  for (const [key, does] of rows) {
    const row = body.insertRow();
    const head = make("th", "", key);
    head.scope = "row";
    row.append(head, make("td", "", does));
  }
  return made;
}
