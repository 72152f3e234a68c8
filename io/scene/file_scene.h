#ifndef ELASTIMATE_IO_SCENE_FILE_SCENE_H_
#define ELASTIMATE_IO_SCENE_FILE_SCENE_H_

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "elastimate/core/scene/scene.h"
#include "elastimate/io/mesh/mesh_file.h"
#include "elastimate/io/scene/frame_series.h"
#include "elastimate/io/text/file_lines.h"

namespace elastimate {

/// A scene over all nodes of its mesh file, those without an element included,
/// in the order of the file, so that messages can name nodes as the file does.
struct FileScene {
  MeshFile mesh;  ///< Its elements may have moved to the scene.
  Scene scene;
  std::vector<std::string> notices;
  std::optional<FrameSeries> frames;
  /// Where the measurement of each load case stands, in the order of nodes or
  /// of points; empty where that is no text.
  std::vector<std::vector<FileLines>> measured_lines;
  /// The cell arrays that materials have axes from.
  std::map<std::string, Eigen::MatrixXd> axis_arrays;
};

/// The regions from the cell array MeshFile::region_array; empty when there is
/// none.  Throws
/// std::invalid_argument, naming the file, when it is not one of integers.
Eigen::VectorXi ReadRegions(const MeshFile& mesh);

/// The mesh of a scene over all nodes of the file.  `elements` are those of
/// the file, which may be moved from it.
Mesh SceneMesh(const MeshFile& mesh, const Section& section,
               Eigen::MatrixXi elements);

/// The vectors of a field of the file, dimension x num_nodes.  `values` have 3
/// rows, or 2 for planar elements.  Throws std::invalid_argument unless they
/// are finite where `mask`, dimension x num_nodes, says and an element uses the
/// node: "FILE: WHAT of node 7 (x) is nan; MEND"; and unless the third row of
/// planar ones is zero where any component of the node counts.
Eigen::MatrixXd VectorField(const std::filesystem::path& file,
                            const std::string& what, const MeshFile& mesh,
                            const Eigen::MatrixXd& values,
                            const ComponentMask& mask,
                            const std::string& mend = "correct it");

/// A flag that is set for each component of each node.
ComponentMask AllComponents(const MeshFile& mesh);

/// One flag per component from one number per node or one per component, set
/// where they are not zero; a third one of planar elements does not count.
/// Throws std::invalid_argument, naming the file, for nan.
ComponentMask ToComponentMask(const std::filesystem::path& file,
                              const std::string& what, const MeshFile& mesh,
                              const Eigen::MatrixXd& values);

/// Sets what was not observed to zero where it is not a number.
void ClearUnobserved(LoadCase& load_case);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_SCENE_FILE_SCENE_H_
