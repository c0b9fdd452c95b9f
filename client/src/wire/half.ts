/** IEEE 754 half precision, read by table: not every browser has Float16Array yet. */

const TABLE = makeTable();

/**
 * Read halves into singles, multiplied by a factor.
 *
 * @param bits the numbers' bits.
 * @param factor what each is multiplied by, say a unit.
 */
export function fromHalf(bits: Uint16Array, factor: number): Float32Array {
  const values = new Float32Array(bits.length);
  for (let i = 0; i < bits.length; i++) values[i] = (TABLE[bits[i] as number] as number) * factor;
  return values;
}

function makeTable(): Float32Array {
  const table = new Float32Array(0x10000);
  for (let bits = 0; bits < table.length; bits++) table[bits] = value(bits);
  return table;
}

function value(bits: number): number {
  const sign = bits & 0x8000 ? -1 : 1;
  const exponent = (bits >> 10) & 0x1f;
  const fraction = bits & 0x3ff;
  if (exponent === 0x1f) return fraction ? NaN : sign * Infinity;
  if (exponent === 0) return sign * fraction * 2 ** -24;
  return sign * (1 + fraction / 1024) * 2 ** (exponent - 15);
}
