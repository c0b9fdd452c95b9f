/** The text half of the live stream: what the server says in JSON, checked before anything uses it. */

import { type Guiding, type Hello, type InstrumentShape, type Notice, type OrganShape, PROTOCOL } from "./contract";

export type { Guiding, Hello, InstrumentShape, Notice, OrganShape, TaskMark } from "./contract";
/** What a step asks for. */
export type Asked = Pick<Guiding, "words" | "marks" | "least_n" | "most_n">;
export type Tip = InstrumentShape["tip"];

/** What came is not what the contract says; the message is a sentence for the user. */
export class WireError extends Error {}

const LEVELS: readonly unknown[] = ["info", "warning", "stopped"];
const STEERERS: readonly unknown[] = ["page", "trainer"];
const STATES: readonly unknown[] = ["running", "marking", "finished", "interrupted"];
const TIPS: readonly unknown[] = ["probe", "grasper", "needle-holder", "hook", "scissors"];

/** Read one text message of the server. */
export function readServerMessage(text: string): Hello | Guiding | Notice {
  let message: unknown;
  try {
    message = JSON.parse(text);
  } catch {
    throw new WireError("The trainer sent a text that is not JSON.");
  }
  const type = field(message, "type");
  if (type === "notice") return readNotice(message);
  if (type === "hello") return readHello(message);
  if (type === "guiding") return readGuiding(message);
  throw new WireError(`The trainer sent a message of unknown type ${JSON.stringify(type)}.`);
}

function readNotice(message: unknown): Notice {
  const notice = message as Notice;
  if (!LEVELS.includes(notice.level) || typeof notice.text !== "string") {
    throw new WireError("The trainer sent a notice without a level or a text.");
  }
  return notice;
}

function readGuiding(message: unknown): Guiding {
  const guiding = message as Guiding;
  const sound =
    STATES.includes(guiding.state) &&
    [guiding.attempt, guiding.step, guiding.mistakes, guiding.time_s, guiding.left_s].every(Number.isFinite) &&
    [guiding.words, guiding.hint, guiding.mistake, guiding.reason].every((text) => typeof text === "string") &&
    isNumbers(guiding.least_n, 2) &&
    isNumbers(guiding.most_n, 2) &&
    Array.isArray(guiding.marks) &&
    guiding.marks.every((mark) => isNumbers(mark.place_m, 2) && mark.radius_m > 0);
  if (!sound) throw new WireError("The trainer's guidance lacks what this page needs to show it.");
  return guiding;
}

function readHello(message: unknown): Hello {
  const protocol = field(message, "protocol");
  if (protocol !== PROTOCOL) {
    throw new WireError(
      `The trainer speaks protocol ${String(protocol)}, this page ${PROTOCOL}: load the page again.`,
    );
  }
  const hello = message as Hello;
  const sound =
    isNumbers(hello.tissue?.size_m, 2) &&
    Array.isArray(hello.tissue.layers) &&
    hello.tissue.layers.length > 0 &&
    hello.tissue.layers.every((layer) => typeof layer.name === "string" && layer.thickness_m > 0) &&
    isNumbers(hello.grid, 2) &&
    hello.under_m >= 0 &&
    (!hello.shape || isOrgan(hello.shape, hello.grid[0] * hello.grid[1])) &&
    isNumbers(hello.camera?.port_m, 3) &&
    isNumbers(hello.camera.target_m, 3) &&
    Number.isFinite(hello.linear_force_n) &&
    Number.isFinite(hello.rate_hz) &&
    STEERERS.includes(hello.steered_by) &&
    typeof hello.lessons === "boolean" &&
    Array.isArray(hello.instruments) &&
    hello.instruments.length === 2 &&
    hello.instruments.every(isInstrument);
  if (!sound) throw new WireError("The trainer's greeting lacks what this page needs to draw.");
  return hello;
}

function isOrgan(shape: OrganShape, nodes: number): boolean {
  return (
    Array.isArray(shape.rest_m) &&
    shape.rest_m.length === nodes &&
    shape.rest_m.every((height) => height === null || Number.isFinite(height)) &&
    Array.isArray(shape.rim) &&
    Array.isArray(shape.rim_m) &&
    shape.rim.length === shape.rim_m.length &&
    shape.rim.every((node) => Number.isInteger(node) && node >= 0 && node < nodes) &&
    shape.rim_m.every((place) => isNumbers(place, 2)) &&
    Array.isArray(shape.corners_m) &&
    shape.corners_m.every((corner) => isNumbers(corner, 3)) &&
    Array.isArray(shape.normals) &&
    shape.normals.length === shape.corners_m.length &&
    shape.normals.every((normal) => isNumbers(normal, 3)) &&
    Array.isArray(shape.faces) &&
    shape.faces.every((face) => isNumbers(face, 3) && Math.max(...face) < shape.corners_m.length)
  );
}

function isInstrument(shape: InstrumentShape): boolean {
  return (
    isNumbers(shape.port_m, 3) &&
    isNumbers(shape.handle_m, 3) &&
    shape.length_m > 0 &&
    shape.shaft_radius_m > 0 &&
    TIPS.includes(shape.tip)
  );
}

function isNumbers(value: unknown, count: number): boolean {
  return Array.isArray(value) && value.length === count && value.every(Number.isFinite);
}

function field(message: unknown, key: string): unknown {
  return typeof message === "object" && message !== null ? Reflect.get(message, key) : undefined;
}
