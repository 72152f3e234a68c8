#include "python/given_mesh.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>
#include <variant>

#include "elastimate/core/mesh/facets.h"
#include "elastimate/core/mesh/mesh.h"
#include "elastimate/io/mesh/mesh_file_check.h"
#include "elastimate/io/mesh/simplices.h"
#include "elastimate/io/mesh/surface_facets.h"

namespace elastimate {
namespace {

MeshFile Checked(VtkCells cells) {
  MeshFile file = ToMeshFile("mesh", std::move(cells));
  CheckMeshFile(file);
  return file;
}

Mesh AllNodes(const MeshFile& file) {
  return {
      file.kind, {}, file.nodes.topRows(file.Dimension()), file.elements, {}};
}

}  // namespace

GivenMesh::GivenMesh(VtkCells cells)
    : num_cells_(Eigen::Index(cells.types.size())),
      file_(Checked(std::move(cells))),
      nodes_(file_, AllNodes(file_)),
      cell_of_element_(FindArray(file_.element_arrays, "cell")
                           ->row(0)
                           .transpose()
                           .cast<int>()) {}

void GivenMesh::RequireUsed(int node, const std::string& of) const {
  if (node < 0 || node >= file_.nodes.cols() || !file_.used[node]) {
    throw std::invalid_argument(
        of + " names node " + std::to_string(node) +
        ", which no element uses; give numbers of nodes of the mesh");
  }
}

void GivenMesh::CompleteFacets(Eigen::MatrixXi& facets) const {
  for (const int node : facets.reshaped()) {
    RequireUsed(node, "a facet of a load");
  }
  constexpr Eigen::Index kQuadrilateral = 4;
  const bool is_linear = file_.kind == ElementKind::kTet4;
  if ((!is_linear && file_.kind != ElementKind::kTet10) ||
      facets.rows() == file_.Topology().NumNodesOfFace()) {
    return;
  }
  std::vector<std::vector<int>> parts;
  for (const auto& facet : facets.colwise()) {
    const auto vertices = facet.head(std::min(facets.rows(), kQuadrilateral));
    for (std::vector<int>& part :
         CutFace(std::vector<int>(vertices.begin(), vertices.end()))) {
      parts.push_back(std::move(part));
    }
  }
  facets.resize(file_.Topology().NumVerticesOfFace(),
                Eigen::Index(parts.size()));
  for (std::size_t i = 0; i < parts.size(); ++i) {
    std::copy(parts[i].begin(), parts[i].end(),
              facets.col(Eigen::Index(i)).begin());
  }
  if (!is_linear) {
    facets = WithMiddles(facets);
  }
}

Eigen::MatrixXi GivenMesh::WithMiddles(const Eigen::MatrixXi& triangles) const {
  const Eigen::MatrixXi boundary = BoundaryFacets(AllNodes(file_));
  const SurfaceFacets surface(boundary, 3);
  Eigen::MatrixXi facets(boundary.rows(), triangles.cols());
  for (Eigen::Index i = 0; i < triangles.cols(); ++i) {
    const auto vertices = triangles.col(i);
    const Eigen::Index place = surface.Find(vertices);
    if (place < 0) {
      throw std::invalid_argument(
          "a facet of a load has the corners " + std::to_string(vertices(0)) +
          ", " + std::to_string(vertices(1)) + " and " +
          std::to_string(vertices(2)) +
          ", which is no face on the surface of the mesh; give faces of it, or "
          "a Box");
    }
    facets.col(i) = boundary.col(place);
  }
  return facets;
}

void GivenMesh::Complete(LoadCase& load_case) const {
  for (Load& load : load_case.loads) {
    if (auto* const forces = std::get_if<NodalForces>(&load)) {
      forces->force = WithAddedNodes(forces->force);
    } else if (auto* const traction = std::get_if<Traction>(&load)) {
      CompleteFacets(traction->facets);
    } else if (auto* const pressure = std::get_if<Pressure>(&load)) {
      CompleteFacets(pressure->facets);
    } else if (auto* const force = std::get_if<SurfaceForce>(&load)) {
      CompleteFacets(force->facets);
    }
  }
  for (const Resultant& resultant : load_case.resultants) {
    for (const int node : resultant.nodes) {
      RequireUsed(node, "a resultant");
    }
  }
  if (load_case.displacement.size() > 0) {
    load_case.displacement = WithAddedNodes(load_case.displacement);
  }
  if (load_case.observed.size() > 0) {
    load_case.observed = WithAddedNodes(load_case.observed);
  } else if (!file_.added.empty() && load_case.points.points.Size() == 0) {
    load_case.observed = WithAddedNodes<ComponentMask>(
        ComponentMask::Constant(file_.Dimension(), NumPoints(), true));
  }
}

void GivenMesh::Complete(Supports& supports) const {
  supports.held = WithAddedNodes(supports.held);
  FlagAddedNodes(file_, supports.held);
  supports.displacement = WithAddedNodes(supports.displacement);
  Eigen::Index column = NumPoints();
  for (const AddedNode& added : file_.added) {
    supports.displacement.col(column++) =
        ValuesAt(added, supports.displacement);
  }
}

Scene GivenMesh::Finished(Scene scene) const {
  scene = nodes_.Filter(std::move(scene));
  try {
    ValidateScene(scene);
  } catch (const InvalidElement& error) {
    if (file_.element_numbers.empty()) {
      throw;
    }
    throw std::invalid_argument(std::string(error.what()) + "; it is " +
                                ElementName(file_, error.Element()));
  }
  for (const LoadCase& load_case : scene.load_cases) {
    if (file_.is_cut && scene.origin != Origin::kMeasured &&
        IsMeasured(load_case)) {
      throw std::invalid_argument(
          "origin is \"computed\", but the cells of the mesh were cut into " +
          file_.Shapes() +
          ", so that other elements computed the displacements; leave origin "
          "out");
    }
  }
  return scene;
}

Eigen::MatrixXd GivenMesh::ToScene(const Eigen::MatrixXd& of_points) const {
  // Another size is for the check of a measurement to refuse.
  if (of_points.cols() != NumPoints()) {
    return of_points;
  }
  Eigen::MatrixXd of_nodes = WithAddedNodes(of_points);
  nodes_.KeepColumns(of_nodes);
  return of_nodes;
}

Eigen::MatrixXd GivenMesh::OfPoints(const Eigen::MatrixXd& of_scene) const {
  Eigen::MatrixXd of_points = Eigen::MatrixXd::Constant(
      of_scene.rows(), NumPoints(), std::numeric_limits<double>::quiet_NaN());
  for (Eigen::Index point = 0; point < NumPoints(); ++point) {
    if (const int node = nodes_.Positions()[point]; node >= 0) {
      of_points.col(point) = of_scene.col(node);
    }
  }
  return of_points;
}

}  // namespace elastimate
