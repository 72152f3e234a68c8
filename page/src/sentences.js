// Says in three sentences what an estimate means.

import { counted, intervalText, percent, percentOf, valueWithError } from "./numbers.js";
import { causes, listOf, longLabel, sentence } from "./words.js";

const free = (parameters) => parameters.filter((parameter) => !parameter.known);

function valuesSentence({ report, parameters, values }) {
  if (isMean(report)) {
    const { verdict, regions } = report.map;
    if (verdict === "elements") {
      return "Each element has a modulus of its own, which the map below shows.";
    }
    return verdict === "field"
      ? "The stiffness of the specimen varies smoothly: the map below shows Young's modulus E of each part."
      : `The specimen has ${counted(regions.length, "region")} of different stiffness: Young's modulus E is ` +
          `${listOf(regions.map((region) => valueWithError(region.youngs_modulus, region.standard_error ?? 0)))}.`;
  }
  const moduli = parameters.filter(({ name, value }) => name === "youngs_modulus" && value !== null);
  if (moduli.length > 1 && moduli.length < 5) {
    const texts = moduli.map(({ label, value, standard_error: error }) => `${label} is ${valueWithError(value, error ?? 0)}`);
    return `The specimen has ${counted(moduli.length, "material")} of different stiffness: Young's modulus ${listOf(texts)}.`;
  }
  if (report.materials.length > 1 || parameters.length > 3) {
    return (
      `The specimen has ${counted(report.material.regions.length, "material")} with ` +
      `${counted(free(parameters).length, "parameter")} that the measurement was asked for; the table below has them all.`
    );
  }
  const texts = values
    .filter((parameter) => parameter.value !== null)
    .map((parameter) => {
      const error = parameter.standard_error;
      const value = parameter.value;
      return `${longLabel(parameter.label)} is ${error === null ? value : valueWithError(value, error)}`;
    });
  return `${sentence(listOf(texts))}`;
}

/** Returns the parts of the error of a parameter, the largest first, with their words. */
export function partsOfError(report, place) {
  const names = ["youngs_modulus", "poisson_ratio"];
  return Object.entries(report.error_budget)
    .map(([cause, errors]) => ({ cause, words: causes[cause] ?? cause, size: errors?.[place] ?? errors?.[names[place]] }))
    .filter(({ size }) => size > 0)
    .sort((a, b) => b.size - a.size);
}

/** Tells whether E of the report is the mean of a map. */
export const isMean = ({ map }) => map !== null && map.verdict !== "homogeneous";

function trustSentence({ report, parameters }) {
  const known = free(parameters).filter((parameter) => parameter.interval !== null);
  if (known.length === 0) {
    return sentence(report.diagnostics.why_no_standard_error || "how far it may be off is not known");
  }
  const places = known.length <= 2 ? known : known.slice(0, 1);
  const ranges = places.map(({ label, interval }) => `${isMean(report) && label === "E" ? "the geometric mean of E" : label} lies between ${intervalText(interval).replace(" to ", " and ")}`);
  const [first] = partsOfError(report, parameters.indexOf(known[0]));
  const relative = known[0].is_relative;
  const cause = first
    ? `; most of the error of ${known[0].label} comes from ${first.words}${relative ? ` (${percent(first.size)})` : ""}`
    : "";
  return `Each with a probability of 95 %, ${listOf(ranges)}${cause}.`;
}

function fitSentence({ report }) {
  const warnings = report.findings.filter(({ severity }) => severity === "warning").length;
  const residual = report.residual.displacement_relative;
  const objections =
    warnings === 0
      ? "no check of the program contradicts this estimate"
      : `the program warns of ${counted(warnings, "thing")}, which the findings below explain`;
  return residual === null
    ? sentence(objections)
    : `The fit leaves ${percentOf(residual, "the measured displacement")} unexplained, and ${objections}.`;
}

/** Returns what the page says first: of an estimate that is not usable why, and what to do. */
export function threeSentences(data) {
  const { report } = data;
  if (report.usable) {
    return [valuesSentence(data), trustSentence(data), fitSentence(data)];
  }
  const error = report.findings.find(({ severity }) => severity === "error");
  return [
    `The measurement gave no usable answer: ${error?.text ?? report.message}.`,
    `What to do: ${error?.advice ?? "see the findings"}.`,
    "The numbers and pictures below help to find the cause; do not use them as a result.",
  ];
}
