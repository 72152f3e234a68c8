#ifndef ELASTIMATE_TESTS_SCENES_H_
#define ELASTIMATE_TESTS_SCENES_H_

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "elastimate/core/equilibrium/simulated_measurement.h"
#include "elastimate/core/scene/scene.h"

namespace elastimate::testing {

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Returns a box of nx x ny x nz cubes, each cut into six tetrahedra, with one
/// corner at the origin.
Mesh BoxMesh(const Eigen::Vector3i& cells, const Eigen::Vector3d& size);

/// Returns the mesh with its nodes moved by a smooth map, which bends, twists
/// and tapers it.
Mesh Distorted(Mesh mesh);

/// Returns a cylinder of radius 1 and height 1 around the z axis, whose outer
/// nodes lie on it, 4 x cells_per_side of them at each height.
Mesh CylinderMesh(int cells_per_side);

/// Returns a scene of this mesh with one load case of nodal forces on every
/// free node.  Nodes are held where z = 0 in `reference`, which is the mesh
/// before any distortion.
Scene HeldAtBottom(const Mesh& mesh, const Mesh& reference,
                   const Eigen::Vector3d& force_per_node);

/// Holds one component where the coordinate of that axis is `place`.
void HoldPlane(int axis, double place, double displacement, Scene& scene);

/// Returns a small scene by name: "cuboid", "bar" (slender), "organ"
/// (distorted).
Scene SmallScene(const std::string& shape);
std::vector<std::string> SmallSceneNames();

using elastimate::Measure;
using elastimate::MeasureInFinerWorld;
/// Takes the displacements of a finer scene, whose first nodes are those of
/// this one.
void TakeDisplacements(const Scene& finer, Scene& scene);
/// Measures at the nodes, in a world of quadratic elements of half the size.
void MeasureInRefinedWorld(const IsotropicElasticity& elasticity, Scene& scene);

/// Adds independent Gaussian noise to the free components.  Its standard
/// deviation is `relative` times the root mean square of the free displacement
/// of each load case.  Returns the standard deviation for the first load case.
double AddNoise(double relative, std::uint64_t seed, Scene& scene);

/// Returns the scene with three load cases: forces along x, y and z.
Scene WithThreeForces(const Scene& scene);

/// Returns the scene with one load case of a force per volume, which is the
/// same load for linear and for quadratic elements.
Scene UnderBodyForce(Scene scene);

/// Returns a block with E = 5e4, nu = 0.3 in simple shear, u = (0.01 y, 0, 0),
/// under exact forces and statically determinate supports.  Its volume does not
/// change, so that the shear modulus alone acts.
Scene ShearedBlock();

}  // namespace elastimate::testing

#endif  // ELASTIMATE_TESTS_SCENES_H_
