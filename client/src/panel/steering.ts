/** Whose hands move the instruments, in words and in what the page offers. */

import type { Hello } from "../wire/messages";
import { byId } from "./element";

const OBEYS = "Picture of the tissue. Keys move the instruments; Escape leaves the picture.";
const WATCHES = "Picture of the tissue. Keys move the endoscope; Tab or Escape leaves the picture.";

/** Say who steers, and hide what would be without effect. */
export function showSteering(by: Hello["steered_by"]): void {
  const watching = by === "trainer";
  byId("picture", HTMLDivElement).setAttribute("aria-label", watching ? WATCHES : OBEYS);
  byId("picture", HTMLDivElement).dataset["steeredBy"] = by;
  byId("steered", HTMLElement).hidden = !watching;
  byId("help-watching", HTMLElement).hidden = !watching;
  for (const element of document.querySelectorAll<HTMLElement>(".of-hands")) element.hidden = watching;
}
