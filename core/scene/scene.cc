#include "elastimate/core/scene/scene.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "elastimate/core/materials/material_parameters.h"
#include "elastimate/core/mesh/axis_names.h"
#include "elastimate/core/mesh/facets.h"
#include "elastimate/core/mesh/representable.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/core/scene/unknown_motion.h"
#include "elastimate/core/text/numbers.h"

namespace elastimate {
namespace {

std::string CaseName(std::size_t index) {
  return "load case " + std::to_string(index + 1);
}

[[noreturn]] void Fail(const std::string& what) {
  throw std::invalid_argument(what);
}

// Requires one row for each dimension and one column for each node.
template <class Values>
void RequireShape(const Values& values, const Mesh& mesh,
                  const std::string& what) {
  if (values.rows() != mesh.Dimension()) {
    Fail(what + " has " + std::to_string(values.rows()) + " rows for " +
         std::to_string(mesh.Dimension()) + " dimensions; give one for each");
  }
  if (values.cols() != mesh.NumNodes()) {
    Fail(what + " has " + std::to_string(values.cols()) + " columns for " +
         std::to_string(mesh.NumNodes()) + " nodes; give one for each");
  }
}

// Requires a vector in space.
void RequireVector(const Eigen::VectorXd& vector, const Mesh& mesh,
                   const std::string& what) {
  if (vector.size() != mesh.Dimension()) {
    Fail(what + " has " + std::to_string(vector.size()) + " components for " +
         std::to_string(mesh.Dimension()) + " dimensions; give one for each");
  }
  if (!vector.allFinite()) {
    Fail(what + " is not finite; correct it");
  }
  RequireRepresentable(vector.cwiseAbs().maxCoeff(), what);
}

// Requires one vector for all of `count`, or one for each.
void RequireVectors(const Eigen::MatrixXd& vectors, const Mesh& mesh,
                    Eigen::Index count, const std::string& what) {
  if (vectors.cols() != 1 && vectors.cols() != count) {
    Fail(what + " has " + std::to_string(vectors.cols()) + " columns for " +
         std::to_string(count) + " places; give one for all or one for each");
  }
  for (const auto& vector : vectors.colwise()) {
    RequireVector(vector, mesh, what);
  }
}

// `values` may be an expression; it is not kept.
template <class Values>
void RequireFinite(const Values& values, const std::string& what) {
  double largest = 0;
  for (Eigen::Index node = 0; node < values.cols(); ++node) {
    for (Eigen::Index i = 0; i < values.rows(); ++i) {
      const double value = values(i, node);
      if (!std::isfinite(value)) {
        Fail(what + " of node " + std::to_string(node) +
             " is not finite; correct it");
      }
      largest = std::max(largest, std::abs(value));
    }
  }
  RequireRepresentable(largest, what);
}

// `of_case` is empty where the supports are those of the scene.
void ValidateSupports(const Mesh& mesh, const Supports& supports,
                      const std::string& of_case) {
  const std::string displacement = "the displacement of the supports" + of_case;
  RequireShape(supports.held, mesh, "the mask of held components" + of_case);
  RequireShape(supports.displacement, mesh, displacement);
  RequireFinite(supports.held.select(supports.displacement.array(), 0.0),
                displacement);
  for (const HeldBox& box : supports.boxes) {
    const Eigen::Index d = mesh.Dimension();
    if (box.lower.size() != d || box.upper.size() != d ||
        box.components.size() != d || box.displacement.size() != d ||
        !box.displacement.allFinite()) {
      Fail("a box of the supports" + of_case + " does not have " +
           std::to_string(d) + " finite numbers of each kind; correct it");
    }
  }
  if (supports.delimited.size() != 0) {
    RequireShape(supports.delimited, mesh,
                 "the mask of delimited supports" + of_case);
  }
  if (supports.held.all()) {
    Fail("every degree of freedom is held" +
         (of_case.empty() ? "" : " in the supports" + of_case) +
         "; free the nodes that could move");
  }
}

void ValidateFacets(const Mesh& mesh, const Eigen::MatrixXi& facets,
                    const std::string& what) {
  if (facets.cols() == 0) {
    Fail(what + " acts on no facet; name a part of the surface");
  }
  const ElementTopology& topology = mesh.Topology();
  const int num_vertices = topology.NumVerticesOfFace();
  if (facets.rows() != topology.NumNodesOfFace()) {
    Fail(what + " has " + std::to_string(facets.rows()) +
         " nodes per facet; the facets of " +
         (mesh.Order() == 2 ? "quadratic " : "") +
         std::string(topology.shapes) + " have " +
         std::to_string(topology.NumNodesOfFace()));
  }
  for (Eigen::Index facet = 0; facet < facets.cols(); ++facet) {
    if (facets.col(facet).minCoeff() < 0 ||
        facets.col(facet).maxCoeff() >= mesh.NumNodes()) {
      Fail("facet " + std::to_string(facet) + " of " + what +
           " has a node index outside 0.." +
           std::to_string(mesh.NumNodes() - 1));
    }
    for (int i = num_vertices;
         !IsCurved(mesh.kind) && i < topology.NumNodesOfFace(); ++i) {
      std::vector<int> vertices;
      for (const int place : topology.middles_of_face[i - num_vertices]) {
        vertices.push_back(facets(place, facet));
      }
      if (!IsInTheMiddle(mesh, facets(i, facet), vertices)) {
        Fail("node " + std::to_string(facets(i, facet)) + " of facet " +
             std::to_string(facet) + " of " + what + " is not in the middle " +
             (vertices.size() == 2 ? "of its edge" : "of it") +
             "; order the nodes as VTK does");
      }
    }
  }
  if (const std::optional<Eigen::Index> facet =
          FirstThatIsNoFace(mesh, facets)) {
    Fail("facet " + std::to_string(*facet) + " of " + what + " is not a" +
         (mesh.Dimension() == 3 ? " face" : "n edge") + " of " +
         std::string(topology.shapes) +
         "; take the facets from the mesh, as BoundaryFacets has them");
  }
}

// One overload per kind of load.
struct LoadValidator {
  const Mesh& mesh;
  std::string where;  // "load 1 of load case 2"

