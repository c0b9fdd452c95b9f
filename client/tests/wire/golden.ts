/** Bytes as the trainer's own encoder made them, and what they mean stands in the tests. */

export const FRAME =
  "54524f310900000007000000020000000000000000002940290000002a00000000e07944030000000000c44100007442" +
  "050000000100020002000100000000000ad7233c0ad7a33ca69b44bb000000009a99193fcdcc4cbf0000803e0000003f" +
  "000000000000003e0000003f00000000000080bd0000803e01000000a69b443b0ad7a33c0ad7a33ca69b44bb00000000" +
  "9a99193fcdcc4cbf0000003f0000003f000000000000003e0000803f00000000000080bd0000803e07000000a69b443b" +
  "000000be003400c6003c00000000000000000000000000bc";

export const POSE =
  "504f5345020100000100000001000000000000000000c03f000000000000d0bf000000000000e03f0000c0bf0000403f";

export function bytes(hex: string): ArrayBuffer {
  return Uint8Array.from(hex.match(/../g) ?? [], (pair) => parseInt(pair, 16)).buffer;
}

export function hex(buffer: ArrayBuffer): string {
  return Array.from(new Uint8Array(buffer), (byte) => byte.toString(16).padStart(2, "0")).join("");
}

/** The golden frame under another sequence number. */
export function frame(sequence: number): ArrayBuffer {
  const buffer = bytes(FRAME);
  new DataView(buffer).setUint32(4, sequence, true);
  return buffer;
}
