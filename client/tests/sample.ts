/** A greeting, hands and a view for tests. */

import type { Hand, View } from "../src/input/device";
import { handleFor } from "../src/instrument/fulcrum";
import type { Vector } from "../src/vector";
import type { Hello } from "../src/wire/messages";

export const LENGTH = 0.31; // [m]
export const LEFT_PORT: Vector = [-0.05, -0.01, 0.1];
export const RIGHT_PORT: Vector = [0.11, -0.01, 0.1];
export const VIEW: View = { right: [1, 0, 0], up: [0, 0.6, 0.8], forward: [0, 0.8, -0.6], pixel: 1e-4 };

export function hello(): Hello {
  const instrument = (name: "left" | "right", port: Vector, tip: Vector) => ({
    name,
    port_m: port,
    length_m: LENGTH,
    shaft_radius_m: 0.0025,
    tip: "grasper" as const,
    handle_m: handleFor(tip, { port, length: LENGTH }),
  });
  return {
    type: "hello",
    protocol: 1,
    tissue: { name: "skin", size_m: [0.06, 0.06], layers: [{ name: "dermis", thickness_m: 0.0015 }] },
    grid: [2, 2],
    shape: null,
    under_m: 0,
    instruments: [
      instrument("left", LEFT_PORT, [0.02, 0.03, 0.01]),
      instrument("right", RIGHT_PORT, [0.04, 0.03, 0.01]),
    ],
    camera: { port_m: [0.03, -0.07, 0.11], target_m: [0.03, 0.03, 0] },
    linear_force_n: 0.4,
    rate_hz: 1000,
    lessons: false,
    steered_by: "page",
  };
}

/** Left and right hand as they start. */
export function hands(): [Hand, Hand] {
  const [left, right] = hello().instruments.map((shape) => ({
    pose: { handle: shape.handle_m, roll: 0, jaw: 1, present: true },
    port: shape.port_m,
  })) as [Hand, Hand];
  return [left, right];
}
