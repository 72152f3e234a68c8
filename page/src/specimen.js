// The specimen as the page carries it: its surface, and what is known at nodes, facets and points of each load case.

import { bytes, floats, integers, lengths } from "./arrays.js";

function readPoints(points) {
  return {
    total: points.total,
    areNodes: points.are_nodes,
    positions: floats(points.positions),
    displacement: floats(points.displacement),
    residual: floats(points.residual),
    isLeftOut: bytes(points.left_out),
  };
}

// What was measured may have outliers, which are drawn no farther than this times the length that 95 % of nodes move.
const farthest = 2;

function withoutOutliers(displacement, isFitted) {
  if (!displacement || isFitted) {
    return { displacement, numCut: 0 };
  }
  const all = lengths(displacement);
  const most = farthest * [...all].sort((a, b) => a - b)[Math.floor(0.95 * (all.length - 1))];
  const scales = all.map((length) => (most > 0 && length > most ? most / length : 1));
  return { displacement: displacement.map((value, i) => value * scales[Math.floor(i / 3)]), numCut: scales.filter((scale) => scale < 1).length };
}

function readCase(loadCase) {
  const isFitted = loadCase.is_fitted;
  const { displacement, numCut } = withoutOutliers(floats(loadCase.displacement), isFitted);
  const ofNodes = Object.entries(loadCase.node_fields).map(([name, values]) => [name, floats(values)]);
  const ofFacets = Object.entries(loadCase.facet_fields).map(([name, values]) => [name, floats(values)]);
  if (displacement) {
    ofNodes.unshift([isFitted ? "displacement" : "measured_displacement", lengths(displacement)]);
  }
  return {
    displacement,
    isFitted,
    numCut,
    held: bytes(loadCase.held),
    moved: bytes(loadCase.moved),
    loads: loadCase.loads,
    points: loadCase.points ? readPoints(loadCase.points) : null,
    fields: [
      ...ofNodes.map(([name, values]) => ({ name, values, isOfNodes: true })),
      ...ofFacets.map(([name, values]) => ({ name, values, isOfNodes: false })),
    ],
  };
}

/** Reads the specimen of the data of the page. */
export function readSpecimen(specimen) {
  const nodes = floats(specimen.nodes);
  return {
    dimension: specimen.dimension,
    nodes,
    facets: integers(specimen.facets),
    numCorners: specimen.corners,
    fields: Object.entries(specimen.facet_fields).map(([name, values]) => ({ name, values: floats(values), isOfNodes: false })),
    cases: specimen.cases.map(readCase),
    casesLeftOut: specimen.cases_left_out,
  };
}
