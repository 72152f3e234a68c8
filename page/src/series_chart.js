// A parameter of each frame of a series with its error, beside what all frames together say.

import { chart, rangeOf } from "./chart.js";
import { svg } from "./elements.js";

/**
 * Draws the parameter with this title of a column; `rows` are those of the table of frames, the last one for all frames.
 * Frames stand over their load where it differs, else over their number.
 */
export function seriesChart(rows, column, label) {
  const joint = rows[rows.length - 1];
  const frames = rows.slice(0, -1);
  const loads = new Set(frames.map(({ load }) => load).filter((load) => load !== ""));
  const isOverLoad = loads.size > 1;
  const at = (frame) => Number(isOverLoad ? frame.load : frame.frame);
  const used = frames
    .filter((frame) => frame[column] !== "" && (!isOverLoad || frame.load !== ""))
    .map((frame) => ({
      at: at(frame),
      value: Number(frame[column]),
      error: Number(frame[`${column}_standard_error`] || NaN),
      isUsable: frame.status === "ok",
    }));
  if (used.length === 0) {
    return null;
  }
  const mean = joint[column] === "" ? NaN : Number(joint[column]);
  const meanError = Number(joint[`${column}_standard_error`] || NaN);
  const errorsOf = used.map(({ error }) => error).filter(Number.isFinite).sort((a, b) => a - b);
  // The frames of the smallest loads know least; their bars may leave the frame of the chart.
  const usual = errorsOf[Math.floor(errorsOf.length / 2)] ?? 0;
  const ends = used.flatMap(({ value, error }) => [value, value - Math.min(error, 4 * usual), value + Math.min(error, 4 * usual)]);
  const yRange = rangeOf([...ends, mean - meanError, mean + meanError]);
  const frame = chart({
    x: rangeOf(used.map((point) => point.at)),
    y: yRange,
    xTitle: isOverLoad ? "load, as a multiple of that of the scene" : "frame",
    yTitle: label,
    label: `${label} of each frame`,
  });
  const inside = (value) => frame.y(Math.min(Math.max(value, yRange[0]), yRange[1]));
  const xEnds = rangeOf(used.map((point) => point.at)).map(frame.x);
  if (Number.isFinite(mean)) {
    const half = Number.isFinite(meanError) ? meanError : 0;
    frame.add(
      svg("rect", { x: xEnds[0], width: xEnds[1] - xEnds[0], y: inside(mean + half), height: inside(mean - half) - inside(mean + half), class: "band" }),
      svg("line", { x1: xEnds[0], x2: xEnds[1], y1: inside(mean), y2: inside(mean), class: "curve" }),
    );
  }
  frame.add(
    used.map((point) => [
      Number.isFinite(point.error) &&
        svg("line", { x1: frame.x(point.at), x2: frame.x(point.at), y1: inside(point.value - point.error), y2: inside(point.value + point.error), class: "whisker" }),
      point.isUsable
        ? svg("circle", { cx: frame.x(point.at), cy: frame.y(point.value), r: 3.5, class: "point" })
        : svg("path", { d: `M${frame.x(point.at) - 4} ${frame.y(point.value) - 4}l8 8m0 -8l-8 8`, class: "cross" }),
    ]),
  );
  return frame.element;
}
