/** The only light there is: the end of the light guide beside the lens, so that shadows fall a little aside. */

import { Color, HemisphereLight, type Matrix4, type Scene, SpotLight, Vector3 } from "three";

import { bySoftware } from "./software";

const BESIDE = new Vector3(0.0075, 0.009, 0.002); // of the lens, to the right, up and back [m]
const POWER = 0.0205; // [cd], for a picture that is bright at the working distance
const WORKING_DISTANCE = 0.07; // at which POWER is right [m]
const HALF_ANGLE = 0.82; // [rad]

export class Lamp {
  private readonly light = new SpotLight(new Color(1.0, 0.965, 0.91), POWER, 0, HALF_ANGLE, 0.75, 2);
  private readonly at = new Vector3();

  constructor(scene: Scene) {
    const { shadow } = this.light;
    this.light.castShadow = true;
    const side = bySoftware() ? 512 : 2048; // of the shadow's picture [texels]
    shadow.mapSize.set(side, side);
    shadow.camera.near = 0.008;
    shadow.camera.far = 0.6;
    shadow.bias = -0.0006;
    shadow.normalBias = 0.0004;
    shadow.radius = bySoftware() ? 1 : 3;
    shadow.intensity = 0.9; // what wet walls send back reaches everywhere
    // Light that comes back from red walls all round.
    scene.add(this.light, this.light.target, new HemisphereLight(new Color(0.5, 0.24, 0.3), new Color(0.4, 0.14, 0.1), 0.3));
  }

  /** Put the lamp beside an eye. @param reach how far the eye looks; the light keeps the picture as bright [m]. */
  follow(eye: Matrix4, reach: number): void {
    this.light.position.copy(this.at.copy(BESIDE).applyMatrix4(eye));
    this.light.target.position.copy(this.at.set(0, 0, -reach).applyMatrix4(eye));
    this.light.target.updateMatrixWorld();
    this.light.intensity = POWER * (0.45 + 0.55 * (reach / WORKING_DISTANCE) ** 2); // as a camera's automatic gain does
  }
}
