#ifndef ELASTIMATE_CORE_SCENE_SCENE_H_
#define ELASTIMATE_CORE_SCENE_SCENE_H_

#include <Eigen/Core>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "elastimate/core/materials/material.h"
#include "elastimate/core/mesh/facets.h"
#include "elastimate/core/mesh/mesh.h"

namespace elastimate {

/// One flag per displacement component: dimension x num_nodes.
using ComponentMask = Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic>;

/// The held degrees of freedom, and the displacement they are held at.
struct Supports {
  ComponentMask held;            ///< dimension x num_nodes.
  Eigen::MatrixXd displacement;  ///< dimension x num_nodes [length]; used where
                                 ///< `held`, ignored elsewhere.
};

/// Forces that act on nodes.
struct NodalForces {
  Eigen::MatrixXd force;  ///< dimension x num_nodes [force].
};

/// A uniform force per volume, such as gravity.
struct BodyForce {
  Eigen::VectorXd force_density;  ///< [force / length^3], of `dimension`.
};

/// A uniform force per (undeformed) area on some facets.
struct Traction {
  Eigen::MatrixXi facets;    ///< As those of BoundaryFacets.
  Eigen::VectorXd traction;  ///< [force / length^2], of `dimension`.
};

/// A uniform pressure on some facets; positive pushes against the outward
/// normal.
struct Pressure {
  Eigen::MatrixXi facets;  ///< As those of BoundaryFacets, in their order.
  double pressure;         ///< [force / length^2].
};

/// A total force that is spread uniformly over some facets: the traction
/// force / area, where area is that of all of them.
struct SurfaceForce {
  Eigen::MatrixXi facets;  ///< As those of a traction; not all without area.
  Eigen::VectorXd force;   ///< [force], of `dimension`.
};

/// Loads are kept as what they physically are, so that each discretisation can
/// assemble its own nodal forces.
using Load =
    std::variant<NodalForces, BodyForce, Traction, Pressure, SurfaceForce>;

/// One experiment on the specimen: what pushed, and what was measured.
struct LoadCase {
  std::vector<Load> loads;
  Eigen::MatrixXd displacement;  ///< Measured, dimension x num_nodes [length];
                                 ///< empty when nothing was measured.
  ComponentMask observed;        ///< dimension x num_nodes, or empty when every
                                 ///< component was measured.
  std::optional<double> noise_sd;  ///< Standard deviation of the measured
                                   ///< displacement per component [length].
};

/// Geometry, materials, supports, and one or more load cases.
struct Scene {
  Mesh mesh;
  /// Empty: one isotropic material.
  std::vector<Material> materials;
  Supports supports;
  std::vector<LoadCase> load_cases;
};

/// Throws std::invalid_argument with one sentence that names the load case, the
/// array, and the node or element, unless: the mesh and its materials are
/// valid (ValidateMesh, ValidateMaterials); every array has its shape; every number is finite, and no array's largest
/// one beyond 1e-50 to 1e50 unless zero (displacements only where they are
/// observed or held); every facet has nodes in range (and mid-edge nodes in the
/// middle); the facets of a surface force have an area; noise standard
/// deviations are positive; there is a load case; and at least one degree of
/// freedom is free.  O(num_elements + num_nodes * num_load_cases).
void ValidateScene(const Scene& scene);

/// The part of ValidateScene that is about observed components, displacements
/// and noise: for another measurement of a valid scene.
/// O(num_nodes * num_load_cases).
void ValidateMeasurements(const Scene& scene);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SCENE_SCENE_H_
