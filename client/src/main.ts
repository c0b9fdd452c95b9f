/** Puts the page together and starts it. */

import { ActiveHand } from "./input/device";
import { GamepadDevice } from "./input/gamepad";
import { Squeeze } from "./input/headset";
import { Keyboard } from "./input/keyboard";
import { listenToKeys, listenToPointer } from "./input/listen";
import { Mouse } from "./input/mouse";
import { ScopeKeys } from "./input/scope-keys";
import { Day } from "./lesson/day";
import { Replay } from "./lesson/replay";
import { connectControls, showHeadset, showScope } from "./panel/controls";
import { byId } from "./panel/element";
import { makeHelp } from "./panel/help";
import { Panel } from "./panel/panel";
import { Immersion } from "./scene/immersion";
import { Picture } from "./scene/picture";
import type { ScopeAngle } from "./scene/scope";
import { Theatre } from "./scene/theatre";
import { Trainer } from "./trainer";
import { Link } from "./wire/link";

function start(): void {
  const panel = new Panel();
  const picture = byId("picture", HTMLDivElement);
  const theatre = new Theatre();
  const drawn = new Picture(byId("canvas", HTMLCanvasElement), theatre);
  const active = new ActiveHand((side) => panel.active(side));
  const keyboard = new Keyboard(active);
  const mouse = new Mouse(active);
  const scopeKeys = new ScopeKeys();
  const gamepad = new GamepadDevice(() => navigator.getGamepads());
  const immersion = new Immersion(drawn.renderer, drawn.rig, () => showHeadset(true, false));
  const link = new Link(
    {
      hello: (hello) => {
        active.steers = hello.steered_by === "page";
        trainer.greet(hello);
        panel.active(active.side);
        day.greet(hello);
      },
      guiding: (guiding) => day.take(guiding),
      settled: () => day.settle(),
      notice: (notice) => panel.notices.take(notice),
      connection: (state, reason) => {
        panel.notices.connected(state, reason);
        if (state === "lost" || state === "refused") day.lose();
      },
    },
    () => new WebSocket(`${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/live`),
  );
  const replay = new Replay();
  const squeeze = new Squeeze(() => day.squeezed());
  const trainer = new Trainer(link, panel, theatre, drawn, immersion, [mouse, keyboard, gamepad], scopeKeys, replay, squeeze);
  const day = new Day({
    replay,
    ask: (asked) => trainer.ask(asked),
    write: (lines) => theatre.write(lines),
    say: (level, text) => panel.notices.take({ type: "notice", level, text }),
    begin: () => {
      trainer.begin();
      picture.focus({ preventScroll: true });
    },
    show: (hello) => trainer.screen(hello),
  });

  const scope = (angle: ScopeAngle): void => {
    trainer.chooseScope(angle);
    showScope(angle);
  };
  const headset = async (): Promise<void> => {
    try {
      await (immersion.presenting ? immersion.leave() : immersion.begin());
    } catch (error) {
      const text = `The headset could not be entered: ${(error as Error).message}`;
      panel.notices.take({ type: "notice", level: "warning", text });
    }
    showHeadset(true, immersion.presenting);
  };
  const actions = {
    scope,
    home: () => trainer.home(),
    reset: () => link.reset(),
    help: makeHelp(),
    headset: () => void headset(),
    sharpness: (choice: typeof drawn.choice) => {
      drawn.choice = choice;
      replay.choice = choice;
    },
  };
  connectControls(actions);
  listenToKeys(picture, keyboard, scopeKeys, {
    Digit0: () => scope(0),
    Digit3: () => scope(30),
    KeyC: actions.home,
    KeyR: actions.reset,
    KeyH: actions.help,
  });
  listenToPointer(picture, mouse, active);
  void Immersion.possible().then((possible) => showHeadset(possible, false));
  drawn.renderer.setAnimationLoop((now, frame) => trainer.turn(now, frame));
  link.connect();
  picture.focus({ preventScroll: true });
}

try {
  start();
} catch (error) {
  const notice = byId("notice", HTMLElement);
  notice.dataset["level"] = "stopped";
  notice.textContent = `This browser cannot show the trainer, which needs WebGL 2: ${(error as Error).message}`;
}
