// Residuals against position, with the mean of each stretch: noise scatters about zero, and a wrong model bends.

import { chart, rangeOf } from "./chart.js";
import { svg } from "./elements.js";

const numStretches = 12;

// Returns the mean of each stretch that has enough points, with its standard error.
function meansOf(points, [from, to]) {
  const stretches = Array.from({ length: numStretches }, () => []);
  for (const { at, value } of points) {
    stretches[Math.min(Math.floor((numStretches * (at - from)) / (to - from || 1)), numStretches - 1)].push(value);
  }
  return stretches.flatMap((values, i) => {
    if (values.length < 4) {
      return [];
    }
    const mean = values.reduce((sum, value) => sum + value, 0) / values.length;
    const square = values.reduce((sum, value) => sum + (value - mean) ** 2, 0) / (values.length - 1);
    return [{ at: from + ((i + 0.5) * (to - from)) / numStretches, mean, error: Math.sqrt(square / values.length) }];
  });
}

/** Draws `points`, a list of {at, value}, against the axis of this name. */
export function positionChart(points, axis) {
  const range = rangeOf(points.map(({ at }) => at), 0);
  const largest = Math.max(...points.map(({ value }) => Math.abs(value)));
  const frame = chart({
    x: range,
    y: [-1.05 * largest, 1.05 * largest],
    xTitle: `${axis} [length]`,
    yTitle: "residual [length]",
    label: `Residuals against ${axis}`,
  });
  frame.add(
    svg("line", { x1: frame.x(range[0]), x2: frame.x(range[1]), y1: frame.y(0), y2: frame.y(0), class: "axis" }),
    points.map(({ at, value }) => svg("circle", { cx: frame.x(at).toFixed(1), cy: frame.y(value).toFixed(1), r: 1.6, class: "dot" })),
  );
  const means = meansOf(points, range);
  frame.add(
    means.map(({ at, mean, error }) =>
      svg("line", { x1: frame.x(at), x2: frame.x(at), y1: frame.y(mean - 2 * error), y2: frame.y(mean + 2 * error), class: "whisker" }),
    ),
    svg("polyline", { points: means.map(({ at, mean }) => `${frame.x(at)},${frame.y(mean)}`).join(" "), class: "curve" }),
  );
  return frame.element;
}
