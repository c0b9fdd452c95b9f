/** The WebSocket to the trainer: connects, says what came, connects again after a while when it was lost. */

import type { HandlePose } from "../instrument/pose";
import { type Guiding, type Hello, type Notice, readServerMessage, WireError } from "./messages";
import { Newest } from "./newest";
import { writePose } from "./pose";
import { Sending } from "./sending";

const FIRST_WAIT = 500; // [ms]
const LONGEST_WAIT = 8000; // [ms]
const MOST_WAITING = 1 << 16; // bytes not sent yet, beyond which poses are left out
const STOPPED = 1001; // the trainer's farewell when it goes; every other one has a reason that a user can act on

export type Connection = "connecting" | "open" | "lost" | "refused";

export interface Listener {
  hello(hello: Hello): void;
  guiding(guiding: Guiding): void;
  /** What is on at the trainer has been said: it comes before the first frame of a connection. */
  settled(): void;
  notice(notice: Notice): void;
  /** Told once for each change; tries to come again change nothing. @param reason why the trainer ended it, if it said. */
  connection(state: Connection, reason: string): void;
}

export class Link {
  readonly frames = new Newest((sequence) => this.text({ type: "ack", sequence }));
  private readonly sending = [new Sending(), new Sending()] as const;
  private socket: WebSocket | null = null;
  private wait = FIRST_WAIT;
  private greeted = false;
  private isSettled = false;
  private told: readonly [Connection, string] | null = null;

  /** @param open makes a socket; a test gives its own. */
  constructor(
    private readonly listener: Listener,
    private readonly open: () => WebSocket,
  ) {}

  connect(): void {
    if (this.told?.[0] !== "lost") this.tell("connecting", "");
    const socket = this.open();
    socket.binaryType = "arraybuffer";
    this.socket = socket;
    this.greeted = this.isSettled = false;
    this.frames.clear();
    for (const sending of this.sending) sending.clear();
    socket.onmessage = (event: MessageEvent<string | ArrayBuffer>) => this.take(socket, event.data);
    socket.onclose = (event: CloseEvent) => this.lost(socket, event.code === STOPPED ? "" : event.reason);
  }

  /** Send a pose if it is time to. @param tracked whether a headset's controller is the handle. */
  pose(instrument: 0 | 1, pose: HandlePose, now: number, tracked = false): void {
    const socket = this.socket;
    if (!this.greeted || !socket || socket.bufferedAmount > MOST_WAITING) return;
    const sequence = this.sending[instrument].due(pose, now);
    if (sequence !== null) socket.send(writePose(instrument, sequence, pose, tracked));
  }

  /** Put the tissue back to rest. */
  reset(): void {
    this.text({ type: "reset" });
  }

  private text(message: object): void {
    if (this.greeted) this.socket?.send(JSON.stringify(message));
  }

  private take(socket: WebSocket, data: string | ArrayBuffer): void {
    if (socket !== this.socket) return;
    try {
      if (typeof data !== "string") {
        this.frames.put(data);
        if (!this.isSettled) this.listener.settled();
        this.isSettled = true;
        return;
      }
      const message = readServerMessage(data);
      if (message.type === "notice") {
        this.listener.notice(message);
        return;
      }
      if (message.type === "guiding") {
        this.listener.guiding(message);
        return;
      }
      this.greeted = true;
      this.wait = FIRST_WAIT;
      this.listener.hello(message);
      this.tell("open", "");
    } catch (error) {
      if (!(error instanceof WireError)) throw error;
      this.refuse(error.message);
    }
  }

  /** Give up: what came cannot be understood, and coming again would not help. */
  refuse(sentence: string): void {
    const socket = this.socket;
    this.socket = null;
    this.greeted = false;
    socket?.close();
    this.tell("refused", sentence);
  }

  private lost(socket: WebSocket, reason: string): void {
    if (socket !== this.socket) return;
    this.socket = null;
    this.greeted = false;
    this.tell("lost", reason);
    setTimeout(() => this.connect(), this.wait);
    this.wait = Math.min(2 * this.wait, LONGEST_WAIT);
  }

  private tell(state: Connection, reason: string): void {
    if (this.told?.[0] === state && this.told[1] === reason) return;
    this.told = [state, reason];
    this.listener.connection(state, reason);
  }
}
