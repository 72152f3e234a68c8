#include "elastimate/core/scene.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <numeric>
#include <sstream>
#include <stdexcept>

#include "elastimate/core/magnitude.h"
#include "elastimate/core/quadratic_tetrahedron.h"

namespace elastimate {
namespace {

const char* const kAxis[3] = {"x", "y", "z"};

std::string CaseName(std::size_t index) {
  return "load case " + std::to_string(index + 1);
}

[[noreturn]] void Fail(const std::string& what) {
  throw std::invalid_argument(what);
}

void RequireColumns(Eigen::Index columns, const Mesh& mesh,
                    const std::string& what) {
  if (columns != mesh.NumNodes()) {
    Fail(what + " has " + std::to_string(columns) + " columns for " +
         std::to_string(mesh.NumNodes()) + " nodes; give one for each");
  }
}

// `values` may be an expression; it is not kept.
template <class Values>
void RequireFinite(const Values& values, const std::string& what) {
  double largest = 0;
  for (Eigen::Index node = 0; node < values.cols(); ++node) {
    const Eigen::Vector3d of_node = values.col(node);
    if (!of_node.allFinite()) {
      Fail(what + " of node " + std::to_string(node) +
           " is not finite; correct it");
    }
    largest = std::max(largest, of_node.cwiseAbs().maxCoeff());
  }
  RequireMagnitude(largest, what);
}

void ValidateSupports(const Mesh& mesh, const Supports& supports) {
  RequireColumns(supports.held.cols(), mesh, "the mask of held components");
  RequireColumns(supports.displacement.cols(), mesh,
                 "the displacement of the supports");
  RequireFinite(supports.held.select(supports.displacement.array(), 0.0),
                "the displacement of the supports");
  if (supports.held.all()) {
    Fail("every degree of freedom is held; free the nodes that could move");
  }
}

void ValidateFacets(const Mesh& mesh, const Eigen::MatrixXi& facets,
                    const std::string& what) {
  if (facets.cols() == 0) {
    Fail(what + " acts on no facet; name a part of the surface");
  }
  const Eigen::Index nodes_per_facet = mesh.Order() == 2 ? 6 : 3;
  if (facets.rows() != nodes_per_facet) {
    Fail(what + " has " + std::to_string(facets.rows()) +
         " nodes per facet; the facets of " +
         (mesh.Order() == 2 ? "quadratic " : "") + "tetrahedra have " +
         std::to_string(nodes_per_facet));
  }
  for (Eigen::Index facet = 0; facet < facets.cols(); ++facet) {
    if (facets.col(facet).minCoeff() < 0 ||
        facets.col(facet).maxCoeff() >= mesh.NumNodes()) {
      Fail("facet " + std::to_string(facet) + " of " + what +
           " has a node index outside 0.." +
           std::to_string(mesh.NumNodes() - 1));
    }
    for (Eigen::Index i = 3; i < facets.rows(); ++i) {
      const auto& [a, b] = kTriangleEdges[i - 3];
      if (!IsInTheMiddle(mesh, facets(i, facet), facets(a, facet),
                         facets(b, facet))) {
        Fail("node " + std::to_string(facets(i, facet)) + " of facet " +
             std::to_string(facet) + " of " + what +
             " is not in the middle of its edge; order the nodes as VTK does");
      }
    }
  }
}

// One overload per kind of load.
struct LoadValidator {
  const Mesh& mesh;
  std::string where;  // "load 1 of load case 2"

