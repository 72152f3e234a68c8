// A frame with axes, in which the charts of the page are drawn.

import { svg } from "./elements.js";
import { numberText, ticks } from "./numbers.js";

const margin = { left: 100, right: 16, top: 14, bottom: 50 };

const sizeOf = (range) => range[1] - range[0] || 1;

// Writes the labels of ticks with as many digits as tell them apart.
function tickLabel(value, values) {
  const largest = Math.max(...values.map(Math.abs));
  return Math.abs(value) < 1e-9 * largest ? "0" : numberText(value, 4);
}

/**
 * Makes the frame of a chart with the ranges [least, largest] of its axes.  Returns its element, `add` for what is
 * drawn in it, and `x` and `y`, which place a value.
 */
export function chart({ width = 560, height = 260, x: xRange, y: yRange, xTitle, yTitle, label, xLabels = true }) {
  const right = width - margin.right;
  const bottom = height - margin.bottom;
  const x = (value) => margin.left + ((value - xRange[0]) / sizeOf(xRange)) * (right - margin.left);
  const y = (value) => bottom - ((value - yRange[0]) / sizeOf(yRange)) * (bottom - margin.top);
  const xTicks = ticks(...xRange, 5);
  const yTicks = ticks(...yRange, 4);
  const element = svg(
    "svg",
    { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": label, class: "chart" },
    yTicks.map((value) => [
      svg("line", { x1: margin.left, x2: right, y1: y(value), y2: y(value), class: "grid" }),
      svg("text", { x: margin.left - 6, y: y(value) + 4, class: "tick end" }, tickLabel(value, yTicks)),
    ]),
    xLabels &&
      xTicks.map((value) => [
        svg("line", { x1: x(value), x2: x(value), y1: bottom, y2: bottom + 4, class: "axis" }),
        svg("text", { x: x(value), y: bottom + 20, class: "tick middle" }, tickLabel(value, xTicks)),
      ]),
    svg("line", { x1: margin.left, x2: right, y1: bottom, y2: bottom, class: "axis" }),
    svg("text", { x: (margin.left + right) / 2, y: height - 6, class: "title middle" }, xTitle),
    svg("text", { transform: `translate(16 ${(margin.top + bottom) / 2}) rotate(-90)`, class: "title middle" }, yTitle),
  );
  return { element, x, y, add: (...children) => element.append(...children.flat(Infinity).filter(Boolean)) };
}

/** Returns a range around values, with a part of its size beyond either end. */
export function rangeOf(values, beyond = 0.05) {
  const finite = values.filter(Number.isFinite);
  if (finite.length === 0) {
    return [0, 1];
  }
  const least = Math.min(...finite);
  const largest = Math.max(...finite);
  const size = largest - least || Math.abs(least) || 1;
  return [least - beyond * size, largest + beyond * size];
}
