/**
 * One turn of the page, at the display's own rate: devices move the hands, the hands go to the trainer, the newest
 * frame moves the tissue, and the picture is drawn. Instruments and head never wait for the trainer. Where a device of
 * the trainer's own moves the instruments, no hands are asked and none are sent: frames say where instruments are.
 */

import type { Device } from "./input/device";
import { NEITHER } from "./input/device";
import { HeadsetDevice, type Squeeze } from "./input/headset";
import type { ScopeKeys } from "./input/scope-keys";
import { asHeld, type Drawn } from "./instrument/drawn";
import { asSeen, Followed } from "./instrument/followed";
import { Hands } from "./instrument/hands";
import type { Replay } from "./lesson/replay";
import { showRim } from "./panel/controls";
import type { Panel } from "./panel/panel";
import type { Immersion } from "./scene/immersion";
import type { Picture } from "./scene/picture";
import { type Look, Scope, type ScopeAngle } from "./scene/scope";
import type { Theatre } from "./scene/theatre";
import type { Vector } from "./vector";
import type { Frame } from "./wire/frame";
import type { Link } from "./wire/link";
import type { Asked, Hello } from "./wire/messages";

const LONGEST = 0.1; // a longer pause moves nothing further [s]
const SIDES = [0, 1] as const;

export class Trainer {
  private hello: Hello | null = null;
  private built: Hello | null = null; // what the theatre shows
  private hands: Hands | null = null;
  private scope = new Scope([0, -0.1, 0.1], [0, 0, 0]);
  private centre: Vector = [0, 0, 0];
  private last = 0; // [ms]
  private readonly followed = new Followed();
  private readonly touching: [boolean, boolean] = [false, false];
  private readonly holding: [boolean, boolean] = [false, false];
  private tracked: ReturnType<Immersion["controllers"]> = NEITHER;
  private readonly headset = new HeadsetDevice(() => this.tracked);

  constructor(
    private readonly link: Link,
    private readonly panel: Panel,
    private readonly theatre: Theatre,
    private readonly picture: Picture,
    private readonly immersion: Immersion,
    private readonly devices: readonly Device[],
    private readonly scopeKeys: ScopeKeys,
    private readonly replay: Replay,
    private readonly squeeze: Squeeze,
  ) {}

  /** Take what the trainer says first; the same again, after a lost connection, changes nothing that is held. */
  greet(hello: Hello): void {
    this.panel.greet(hello);
    this.followed.clear();
    if (JSON.stringify(hello) === JSON.stringify(this.hello)) return;
    this.link.frames.take(); // what waits to be drawn is of what was shown before
    this.hello = hello;
    this.hands = new Hands(hello);
    if (!this.replay.showing) this.look(hello);
  }

  /** Show another tissue than the live one, without hands; null shows the live one again. */
  screen(hello: Hello | null): void {
    const shown = hello ?? this.hello;
    if (shown) this.look(shown);
    this.ask(null);
  }

  private look(hello: Hello): void {
    if (this.built && drawnOf(hello) === drawnOf(this.built)) return;
    const angle = this.scope.viewAngle;
    this.built = hello;
    this.scope = new Scope(hello.camera.port_m, hello.camera.target_m);
    this.scope.choose(angle);
    this.centre = hello.camera.target_m;
    this.theatre.build(hello);
  }

  /** Show what a step asks for, in the scene and on the bars; null asks for nothing. */
  ask(asked: Asked | null): void {
    this.theatre.mark(asked?.marks ?? []);
    this.panel.ask(asked);
  }

  /** Put the page's hands where they begin. */
  begin(): void {
    if (this.hello) this.hands = new Hands(this.hello);
    for (const device of this.devices) device.begin?.();
  }

  chooseScope(angle: ScopeAngle): void {
    this.scope.choose(angle);
  }

  home(): void {
    this.scope.home();
  }

  /** One turn. @param now [ms]. @param xr the headset's frame while in a session. */
  turn(now: number, xr: XRFrame | undefined): void {
    const seconds = Math.min((now - this.last) / 1000, LONGEST);
    this.last = now;
    this.scopeKeys.move(this.scope, seconds);
    const look = this.scope.look();
    if (this.immersion.presenting) this.immersion.place(xr, this.centre);
    else this.picture.aim(look);
    this.theatre.immerse(this.immersion.presenting);
    showRim(this.scope.viewAngle, this.scope.rim);
    const frame = this.hello && this.newest();
    if (this.replay.showing) this.rerun(look, now, seconds);
    else {
      if (this.steers && this.hands) this.steer(this.hands, look, now, seconds, xr);
      if (frame) this.show(frame, now);
      const drawn = this.steers ? this.held() : this.followed.drawn(now);
      if (drawn) this.theatre.place(drawn);
    }
    this.picture.draw(now, this.centre);
  }

  /** Whether the hands of this page move the instruments. */
  private get steers(): boolean {
    return this.hello?.steered_by === "page";
  }

  /** Show a film in place of the live tissue; the hands stay where they are. */
  private rerun(look: Look, now: number, seconds: number): void {
    const hands = this.hands;
    if (this.steers && hands) for (const side of SIDES) this.link.pose(side, hands.poses[side], now);
    const frame = this.replay.turn(seconds, now, look, this.centre);
    if (!frame) return;
    this.ask(this.replay.asked);
    this.theatre.deform(frame);
    this.theatre.place([asSeen(frame.instruments[0]), asSeen(frame.instruments[1])]);
    this.panel.update(frame, now);
  }

  private steer(hands: Hands, look: Look, now: number, seconds: number, xr: XRFrame | undefined): void {
    const view = this.picture.view(look, this.centre);
    this.tracked = this.immersion.controllers(xr);
    this.squeeze.take(this.tracked, seconds);
    for (const device of [...this.devices, this.headset]) hands.move(device, view, seconds);
    for (const side of SIDES) this.link.pose(side, hands.poses[side], now, this.tracked[side] !== null);
  }

  private held(): readonly [Drawn, Drawn] | null {
    const hands = this.hands;
    if (!hands) return null;
    const held = (side: 0 | 1): Drawn => asHeld(hands.poses[side], hands.reach(side), this.holding[side]);
    return [held(0), held(1)];
  }

  private newest(): Frame | null {
    const frame = this.link.frames.take();
    if (!frame || !this.hello) return null;
    const [nx, ny] = this.hello.grid;
    if (frame.nx === nx && frame.ny === ny && frame.layers === this.hello.tissue.layers.length) return frame;
    this.link.refuse("The trainer's frames have another grid than its greeting: load the page again.");
    return null;
  }

  private show(frame: Frame, now: number): void {
    this.theatre.deform(frame);
    this.followed.take(frame, now);
    this.panel.update(frame, now);
    frame.instruments.forEach((state, at) => {
      const side = at as 0 | 1;
      if (this.steers && state.touching && !this.touching[side]) this.immersion.pulse(side);
      this.touching[side] = state.touching;
      this.holding[side] = state.holding;
    });
  }
}

/** What of a greeting is drawn. */
function drawnOf({ tissue, grid, shape, under_m, instruments, camera }: Hello): string {
  return JSON.stringify([tissue, grid, shape, under_m, instruments, camera]);
}
