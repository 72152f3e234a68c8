#include "elastimate/core/scene/scene_builder.h"

#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "elastimate/core/mesh/axis_names.h"

namespace elastimate {
namespace {

std::string PositionText(const Eigen::VectorXd& position) {
  std::ostringstream text;
  for (Eigen::Index i = 0; i < position.size(); ++i) {
    text << (i == 0 ? "(" : ", ") << position(i);
  }
  text << ")";
  return text.str();
}

std::string ExtentText(const Mesh& mesh) {
  return "the nodes lie between " +
         PositionText(mesh.nodes.rowwise().minCoeff()) + " and " +
         PositionText(mesh.nodes.rowwise().maxCoeff());
}

// A box of space with its name in messages.
struct NamedBox {
  HeldBox box;  // A little larger than the one that was given.
  std::string name;
};

void RequireSize(Eigen::Index size, const Mesh& mesh, const std::string& what) {
  if (size != mesh.Dimension()) {
    throw std::invalid_argument(what + " has " + std::to_string(size) +
                                " components; give " +
                                std::to_string(mesh.Dimension()));
  }
}

NamedBox MakeBox(const Mesh& mesh, const Eigen::VectorXd& lower,
                 const Eigen::VectorXd& upper) {
  RequireSize(lower.size(), mesh, "the lower corner of the box");
  RequireSize(upper.size(), mesh, "the upper corner of the box");
  const std::string name =
      "the box from " + PositionText(lower) + " to " + PositionText(upper);
  constexpr double kTolerance = 1e-9;
  const double margin = kTolerance * (mesh.nodes.rowwise().maxCoeff() -
                                      mesh.nodes.rowwise().minCoeff())
                                         .maxCoeff();
  HeldBox box;
  box.lower = lower.array() - margin;
  box.upper = upper.array() + margin;
  return {box, name};
}

NamedBox MakeOrderedBox(const Mesh& mesh, const Eigen::VectorXd& lower,
                        const Eigen::VectorXd& upper) {
  NamedBox box = MakeBox(mesh, lower, upper);
  if (!(lower.array() <= upper.array()).all()) {
    throw std::invalid_argument(box.name +
                                " is empty; give a lower corner that is below "
                                "the upper one in each direction");
  }
  return box;
}

}  // namespace

Mesh MakeMesh(ElementKind kind, const double* coordinates,
              Eigen::Index num_nodes, const int* connectivity,
              Eigen::Index num_elements) {
  if (coordinates == nullptr || connectivity == nullptr) {
    throw std::invalid_argument(
        "the coordinates or the connectivity of the mesh are a null pointer; "
        "give both arrays");
  }
  if (num_nodes < 1 || num_elements < 1) {
    throw std::invalid_argument("the mesh has " + std::to_string(num_nodes) +
                                " nodes and " + std::to_string(num_elements) +
                                " elements; give one of each at least");
  }
  Mesh mesh;
  mesh.kind = kind;
  if (mesh.Dimension() == 2) {
    mesh.section.model = SectionModel::kPlaneStrain;
  }
  mesh.nodes = Eigen::Map<const Eigen::MatrixXd>(coordinates, mesh.Dimension(),
                                                 num_nodes);
  mesh.elements = Eigen::Map<const Eigen::MatrixXi>(
      connectivity, mesh.Topology().num_nodes, num_elements);
  ValidateMesh(mesh);
  return mesh;
}

Scene UnsupportedScene(Mesh mesh) {
  Scene scene;
  scene.supports.held.setConstant(mesh.Dimension(), mesh.NumNodes(), false);
  scene.supports.displacement.setZero(mesh.Dimension(), mesh.NumNodes());
  scene.mesh = std::move(mesh);
  return scene;
}

Eigen::MatrixXi FacetsInBox(const Mesh& mesh, const Eigen::VectorXd& lower,
                            const Eigen::VectorXd& upper) {
  const HeldBox box = MakeBox(mesh, lower, upper).box;
  return BoundaryFacetsWhere(
      mesh, [&](int node) { return box.Contains(mesh.nodes.col(node)); });
}

Traction TractionInBox(const Mesh& mesh, const Eigen::VectorXd& lower,
                       const Eigen::VectorXd& upper,
                       const Eigen::VectorXd& traction) {
  RequireSize(traction.size(), mesh, "the traction");
  if (!traction.allFinite()) {
    throw std::invalid_argument("the traction is " + PositionText(traction) +
                                "; give finite numbers");
  }
  const std::string name = MakeOrderedBox(mesh, lower, upper).name;
  Eigen::MatrixXi facets = FacetsInBox(mesh, lower, upper);
  if (facets.cols() == 0) {
    throw std::invalid_argument(
        name + " holds no whole facet of the surface; " + ExtentText(mesh));
  }
  return {std::move(facets), traction};
}

void HoldInBox(const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
               Scene& scene) {
  const Eigen::Index dimension = scene.mesh.Dimension();
  HoldInBox(lower, upper,
            Eigen::Array<bool, Eigen::Dynamic, 1>::Constant(dimension, true),
            Eigen::VectorXd::Zero(dimension), scene);
}

void HoldInBox(const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
               const Eigen::Array<bool, Eigen::Dynamic, 1>& components,
               const Eigen::VectorXd& displacement, Scene& scene) {
  const Mesh& mesh = scene.mesh;
  RequireSize(components.size(), mesh, "the array of held components");
  RequireSize(displacement.size(), mesh, "the displacement of the support");
  if (!components.any() || !displacement.allFinite()) {
    throw std::invalid_argument(
        "the support holds no component, or one at a displacement that is not "
        "finite; name a component, and give finite numbers");
  }
  NamedBox held = MakeOrderedBox(mesh, lower, upper);
  held.box.components = components;
  held.box.displacement = displacement;
  Supports supports = scene.supports;
  bool is_any_inside = false;
  for (Eigen::Index node = 0; node < mesh.NumNodes(); ++node) {
    if (!held.box.Contains(mesh.nodes.col(node))) {
      continue;
    }
    is_any_inside = true;
    for (int i = 0; i < mesh.Dimension(); ++i) {
      if (!components(i)) {
        continue;
      }
      if (supports.held(i, node) &&
          !(supports.IsGiven(i, node) &&
            supports.displacement(i, node) == displacement(i))) {
        throw std::invalid_argument(
            held.name + " holds the " + std::string(kAxisNames[i]) +
            " component of node " + std::to_string(node) +
            ", which another support holds differently; make one of the two "
            "boxes smaller");
      }
      supports.held(i, node) = true;
      supports.displacement(i, node) = displacement(i);
    }
  }
  if (!is_any_inside) {
    throw std::invalid_argument(held.name + " holds no node; " +
                                ExtentText(mesh));
  }
  supports.boxes.push_back(std::move(held.box));
  scene.supports = std::move(supports);
}

}  // namespace elastimate
