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

function readCase(loadCase) {
  const displacement = floats(loadCase.displacement);
  const ofNodes = Object.entries(loadCase.node_fields).map(([name, values]) => [name, floats(values)]);
  const ofFacets = Object.entries(loadCase.facet_fields).map(([name, values]) => [name, floats(values)]);
  if (displacement) {
    ofNodes.unshift(["displacement", lengths(displacement)]);
  }
  return {
    displacement,
    isFitted: loadCase.is_fitted,
    held: bytes(loadCase.held),
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
