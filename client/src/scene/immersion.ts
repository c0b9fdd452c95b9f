/**
 * The headset: both eyes see the cavity at its own size, as if the wall towards them were glass, and each tracked
 * controller is an instrument's handle. The block is put before the user when a session begins.
 */

import { Matrix4, Quaternion, Vector3, type Group, type WebGLRenderer } from "three";

import type { Controller } from "../input/headset";
import type { Vector } from "../vector";

const AHEAD = 0.38; // of the head [m]
const BELOW = 0.44; // the head [m]
const PULSE = { strength: 0.5, duration: 30 } as const; // at a touch [ms]

export class Immersion {
  private session: XRSession | null = null;
  private placed = false;

  /**
   * @param rig carries the headset's space into the block's frame.
   */
  constructor(
    private readonly renderer: WebGLRenderer,
    private readonly rig: Group,
    private readonly ended: () => void,
  ) {
    renderer.xr.setReferenceSpaceType("local");
  }

  /** Whether this browser has a headset to show in. */
  static async possible(): Promise<boolean> {
    return (await navigator.xr?.isSessionSupported("immersive-vr").catch(() => false)) ?? false;
  }

  /** Begin a session; only a click may ask for one. */
  async begin(): Promise<void> {
    if (!navigator.xr) return;
    const session = await navigator.xr.requestSession("immersive-vr", { optionalFeatures: ["local-floor"] });
    this.session = session;
    this.placed = false;
    session.addEventListener("end", () => this.end());
    await this.renderer.xr.setSession(session);
  }

  get presenting(): boolean {
    return this.renderer.xr.isPresenting;
  }

  async leave(): Promise<void> {
    await this.session?.end();
  }

  /** Put the block before the head, once, when it is first tracked. @param centre of its upper face [m]. */
  place(frame: XRFrame | undefined, centre: Vector): void {
    const space = this.renderer.xr.getReferenceSpace();
    if (this.placed || !frame || !space) return;
    const head = frame.getViewerPose(space)?.transform;
    if (!head) return;
    this.rig.matrix.copy(beforeTheHead(head.matrix, centre));
    this.rig.matrix.decompose(this.rig.position, this.rig.quaternion, this.rig.scale);
    this.rig.updateMatrixWorld(true);
    this.placed = true;
  }

  /** Both controllers as they are in a frame, in the block's frame. */
  controllers(frame: XRFrame | undefined): readonly [Controller | null, Controller | null] {
    const found: [Controller | null, Controller | null] = [null, null];
    const space = this.renderer.xr.getReferenceSpace();
    if (!frame || !space || !this.placed) return found;
    for (const source of this.session?.inputSources ?? []) {
      const side = source.handedness === "left" ? 0 : source.handedness === "right" ? 1 : null;
      const pose = source.gripSpace ? frame.getPose(source.gripSpace, space) : undefined;
      if (side === null || !pose) continue;
      const grip = new Matrix4().fromArray(pose.transform.matrix).premultiply(this.rig.matrixWorld);
      const at = new Vector3().setFromMatrixPosition(grip);
      const turned = new Quaternion().setFromRotationMatrix(grip);
      found[side] = {
        position: [at.x, at.y, at.z],
        twist: -2 * Math.atan2(turned.z, turned.w), // about the grip's z, which runs through the fist
        trigger: source.gamepad?.buttons[0]?.value ?? 0,
      };
    }
    return found;
  }

  /** Let a controller be felt, where it can be. */
  pulse(side: 0 | 1): void {
    for (const source of this.session?.inputSources ?? []) {
      if (source.handedness !== (side === 0 ? "left" : "right")) continue;
      const actuators = source.gamepad?.hapticActuators as readonly GamepadHapticActuator[] | undefined;
      const actuator = actuators?.[0] as { pulse?(strength: number, duration: number): unknown } | undefined;
      actuator?.pulse?.(PULSE.strength, PULSE.duration);
    }
  }

  private end(): void {
    this.session = null;
    this.rig.position.set(0, 0, 0);
    this.rig.quaternion.identity();
    this.rig.updateMatrixWorld(true);
    this.ended();
  }
}

/**
 * Return what carries the headset's space (y up) into the block's frame (z up), for a block that lies before and below
 * a head, its y axis pointing away from the user.
 *
 * @param head pose of the head, column by column.
 * @param centre of the block's upper face in its own frame [m].
 */
export function beforeTheHead(head: Float32Array, centre: Vector): Matrix4 {
  const pose = new Matrix4().fromArray(head);
  const away = new Vector3(0, 0, -1).transformDirection(pose).setY(0);
  if (away.lengthSq() < 1e-6) away.set(0, 0, -1);
  away.normalize();
  const there = new Vector3().setFromMatrixPosition(pose).addScaledVector(away, AHEAD);
  there.y -= BELOW;
  const up = new Vector3(0, 1, 0);
  const right = new Vector3().crossVectors(away, up);
  const block = new Matrix4().makeBasis(right, away, up).setPosition(there);
  block.multiply(new Matrix4().makeTranslation(-centre[0], -centre[1], -centre[2]));
  return block.invert();
}
