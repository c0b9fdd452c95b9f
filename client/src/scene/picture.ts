/** The picture: a square canvas behind a round mask, drawn through the scope, or into a headset. */

import { ACESFilmicToneMapping, Matrix4, PCFShadowMap, PerspectiveCamera, Group, Vector3, WebGLRenderer } from "three";

import type { View } from "../input/device";
import { cross, norm, subtract, type Vector } from "../vector";
import { FIELD, type Look } from "./scope";
import { type Choice, Sharpness } from "./sharpness";
import { bySoftware } from "./software";
import type { Theatre } from "./theatre";

const NEAR = 0.002; // [m]
const FAR = 3; // [m]
const MOST_PIXELS = 2; // of the device in one of CSS, drawn at most

export class Picture {
  readonly renderer: WebGLRenderer;
  readonly camera = new PerspectiveCamera(FIELD, 1, NEAR, FAR);
  readonly rig = new Group(); // carries the headset's space into the block's frame; at rest outside a session
  private readonly sharpness: Sharpness;
  private readonly eye = new Matrix4();
  private last = 0; // [ms]
  private side = 0; // of the canvas on the page [px]

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly theatre: Theatre,
  ) {
    const slow = bySoftware();
    this.sharpness = new Sharpness(slow ? 2 : 0);
    this.renderer = new WebGLRenderer({ canvas, antialias: !slow, powerPreference: "high-performance" });
    this.renderer.toneMappingExposure = 0.9;
    this.renderer.toneMapping = ACESFilmicToneMapping;
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = PCFShadowMap;
    this.renderer.xr.enabled = true;
    this.rig.add(this.camera);
    theatre.scene.add(this.rig);
  }

  set choice(choice: Choice) {
    this.sharpness.choice = choice;
    this.side = 0;
  }

  /** Point the camera as the scope looks. */
  aim(look: Look): void {
    this.camera.up.set(...look.up);
    this.camera.position.set(...look.eye);
    this.camera.lookAt(new Vector3(...look.eye).add(new Vector3(...look.forward)));
    this.camera.updateMatrixWorld();
  }

  /** The view a hand moves across; a pixel spans what it shows at the target's distance. */
  view(look: Look, target: Vector): View {
    const distance = norm(subtract(target, look.eye));
    const height = 2 * distance * Math.tan((FIELD * Math.PI) / 360);
    return { right: cross(look.forward, look.up), up: look.up, forward: look.forward, pixel: height / Math.max(this.canvas.clientHeight, 1) };
  }

  /** Draw. @param now [ms]. @param reach how far away the tissue is [m]. */
  draw(now: number, target: Vector): void {
    const eyes = this.renderer.xr.isPresenting ? this.renderer.xr.getCamera() : this.camera;
    if (!this.renderer.xr.isPresenting) this.fit(this.sharpness.take(now - this.last));
    this.last = now;
    this.eye.copy(eyes.matrixWorld);
    const distance = new Vector3().setFromMatrixPosition(this.eye).distanceTo(new Vector3(...target));
    this.theatre.lamp.follow(this.eye, distance);
    this.renderer.render(this.theatre.scene, this.camera);
  }

  private fit(changed: boolean): void {
    const side = Math.round(Math.min(this.canvas.clientWidth, this.canvas.clientHeight));
    if (side < 1 || (side === this.side && !changed)) return;
    this.side = side;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, MOST_PIXELS) * this.sharpness.share);
    this.renderer.setSize(side, side, false);
  }
}
