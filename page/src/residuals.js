// What the fit leaves of the measurement, of all load cases that the page carries.

import { html, section } from "./elements.js";
import { histogram } from "./histogram.js";
import { numberText, percentOf } from "./numbers.js";
import { positionChart } from "./position_chart.js";

const axes = ["x", "y", "z"];

// All components of all points that were measured, each with its place.
function componentsOf({ cases, dimension }) {
  return cases.flatMap(({ points }) => {
    if (!points) {
      return [];
    }
    const { positions, residual, isLeftOut } = points;
    const list = [];
    for (let i = 0; i < isLeftOut.length; ++i) {
      for (let axis = 0; axis < dimension; ++axis) {
        const value = residual[3 * i + axis];
        if (Number.isFinite(value) && !isLeftOut[i]) {
          list.push({ place: positions.slice(3 * i, 3 * i + 3), value });
        }
      }
    }
    return list;
  });
}

function positionCharts(components, dimension) {
  const box = html("div");
  // A print has no choice.
  const where = html("span", { class: "print" });
  const draw = (axis) => {
    where.textContent = axes[axis];
    box.replaceChildren(positionChart(components.map(({ place, value }) => ({ at: place[axis], value })), axes[axis]));
  };
  draw(0);
  const choice = html(
    "select",
    { onchange: (event) => draw(Number(event.target.value)) },
    axes.slice(0, dimension).map((name, axis) => html("option", { value: axis }, name)),
  );
  return [html("label", { class: "tabs" }, "against ", choice, where), box];
}

function numbersOf({ report }) {
  const { noise_sd: noise, residual, diagnostics } = report;
  return [
    noise === null ? null : `noise of ${numberText(noise, 3)} (standard deviation of a component)`,
    residual.displacement_relative === null ? null : `residual of ${percentOf(residual.displacement_relative, "the measured displacement")}`,
    residual.force_relative === null ? null : `forces of the measured displacement that differ from the loads by ${percentOf(residual.force_relative, "the load")}`,
    diagnostics.residual_correlation === null ? null : `correlation between neighbours of ${numberText(diagnostics.residual_correlation, 2)}`,
    diagnostics.outliers.length === 0 ? null : `${diagnostics.outliers.length} of the points left out as outliers`,
  ].filter(Boolean);
}

/** Returns the section on residuals, or null where there are neither residuals nor numbers on them. */
export function residualSection(data, specimen) {
  const numbers = numbersOf(data);
  const components = componentsOf(specimen);
  if (components.length === 0) {
    return section("What the fit leaves", numbers.length === 0 ? null : html("p", {}, `${numbers.join("; ")}.`));
  }
  const total = specimen.cases.reduce((sum, { points }) => sum + (points?.total ?? 0), 0);
  const shown = specimen.cases.reduce((sum, { points }) => sum + (points?.isLeftOut.length ?? 0), 0);
  const part = shown < total ? ` The charts show ${shown} of ${total} points.` : "";
  return section(
    "What the fit leaves",
    html("p", {}, `${numbers.join("; ")}.${part}`),
    html(
      "div",
      { class: "columns" },
      html(
        "div",
        {},
        html("h3", {}, "How large"),
        histogram(components.map(({ value }) => value), data.report.noise_sd),
        html("p", { class: "note" }, "Bars: residuals. Line: what noise alone would leave. Bars far above the line at the ends are outliers or a wrong model; the last bars hold all values beyond."),
      ),
      html(
        "div",
        {},
        html("h3", {}, "Where"),
        positionCharts(components, specimen.dimension),
        html("p", { class: "note" }, "Dots: residuals. Line: their mean with two standard errors. It stays at zero if the model is right."),
      ),
    ),
  );
}
