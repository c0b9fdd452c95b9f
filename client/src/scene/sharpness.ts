/** How many pixels are drawn: all of them where the machine keeps up, fewer where it does not. */

const SLOW = 45; // a frame longer than this is too slow to steer by [ms]
const SMOOTH = 21; // a frame shorter than this keeps up with a common display [ms]
const PAUSE = 3000; // a longer one is a pause, not a frame [ms]
const STEPS = [1, 0.75, 0.5, 0.35] as const; // of the display's pixels, each way
const PATIENCE = 600; // slow for so long, before fewer pixels are drawn [ms]
const FIRST_TRIAL = 10_000; // smooth for so long, before more are tried; twice as long after each failure [ms]

export type Choice = "auto" | "sharp" | "fast";

export class Sharpness {
  private slow = 0; // for how long now [ms]
  private smooth = 0; // [ms]
  private trial = FIRST_TRIAL;
  choice: Choice = "auto";

  /** @param step to begin with, 0 for every pixel. */
  constructor(private step = 0) {}

  /** Share of the display's pixels to draw, each way. */
  get share(): number {
    if (this.choice === "sharp") return STEPS[0];
    if (this.choice === "fast") return STEPS[3];
    return STEPS[this.step] ?? 1;
  }

  /** Take the length of a frame [ms]; returns whether the share changed. */
  take(milliseconds: number): boolean {
    if (this.choice !== "auto" || milliseconds > PAUSE) return false;
    this.slow = milliseconds > SLOW ? this.slow + milliseconds : 0;
    this.smooth = milliseconds < SMOOTH ? this.smooth + milliseconds : 0;
    if (this.slow >= PATIENCE && this.step < STEPS.length - 1) {
      this.trial *= 2;
      return this.go(1);
    }
    if (this.smooth >= this.trial && this.step > 0) return this.go(-1);
    return false;
  }

  private go(by: number): boolean {
    this.step += by;
    this.slow = this.smooth = 0;
    return true;
  }
}
