import { describe, expect, it } from "vitest";

import { shown } from "../../src/lesson/value";

describe("a measured number", () => {
  it.each([
    [0, "0"],
    [24.3, "24.3"],
    [0.07001, "0.07001"],
    [-11.23456, "-11.23"],
    [13827, "13830"],
    [13827123, "1.383 × 10⁷"],
    [99999.9, "100000"],
    [0.00012346, "1.235 × 10⁻⁴"],
    [-2e12, "-2 × 10¹²"],
  ])("%j is written %s", (value, words) => {
    expect(shown(value)).toBe(words);
  });
});
