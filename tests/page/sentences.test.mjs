// The three sentences say what the report says.

import assert from "node:assert";
import test from "node:test";
import { partsOfError, threeSentences } from "../../page/src/sentences.js";

const report = {
  usable: true,
  message: "",
  map: null,
  materials: [],
  material: { law: "isotropic", regions: [null] },
  residual: { displacement_relative: 0.0155, force_relative: null },
  diagnostics: { why_no_standard_error: "" },
  findings: [{ severity: "warning", text: "a residual is smooth", advice: "look at it" }],
  error_budget: {
    noise: { youngs_modulus: 0.0013, poisson_ratio: 0.0028 },
    discretization: { youngs_modulus: 0.0088, poisson_ratio: 0.0057 },
    law: { youngs_modulus: null, poisson_ratio: null },
  },
};
const parameters = [
  { label: "E", is_relative: true, known: false, value: 0.10053, standard_error: 0.0009, interval: [0.09877, 0.10229] },
  { label: "nu", is_relative: false, known: true, value: 0.3, standard_error: null, interval: null },
];

test("an estimate that is usable has values, ranges and what the fit leaves", () => {
  const [values, trust, fit] = threeSentences({ report, parameters, values: parameters });
  assert.strictEqual(values, "Young's modulus E is 0.10053 ± 0.00090 and Poisson's ratio nu is 0.3.");
  assert.match(trust, /95 %, E lies between 0\.09877 and 0\.10229; most of the error of E comes from the mesh \(0\.88 %\)/);
  assert.match(fit, /1\.6 % of the measured displacement.*warns of 1 thing/);
});

test("a shear modulus that is determined in place of E and nu is among the values", () => {
  const shear = { label: "shear_modulus", is_relative: true, known: false, value: 0.0387, standard_error: 0.0009, interval: null };
  const [values] = threeSentences({ report, parameters, values: [shear, ...parameters] });
  assert.match(values, /^Shear modulus mu is 0\.03870 ± 0\.00090, Young's modulus E is /);
});

test("the parts of an error are sorted, without those that are zero or unknown", () => {
  assert.deepStrictEqual(partsOfError(report, 0).map(({ cause }) => cause), ["discretization", "noise"]);
});

test("an estimate that is not usable says why first, and what to do", () => {
  const findings = [{ severity: "error", text: "noise biases nu", advice: "use --estimator=auto" }];
  const [why, mend, rest] = threeSentences({ report: { ...report, usable: false, findings }, parameters, values: parameters });
  assert.match(why, /no usable answer: noise biases nu\./);
  assert.match(mend, /use --estimator=auto\./);
  assert.match(rest, /do not use them/);
});
