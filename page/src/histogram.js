// How often residuals of each size occur, beside what noise would leave.

import { chart } from "./chart.js";
import { svg } from "./elements.js";
import { counted } from "./numbers.js";

const numBins = 31;
// Beyond so many standard deviations all values are counted in the outermost bars.
const widest = 4;

const normal = (t) => Math.exp((-t * t) / 2) / Math.sqrt(2 * Math.PI);

/** Draws all components of residuals; `sd` is the standard deviation of the noise, or null. */
export function histogram(values, sd) {
  const spread = sd ?? Math.sqrt(values.reduce((sum, value) => sum + value * value, 0) / values.length);
  if (!(spread > 0)) {
    return null;
  }
  const end = widest * spread;
  const step = (2 * end) / numBins;
  const counts = new Array(numBins).fill(0);
  for (const value of values) {
    counts[Math.min(Math.max(Math.floor((value + end) / step), 0), numBins - 1)] += 1;
  }
  const expected = (value) => (values.length * step * normal(value / spread)) / spread;
  const frame = chart({
    x: [-end, end],
    y: [0, 1.05 * Math.max(...counts, expected(0))],
    xTitle: "measured minus fitted displacement [length]",
    yTitle: "how often",
    label: `Histogram of ${counted(values.length, "residual")}`,
  });
  counts.forEach((count, i) => {
    const from = frame.x(-end + i * step);
    const to = frame.x(-end + (i + 1) * step);
    frame.add(
      svg("rect", { x: from, y: frame.y(count), width: to - from - 1, height: frame.y(0) - frame.y(count), class: "bar" }),
    );
  });
  const points = Array.from({ length: 81 }, (_, i) => -end + (i * 2 * end) / 80);
  frame.add(svg("polyline", { points: points.map((t) => `${frame.x(t)},${frame.y(expected(t))}`).join(" "), class: "curve" }));
  return frame.element;
}
