// Tables of the page on loads, materials, maps, and what `auto` ran.

import { html, section, table } from "./elements.js";
import { counted, numberText, percent, twoDigits, valueWithError } from "./numbers.js";
import { regionsLabel, sentence } from "./words.js";

const mostLoads = 8;

function vectorText(components) {
  const largest = Math.max(...components.map((value) => Math.abs(value ?? 0)));
  const texts = components.map((value) =>
    value === null ? "not measured" : numberText(Math.abs(value) > 1e-12 * largest ? value : 0, 4),
  );
  return `(${texts.join(", ")})`;
}

/** Returns a table of the loads, which is the cheapest check of a scene. */
export function loadsOf({ loads }) {
  const rows = loads.flatMap((list, i) =>
    list.map(({ type, resultant, area }) => [
      ...(loads.length > 1 ? [i + 1] : []),
      type.replaceAll("_", " "),
      vectorText(resultant),
      area === null ? "" : numberText(area, 4),
    ]),
  );
  const header = [...(loads.length > 1 ? ["load case"] : []), "load", "resultant", "area"];
  return [
    rows.length === 0 ? null : table(header, rows.slice(0, mostLoads)),
    rows.length > mostLoads ? html("p", { class: "note" }, `and ${rows.length - mostLoads} more`) : null,
  ];
}

/** Returns the section on the map of a modulus. */
export function mapSection({ map }) {
  if (!map) {
    return null;
  }
  const verdicts = {
    homogeneous: "The measurement does not tell any part of the specimen from another: one material.",
    regions: `The specimen has ${map.regions.length} regions.`,
    field: "The stiffness varies smoothly over the specimen.",
    elements: "Each element has a modulus of its own, by the balance of forces alone. It has no standard error.",
  };
  // There is none where each element has a modulus of its own.
  const evidence = ({ regions, field }) =>
    regions === null ? "" : `The data support ${numberText(map.supported_parameters, 3)} of ${map.elements} parameters. Logarithm of the evidence ` +
    `over one material: ${numberText(regions, 3)} for regions, ${numberText(field, 3)} for a field (from 3 on, the odds against one material are 20 to 1).`;
  const values = (region) => [
    valueWithError(region.youngs_modulus, region.standard_error ?? 0),
    numberText(region.volume, 3),
  ];
  const rows = map.regions.map((region, i) => [
    `${i + 1}`,
    ...values(region),
    numberText(region.diameter, 3),
    region.resolved ? "yes" : "no: narrower than three resolution lengths",
  ]);
  if (map.boundary) {
    rows.push(["their boundary", ...values(map.boundary), "", ""]);
  }
  return section(
    "Map of Young's modulus",
    html("p", {}, verdicts[map.verdict]),
    map.regions.length > 1 ? table(["region", "E", "volume", "diameter", "resolved"], rows, [1, 2, 3]) : null,
    html("p", { class: "note" }, evidence(map.log_evidence)),
  );
}

function verdictRow(material) {
  const { determination, energy_share: energy, residual_chi_square: square } = material;
  return [
    regionsLabel(material.region),
    determination === null ? "" : determination === "determined" ? "determined" : `${determination} determined`,
    energy === null ? "" : percent(energy),
    square === null ? "" : `${twoDigits(Math.sqrt(square))} times the noise`,
  ];
}

/** Returns the section on several materials: what the data say of each, and how they were told apart. */
export function materialsSection({ materials, combinations, merges, laws }) {
  const merged = merges.map(({ regions, chi_square: distance, limit, merged: isMerged }) => [
    `${regionsLabel(regions[0])} and ${regionsLabel(regions[1])}`,
    isMerged ? "joined" : "told apart",
    distance === null ? "" : numberText(distance, 3),
    numberText(limit, 3),
  ]);
  const compared = laws.map(({ law, num_parameters: count, chi_square: square, bic_difference: difference }, i) => [
    i === 0 ? `${law} (chosen)` : law,
    count,
    square === null ? "" : numberText(square, 3),
    difference === null ? "" : i === 0 ? "least" : `+${numberText(difference, 3)}`,
  ]);
  return section(
    "Materials",
    materials.length === 0 ? null : table(["material", "by the data", "of the strain energy", "residuals"], materials.map(verdictRow), [2]),
    combinations.map((combination) => html("p", {}, `Determined only: ${combination}.`)),
    merged.length === 0 ? null : table(["regions", "verdict", "chi²", "limit"], merged, [2, 3]),
    compared.length === 0 ? null : table(["law", "parameters", "chi² above the least", "BIC above the least"], compared, [1, 2, 3]),
  );
}

/** Returns the section on how the estimate was found. */
export function howSection({ estimator, rungs, seconds, work }) {
  const rows = rungs.map((rung) => [
    rung.estimator + (rung.order === 2 ? " with quadratic elements" : ""),
    rung.youngs_modulus === null ? "" : numberText(rung.youngs_modulus, 4),
    rung.poisson_ratio === null ? "" : numberText(rung.poisson_ratio, 3),
    rung.status === null ? "" : `${numberText(rung.seconds, 2)} s`,
    sentence(rung.decision),
  ]);
  const cost = `${counted(work.factorizations, "factorisation")}, ${counted(work.solves, "solve")}, ${numberText(seconds.total, 3)} s in all.`;
  return section(
    "How it was found",
    html("p", {}, `Estimator ${estimator}: ${cost}`),
    rows.length === 0 ? null : table(["step", "E", "nu", "time", "decision"], rows, [1, 2, 3]),
  );
}
