/** How a measured number is written: four digits that count, large and tiny ones in scientific form. */

const DIGITS = 4;
const LARGE = 1e5;
const TINY = 1e-3;
const RAISED: Readonly<Record<string, string>> = { "-": "⁻", ...Object.fromEntries([..."⁰¹²³⁴⁵⁶⁷⁸⁹"].map((each, digit) => [digit, each])) };

export function shown(value: number): string {
  const size = Math.abs(value);
  if (size === 0 || (size >= TINY && size < LARGE)) return String(Number(value.toPrecision(DIGITS)));
  const [digits, power] = value.toExponential(DIGITS - 1).split("e") as [string, string];
  return `${Number(digits)} × 10${[...String(Number(power))].map((each) => RAISED[each]).join("")}`;
}
