#ifndef ELASTIMATE_IO_SCENE_FILE_SCENE_H_
#define ELASTIMATE_IO_SCENE_FILE_SCENE_H_

#include <string>
#include <vector>

#include "elastimate/core/scene/scene.h"
#include "elastimate/io/mesh/mesh_file.h"

namespace elastimate {

/// A scene over all nodes of its mesh file, those without a tetrahedron
/// included, so that messages can name nodes as the file does.
struct FileScene {
  MeshFile mesh;  ///< Nodes and tetrahedra may have moved to the scene.
  Scene scene;
  std::vector<std::string> notices;
};

/// The regions from the cell array `region`; empty when there is none.  Throws
/// std::invalid_argument, naming the file, when it is not one of integers.
Eigen::VectorXi ReadRegions(const MeshFile& mesh);

/// Throws std::invalid_argument unless `values`, 3 x num_nodes, are finite
/// where `mask` says and a tetrahedron uses the node: "FILE: WHAT of node 7
/// (x) is nan; MEND".
void RequireFinite(const std::filesystem::path& file, const std::string& what,
                   const MeshFile& mesh, const Eigen::MatrixXd& values,
                   const ComponentMask& mask,
                   const std::string& mend = "correct it");

/// One flag per component from one or three numbers per node, set where they
/// are not zero.  Throws std::invalid_argument, naming the file, for nan.
ComponentMask ToComponentMask(const std::filesystem::path& file,
                              const std::string& what, const MeshFile& mesh,
                              const Eigen::MatrixXd& values);

/// Sets what was not observed to zero where it is not a number.
void ClearUnobserved(LoadCase& load_case);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_SCENE_FILE_SCENE_H_
