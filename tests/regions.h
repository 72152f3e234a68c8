#ifndef ELASTIMATE_TESTS_REGIONS_H_
#define ELASTIMATE_TESTS_REGIONS_H_

#include <Eigen/Core>
#include <vector>

#include "elastimate/core/materials/elasticity.h"
#include "elastimate/core/scene/scene.h"
#include "tests/element_kinds.h"

namespace elastimate::testing {

/// SceneOfKind with region 7 where the first coordinate of an element's centre
/// is below the middle, 3 elsewhere, and an isotropic material in each: that of
/// region 3 first.
Scene TwoRegionScene(const KindOfSection& parameter, int cells = 3);

/// Regions 1, 2, ... of boxes, so many along each axis of a body from zero to
/// `size`, the first axis fastest, and an isotropic material in each.
void DivideIntoRegions(const Eigen::Vector3i& boxes,
                       const Eigen::Vector3d& size, Scene& scene);

/// BoxMesh held at the bottom, with a slanted traction on its top.
Scene BlockUnderTraction(const Eigen::Vector3i& cells,
                         const Eigen::Vector3d& size);

/// TextbookStiffness of the isotropic materials of a scene, one of
/// `elasticities` for each.
Eigen::MatrixXd TextbookStiffness(
    const Scene& scene, const std::vector<IsotropicElasticity>& elasticities);

/// A dense solution with that, with held nodes where they are held: num_dofs x
/// num_load_cases.
Eigen::MatrixXd SolveByTextbook(
    const Scene& scene, const std::vector<IsotropicElasticity>& elasticities);

/// Measures the scene by it.
void MeasureByTextbook(const std::vector<IsotropicElasticity>& elasticities,
                       Scene& scene);

}  // namespace elastimate::testing

#endif  // ELASTIMATE_TESTS_REGIONS_H_
