// What the colours on the specimen mean, with the value of each line between two bands.

import { colourOfBand, css } from "./colour_map.js";
import { html, svg } from "./elements.js";
import { numberText } from "./numbers.js";

const width = 560;
const left = 30;
const right = width - 30;

/** Explains bands of values between `lower` and `upper`. */
export function bandLegend({ lower, upper, count }) {
  const x = (i) => left + (i / count) * (right - left);
  const valueAt = (i) => lower + (i / count) * (upper - lower);
  return svg(
    "svg",
    { viewBox: `0 0 ${width} 40`, role: "img", "aria-label": `from ${lower} to ${upper}`, class: "chart" },
    Array.from({ length: count }, (_, band) =>
      svg("rect", { x: x(band), y: 2, width: x(band + 1) - x(band), height: 14, fill: css(colourOfBand(band, count)), class: "patch" }),
    ),
    Array.from({ length: count + 1 }, (_, i) => i)
      .filter((i) => count < 6 || i % 2 === 0)
      .map((i) => svg("text", { x: x(i), y: 32, class: "tick middle" }, Math.abs(valueAt(i)) < 1e-9 * Math.abs(upper) ? "0" : numberText(valueAt(i), 3))),
  );
}

/** Explains the colour of each of some categories. */
export function categoryLegend(labels, colours) {
  return html(
    "ul",
    { class: "categories" },
    labels.map((label, i) =>
      html("li", {}, svg("svg", { viewBox: "0 0 14 14", class: "swatch" }, svg("rect", { width: 14, height: 14, fill: css(colours[i]), class: "patch" })), label),
    ),
  );
}