  void operator()(const NodalForces& load) const {
    RequireColumns(load.force.cols(), mesh, "the force in " + where);
    RequireFinite(load.force, "the force in " + where);
  }
  void operator()(const BodyForce& load) const {
    if (!load.force_density.allFinite()) {
      Fail("the body force in " + where + " is not finite; correct it");
    }
    RequireMagnitude(load.force_density.cwiseAbs().maxCoeff(),
                     "the body force in " + where);
  }
  void operator()(const Traction& load) const {
    ValidateFacets(mesh, load.facets, "the traction in " + where);
    if (!load.traction.allFinite()) {
      Fail("the traction in " + where + " is not finite; correct it");
    }
    RequireMagnitude(load.traction.cwiseAbs().maxCoeff(),
                     "the traction in " + where);
  }
  void operator()(const Pressure& load) const {
    ValidateFacets(mesh, load.facets, "the pressure in " + where);
    if (!std::isfinite(load.pressure)) {
      Fail("the pressure in " + where + " is not finite; correct it");
    }
    RequireMagnitude(std::abs(load.pressure), "the pressure in " + where);
  }
};

void ValidateMeasurement(const Mesh& mesh, const LoadCase& load_case,
                         const std::string& name) {
  if (load_case.observed.size() != 0) {
    RequireColumns(load_case.observed.cols(), mesh,
                   "the mask of observed components of " + name);
  }
  if (load_case.noise_sd &&
      !(std::isfinite(*load_case.noise_sd) && *load_case.noise_sd > 0)) {
    Fail("the noise standard deviation of " + name + " is " +
         std::to_string(*load_case.noise_sd) + "; it must be positive");
  }
  RequireMagnitude(load_case.noise_sd.value_or(0),
                   "the noise standard deviation of " + name);
  if (load_case.displacement.size() == 0) {
    return;
  }
  RequireColumns(load_case.displacement.cols(), mesh,
                 "the measured displacement of " + name);
  double largest = 0;
  for (Eigen::Index node = 0; node < mesh.NumNodes(); ++node) {
    for (int i = 0; i < 3; ++i) {
      const bool observed =
          load_case.observed.size() == 0 || load_case.observed(i, node);
      if (!observed) {
        continue;
      }
      const double value = load_case.displacement(i, node);
      largest = std::max(largest, std::abs(value));
      if (!std::isfinite(value)) {
        Fail("the measured displacement of node " + std::to_string(node) +
             " (" + kAxis[i] + ") in " + name +
             " is not finite; correct it or mark it as not observed");
      }
    }
  }
  RequireMagnitude(largest, "the measured displacement of " + name);
}

// The part of the mesh that each node belongs to: nodes connected by elements
// have the same label, the smallest node index of the part.
std::vector<int> ConnectedParts(const Mesh& mesh) {
  std::vector<int> parent(mesh.NumNodes());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&parent](int node) {
    while (parent[node] != node) {
      parent[node] = parent[parent[node]];
      node = parent[node];
    }
    return node;
  };
  for (Eigen::Index element = 0; element < mesh.NumElements(); ++element) {
    int first = root(mesh.elements(0, element));
    for (Eigen::Index i = 1; i < mesh.elements.rows(); ++i) {
      const int other = root(mesh.elements(i, element));
      parent[std::max(first, other)] = std::min(first, other);
      first = std::min(first, other);
    }
  }
  for (int node = 0; node < mesh.NumNodes(); ++node) {
    parent[node] = root(node);
  }
  return parent;
}

// Coefficients of the six rigid motions (translations, then rotations about
// axes through the part's centroid) in the displacement of one component.
Eigen::Matrix<double, 1, 6> RigidMotionRow(const Eigen::Vector3d& arm,
                                           int component) {
  Eigen::Matrix<double, 1, 6> row = Eigen::Matrix<double, 1, 6>::Zero();
  row(component) = 1;
  for (int axis = 0; axis < 3; ++axis) {
    row(3 + axis) = Eigen::Vector3d::Unit(axis).cross(arm)(component);
  }
  return row;
}

// Of the directions that the orthonormal columns of `span` span, the one
// closest to an axis: "x", or "(0.6, 0.8, 0)".
std::string DescribeDirection(const Eigen::Matrix3Xd& span) {
  const Eigen::Matrix3d projection = span * span.transpose();
  Eigen::Index axis = 0;
  projection.diagonal().maxCoeff(&axis);
  const Eigen::Vector3d direction = projection.col(axis).normalized();
  if (direction(axis) > 0.9999) {
    return kAxis[axis];
  }
  std::ostringstream text;
  text << std::setprecision(2);
  for (int i = 0; i < 3; ++i) {
    text << (i == 0 ? "(" : ", ")
         << (std::abs(direction(i)) < 0.005 ? 0.0 : direction(i));
  }
  text << ")";
  return text.str();
}

// One of the rigid motions that the orthonormal columns span; a translation if
// there is one, since any rotation about an axis off the centroid moves that
// too.
std::string DescribeRigidMotion(const Eigen::Matrix<double, 6, -1>& motions) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> rotations(
      motions.bottomRows<3>(), Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Index rank = (rotations.singularValues().array() > 1e-5).count();
  if (rank < motions.cols()) {
    return "move along " + DescribeDirection(motions.topRows<3>() *
                                             rotations.matrixV().rightCols(
                                                 motions.cols() - rank));
  }
  return "rotate about " +
         DescribeDirection(rotations.matrixU().leftCols(rank));
}

}  // namespace

