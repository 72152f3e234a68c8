#ifndef ELASTIMATE_TESTS_REGIONS_H_
#define ELASTIMATE_TESTS_REGIONS_H_

#include <Eigen/Core>
#include <vector>

#include "elastimate/core/laws/elasticity.h"
#include "elastimate/core/scene/scene.h"
#include "tests/element_kinds.h"

namespace elastimate::testing {

/// Returns SceneOfKind with region 7 where the first coordinate of an element's
/// centre is below the middle, and region 3 elsewhere.  Each region has an
/// isotropic material; that of region 3 is the first.
Scene TwoRegionScene(const KindOfSection& parameter, int cells = 3);

/// Divides a body from zero to `size` into regions 1, 2, ..., which are so many
/// `boxes` along each axis; the first axis is the fastest.  Each region gets an
/// isotropic material.
void DivideIntoRegions(const Eigen::Vector3i& boxes,
                       const Eigen::Vector3d& size, Scene& scene);

/// Returns a BoxMesh that is held at the bottom, with a slanted traction on its
/// top.
Scene BlockUnderTraction(const Eigen::Vector3i& cells,
                         const Eigen::Vector3d& size);

/// Returns the TextbookStiffness of a scene whose isotropic materials have
/// these `elasticities`, one for each.
Eigen::MatrixXd TextbookStiffness(
    const Scene& scene, const std::vector<IsotropicElasticity>& elasticities);

/// Returns the dense solution with that TextbookStiffness, num_dofs x
/// num_load_cases.  Held components have their given displacements.
Eigen::MatrixXd SolveByTextbook(
    const Scene& scene, const std::vector<IsotropicElasticity>& elasticities);

/// Measures the scene by SolveByTextbook.
void MeasureByTextbook(const std::vector<IsotropicElasticity>& elasticities,
                       Scene& scene);

}  // namespace elastimate::testing

#endif  // ELASTIMATE_TESTS_REGIONS_H_
