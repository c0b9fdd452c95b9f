/** One instrument: shaft, tip and grip, placed where it is drawn. */

import { CapsuleGeometry, Group, Matrix4, Mesh, type Object3D, Vector3 } from "three";

import type { Drawn } from "../instrument/drawn";
import { cross, dot, norm, scale, subtract, turn, unit, type Vector } from "../vector";
import type { InstrumentShape } from "../wire/messages";
import type { ContactShade } from "./contact-shade";
import { RUBBER, SLEEVE, STEEL } from "./steel";
import { makeTip, rod, type TipModel } from "./tips";

const HELD = 0.08; // how far a jaw stays open that is closed on a fold of tissue

export class Instrument {
  readonly group = new Group();
  private readonly tip: TipModel;
  private readonly frame = new Matrix4();

  constructor(shape: InstrumentShape) {
    const radius = shape.shaft_radius_m;
    this.tip = makeTip(shape.tip, radius);
    const start = this.tip.length;
    this.group.add(this.tip.group);
    this.group.add(rod(radius, 0.006, start, STEEL));
    this.group.add(rod(radius, shape.length_m - start - 0.006, start + 0.006, SLEEVE));
    const grip = new Mesh(new CapsuleGeometry(0.011, 0.07, 8, 20), RUBBER);
    grip.rotation.x = Math.PI / 2;
    grip.position.z = shape.length_m + 0.02;
    this.group.add(grip);
    this.group.traverse((part: Object3D) => {
      part.castShadow = true;
      part.receiveShadow = true;
    });
    this.group.matrixAutoUpdate = false;
    this.group.visible = false; // until it is known where it is
  }

  /** Place it. @param shade what it takes light away from. */
  place(drawn: Drawn, side: 0 | 1, shade: ContactShade): void {
    this.group.visible = drawn.present;
    const back = scale(drawn.direction, -1); // from tip to handle
    const y = turn(reference(back), drawn.direction, drawn.roll);
    const x = cross(y, back);
    this.frame.makeBasis(new Vector3(...x), new Vector3(...y), new Vector3(...back));
    this.frame.setPosition(...drawn.tip);
    this.group.matrix.copy(this.frame);
    this.group.matrixWorldNeedsUpdate = true;
    const jaw = drawn.holding ? HELD : drawn.jaw;
    this.tip.open(jaw);
    shade.place(side, drawn.tip, back, this.tip.solidFrom(jaw), drawn.present ? this.tip.girth : 0);
  }
}

/** A direction across the shaft that means roll zero: upwards, as far as the shaft allows. */
function reference(back: Vector): Vector {
  const up: Vector = [0, 0, 1];
  const across = subtract(up, scale(back, dot(up, back)));
  return norm(across) > 1e-3 ? unit(across) : unit(subtract([0, 1, 0], scale(back, back[1])));
}
