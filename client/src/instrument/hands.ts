/** Both instruments as they are held now: what devices move, what is drawn and what is sent. */

import type { Device, Hand, View } from "../input/device";
import type { Hello, InstrumentShape } from "../wire/messages";
import { keepPossible, type Reach, reach, type Shaft } from "./fulcrum";
import type { HandlePose } from "./pose";

export class Hands {
  readonly shafts: readonly [Shaft, Shaft];
  private readonly floor: number;
  private held: [HandlePose, HandlePose];

  /** Begin where the trainer says the handles are. */
  constructor(hello: Hello) {
    const [left, right] = hello.instruments as [InstrumentShape, InstrumentShape];
    this.shafts = [shaft(left), shaft(right)];
    this.floor = -hello.tissue.layers.reduce((sum, layer) => sum + layer.thickness_m, 0);
    this.held = [this.possible(0, start(left)), this.possible(1, start(right))];
  }

  get poses(): readonly [HandlePose, HandlePose] {
    return this.held;
  }

  /** Let a device move what it moves. */
  move(device: Device, view: View, seconds: number): void {
    const hands: [Hand, Hand] = [
      { pose: this.held[0], port: this.shafts[0].port },
      { pose: this.held[1], port: this.shafts[1].port },
    ];
    const [left, right] = device.poses(hands, view, seconds);
    this.held = [left ? this.possible(0, left) : this.held[0], right ? this.possible(1, right) : this.held[1]];
  }

  /** Return where an instrument's tip is. */
  reach(side: 0 | 1): Reach {
    return reach(this.held[side].handle, this.shafts[side]);
  }

  private possible(side: 0 | 1, pose: HandlePose): HandlePose {
    return keepPossible(pose, this.shafts[side], this.floor);
  }
}

function shaft(shape: InstrumentShape): Shaft {
  return { port: shape.port_m, length: shape.length_m };
}

function start(shape: InstrumentShape): HandlePose {
  return { handle: shape.handle_m, roll: 0, jaw: 1, present: true };
}
