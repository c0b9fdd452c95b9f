// Written by `python -m trocar.web.typescript`; do not edit.

/** The client has taken the frame of this sequence number, and with it all before. */
export interface Acknowledgement {
  readonly type: "ack";
  readonly sequence: number;
}

/** The endoscope: it enters at a port and looks at a point. */
export interface Camera {
  readonly port_m: readonly [number, number, number];
  readonly target_m: readonly [number, number, number];
}

/** What to do now, in the attempt that is under way. */
export interface Guiding {
  readonly words: string;
  readonly marks: readonly TaskMark[];
  /** force asked of the left and the right hand, at least */
  readonly least_n: readonly [number, number];
  /** at most; 0 where none is asked for */
  readonly most_n: readonly [number, number];
  readonly type: "guiding";
  /** number of its record */
  readonly attempt: number;
  /** a finished one has its score card under /api/attempts/ */
  readonly state: "running" | "marking" | "finished" | "interrupted";
  /** number of the step that is on, from 0; as many as there are when all is done */
  readonly step: number;
  /** what would bring it nearer */
  readonly hint: string;
  readonly mistakes: number;
  /** the last one */
  readonly mistake: string;
  /** since the attempt began */
  readonly time_s: number;
  /** of the time allowed */
  readonly left_s: number;
  /** why it is over, or why the newest ticks are not kept yet */
  readonly reason: string;
}

/** What the server says first: the tissue, its grid and the instruments. */
export interface Hello {
  readonly type: "hello";
  readonly protocol: 1;
  readonly tissue: TissueSize;
  /** nodes along x and y, from edge to edge inclusive */
  readonly grid: readonly [number, number];
  readonly instruments: readonly InstrumentShape[];
  readonly camera: Camera;
  /** up to this force the tissue's answer is trusted as linear */
  readonly linear_force_n: number;
  /** requested ticks of the servo in a second */
  readonly rate_hz: number;
  /** of a tissue that is no block */
  readonly shape: OrganShape | null;
  /** free depth below a film, down to the tray it is clipped over */
  readonly under_m: number;
  /** whether there are tasks to do, under /api/tasks */
  readonly lessons: boolean;
  /** whose hands move the instruments: the page's, or a device of the trainer's own */
  readonly steered_by: "page" | "trainer";
}

/** A straight shaft through a port; the tip lies `length_m` from the handle, through the port. */
export interface InstrumentShape {
  readonly name: "left" | "right";
  /** the fixed point the shaft turns about */
  readonly port_m: readonly [number, number, number];
  /** from handle to tip */
  readonly length_m: number;
  readonly shaft_radius_m: number;
  readonly tip: "probe" | "grasper" | "needle-holder" | "hook" | "scissors";
  /** where the handle is at the start */
  readonly handle_m: readonly [number, number, number];
}

/** A layer of the tissue. */
export interface LayerSize {
  readonly name: string;
  readonly thickness_m: number;
}

/** A sentence for the user's eyes. */
export interface Notice {
  readonly type: "notice";
  readonly level: "info" | "warning" | "stopped";
  readonly text: string;
}

/** An organ that is no block: the grid's nodes lie on its surface, and its other faces stay as they are. */
export interface OrganShape {
  /** heights of the grid's nodes at rest, x fastest; null where nothing is drawn */
  readonly rest_m: readonly (number | null)[];
  /** nodes that are drawn from their places beside the organ to its outline */
  readonly rim: readonly number[];
  /** x and y of those */
  readonly rim_m: readonly (readonly [number, number])[];
  /** of the other faces */
  readonly corners_m: readonly (readonly [number, number, number])[];
  /** of the organ at those corners, of length one */
  readonly normals: readonly (readonly [number, number, number])[];
  /** triangles of those corners */
  readonly faces: readonly (readonly [number, number, number])[];
}

/** The tissue shall go back to rest. */
export interface Reset {
  readonly type: "reset";
}

/** Something to be drawn on the tissue while a step is on. */
export interface TaskMark {
  readonly place_m: readonly [number, number];
  readonly radius_m: number;
  readonly hand: "left" | "right";
}

/** The block: it covers 0 <= x <= size_m[0] and 0 <= y <= size_m[1], its rest surface is z = 0. */
export interface TissueSize {
  readonly name: string;
  readonly size_m: readonly [number, number];
  /** top first */
  readonly layers: readonly LayerSize[];
}

export type ServerMessage = Hello | Guiding | Notice;

export type ClientMessage = Acknowledgement | Reset;

export const PROTOCOL = 1;
export const UNACKNOWLEDGED = 2;
export const MESSAGE_RATE_HZ = 400;
export const IDLE_S = 10;
export const REACH_M = 1;
export const FRAME_MAGIC = 0x314f5254;
export const POSE_MAGIC = 0x45534f50;
export const LINKS = 3;

/** Codes with which the server closes the stream. */
export const Closing = {
  stopped: 1001,
  malformed: 4000,
  outOfRange: 4001,
  tooManyMessages: 4002,
  idle: 4003,
  slow: 4004,
  full: 4005,
} as const;

/** Bits of a frame's status. */
export const Status = {
  alive: 1,
  degraded: 2,
  beyondLinear: 4,
  forcesCut: 8,
} as const;

/** Bits of an instrument's flags. */
export const Touch = {
  present: 1,
  touching: 2,
  holding: 4,
} as const;

/** Bits of a pose's flags. */
export const Held = {
  present: 1,
  tracked: 2,
} as const;

/** Byte offsets in a frame's header, little-endian; `bytes` is its length. */
export const HEADER = {
  magic: 0,
  sequence: 4,
  tick: 8,
  timeS: 16,
  poseSequence: 24,
  rateHz: 32,
  missedTicks: 36,
  tickP50Us: 40,
  tickP99Us: 44,
  status: 48,
  layers: 52,
  nx: 54,
  ny: 56,
  inPlane: 58,
  cut: 60,
  bytes: 64,
} as const;

/** Byte offsets in an instrument's record in a frame, little-endian; `bytes` is its length. */
export const INSTRUMENT = {
  tipM: 0,
  direction: 12,
  rollRad: 24,
  jaw: 28,
  forceN: 32,
  handleForceN: 44,
  flags: 56,
  depthM: 60,
  bytes: 64,
} as const;

/** Byte offsets in a pose, little-endian; `bytes` is its length. */
export const POSE = {
  magic: 0,
  sequence: 4,
  instrument: 8,
  flags: 12,
  handleM: 16,
  rollRad: 40,
  jaw: 44,
  bytes: 48,
} as const;
