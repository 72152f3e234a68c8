// The parts of an error as bars that carry their names and numbers.

import { svg } from "./elements.js";
import { percent, twoDigits } from "./numbers.js";

const rowHeight = 24;
const width = 560;
const barStart = 150;
const barWidth = 260;

/** Draws the parts of partsOfError.  The longest bar is the largest part. */
export function budgetChart(parts, isRelative, label) {
  const largest = parts[0].size;
  const rows = parts.map(({ words, size }, i) => {
    const y = i * rowHeight;
    const length = Math.max((barWidth * size) / largest, 1);
    return [
      svg("text", { x: barStart - 8, y: y + 17, class: "tick end" }, words),
      svg("rect", { x: barStart, y: y + 5, width: length, height: rowHeight - 8, class: "bar" }),
      svg("text", { x: barStart + length + 6, y: y + 17, class: "tick" }, isRelative ? percent(size) : twoDigits(size)),
    ];
  });
  return svg(
    "svg",
    { viewBox: `0 0 ${width} ${parts.length * rowHeight + 4}`, role: "img", "aria-label": label, class: "chart" },
    rows,
  );
}
