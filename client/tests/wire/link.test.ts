import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import { type Connection, Link } from "../../src/wire/link";
import { type Guiding, type Hello, type Notice, readServerMessage, WireError } from "../../src/wire/messages";
import { hands, hello } from "../sample";
import { frame } from "./golden";

class FakeSocket {
  static made: FakeSocket[] = [];
  binaryType = "";
  bufferedAmount = 0;
  sent: (string | ArrayBuffer)[] = [];
  onmessage: (event: { data: unknown }) => void = () => undefined;
  onclose: (event: { code: number; reason: string }) => void = () => undefined;
  constructor() {
    FakeSocket.made.push(this);
  }
  send(message: string | ArrayBuffer): void {
    this.sent.push(message);
  }
  close(): void {
    this.onclose({ code: 1005, reason: "" });
  }
}

const told: { hellos: Hello[]; guided: Guiding[]; notices: Notice[]; states: [Connection, string][]; settled: number } = {
  hellos: [],
  guided: [],
  notices: [],
  states: [],
  settled: 0,
};
const POSE = hands()[0].pose;

function connected(): [Link, FakeSocket] {
  const link = new Link(
    {
      hello: (message) => told.hellos.push(message),
      guiding: (message) => told.guided.push(message),
      settled: () => (told.settled += 1),
      notice: (message) => told.notices.push(message),
      connection: (state, reason) => told.states.push([state, reason]),
    },
    () => new FakeSocket() as unknown as WebSocket,
  );
  link.connect();
  return [link, FakeSocket.made.at(-1) as FakeSocket];
}

beforeEach(() => {
  vi.useFakeTimers();
  FakeSocket.made = [];
  told.hellos = [];
  told.notices = [];
  told.states = [];
  told.settled = 0;
});
afterEach(() => vi.useRealTimers());

describe("the link", () => {
  it("says nothing before it is greeted", () => {
    const [link, socket] = connected();
    link.pose(0, POSE, 0);
    link.reset();
    expect(socket.sent).toEqual([]);
    socket.onmessage({ data: JSON.stringify(hello()) });
    expect(told.hellos).toHaveLength(1);
    link.pose(0, POSE, 1);
    link.reset();
    expect(socket.sent).toHaveLength(2);
    expect(socket.sent[1]).toBe('{"type":"reset"}');
  });

  it("acknowledges a frame when it is taken", () => {
    const [link, socket] = connected();
    socket.onmessage({ data: JSON.stringify(hello()) });
    socket.onmessage({ data: frame(1) });
    expect(socket.sent).toEqual([]);
    link.frames.take();
    expect(socket.sent).toEqual(['{"type":"ack","sequence":1}']);
  });

  it("leaves poses out while earlier ones have not gone", () => {
    const [link, socket] = connected();
    socket.onmessage({ data: JSON.stringify(hello()) });
    socket.bufferedAmount = 1 << 20;
    link.pose(0, POSE, 0);
    expect(socket.sent).toEqual([]);
  });

  it("comes again after it was lost, waiting longer each time", () => {
    const [, socket] = connected();
    socket.onclose({ code: 1006, reason: "" });
    expect(told.states.at(-1)).toEqual(["lost", ""]);
    vi.advanceTimersByTime(499);
    expect(FakeSocket.made).toHaveLength(1);
    vi.advanceTimersByTime(1);
    expect(FakeSocket.made).toHaveLength(2);
    FakeSocket.made[1]?.onclose({ code: 1006, reason: "" });
    vi.advanceTimersByTime(999);
    expect(FakeSocket.made).toHaveLength(2);
    vi.advanceTimersByTime(1);
    expect(FakeSocket.made).toHaveLength(3);
  });

  it("says once that it was lost, however often it tries, and why if that was said", () => {
    const [, socket] = connected();
    socket.onmessage({ data: JSON.stringify(hello()) });
    socket.onclose({ code: 1001, reason: "the trainer stops" });
    for (const at of [1, 2, 3]) {
      vi.advanceTimersByTime(10_000);
      FakeSocket.made[at]?.onclose({ code: 1006, reason: "" });
    }
    expect(told.states).toEqual([["connecting", ""], ["open", ""], ["lost", ""]]);
    vi.advanceTimersByTime(10_000);
    FakeSocket.made.at(-1)?.onclose({ code: 4005, reason: "4 clients are connected" });
    expect(told.states.at(-1)).toEqual(["lost", "4 clients are connected"]);
    vi.advanceTimersByTime(10_000);
    FakeSocket.made.at(-1)?.onmessage({ data: JSON.stringify(hello()) });
    expect(told.states.at(-1)).toEqual(["open", ""]);
  });

  it("knows what is on with the first frame of each connection", () => {
    const [, socket] = connected();
    socket.onmessage({ data: JSON.stringify(hello()) });
    expect(told.settled).toBe(0);
    for (const sequence of [1, 2]) socket.onmessage({ data: frame(sequence) });
    expect(told.settled).toBe(1);
    socket.onclose({ code: 1006, reason: "" });
    vi.advanceTimersByTime(500);
    FakeSocket.made[1]?.onmessage({ data: JSON.stringify(hello()) });
    FakeSocket.made[1]?.onmessage({ data: frame(1) });
    expect(told.settled).toBe(2);
  });

  it("gives up on what it cannot understand", () => {
    const [, socket] = connected();
    socket.onmessage({ data: JSON.stringify({ ...hello(), protocol: 2 }) });
    expect(told.states.at(-1)?.[0]).toBe("refused");
    expect(told.states.at(-1)?.[1]).toContain("protocol 2");
    vi.advanceTimersByTime(60_000);
    expect(FakeSocket.made).toHaveLength(1);
  });
});

describe("a text message", () => {
  it("is a notice or a greeting", () => {
    const notice = { type: "notice", level: "warning", text: "Forces fall." };
    expect(readServerMessage(JSON.stringify(notice))).toEqual(notice);
    expect(readServerMessage(JSON.stringify(hello()))).toEqual(hello());
  });

  it.each([
    ["no JSON", "{"],
    ["an unknown type", '{"type": "gossip"}'],
    ["a notice of no level", '{"type": "notice", "text": "x"}'],
    ["a greeting without a camera", JSON.stringify({ ...hello(), camera: undefined })],
    ["a greeting with one instrument", JSON.stringify({ ...hello(), instruments: hello().instruments.slice(1) })],
    ["a greeting that nobody steers", JSON.stringify({ ...hello(), steered_by: "nobody" })],
    ["a greeting without layers", JSON.stringify({ ...hello(), tissue: { ...hello().tissue, layers: [] } })],
  ])("is refused: %s", (_, text) => {
    expect(() => readServerMessage(text)).toThrow(WireError);
  });
});
