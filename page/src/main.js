// Draws the page from the data that it carries.

import { budgetChart } from "./budget_chart.js";
import { readCsv } from "./csv.js";
import { html, section, table } from "./elements.js";
import { findingsSection } from "./findings.js";
import { intervalChart } from "./interval_chart.js";
import { intervalText, percent, numberText, valueWithError } from "./numbers.js";
import { residualSection } from "./residuals.js";
import { isMean, partsOfError, threeSentences } from "./sentences.js";
import { seriesChart } from "./series_chart.js";
import { readSpecimen } from "./specimen.js";
import { howSection, loadsOf, materialsSection, mapSection } from "./tables.js";
import { Viewer } from "./viewer.js";
import { elementsText, longLabel, meanings, mendsOfCauses } from "./words.js";

const data = JSON.parse(document.getElementById("data").textContent);
// Labels are those of the command line, such as "E of region 3".
data.parameters = data.report.parameters.map((parameter, i) => ({ ...parameter, ...data.labels[i] }));
const { report, parameters } = data;
// What the data determine in place of E and nu comes first.
data.values = data.shear_modulus
  ? [{ name: "shear_modulus", label: "shear_modulus", is_relative: true, known: false, interval: null, ...data.shear_modulus }, ...parameters]
  : parameters;

function header() {
  const verdict = report.usable
    ? html("p", { class: "verdict" }, "✓ usable")
    : html("p", { class: "verdict refused" }, `✗ NOT USABLE: ${report.status.replaceAll("_", " ")}`);
  return html("header", {}, html("h1", {}, `Elasticity of ${data.title}`), verdict);
}

function meaning() {
  return html("section", { class: "meaning" }, html("h2", {}, "What it means"), threeSentences(data).map((text) => html("p", {}, text)));
}

function valueText({ value, standard_error: error, known }) {
  if (value === null) {
    return "none";
  }
  if (known) {
    return `${numberText(value)} (known)`;
  }
  return error === null ? `${numberText(value)} (no standard error)` : valueWithError(value, error);
}

function parameterTable() {
  const row = (parameter) => {
    const { name, label, interval, standard_error: error, value, is_relative: isRelative } = parameter;
    const explanation = meanings[name] && parameters.length <= 3 ? html("span", { class: "note" }, meanings[name]) : null;
    return [
      [longLabel(label), isMean(report) && name === "youngs_modulus" ? " (geometric mean over the specimen)" : "", explanation],
      valueText(parameter),
      interval === null ? "" : intervalText(interval),
      error !== null && isRelative && value ? percent(Math.abs(error / value)) : "",
    ];
  };
  return table(["parameter", "value", "95 % interval", "relative error"], data.values.map(row), [1, 2, 3]);
}

function budgetOf(place) {
  const parameter = parameters[place];
  const parts = partsOfError(report, place);
  if (parts.length === 0 || parameter.standard_error === null) {
    return null;
  }
  const mend = mendsOfCauses[parts[0].cause];
  return html(
    "div",
    {},
    html("h3", {}, `What the error of ${parameter.label} comes from`),
    budgetChart(parts, parameter.is_relative, `Parts of the error of ${parameter.label}`),
    html("p", { class: "note" }, mend ? `To reduce the largest part, ${mend}.` : null),
  );
}

function parameterSection() {
  const nu = parameters.filter(({ name }) => name === "poisson_ratio");
  const interval = nu.length === 1 && nu[0].interval !== null && nu[0].value !== null && intervalChart(nu[0].value, nu[0].interval);
  // Many parameters would make more bars than anybody reads, and more than a printed page has room for.
  const budgets = parameters.length <= 6 ? parameters.map((_, place) => budgetOf(place)).filter(Boolean) : [];
  return section(
    "Parameters",
    parameterTable(),
    html("div", { class: parameters.length > 3 ? "columns screen" : "columns" }, budgets, interval ? html("div", {}, html("h3", {}, "Where nu lies"), interval) : null),
  );
}

function labelOfRegion(region) {
  const own = parameters.filter((parameter) => [parameter.region].flat().includes(region));
  return [`region ${region}`, ...own.map((parameter) => `${parameter.label.split(" of ")[0]} = ${valueText(parameter)}`)].join(", ");
}

// Returns NaN where no parameter of the region tells.
function valueOfRegion(region) {
  const own = parameters.find((parameter) => [parameter.region].flat().includes(region));
  return own?.value ?? NaN;
}

function firstField(specimen) {
  if (!report.usable) {
    return "residual";
  }
  const moduli = specimen.fields.find(({ name }) => name === "youngs_modulus");
  return moduli && moduli.values.some((value) => value !== moduli.values[0]) ? "youngs_modulus" : "displacement";
}

function specimenSection(specimen, viewer) {
  const { mesh } = report;
  const planar = mesh.model === "3d" ? "" : `, ${mesh.model.replaceAll("_", " ")}, thickness ${numberText(mesh.thickness, 4)}`;
  const frame = data.frame === null ? "" : ` Frame ${data.frame}, the usable one of the largest load, is shown.`;
  const left = specimen.casesLeftOut > 0 ? ` ${specimen.casesLeftOut} further load cases are not drawn.` : "";
  return section(
    "The specimen",
    html("p", {}, `${mesh.nodes} nodes, ${elementsText(mesh)}${planar}.${frame}${left}`),
    viewer.element,
    loadsOf(report),
  );
}

function seriesSection() {
  if (!report.series) {
    return null;
  }
  const rows = readCsv(data.frames);
  const columns = Object.keys(rows[0]).filter((title) => `${title}_standard_error` in rows[0]);
  const { used, frames } = report.series;
  return section(
    "Frame by frame",
    html("p", {}, `${used} of ${frames} frames are used. Dots with bars: frames with their standard error. Crosses: frames that are not usable. Line and band: all frames together.`),
    html("div", { class: "columns" }, columns.slice(0, 4).map((column, i) => seriesChart(rows, column, longLabel(data.labels[i]?.label ?? column)))),
  );
}

function commandSection() {
  return section(
    "How this page was made",
    html("pre", {}, html("code", {}, data.command)),
    html("p", { class: "note" }, `elastimate ${report.elastimate}. Values are in the consistent units of the scene (such as mm, N and MPa).`),
  );
}

function draw() {
  document.title = `${data.title}: ${report.usable ? "usable" : "NOT USABLE"}`;
  const specimen = readSpecimen(data.specimen);
  const viewer = new Viewer(specimen, { labelOfRegion, valueOfRegion, firstField: firstField(specimen) });
  const second = html(
    "div",
    { class: "second" },
    [residualSection(data, specimen), seriesSection(), howSection(report), findingsSection(report), commandSection()].filter(Boolean),
  );
  document.querySelector("main").append(
    ...[header(), meaning(), parameterSection(), mapSection(report), materialsSection(report), specimenSection(specimen, viewer), second].filter(Boolean),
  );
  viewer.start();
}

draw();