  void operator()(const NodalForces& load) const {
    RequireShape(load.force, mesh, "the force in " + where);
    RequireFinite(load.force, "the force in " + where);
  }
  void operator()(const BodyForce& load) const {
    RequireVectors(load.force_density, mesh, mesh.NumElements(),
                   "the body force in " + where);
  }
  void operator()(const Traction& load) const {
    ValidateFacets(mesh, load.facets, "the traction in " + where);
    RequireVectors(load.traction, mesh, load.facets.cols(),
                   "the traction in " + where);
  }
  void operator()(const Pressure& load) const {
    ValidateFacets(mesh, load.facets, "the pressure in " + where);
    if (!std::isfinite(load.pressure)) {
      Fail("the pressure in " + where + " is not finite; correct it");
    }
    RequireRepresentable(std::abs(load.pressure), "the pressure in " + where);
  }
  void operator()(const SurfaceForce& load) const {
    ValidateFacets(mesh, load.facets, "the force on a surface in " + where);
    RequireVector(load.force, mesh, "the force on a surface in " + where);
  }
};

void ValidatePointDisplacements(const Mesh& mesh,
                                const PointDisplacements& measured,
                                const std::string& name) {
  ValidatePoints(mesh, measured.points);
  const auto require_shape = [&](const Eigen::MatrixXd& array,
                                 const std::string& what) {
    if (array.rows() != mesh.Dimension() ||
        array.cols() != measured.points.Size()) {
      Fail(what + " at the points of " + name + " is " +
           std::to_string(array.rows()) + " x " + std::to_string(array.cols()) +
           "; make it " + std::to_string(mesh.Dimension()) + " x " +
           std::to_string(measured.points.Size()));
    }
  };
  require_shape(measured.displacement, "the displacement");
  if (measured.noise_sd.size() != 0) {
    require_shape(measured.noise_sd, "the noise standard deviation");
  }
  double largest = 0;
  for (Eigen::Index point = 0; point < measured.points.Size(); ++point) {
    for (int i = 0; i < mesh.Dimension(); ++i) {
      const double value = measured.displacement(i, point);
      if (std::isnan(value)) {
        continue;
      }
      const std::string where = "point " + std::to_string(point) + " (" +
                                kAxisNames[i] + ") in " + name;
      if (std::isinf(value)) {
        Fail("the measured displacement of " + where +
             " is infinite; correct it, or make it not a number");
      }
      largest = std::max(largest, std::abs(value));
      if (measured.noise_sd.size() != 0) {
        const double sd = measured.noise_sd(i, point);
        if (!(std::isfinite(sd) && sd > 0)) {
          Fail("the noise standard deviation of " + where + " is " +
               NumberText(sd) + "; it must be positive");
        }
        RequireRepresentable(sd, "the noise standard deviation of " + where);
      }
    }
  }
  RequireRepresentable(largest, "the displacement at the points of " + name);
}

void ValidateMeasurement(const Mesh& mesh, const LoadCase& load_case,
                         const std::string& name) {
  if (load_case.observed.size() != 0) {
    RequireShape(load_case.observed, mesh,
                 "the mask of observed components of " + name);
  }
  if (load_case.noise_sd &&
      !(std::isfinite(*load_case.noise_sd) && *load_case.noise_sd > 0)) {
    Fail("the noise standard deviation of " + name + " is " +
         NumberText(*load_case.noise_sd) + "; it must be positive");
  }
  RequireRepresentable(load_case.noise_sd.value_or(0),
                       "the noise standard deviation of " + name);
  if (load_case.points.points.Size() != 0) {
    ValidatePointDisplacements(mesh, load_case.points, name);
  }
  if (load_case.displacement.size() == 0) {
    return;
  }
  RequireShape(load_case.displacement, mesh,
               "the measured displacement of " + name);
  double largest = 0;
  for (Eigen::Index node = 0; node < mesh.NumNodes(); ++node) {
    for (int i = 0; i < mesh.Dimension(); ++i) {
      const bool observed =
          load_case.observed.size() == 0 || load_case.observed(i, node);
      if (!observed) {
        continue;
      }
      const double value = load_case.displacement(i, node);
      largest = std::max(largest, std::abs(value));
      if (!std::isfinite(value)) {
        Fail("the measured displacement of node " + std::to_string(node) +
             " (" + kAxisNames[i] + ") in " + name +
             " is not finite; correct it or mark it as not observed");
      }
    }
  }
  RequireRepresentable(largest, "the measured displacement of " + name);
}

}  // namespace

bool HasSupportsOfCases(const Scene& scene) {
  return std::any_of(
      scene.load_cases.begin(), scene.load_cases.end(),
      [](const LoadCase& load_case) { return load_case.supports.has_value(); });
}

void ValidateScene(const Scene& scene) {
  ValidateMesh(scene.mesh);
  ValidateMaterials(scene.materials, scene.mesh);
  ValidateSupports(scene.mesh, scene.supports, "");
  if (scene.load_cases.empty()) {
    Fail("the scene has no load case; give at least one");
  }
  const bool has_large_strains = HasLargeStrainLaw(scene.materials);
  for (std::size_t i = 0; i < scene.load_cases.size(); ++i) {
    const LoadCase& load_case = scene.load_cases[i];
    if (load_case.supports) {
      ValidateSupports(scene.mesh, *load_case.supports, " of " + CaseName(i));
    }
    for (std::size_t k = 0; k < load_case.loads.size(); ++k) {
      const std::string where =
          "load " + std::to_string(k + 1) + " of " + CaseName(i);
      std::visit(LoadValidator{scene.mesh, where}, load_case.loads[k]);
      if (Follows(load_case.loads[k]) && !has_large_strains) {
        Fail("the pressure in " + where +
             " follows the deformed surface, but the materials have laws of "
             "small strains; give them a law of large strains, such as "
             "--material=neo_hookean, or leave out \"follows\"");
      }
    }
  }
  ValidateMeasurements(scene);
  ValidateUnknownMotion(scene);
}

void ValidateMeasurements(const Scene& scene) {
  for (std::size_t i = 0; i < scene.load_cases.size(); ++i) {
    ValidateMeasurement(scene.mesh, scene.load_cases[i], CaseName(i));
  }
}

}  // namespace elastimate
