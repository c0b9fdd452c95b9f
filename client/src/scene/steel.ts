/**
 * What instruments are made of. Brushed steel throws light back broadly: a shaft that slants towards the lens still has
 * its bright line. Highlights come from the lamp alone: there is nothing else in a cavity to mirror.
 */

import { Color, DoubleSide, MeshPhongMaterial } from "three";

export const STEEL = metal(new Color(0.22, 0.225, 0.235), 1.6, 5);
export const DARK_STEEL = metal(new Color(0.1, 0.103, 0.11), 0.9, 6);
export const GOLD = metal(new Color(0.5, 0.33, 0.09), 0.7, 30);
export const SLEEVE = metal(new Color(0.024, 0.025, 0.029), 0.1, 28); // black insulation
export const RUBBER = metal(new Color(0.06, 0.12, 0.2), 0.03, 12);
export const CANNULA = metal(new Color(0.3, 0.36, 0.4), 0.15, 30);
CANNULA.side = DoubleSide;

/** @param mirror how much it reflects straight back, 0 to 1. @param polish Blinn-Phong exponent. */
function metal(colour: Color, mirror: number, polish: number): MeshPhongMaterial {
  const specular = new Color(1, 0.98, 0.95).multiplyScalar(mirror);
  return new MeshPhongMaterial({ color: colour, specular, shininess: polish });
}
