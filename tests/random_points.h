#ifndef ELASTIMATE_TESTS_RANDOM_POINTS_H_
#define ELASTIMATE_TESTS_RANDOM_POINTS_H_

#include <cstdint>

#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/mesh/mesh_points.h"
#include "elastimate/core/scene/scene.h"

namespace elastimate::testing {

/// Points anywhere in elements that are drawn evenly.
MeshPoints RandomPoints(const Mesh& mesh, Eigen::Index count,
                        std::uint64_t seed);

/// Puts measurements at random points in the place of those of the nodes, which
/// are interpolated.
void MeasureAtPoints(Eigen::Index count, std::uint64_t seed, Scene& scene);

/// Adds noise of this standard deviation at the points.
void AddNoiseAtPoints(double standard_deviation, std::uint64_t seed,
                      Scene& scene);

}  // namespace elastimate::testing

#endif  // ELASTIMATE_TESTS_RANDOM_POINTS_H_
