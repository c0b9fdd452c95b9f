/** Buttons and choices of the panel. */

import type { ScopeAngle } from "../scene/scope";
import type { Choice } from "../scene/sharpness";
import { byId } from "./element";

export interface Actions {
  scope(angle: ScopeAngle): void;
  home(): void;
  reset(): void;
  help(): void;
  headset(): void;
  sharpness(choice: Choice): void;
}

/** Connect the panel's controls to what they do. */
export function connectControls(actions: Actions): void {
  for (const radio of scopes()) {
    radio.addEventListener("change", () => actions.scope(radio.value === "30" ? 30 : 0));
  }
  const click = (id: string, act: () => void): void => byId(id, HTMLButtonElement).addEventListener("click", act);
  click("home", actions.home);
  click("reset", actions.reset);
  click("help-open", actions.help);
  click("headset", actions.headset);
  const sharpness = byId("sharpness", HTMLSelectElement);
  sharpness.addEventListener("change", () => actions.sharpness(sharpness.value as Choice));
}

/** Show the scope chosen by key. */
export function showScope(angle: ScopeAngle): void {
  for (const radio of scopes()) radio.checked = radio.value === String(angle);
}

/** Point the notch at the rim to where a 30 degree scope looks. @param turn clockwise from the top [rad]. */
export function showRim(angle: ScopeAngle, turn: number): void {
  const rim = byId("rim", HTMLDivElement);
  rim.hidden = angle === 0;
  rim.style.transform = `rotate(${turn.toFixed(3)}rad)`;
}

/** Offer the headset, or what leaves it. */
export function showHeadset(possible: boolean, presenting: boolean): void {
  const button = byId("headset", HTMLButtonElement);
  button.hidden = !possible;
  button.textContent = presenting ? "Leave the headset" : "Enter the headset";
}

function scopes(): NodeListOf<HTMLInputElement> {
  return document.querySelectorAll<HTMLInputElement>("input[name=scope]");
}
