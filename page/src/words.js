// The words of the page for the names of the report.

/** Returns the causes of errors, by their keys in `error_budget`, in the words of the command line. */
export const causes = {
  noise: "noise",
  bias: "the bias by noise",
  model: "the model",
  outliers: "outliers",
  discretization: "the mesh",
  curvature: "other values that fit as well",
  law: "the choice of the law",
  kinematics: "large deformations",
  section: "the margin",
  prior: "the prior",
};

/** Returns what to do to make each error smaller. */
export const mendsOfCauses = {
  noise: "measure more points or frames, or larger displacements",
  bias: "use --estimator=auto",
  model: "describe supports, loads and materials as they are in the experiment",
  outliers: "look at the few points with large residuals",
  discretization: "use a finer mesh",
  curvature: "add a load case, or give a ratio that you know",
  law: "measure larger deformations, or name the law if you know it",
  kinematics: "use --estimator=auto, or smaller loads",
  section: "measure how far the outermost points are from the free edges, and give that margin",
  prior: "give a tighter prior",
};

/** Returns what a parameter is, for those who do not use it every day. */
export const meanings = {
  youngs_modulus: "how stiff the material is: the pull per area that a strain needs, in units of pressure",
  poisson_ratio: "how much it narrows when it is stretched: at 0.5 it keeps its volume",
  shear_modulus: "how stiff it is against a change of shape",
};

const longLabels = { E: "Young's modulus E", nu: "Poisson's ratio nu", shear_modulus: "shear modulus mu" };

/** Returns "Young's modulus E of region 3" for "E of region 3". */
export function longLabel(label) {
  const [symbol, ...rest] = label.split(" of ");
  return [longLabels[symbol] ?? symbol, ...rest].join(" of ");
}

/** Returns the fields that are drawn on the specimen, with what they mean. */
export const fields = {
  displacement: {
    title: "fitted displacement",
    meaning: "How far each point moves in the fitted model.",
  },
  measured_displacement: {
    title: "measured displacement",
    meaning: "How far each point moved, as it was measured: there is no fit to draw.",
  },
  residual: {
    title: "residual",
    meaning:
      "The distance between the measured and the fitted displacement. Speckles are noise; a pattern says that " +
      "the mesh, the supports, the loads or the material are not those of the experiment.",
  },
  mesh_error: {
    title: "mesh error",
    meaning: "How far finer elements move each point beyond the elements of this mesh. Large values call for a finer mesh.",
  },
  strain_energy_density: {
    title: "strain energy",
    meaning: "The energy per volume. The material is seen best where this is large, and hardly where it is small.",
  },
  force_residual: {
    title: "force residual",
    meaning: "At each node, the difference between the load and the force that the measured displacement needs.",
  },
  region: { title: "regions", meaning: "The regions of the mesh." },
  youngs_modulus: { title: "Young's modulus", meaning: "How stiff each part is." },
  youngs_modulus_standard_error: {
    title: "error of Young's modulus",
    meaning: "The standard error of Young's modulus in each element.",
  },
  resolution_length: {
    title: "resolution",
    meaning: "The size of the smallest detail that the measurement shows here. Smaller details are blurred.",
  },
  residual_chi_square: {
    title: "residual by region",
    meaning: "The mean square of the residual over that of noise: about 1 where the material is right.",
  },
  residual_correlation: {
    title: "likeness of residuals",
    meaning: "How alike the residuals of neighbours are: near 0 for noise, near 1 where the region may be wrong.",
  },
};

/** Returns the title and the meaning of a field, also of one that is a parameter of a law. */
export function wordsOfField(name) {
  const title = name.replaceAll("_", " ");
  return fields[name] ?? { title, meaning: `The parameter ${title} of the material of each element.` };
}

const shapes = { tet: "tetrahedra", hex: "hexahedra", tri: "triangles", quad: "quadrilaterals", wedge: "wedges", pyramid: "pyramids" };

/** Returns "320 quadratic tetrahedra", as the command line says it. */
export function elementsText({ kind, elements, order }) {
  const shape = shapes[kind.replace("curved_", "").replace(/\d+$/, "")] ?? `elements (${kind})`;
  return `${elements} ${kind.startsWith("curved_") ? "curved " : ""}${order === 2 ? "quadratic " : ""}${shape}`;
}

/** Returns "1", "1 and 2" or "1, 2 and 3". */
export function listOf(items) {
  return items.length < 2 ? String(items) : `${items.slice(0, -1).join(", ")} and ${items[items.length - 1]}`;
}

/** Returns "the specimen", "region 3" or "regions 1 and 2". */
export function regionsLabel(region) {
  if (region === null) {
    return "the specimen";
  }
  const ids = [region].flat();
  return `${ids.length === 1 ? "region" : "regions"} ${listOf(ids)}`;
}

/** Returns a sentence that begins with a capital and ends with a full stop. */
export function sentence(text) {
  return text === "" ? "" : `${text[0].toUpperCase()}${text.slice(1)}${/[.!?]$/.test(text) ? "" : "."}`;
}
