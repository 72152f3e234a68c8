#ifndef ELASTIMATE_IO_SCENE_SCENE_NODES_H_
#define ELASTIMATE_IO_SCENE_SCENE_NODES_H_

#include <Eigen/Core>
#include <string>
#include <vector>

#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/scene/scene.h"
#include "elastimate/io/mesh/mesh_file.h"
#include "elastimate/io/scene/frame_series.h"
#include "elastimate/io/scene/scene_reader.h"
#include "elastimate/io/text/file_lines.h"

namespace elastimate {

/// Turns a scene over all nodes of its mesh file into one of the nodes that
/// elements use, in their order but for the nodes in the middle of edges, faces
/// and elements, which come after all vertices (Mesh::elements).
class SceneNodes {
 public:
  /// `mesh` is that of the scene, over all nodes of `file`.
  SceneNodes(const MeshFile& file, const Mesh& mesh);

  /// Counts the nodes that no element uses, also those that Gmsh left out.
  Eigen::Index NumDropped() const { return num_dropped_; }
  /// Tells whether the scene has all nodes, in their order in the file.
  bool AreThoseOfFile() const { return are_those_of_file_; }

  /// Returns the kept nodes as they are numbered now, in their order in the
  /// file; empty where that order is the same.
  std::vector<int> FileOrder() const;

  Scene Filter(Scene scene) const;
  /// Keeps the lines of the kept nodes of a measurement of all nodes.
  FileLines Filter(const FileLines& all) const;
  /// Filters the frames as they are read.
  FrameSeries Filter(FrameSeries frames) const;
  /// Keeps the columns of the kept nodes, of which a matrix has one for each
  /// node of the file, or none.
  template <typename Columns>
  void KeepColumns(Columns& columns) const {
    if (columns.size() > 0) {
      columns = Columns(columns(Eigen::all, kept_));
    }
  }

  /// Returns the numbers of the kept nodes in the file.
  NumberedNodes Numbered(const MeshFile& mesh) const;
  /// Returns sentences for people about what is read in another way than the
  /// file has it (MeshFile::notices), about nodes that were put into the middle
  /// of their edges, and about nodes that are left out.
  std::vector<std::string> Notices(const MeshFile& mesh) const;

  /// Returns the number in the scene of each node of the file; -1 for those
  /// that no element uses.
  const std::vector<int>& Positions() const { return position_; }

 private:
  void FilterLoadCase(LoadCase& load_case) const;
  void FilterSupports(Supports& supports) const;
  void FilterLoad(NodalForces& load) const { KeepColumns(load.force); }
  void FilterLoad(BodyForce& /*load*/) const {}
  void FilterLoad(Traction& load) const { Renumber(load.facets); }
  void FilterLoad(Pressure& load) const { Renumber(load.facets); }
  void FilterLoad(SurfaceForce& load) const { Renumber(load.facets); }
  void Renumber(Eigen::MatrixXi& nodes) const;
  /// Leaves out nodes that no element uses, which may have been selected all
  /// the same.
  void Renumber(std::vector<int>& nodes) const;

  std::vector<int> position_;
  std::vector<Eigen::Index> kept_;
  Eigen::Index num_dropped_;
  bool are_those_of_file_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_IO_SCENE_SCENE_NODES_H_
