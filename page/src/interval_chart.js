// Where Poisson's ratio lies, on the axis of all values that it may have.

import { svg } from "./elements.js";
import { intervalText, numberText } from "./numbers.js";

const width = 560;
const left = 24;
const right = width - 24;
const axis = 42;

/** Draws the interval of 95 % and the value of nu between `lower` and 1/2, beyond which no material is. */
export function intervalChart(value, interval) {
  const lower = interval[0] < 0 ? -1 : 0;
  const x = (nu) => left + ((nu - lower) / (0.5 - lower)) * (right - left);
  const ticks = lower < 0 ? [-1, -0.5, 0, 0.5] : [0, 0.1, 0.2, 0.3, 0.4, 0.5];
  const ends = [x(interval[0]), x(interval[1])];
  return svg(
    "svg",
    { viewBox: `0 0 ${width} 66`, role: "img", "aria-label": `nu is ${value}, ${intervalText(interval)}`, class: "chart" },
    svg("line", { x1: left, x2: right, y1: axis, y2: axis, class: "axis" }),
    ticks.map((nu) => [
      svg("line", { x1: x(nu), x2: x(nu), y1: axis - 4, y2: axis + 4, class: "axis" }),
      svg("text", { x: x(nu), y: axis + 20, class: "tick middle" }, numberText(nu, 2)),
    ]),
    svg("rect", { x: ends[0], y: axis - 6, width: Math.max(ends[1] - ends[0], 2), height: 12, class: "interval" }),
    svg("circle", { cx: x(value), cy: axis, r: 4, class: "point" }),
    svg(
      "text",
      { x: Math.min(Math.max(x(value), 140), width - 140), y: 18, class: "tick middle" },
      `95 %: ${intervalText(interval)}`,
    ),
  );
}
