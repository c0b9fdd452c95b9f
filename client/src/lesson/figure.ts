/** A picture that the trainer draws: its place is kept, and says what is on, until it is there. */

import { make, say } from "../panel/element";

const WIDTH = 720; // of every picture [px]

/** @param height of the picture, about [px]. @param alt what it shows. */
export function figure(source: string, height: number, alt: string): HTMLElement {
  const made = make("figure");
  made.tabIndex = 0; // on a small screen it scrolls sideways, with keys too
  const image = make("img");
  const drawing = make("p", "drawing", "This picture is being drawn.");
  image.width = WIDTH;
  image.height = height;
  image.alt = alt;
  image.addEventListener("load", () => drawing.remove());
  image.addEventListener("error", () => {
    image.remove();
    say(drawing, "This picture could not be drawn.");
  });
  image.src = source;
  made.append(image, drawing);
  return made;
}
