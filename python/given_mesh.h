#ifndef ELASTIMATE_PYTHON_GIVEN_MESH_H_
#define ELASTIMATE_PYTHON_GIVEN_MESH_H_

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "elastimate/core/scene/scene.h"
#include "elastimate/io/mesh/mesh_file.h"
#include "elastimate/io/scene/scene_nodes.h"
#include "elastimate/io/vtk/vtk_cells.h"

namespace elastimate {

/// A mesh as a caller gave it.  It is read as a file of these cells is: cells
/// of several kinds are cut into simplices, which may add nodes behind the
/// points, and the scene has its nodes in an order of its own, without those
/// that no element uses.
class GivenMesh {
 public:
  /// Throws std::invalid_argument, with a sentence about "mesh", for cells that
  /// a file may not have.
  explicit GivenMesh(VtkCells cells);

  const MeshFile& File() const { return file_; }
  /// dimension x (points and added nodes).
  Eigen::MatrixXd Nodes() const {
    return file_.nodes.topRows(file_.Dimension());
  }
  Eigen::Index NumPoints() const {
    return file_.nodes.cols() - Eigen::Index(file_.added.size());
  }
  Eigen::Index NumCells() const { return num_cells_; }
  /// Returns the place among all cells of the cell of each element.
  const Eigen::VectorXi& CellOfElement() const { return cell_of_element_; }
  /// Tells whether the scene has the points as its nodes, in their order.
  bool IsScene() const {
    return nodes_.AreThoseOfFile() && file_.added.empty();
  }

  /// Returns one column for each node from one for each point: those of added
  /// nodes are zero.
  template <typename Columns>
  Columns WithAddedNodes(const Columns& of_points) const {
    Columns all = Columns::Zero(of_points.rows(), file_.nodes.cols());
    all.leftCols(of_points.cols()) = of_points;
    return all;
  }

  /// Completes a load case over all nodes, whose arrays have one column for
  /// each point.  Quadrilateral facets, with or without middle nodes, are cut
  /// into triangles as the cells are; on quadratic meshes these get the middle
  /// nodes of the elements.  Throws std::invalid_argument for a load or a
  /// resultant on a node that no element uses and, on a quadratic mesh, for a
  /// cut facet that is no face of the surface.
  void Complete(LoadCase& load_case) const;
  /// Completes supports in the same way: an added node is held where all nodes
  /// around it are.
  void Complete(Supports& supports) const;

  /// Returns the scene of the nodes that elements use.  Throws
  /// std::invalid_argument unless it is valid, and where it says that cells
  /// which were cut computed its displacements.
  Scene Finished(Scene scene) const;
  std::vector<std::string> Notices() const { return nodes_.Notices(file_); }

  /// Returns one column for each node of the scene from one for each point.
  Eigen::MatrixXd ToScene(const Eigen::MatrixXd& of_points) const;
  /// Returns one column for each point from one for each node of the scene; NaN
  /// for points that no element uses.
  Eigen::MatrixXd OfPoints(const Eigen::MatrixXd& of_scene) const;

 private:
  void CompleteFacets(Eigen::MatrixXi& facets) const;
  /// Returns the faces on the surface of a mesh of quadratic tetrahedra that
  /// have these vertices.
  Eigen::MatrixXi WithMiddles(const Eigen::MatrixXi& triangles) const;
  void RequireUsed(int node, const std::string& of) const;

  Eigen::Index num_cells_;
  MeshFile file_;
  SceneNodes nodes_;
  Eigen::VectorXi cell_of_element_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_PYTHON_GIVEN_MESH_H_
