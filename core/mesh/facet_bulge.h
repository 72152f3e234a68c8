#ifndef ELASTIMATE_CORE_MESH_FACET_BULGE_H_
#define ELASTIMATE_CORE_MESH_FACET_BULGE_H_

#include <Eigen/Core>

#include "elastimate/core/mesh/mesh.h"

namespace elastimate {

/// Returns the mean distance [length] by which a smooth surface through the
/// vertices lies outside each of these facets; it is negative where the surface
/// is hollow.  One value for each facet.
///
/// The normal n_i of the smooth surface at a vertex x_i of a facet is the mean
/// of the normals of the facets around x_i that make an angle of less than 40
/// degrees with the facet; at larger angles the surface has an edge.  A facet
/// whose edges a and b meet in x_i has the weight |a x b| / (|a|^2 |b|^2), with
/// which n_i is exact on a sphere (Max, J. Graphics Tools 4 (1999) 1); an edge
/// of a planar mesh has that of its inverse length.  The surface rises over an
/// edge of the facet by
///
///   h_ij = (n_j - n_i) . (x_j - x_i) / 8
///
/// in the middle, and over the facet by a third of the sum of h_ij on average;
/// over an edge of a planar mesh by 2 h_01 / 3.  At a symmetry plane the facets
/// of the other half are missing, so that the result is too small there.
///
/// Precondition: `facets` as by BoundaryFacets, so that all facets around a
/// vertex are there.  Middle nodes are not looked at.  O(num_facets).
[[nodiscard]] Eigen::VectorXd BulgeOfFacets(const Mesh& mesh,
                                            const Eigen::MatrixXi& facets);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MESH_FACET_BULGE_H_
