/** A trocar's cannula in the wall: the sleeve an instrument or the scope goes through, and its rim. */

import { CylinderGeometry, Group, Mesh, Quaternion, TorusGeometry, Vector3 } from "three";

import { subtract, unit, type Vector } from "../vector";
import { CANNULA, STEEL } from "./steel";

const INSIDE = 0.009; // how far the sleeve reaches into the cavity [m]
const OUTSIDE = 0.025; // [m]

/**
 * Make one.
 *
 * @param port its centre in the wall [m].
 * @param towards a point it is aimed at [m].
 * @param radius of what goes through [m].
 */
export function makePort(port: Vector, towards: Vector, radius: number): Group {
  const group = new Group();
  const bore = radius * 1.25;
  const sleeve = new Mesh(new CylinderGeometry(bore, bore, INSIDE + OUTSIDE, 32, 1, true), CANNULA);
  sleeve.rotation.x = Math.PI / 2;
  sleeve.position.z = (OUTSIDE - INSIDE) / 2;
  const lip = new Mesh(new TorusGeometry(bore, radius * 0.18, 12, 40), CANNULA);
  lip.position.z = -INSIDE;
  const rim = new Mesh(new TorusGeometry(bore * 1.5, radius * 0.4, 14, 48), STEEL);
  for (const part of [sleeve, lip, rim]) {
    part.castShadow = true;
    part.receiveShadow = true;
    group.add(part);
  }
  const outwards = unit(subtract(port, towards));
  group.quaternion.copy(new Quaternion().setFromUnitVectors(new Vector3(0, 0, 1), new Vector3(...outwards)));
  group.position.set(...port);
  return group;
}
