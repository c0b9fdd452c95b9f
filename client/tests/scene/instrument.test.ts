import { Box3, type Object3D, Raycaster, Vector3 } from "three";
import { describe, expect, it } from "vitest";

import type { Drawn } from "../../src/instrument/drawn";
import { ContactShade } from "../../src/scene/contact-shade";
import { Instrument } from "../../src/scene/instrument";
import { makeTip } from "../../src/scene/tips";
import type { InstrumentShape, Tip } from "../../src/wire/messages";
import { hello } from "../sample";

const SHAPE = { ...hello().instruments[0], tip: "grasper" } as InstrumentShape;
const DRAWN: Drawn = { tip: [0.02, 0.03, 0], direction: [0, 0, -1], roll: 0, jaw: 1, present: true, holding: false };
const RADIUS = 0.0025; // [m]

/** How far the jaws of a grasper reach across its shaft, drawn in some way [m]. */
function spread(changes: Partial<Drawn>): number {
  const instrument = new Instrument(SHAPE);
  instrument.place({ ...DRAWN, ...changes }, 0, new ContactShade());
  instrument.group.updateMatrixWorld(true);
  const jaws = instrument.group.children[0] as Object3D; // the tip
  const box = new Box3().setFromObject(jaws, true);
  return Math.max(box.max.x - box.min.x, box.max.y - box.min.y);
}

describe("an instrument", () => {
  it("is not seen before it is known where it is, nor where it is not present", () => {
    const instrument = new Instrument(SHAPE);
    expect(instrument.group.visible).toBe(false);
    instrument.place(DRAWN, 0, new ContactShade());
    expect(instrument.group.visible).toBe(true);
    instrument.place({ ...DRAWN, present: false }, 0, new ContactShade());
    expect(instrument.group.visible).toBe(false);
  });

  it("shows its jaw closed on a fold while it holds tissue, however the hand has it", () => {
    const open = spread({ jaw: 1 });
    const held = spread({ jaw: 0.4, holding: true });
    const shut = spread({ jaw: 0 });
    expect(held).toBeLessThan(0.7 * open);
    expect(held).toBe(spread({ jaw: 0, holding: true }));
    expect(held).toBeGreaterThanOrEqual(shut);
  });

  it("ends at its tip, whatever the tip and however far its jaw is open", () => {
    for (const tip of ["probe", "grasper", "needle-holder", "hook"] as Tip[]) {
      const model = makeTip(tip, RADIUS);
      for (const jaw of [0, 0.5, 1]) {
        model.open(jaw);
        model.group.updateMatrixWorld(true);
        const lowest = new Box3().setFromObject(model.group, true).min.z;
        // the bevel, and the thickness of a turned jaw, are drawn beyond it
        expect(Math.abs(lowest)).toBeLessThan(1e-3);
      }
    }
  });

  it("is not solid in the middle between open jaws, where light comes through", () => {
    const model = makeTip("grasper", RADIUS);
    model.open(1);
    model.group.updateMatrixWorld(true);
    const along = new Raycaster(new Vector3(0, 0, -0.01), new Vector3(0, 0, 1));
    const hit = along.intersectObject(model.group, true)[0];
    expect(model.solidFrom(0)).toBe(0);
    expect((hit?.distance ?? 0) - 0.01).toBeGreaterThan(0.5 * model.solidFrom(1));
  });
});

describe("light near a shaft", () => {
  it("is taken away by a present instrument from its tip upwards, by an absent one not", () => {
    const shade = new ContactShade();
    const instrument = new Instrument({ ...SHAPE, tip: "probe" });
    instrument.place(DRAWN, 1, shade);
    const { shaftFrom, shaftTo, shaftRadius } = shade.uniforms;
    expect(shaftRadius.value).toEqual([0, 0.8 * SHAPE.shaft_radius_m]);
    expect(shaftFrom.value[1]?.z).toBeCloseTo(0.8 * SHAPE.shaft_radius_m, 9); // the middle of its round end
    expect(shaftTo.value[1]?.z).toBeCloseTo(0.03, 9);
    instrument.place({ ...DRAWN, present: false }, 1, shade);
    expect(shaftRadius.value).toEqual([0, 0]);
  });
});
