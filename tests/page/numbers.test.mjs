// The page shows the same digits as the command line.  The expected texts are those of tests/core/text/numbers_test.cc,
// and of printf.

import assert from "node:assert";
import test from "node:test";
import { intervalText, numberText, percent, ticks, valueWithError } from "../../page/src/numbers.js";

test("numbers have the asked digits, and an exponent only where they are small or large", () => {
  assert.strictEqual(numberText(0.3), "0.3");
  assert.strictEqual(numberText(13200, 3), "13200");
  assert.strictEqual(numberText(13249, 3), "13200");
  assert.strictEqual(numberText(2e-9), "2e-09");
  assert.strictEqual(numberText(1e-4, 2), "0.0001");
  assert.strictEqual(numberText(1.5e7, 2), "1.5e+07");
  assert.strictEqual(numberText(-0.0449, 2), "-0.045");
  assert.strictEqual(numberText(0), "0");
});

test("values end at the second digit of their error", () => {
  assert.strictEqual(valueWithError(49890.4, 123), "49890 ± 120");
  assert.strictEqual(valueWithError(0.34812, 0.0121), "0.348 ± 0.012");
  assert.strictEqual(valueWithError(0.10053, 0.0009), "0.10053 ± 0.00090");
  assert.strictEqual(valueWithError(1.23456e9, 1.2e7), "1.2346e+09 ± 1.2e+07");
  assert.strictEqual(valueWithError(5, 0.0996), "5.00 ± 0.10");
});

test("percentages that say nothing are words", () => {
  assert.strictEqual(percent(0.0523), "5.2 %");
  assert.strictEqual(percent(20), "more than ten times its value");
});

test("the ends of an interval differ in their text", () => {
  assert.strictEqual(intervalText([0.2974066, 0.3018286]), "0.29741 to 0.30183");
  assert.strictEqual(intervalText([49978.426, 50092.196]), "49978 to 50092");
});

test("ticks are round and lie within their ends", () => {
  assert.deepStrictEqual(ticks(0, 10, 5), [0, 2, 4, 6, 8, 10]);
  for (const [lower, upper] of [[-3.7, 12.1], [1e-7, 4e-6], [0.2999, 0.3001]]) {
    const values = ticks(lower, upper, 5);
    assert.ok(values.length >= 2 && values.length <= 7, String(values));
    assert.ok(values.every((value) => value >= lower - 1e-9 && value <= upper + 1e-9 * upper));
  }
});
