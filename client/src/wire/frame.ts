/** A binary frame of the live stream: the state of tissue and instruments, little-endian. */

import type { Vector } from "../vector";
import { FRAME_MAGIC, HEADER, INSTRUMENT, LINKS, Status as StatusBit, Touch } from "./contract";
import { fromHalf } from "./half";
import { WireError } from "./messages";

const MILLIMETRE = 1e-3; // [m]

export interface Status {
  alive: boolean;
  degraded: boolean;
  beyondLinear: boolean;
  forcesCut: boolean;
}

export interface InstrumentState {
  tip: Vector; // [m]
  direction: Vector;
  roll: number; // [rad]
  jaw: number; // 0 closed to 1 open
  force: Vector; // on the tip [N]
  handleForce: Vector; // on the hand [N]
  present: boolean;
  touching: boolean;
  holding: boolean;
  depth: number; // [m]
}

export interface Frame {
  sequence: number;
  tick: number;
  time: number; // [s]
  poseSequence: readonly [number, number];
  rate: number; // achieved [Hz]
  missedTicks: number;
  tickP50: number; // [us]
  tickP99: number; // [us]
  status: Status;
  instruments: readonly [InstrumentState, InstrumentState];
  layers: number;
  nx: number;
  ny: number;
  heights: Float32Array; // u_z of each layer's upper face [m], layers x ny x nx
  inPlane: Float32Array | null; // u_x, then u_y of the top face [m]
  cut: Uint8Array | null; // of a sheet: where its links are cut (`scene/slit`), LINKS x ny x nx
}

/** Return the sequence number alone, to acknowledge or drop a frame unread. */
export function frameSequence(buffer: ArrayBuffer): number {
  if (buffer.byteLength < HEADER.bytes) throw new WireError("The trainer sent a frame that is too short.");
  const view = new DataView(buffer);
  if (view.getUint32(HEADER.magic, true) !== FRAME_MAGIC) throw new WireError("The trainer sent an unknown frame.");
  return view.getUint32(HEADER.sequence, true);
}

/** Read a frame. */
export function readFrame(buffer: ArrayBuffer): Frame {
  const sequence = frameSequence(buffer);
  const view = new DataView(buffer);
  const layers = view.getUint16(HEADER.layers, true);
  const nx = view.getUint16(HEADER.nx, true);
  const ny = view.getUint16(HEADER.ny, true);
  const planes = layers + (view.getUint16(HEADER.inPlane, true) ? 2 : 0);
  const start = HEADER.bytes + 2 * INSTRUMENT.bytes;
  const end = start + planes * nx * ny * 2;
  const cut = view.getUint32(HEADER.cut, true) !== 0;
  const expected = end + (cut ? LINKS * nx * ny : 0);
  if (buffer.byteLength !== expected) {
    throw new WireError(`The trainer sent a frame of ${buffer.byteLength} bytes where ${expected} belong.`);
  }
  const bits = new Uint16Array(buffer, start, planes * nx * ny);
  const values = fromHalf(bits, MILLIMETRE);
  const surface = layers * nx * ny;
  return {
    sequence,
    tick: Number(view.getBigUint64(HEADER.tick, true)),
    time: view.getFloat64(HEADER.timeS, true),
    poseSequence: [view.getUint32(HEADER.poseSequence, true), view.getUint32(HEADER.poseSequence + 4, true)],
    rate: view.getFloat32(HEADER.rateHz, true),
    missedTicks: view.getUint32(HEADER.missedTicks, true),
    tickP50: view.getFloat32(HEADER.tickP50Us, true),
    tickP99: view.getFloat32(HEADER.tickP99Us, true),
    status: readStatus(view.getUint32(HEADER.status, true)),
    instruments: [readInstrument(view, HEADER.bytes), readInstrument(view, HEADER.bytes + INSTRUMENT.bytes)],
    layers,
    nx,
    ny,
    heights: values.subarray(0, surface),
    inPlane: planes > layers ? values.subarray(surface) : null,
    cut: cut ? new Uint8Array(buffer, end, LINKS * nx * ny) : null,
  };
}

function readStatus(bits: number): Status {
  return {
    alive: (bits & StatusBit.alive) !== 0,
    degraded: (bits & StatusBit.degraded) !== 0,
    beyondLinear: (bits & StatusBit.beyondLinear) !== 0,
    forcesCut: (bits & StatusBit.forcesCut) !== 0,
  };
}

function readInstrument(view: DataView, at: number): InstrumentState {
  const real = (offset: number): number => view.getFloat32(at + offset, true);
  const vector = (offset: number): Vector => [real(offset), real(offset + 4), real(offset + 8)];
  const flags = view.getUint32(at + INSTRUMENT.flags, true);
  return {
    tip: vector(INSTRUMENT.tipM),
    direction: vector(INSTRUMENT.direction),
    roll: real(INSTRUMENT.rollRad),
    jaw: real(INSTRUMENT.jaw),
    force: vector(INSTRUMENT.forceN),
    handleForce: vector(INSTRUMENT.handleForceN),
    present: (flags & Touch.present) !== 0,
    touching: (flags & Touch.touching) !== 0,
    holding: (flags & Touch.holding) !== 0,
    depth: real(INSTRUMENT.depthM),
  };
}