void ValidateScene(const Scene& scene) {
  ValidateMesh(scene.mesh);
  ValidateSupports(scene.mesh, scene.supports);
  if (scene.load_cases.empty()) {
    Fail("the scene has no load case; give at least one");
  }
  for (std::size_t i = 0; i < scene.load_cases.size(); ++i) {
    const LoadCase& load_case = scene.load_cases[i];
    for (std::size_t k = 0; k < load_case.loads.size(); ++k) {
      const std::string where =
          "load " + std::to_string(k + 1) + " of " + CaseName(i);
      std::visit(LoadValidator{scene.mesh, where}, load_case.loads[k]);
    }
  }
  ValidateMeasurements(scene);
}

void ValidateMeasurements(const Scene& scene) {
  for (std::size_t i = 0; i < scene.load_cases.size(); ++i) {
    ValidateMeasurement(scene.mesh, scene.load_cases[i], CaseName(i));
  }
}

std::string WhyNotHeld(const Mesh& mesh, const Supports& supports) {
  struct Part {
    Eigen::Index num_nodes = 0;
    Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
    double radius = 0;
    Eigen::Matrix<double, 6, 6> gram = Eigen::Matrix<double, 6, 6>::Zero();
  };
  const std::vector<int> label = ConnectedParts(mesh);
  std::vector<Part> parts(mesh.NumNodes());
  for (int node = 0; node < mesh.NumNodes(); ++node) {
    Part& part = parts[label[node]];
    ++part.num_nodes;
    part.centroid += mesh.nodes.col(node);
  }
  for (Part& part : parts) {
    part.centroid /= std::max<double>(part.num_nodes, 1);
  }
  for (int node = 0; node < mesh.NumNodes(); ++node) {
    Part& part = parts[label[node]];
    part.radius =
        std::max(part.radius, (mesh.nodes.col(node) - part.centroid).norm());
  }
  for (int node = 0; node < mesh.NumNodes(); ++node) {
    Part& part = parts[label[node]];
    const Eigen::Vector3d arm =
        (mesh.nodes.col(node) - part.centroid) / part.radius;
    for (int i = 0; i < 3; ++i) {
      if (supports.held(i, node)) {
        const Eigen::Matrix<double, 1, 6> row = RigidMotionRow(arm, i);
        part.gram += row.transpose() * row;
      }
    }
  }
  for (int node = 0; node < mesh.NumNodes(); ++node) {
    if (parts[node].num_nodes == 0) {
      continue;
    }
    // Squares of lever arms below 1e-6 of the part's radius hold nothing.
    const Eigen::JacobiSVD<Eigen::Matrix<double, 6, 6>> svd(
        parts[node].gram, Eigen::ComputeFullV);
    const Eigen::Index num_free =
        (svd.singularValues().array() < 1e-12).count();
    if (num_free > 0) {
      return "the supports let the part of the mesh around node " +
             std::to_string(node) + " " +
             DescribeRigidMotion(svd.matrixV().rightCols(num_free)) +
             " without strain; hold more components";
    }
  }
  return "";
}

}  // namespace elastimate
