#ifndef ELASTIMATE_IO_SCENE_SCENE_READER_H_
#define ELASTIMATE_IO_SCENE_SCENE_READER_H_

#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "elastimate/core/scene/scene.h"
#include "elastimate/io/dic/point_gaps.h"
#include "elastimate/io/scene/frame_series.h"
#include "elastimate/io/text/file_lines.h"

namespace elastimate {

/// A scene without measured displacements is wrong input if they are required.
enum class Measurement { kRequired, kOptional };

/// The section of a planar mesh, as far as it is known beside its files.
struct SectionChoice {
  std::optional<SectionModel> model;
  std::optional<double> thickness;  ///< [length], positive.
};

/// The choice of materials for the regions of a mesh.
enum class RegionChoice {
  kAsGiven,      ///< As in the scene.json, else one isotropic one.
  kOne,          ///< One isotropic one, whatever the scene says.
  kEach,         ///< An isotropic one for each region id.
  kGivenOrEach,  ///< As in the scene.json, else one for each region id.
};

/// The law of all materials of a scene.
struct LawChoice {
  std::string law;  ///< Empty: as given for each, else isotropic.
  /// Vectors of 3 components, or 2 in the plane.  Empty leaves axes as they are
  /// given.
  std::vector<Eigen::VectorXd> axes;
  /// Tells whether the axis is to be found, whatever axes are given.
  bool has_free_axis = false;
};

/// What is said of a scene beside its files.
struct SceneChoices {
  SectionChoice section;
  RegionChoice regions = RegionChoice::kAsGiven;
  LawChoice law;
  /// A parameter that is to vary between elements, as by "fields"; or empty.
  std::string field = {};
  /// Whether the camera lost the points of each of SceneReading::gaps, which
  /// then become nodes without a displacement.  Where this is empty, the
  /// specimen ends at the gaps.
  std::vector<bool> filled_gaps = {};
  /// Replaces what the files say of the displacements.
  std::optional<Origin> origin = {};
};

/// The nodes of a scene as its mesh file numbers them.
struct NumberedNodes {
  std::filesystem::path file;
  /// "Gmsh", "Abaqus" or "FEBio"; empty for a VTK file, whose points are
  /// counted from 0.
  std::string program;
  std::vector<std::size_t> numbers;  ///< One for each node of the scene.
};

/// A scene as read, and what the reader has to say about it.
struct SceneReading {
  Scene scene;
  /// Sentences for people: what was left out, and what may be meant in another
  /// way than it is read (forces per node, regions, nodes at one place).
  std::vector<std::string> notices;
  /// The nodes of the scene in the order of the file, in which results are
  /// written (VtuContent).  It is empty where the order is the same, which is
  /// everywhere but in a quadratic mesh with mid-edge nodes numbered before
  /// vertices.
  std::vector<int> file_order;
  /// Empty but where a scene.json has the key "frames".
  std::optional<FrameSeries> frames;
  /// The lines of the measurement of each load case, in the order of nodes or
  /// of points; empty where it is not text.
  std::vector<std::vector<FileLines>> measured_lines;
  NumberedNodes nodes;
  /// The cell arrays that the scene.json names as axes of materials, one column
  /// for each element, by name.
  std::map<std::string, Eigen::MatrixXd> axis_arrays;
  /// Gaps between the points of a camera, of which the scene.json does not say
  /// whether the specimen ends there.
  std::vector<PointGap> gaps;
};

/// Reads a scene from files whose arrays make it up (.vtu, .pvtu, .vtk, or .msh
/// with node data), or from a scene.json over a mesh file (these, .mesh, .unv,
/// .bdf, .inp, .feb); docs/scenes.md describes both.  Several files are
/// further load cases of one specimen: the same nodes (to a millionth of the
/// largest coordinate), cells, regions and supports.  A load case given twice
/// is an error: its noise would count as that of two measurements.
///
/// The elements are the cells of the highest dimension, which are of one
/// ElementKind.  Planar ones lie in a plane z = const and need a model and a
/// thickness: of `choices`, else of the scene.json, else of the field data of
/// the mesh file.  Their arrays have 2 components, or 3 of which the third is
/// zero.  The mid-edge nodes of quadratic elements are numbered after the
/// vertices in the scene, whatever the file does.
///
/// The array `prescribed` (optional) is the displacement at which
/// held components are held.  A node is known by its zero-based position among
/// all nodes of its file, also those without an element: in the order of the
/// points of a VTK file, by ascending node number in files of other formats.
/// That is what ids and CSV rows in a scene.json refer to, and what messages
/// name.
///
/// Elements that were cut into simplices as they were read (MeshFile::is_cut)
/// did not compute displacements, so that these have to be measured there.
///
/// The scene returned is valid (ValidateScene).  Throws std::invalid_argument
/// with one sentence that names the file and the array, key, node or element
/// for anything wrong with the input, std::bad_alloc where memory is lacking,
/// and std::runtime_error when a helper program of the package is not there.
///
/// For concurrent calls.  What Gmsh and VTK's reader of .vtk files parse, and
/// may crash on, is read in a child process; .vtu files are read by one thread
/// after the other.
SceneReading ReadScene(const std::vector<std::filesystem::path>& paths,
                       Measurement measurement,
                       const SceneChoices& choices = {});

}  // namespace elastimate

#endif  // ELASTIMATE_IO_SCENE_SCENE_READER_H_
