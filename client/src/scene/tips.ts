/**
 * Instrument tips. Each has its working end at the origin and its shaft along +z, and can be told how far its jaw is
 * open. Lengths in metres.
 */

import {
  BoxGeometry,
  CatmullRomCurve3,
  CylinderGeometry,
  ExtrudeGeometry,
  Group,
  Mesh,
  type MeshPhongMaterial,
  Shape,
  SphereGeometry,
  TubeGeometry,
  Vector3,
} from "three";

import type { Tip } from "../wire/messages";
import { DARK_STEEL, GOLD, STEEL } from "./steel";

export interface TipModel {
  readonly group: Group;
  readonly length: number; // from the working end to where the shaft begins [m]
  readonly girth: number; // radius near the working end [m]
  open(jaw: number): void; // 0 closed to 1 open
  solidFrom(jaw: number): number; // how far from the working end there is something in the middle [m]
}

const still = (): void => undefined;
const throughout = (): number => 0;

/** Make a tip for a shaft of some radius [m]. */
export function makeTip(tip: Tip, radius: number): TipModel {
  switch (tip) {
    case "probe":
      return makeProbe(radius);
    case "grasper":
      return makeJaws(radius, { length: 0.016, opening: 0.32, both: true, teeth: 9, liner: STEEL });
    case "needle-holder":
      return makeJaws(radius, { length: 0.011, opening: 0.45, both: false, teeth: 0, liner: GOLD });
    case "scissors":
      return makeJaws(radius, { length: 0.011, opening: 0.35, both: true, teeth: 0, liner: STEEL });
    case "hook":
      return makeHook(radius);
  }
}

function makeProbe(radius: number): TipModel {
  const length = 0.03;
  const group = new Group();
  group.add(rod(radius * 0.8, length - radius, radius * 0.8, STEEL));
  const cap = new Mesh(new SphereGeometry(radius * 0.8, 24, 16), STEEL);
  cap.position.z = radius * 0.8;
  group.add(cap);
  return { group, length, girth: radius * 0.8, open: still, solidFrom: throughout };
}

interface Jaws {
  readonly length: number;
  readonly opening: number; // of each moving jaw at most [rad]
  readonly both: boolean;
  readonly teeth: number;
  readonly liner: MeshPhongMaterial;
}

function makeJaws(radius: number, jaws: Jaws): TipModel {
  const group = new Group();
  const reach = jaws.length + 0.003;
  const yoke = 0.008;
  group.add(rod(radius * 0.98, yoke, jaws.length + 0.002, DARK_STEEL));
  const pin = new Mesh(new CylinderGeometry(radius * 0.3, radius * 0.3, radius * 2.1, 16), STEEL);
  pin.rotation.z = Math.PI / 2;
  pin.position.z = jaws.length + 0.003;
  group.add(pin);
  const hinges = [1, -1].map((side) => {
    const hinge = new Group();
    hinge.position.z = reach;
    hinge.add(makeJaw(radius, jaws, side));
    group.add(hinge);
    return hinge;
  });
  return {
    group,
    length: jaws.length + 0.002 + yoke,
    girth: radius * 0.55,
    solidFrom: (jaw) => (jaws.both ? jaw * reach : 0),
    open: (jaw) => {
      // Ends that part move back along the shaft; what touches is the ends, so they stay at the working end's height.
      if (jaws.both) group.position.z = -reach * (1 - Math.cos(jaw * jaws.opening));
      const [upper, lower] = hinges as [Group, Group];
      upper.rotation.x = jaw * jaws.opening;
      lower.rotation.x = jaws.both ? -jaw * jaws.opening : 0;
    },
  };
}

/** One jaw, from the hinge at its origin to the tip at -z; its biting face looks to -y times side. */
function makeJaw(radius: number, jaws: Jaws, side: number): Group {
  const jaw = new Group();
  const reach = jaws.length + 0.003;
  const profile = new Shape();
  profile.moveTo(0, 0.00012);
  const teeth = Math.max(jaws.teeth, 1);
  for (let k = 0; k < jaws.teeth; k++) {
    const from = reach * (0.35 + (0.62 * k) / teeth);
    profile.lineTo(from, 0.00012);
    profile.lineTo(from + (reach * 0.31) / teeth, 0.0007);
  }
  profile.lineTo(reach * 0.985, 0.00012);
  profile.quadraticCurveTo(reach, 0.0002, reach, radius * 0.3);
  profile.quadraticCurveTo(reach * 0.97, radius * 0.55, reach * 0.5, radius * 0.72);
  profile.lineTo(-0.003, radius * 0.9);
  profile.lineTo(-0.003, 0.00012);
  const width = radius * 1.05;
  const geometry = new ExtrudeGeometry(profile, {
    depth: width,
    bevelEnabled: true,
    bevelSize: 0.00025,
    bevelThickness: 0.0003,
    bevelSegments: 3,
    curveSegments: 10,
  });
  const solid = new Mesh(geometry, STEEL);
  // Profile x runs to the tip (-z), profile y away from the other jaw.
  solid.rotation.y = Math.PI / 2;
  solid.position.x = -width / 2;
  const mirrored = new Group();
  mirrored.add(solid);
  mirrored.rotation.z = side > 0 ? 0 : Math.PI;
  jaw.add(mirrored);
  if (jaws.liner === GOLD) {
    const plate = new Mesh(new BoxGeometry(width * 1.1, 0.0005, reach * 0.6), GOLD);
    plate.position.set(0, side * 0.0004, -reach * 0.68);
    jaw.add(plate);
  }
  return jaw;
}

/** An L-hook: a thin rod that bends aside; the heel of the bend is the working end. */
function makeHook(radius: number): TipModel {
  const group = new Group();
  const thin = radius * 0.26;
  const path = new CatmullRomCurve3(
    [
      new Vector3(0, 0, 0.014),
      new Vector3(0, 0, 0.006),
      new Vector3(0, 0.0002, 0.002),
      new Vector3(0, 0.0014, thin),
      new Vector3(0, 0.004, thin),
    ],
    false,
    "catmullrom",
    0.3,
  );
  group.add(new Mesh(new TubeGeometry(path, 40, thin, 12), STEEL));
  const end = new Mesh(new SphereGeometry(thin, 12, 8), STEEL);
  end.position.set(0, 0.004, thin);
  group.add(end);
  const collar = rod(radius * 0.85, 0.006, 0.012, DARK_STEEL);
  group.add(collar);
  return { group, length: 0.018, girth: thin, open: still, solidFrom: throughout };
}

/** A rod along +z from some height. */
export function rod(radius: number, length: number, from: number, material: MeshPhongMaterial): Mesh {
  const mesh = new Mesh(new CylinderGeometry(radius, radius, length, 28, 1), material);
  mesh.rotation.x = Math.PI / 2;
  mesh.position.z = from + length / 2;
  return mesh;
}
