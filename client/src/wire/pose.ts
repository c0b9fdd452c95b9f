/** A pose as it goes to the trainer: 48 bytes, little-endian. */

import type { HandlePose } from "../instrument/pose";
import { clamp } from "../vector";
import { Held, POSE, POSE_MAGIC } from "./contract";

/**
 * Write a pose.
 *
 * @param instrument 0 left, 1 right.
 * @param sequence rises with each pose of this instrument.
 * @param tracked whether a headset's controller is the handle.
 */
export function writePose(instrument: number, sequence: number, pose: HandlePose, tracked = false): ArrayBuffer {
  const buffer = new ArrayBuffer(POSE.bytes);
  const view = new DataView(buffer);
  view.setUint32(POSE.magic, POSE_MAGIC, true);
  view.setUint32(POSE.sequence, sequence, true);
  view.setUint32(POSE.instrument, instrument, true);
  view.setUint32(POSE.flags, (pose.present ? Held.present : 0) | (tracked ? Held.tracked : 0), true);
  pose.handle.forEach((value, axis) => view.setFloat64(POSE.handleM + 8 * axis, value, true));
  view.setFloat32(POSE.rollRad, pose.roll, true);
  view.setFloat32(POSE.jaw, clamp(pose.jaw, 0, 1), true);
  return buffer;
}
