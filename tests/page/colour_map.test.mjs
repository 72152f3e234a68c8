// Colours can be told apart by their lightness alone.

import assert from "node:assert";
import test from "node:test";
import { bandsOf, colourOf, colourOfBand, numBands } from "../../page/src/colour_map.js";

// The lightness L* of CIE 1976 of a colour of sRGB.
function lightness(colour) {
  const [red, green, blue] = colour.map((value) => value / 255).map((c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4));
  const luminance = 0.2126 * red + 0.7152 * green + 0.0722 * blue;
  return luminance > (6 / 29) ** 3 ? 116 * Math.cbrt(luminance) - 16 : (luminance * (29 / 3) ** 3);
}

test("the map is monotone in lightness", () => {
  for (let i = 0; i < 100; ++i) {
    assert.ok(lightness(colourOf(i / 100)) > lightness(colourOf((i + 1) / 100)), `at ${i} %`);
  }
});

test("bands next to each other differ by five steps of lightness at least", () => {
  for (const count of [2, 3, numBands + 2, 12]) {
    for (let band = 1; band < count; ++band) {
      assert.ok(lightness(colourOfBand(band - 1, count)) - lightness(colourOfBand(band, count)) > 5, `${band} of ${count}`);
    }
  }
});

test("bands hold all values, and those that are not known count for nothing", () => {
  assert.deepStrictEqual(bandsOf([NaN, 1, 4]), { lower: 0, upper: 4, count: 8 });
  assert.deepStrictEqual(bandsOf([3, 4]), { lower: 3, upper: 4, count: 10 });
  assert.strictEqual(bandsOf([NaN]), null);
  const { lower, upper } = bandsOf([7, 7]);
  assert.ok(lower <= 7 && upper > 7);
});
