/** The page's events, brought to the devices that understand them. Keys count only while the picture has the focus. */

import type { ActiveHand } from "./device";
import type { Keyboard } from "./keyboard";
import type { Mouse } from "./mouse";
import type { ScopeKeys } from "./scope-keys";

export interface Shortcuts {
  readonly [code: string]: () => void;
}

/** Listen to the keyboard. @param shortcuts what single keys do, by KeyboardEvent.code. */
export function listenToKeys(picture: HTMLElement, keyboard: Keyboard, scope: ScopeKeys, shortcuts: Shortcuts): void {
  picture.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    if (event.code === "Escape") {
      picture.blur();
      return;
    }
    const shortcut = shortcuts[event.code];
    if (shortcut && !event.repeat) shortcut();
    if (shortcut || keyboard.press(event.code, event.shiftKey, event.repeat) || scope.press(event.code)) {
      event.preventDefault();
    }
  });
  picture.addEventListener("keyup", (event) => {
    keyboard.release(event.code, event.shiftKey);
    scope.release(event.code);
  });
  const letGo = (): void => {
    keyboard.releaseAll();
    scope.releaseAll();
  };
  picture.addEventListener("blur", letGo);
  window.addEventListener("blur", letGo);
}

/** Listen to mouse, pen and touch on the picture. */
export function listenToPointer(picture: HTMLElement, mouse: Mouse, active: ActiveHand): void {
  let last: readonly [number, number] | null = null;
  picture.addEventListener("pointermove", (event) => {
    if (last) mouse.move(event.clientX - last[0], event.clientY - last[1], event.shiftKey);
    last = [event.clientX, event.clientY];
  });
  picture.addEventListener("pointerleave", () => {
    last = null; // coming back elsewhere moves nothing: so a small desk is enough
  });
  picture.addEventListener("pointerdown", (event) => {
    picture.focus();
    last = [event.clientX, event.clientY];
    if (event.button === 0 && event.pointerType === "mouse") {
      picture.setPointerCapture(event.pointerId);
      mouse.squeeze(true);
    }
    if (event.button === 2) active.swap();
    event.preventDefault();
  });
  const release = (event: PointerEvent): void => {
    if (event.button <= 0) mouse.squeeze(false);
  };
  picture.addEventListener("pointerup", release);
  picture.addEventListener("pointercancel", release);
  picture.addEventListener("contextmenu", (event) => event.preventDefault());
  picture.addEventListener(
    "wheel",
    (event) => {
      const pixels = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 33 * event.deltaY : event.deltaY;
      mouse.scroll(pixels, event.ctrlKey);
      event.preventDefault();
    },
    { passive: false },
  );
}
