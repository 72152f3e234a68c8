#ifndef ELASTIMATE_IO_SCENE_FILE_SCENE_H_
#define ELASTIMATE_IO_SCENE_FILE_SCENE_H_

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "elastimate/core/scene/scene.h"
#include "elastimate/io/dic/point_gaps.h"
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
  PointGaps gaps;  ///< Of a mesh of measured points.
  /// The lines of the measurement of each load case, in the order of nodes or
  /// of points; empty where it is not text.
  std::vector<std::vector<FileLines>> measured_lines;
  /// The cell arrays from which materials have axes.
  std::map<std::string, Eigen::MatrixXd> axis_arrays;
};

/// Returns the regions from the cell array MeshFile::region_array; empty when
/// there is none.  Throws std::invalid_argument, naming the file, when it is
/// not one of integers.
Eigen::VectorXi ReadRegions(const MeshFile& mesh);

/// Returns the mesh of a scene over all nodes of the file.  `elements` are
/// those of the file, which may be moved from it.
Mesh SceneMesh(const MeshFile& mesh, const Section& section,
               Eigen::MatrixXi elements);

/// Returns the vectors of a field of the file, dimension x num_nodes.  `values`
/// have 3 rows, or 2 for planar elements.  Throws std::invalid_argument, "FILE:
/// WHAT of node 7 (x) is nan; MEND", unless they are finite where `mask`
/// (dimension x num_nodes) is set and an element uses the node.  Throws as well
/// unless the third row of planar elements is zero where any component of the
/// node counts.
Eigen::MatrixXd VectorField(const std::filesystem::path& file,
                            const std::string& what, const MeshFile& mesh,
                            const Eigen::MatrixXd& values,
                            const ComponentMask& mask,
                            const std::string& mend = "correct it");

/// Returns a flag that is set for each component of each node but the added
/// ones, for which a file has no values.
ComponentMask AllComponents(const MeshFile& mesh);

/// Returns one flag per component from one number per node or one per
/// component.  Flags are set where numbers are not zero; a third component of
/// planar elements does not count.  Throws std::invalid_argument, naming the
/// file, for nan.
ComponentMask ToComponentMask(const std::filesystem::path& file,
                              const std::string& what, const MeshFile& mesh,
                              const Eigen::MatrixXd& values);

/// Marks the added nodes of a mesh, where it has some, as not observed.
void MarkObserved(const MeshFile& mesh, LoadCase& load_case);

/// Sets what was not observed to zero where it is NaN.
void ClearUnobserved(LoadCase& load_case);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_SCENE_FILE_SCENE_H_
