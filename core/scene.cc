#include "elastimate/core/scene.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

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

void RequireFinite(const Eigen::Matrix3Xd& values, const std::string& what) {
  for (Eigen::Index node = 0; node < values.cols(); ++node) {
    if (!values.col(node).allFinite()) {
      Fail(what + " of node " + std::to_string(node) +
           " is not finite; correct it");
    }
  }
}

void ValidateSupports(const Mesh& mesh, const Supports& supports) {
  RequireColumns(supports.held.cols(), mesh, "the mask of held components");
  RequireColumns(supports.displacement.cols(), mesh,
                 "the displacement of the supports");
  RequireFinite(supports.displacement, "the displacement of the supports");
  if (supports.held.all()) {
    Fail("every degree of freedom is held; free the nodes that could move");
  }
}

void ValidateFacets(const Mesh& mesh, const Eigen::MatrixXi& facets,
                    const std::string& what) {
  if (facets.cols() == 0) {
    Fail(what + " acts on no facet; name a part of the surface");
  }
  if (facets.rows() != 3) {
    Fail(what + " has " + std::to_string(facets.rows()) +
         " nodes per facet; the facets of tetrahedra have 3");
  }
  for (Eigen::Index facet = 0; facet < facets.cols(); ++facet) {
    if (facets.col(facet).minCoeff() < 0 ||
        facets.col(facet).maxCoeff() >= mesh.NumNodes()) {
      Fail("facet " + std::to_string(facet) + " of " + what +
           " has a node index outside 0.." +
           std::to_string(mesh.NumNodes() - 1));
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
  }
  void operator()(const Traction& load) const {
    ValidateFacets(mesh, load.facets, "the traction in " + where);
    if (!load.traction.allFinite()) {
      Fail("the traction in " + where + " is not finite; correct it");
    }
  }
  void operator()(const Pressure& load) const {
    ValidateFacets(mesh, load.facets, "the pressure in " + where);
    if (!std::isfinite(load.pressure)) {
      Fail("the pressure in " + where + " is not finite; correct it");
    }
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
  if (load_case.displacement.size() == 0) {
    return;
  }
  RequireColumns(load_case.displacement.cols(), mesh,
                 "the measured displacement of " + name);
  for (Eigen::Index node = 0; node < mesh.NumNodes(); ++node) {
    for (int i = 0; i < 3; ++i) {
      const bool observed =
          load_case.observed.size() == 0 || load_case.observed(i, node);
      if (observed && !std::isfinite(load_case.displacement(i, node))) {
        Fail("the measured displacement of node " + std::to_string(node) +
             " (" + kAxis[i] + ") in " + name +
             " is not finite; correct it or mark it as not observed");
      }
    }
  }
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

std::string DescribeRigidMotion(const Eigen::Matrix<double, 6, 1>& motion) {
  Eigen::Index strongest = 0;
  motion.cwiseAbs().maxCoeff(&strongest);
  return strongest < 3 ? std::string("move along ") + kAxis[strongest]
                       : std::string("rotate about ") + kAxis[strongest - 3];
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
    ValidateMeasurement(scene.mesh, load_case, CaseName(i));
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
    if (svd.singularValues()(5) < 1e-12) {
      return "the supports let the part of the mesh around node " +
             std::to_string(node) + " " +
             DescribeRigidMotion(svd.matrixV().col(5)) +
             " without strain; hold more components";
    }
  }
  return "";
}

}  // namespace elastimate
