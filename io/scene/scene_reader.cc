#include "elastimate/io/scene/scene_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "elastimate/core/materials/free_axis_law.h"
#include "elastimate/core/materials/material_parameters.h"
#include "elastimate/core/materials/transversely_isotropic_law.h"
#include "elastimate/core/mesh/coincident_nodes.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/core/text/numbers.h"
#include "elastimate/io/mesh/mesh_file.h"
#include "elastimate/io/scene/array_scene.h"
#include "elastimate/io/scene/file_scene.h"
#include "elastimate/io/scene/json_materials.h"
#include "elastimate/io/scene/json_scene.h"
#include "elastimate/io/scene/mesh_reader.h"
#include "elastimate/io/scene/scene_nodes.h"
#include "elastimate/io/text/input_error.h"
#include "elastimate/io/text/printable.h"

namespace elastimate {
namespace {

/// Positions are the same to within this share of the largest coordinate, as
/// files in text keep fewer digits than other files of the same mesh.
constexpr double kSameLength = 1e-6;  // Of the largest coordinate.

bool AreClose(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return (a - b).cwiseAbs().maxCoeff() <= kSameLength * a.cwiseAbs().maxCoeff();
}

/// One region all over counts as none, because a mesh of Gmsh mostly has one
/// physical group.
bool AreSameRegions(const Eigen::VectorXi& a, const Eigen::VectorXi& b) {
  const auto is_one = [](const Eigen::VectorXi& regions) {
    return regions.size() == 0 || (regions.array() == regions(0)).all();
  };
  return (a.size() == b.size() && a == b) ||
         ((a.size() == 0 || b.size() == 0) && is_one(a) && is_one(b));
}

/// Tells what differs between the specimens of two scenes; empty when nothing
/// does.
std::string WhyDifferent(const Scene& first, const Scene& other,
                         RegionChoice regions) {
  const Mesh& mesh = first.mesh;
  if (mesh.kind != other.mesh.kind) {
    return "it is of kind " + std::string(other.mesh.Topology().name) +
           " instead of " + std::string(mesh.Topology().name);
  }
  if (mesh.section.model != other.mesh.section.model) {
    return "it is in " +
           std::string(SectionModelName(other.mesh.section.model)) +
           " instead of " + std::string(SectionModelName(mesh.section.model));
  }
  if (mesh.section.thickness != other.mesh.section.thickness) {
    return "its thickness differs";
  }
  if (mesh.NumNodes() != other.mesh.NumNodes()) {
    return "it has " + std::to_string(other.mesh.NumNodes()) +
           " nodes instead of " + std::to_string(mesh.NumNodes());
  }
  if (!AreClose(mesh.nodes, other.mesh.nodes)) {
    return "its nodes are at other positions";
  }
  if (mesh.elements.cols() != other.mesh.elements.cols() ||
      mesh.elements != other.mesh.elements) {
    return "its cells differ";
  }
  if (!AreSameRegions(mesh.regions, other.mesh.regions)) {
    return "its regions differ";
  }
  if ((regions == RegionChoice::kAsGiven ||
       regions == RegionChoice::kGivenOrEach) &&
      !other.materials.empty() && !(first.materials == other.materials)) {
    return "its materials differ";
  }
  if (first.is_rigid_motion_free != other.is_rigid_motion_free) {
    return "\"rigid_motion\" is free in one of them only";
  }
  return "";
}

bool AreSame(const ComponentMask& a, const ComponentMask& b) {
  return a.size() == b.size() && (a == b).all();
}

bool AreSame(const Supports& a, const Supports& b) {
  return AreSame(a.held, b.held) && AreSame(a.unknown, b.unknown) &&
         AreClose(a.displacement, b.displacement) &&
         std::equal(a.rigid_faces.begin(), a.rigid_faces.end(),
                    b.rigid_faces.begin(), b.rigid_faces.end(),
                    [](const RigidFace& one, const RigidFace& other) {
                      return one.nodes == other.nodes &&
                             (one.components == other.components).all();
                    });
}

void CheckObserved(const std::filesystem::path& path, const Scene& scene) {
  for (std::size_t i = 0; i < scene.load_cases.size(); ++i) {
    const LoadCase& load_case = scene.load_cases[i];
    if (load_case.observed.size() > 0 && !load_case.observed.any()) {
      ThrowInputError(path, "nothing is observed in load case " +
                                std::to_string(i + 1) +
                                "; mark what was measured");
    }
  }
}

/// Notes what of a mesh may be meant in another way than it is read.
/// `why_no_regions` is that of its file.
void NoteMesh(const std::filesystem::path& path,
              const std::string& why_no_regions, const Scene& scene,
              std::vector<std::string>& notices) {
  const Mesh& mesh = scene.mesh;
  if (!why_no_regions.empty()) {
    notices.push_back(PrintablePath(path) +
                      ": its groups of elements overlap (" + why_no_regions +
                      "), so that they are not the regions of materials");
  }
  const std::set<int> regions(mesh.regions.begin(), mesh.regions.end());
  if (regions.size() > 1 && scene.materials.empty()) {
    notices.push_back(PrintablePath(path) + ": the mesh has " +
                      std::to_string(regions.size()) +
                      " regions, but all regions share one material: E and nu "
                      "are those of the mesh as a whole; --regions=each gives "
                      "each its own");
  }
  const std::vector<std::array<int, 2>> coincident = CoincidentNodes(mesh);
  if (!coincident.empty()) {
    std::ostringstream first;
    for (const double x : mesh.nodes.col(coincident.front()[0])) {
      first << (first.tellp() == 0 ? "(" : ", ") << x;
    }
    first << ")";
    notices.push_back(
        PrintablePath(path) + ": " + Counted(coincident.size(), "node") +
        (coincident.size() == 1 ? " lies" : " lie") +
        " at the same place as another node, such as at " + first.str() +
        ", so that the parts around them are not connected; merge them in the "
        "mesh tool if the parts should be one");
  }
}

/// Whether these materials say more than which regions they fill.
bool SayMore(const std::vector<Material>& materials) {
  return std::any_of(
      materials.begin(), materials.end(), [](const Material& material) {
        return !(material == Material{"isotropic", material.regions, {}, {}});
      });
}

/// Throws where the materials of the scene, or the choice, need regions that
/// the mesh does not have.
void RequireRegions(const MeshFile& mesh, bool is_one_for_each,
                    const Scene& scene) {
  const bool is_one_named = std::any_of(
      scene.materials.begin(), scene.materials.end(),
      [](const Material& material) { return !material.regions.empty(); });
  if (scene.mesh.regions.size() != 0 || (!is_one_for_each && !is_one_named)) {
    return;
  }
  const std::string none =
      is_one_for_each
          ? "there are no regions that could have their own materials"
          : "materials name regions, but the mesh has none";
  if (!mesh.why_no_regions.empty()) {
    ThrowInputError(mesh.path,
                    none + ": " + mesh.why_no_regions +
                        "; put it into one (in .msh of versions 1 and 2 a "
                        "group is of whole elementary entities), or add the "
                        "element data \"region\"");
  }
  ThrowInputError(
      mesh.path,
      none + (mesh.is_vtk ? "; add the cell array 'region', or name another "
                            "by \"regions\": {\"array\": NAME} "
                            "in a scene.json"
              : !mesh.sets_of.empty()
                  ? "; make sets of elements that do not overlap"
                  : "; put the elements into physical "
                    "groups, or add the element data "
                    "\"region\""));
}

/// Gives the scene, which `path` describes, the materials that were chosen for
/// the regions of its mesh.
void ChooseMaterials(const std::filesystem::path& path, const MeshFile& mesh,
                     RegionChoice choice, Scene& scene,
                     std::vector<std::string>& notices) {
  const bool is_one = choice == RegionChoice::kOne;
  if ((is_one || choice == RegionChoice::kEach) && SayMore(scene.materials)) {
    notices.push_back(PrintablePath(path) +
                      ": the laws, axes, known parameters and bounds of its "
                      "materials are left out, because " +
                      (is_one ? "all regions share one isotropic material"
                              : "each region has an isotropic material of its "
                                "own"));
  }
  if (is_one) {
    scene.materials.clear();
    return;
  }
  const bool is_one_for_each =
      choice == RegionChoice::kEach ||
      (choice == RegionChoice::kGivenOrEach && scene.materials.empty());
  RequireRegions(mesh, is_one_for_each, scene);
  if (is_one_for_each) {
    scene.materials = IsotropicMaterialOfEachRegion(scene.mesh);
  }
}

/// Gives all materials of the scene the law and the axes that were chosen.
void ChooseLaw(const std::filesystem::path& path, const LawChoice& choice,
               Scene& scene) {
  if (choice.law.empty() && choice.axes.empty() && !choice.has_free_axis) {
    return;
  }
  if (scene.materials.empty()) {
    scene.materials.emplace_back();
  }
  const int dimension = scene.mesh.Dimension();
  for (Material& material : scene.materials) {
    material.law = choice.law.empty() ? material.law : choice.law;
    if (!choice.axes.empty() || choice.has_free_axis) {
      material.axes.clear();
    }
    if (!choice.axes.empty() && material.law == FreeAxisLaw::kName) {
      material.law = TransverselyIsotropicLaw::kName;
    }
    if (choice.has_free_axis) {
      const std::string free = LawOfFreeAxis(material.law);
      if (free.empty()) {
        ThrowInputError(path, "the axis is to be free, but the law is " +
                                  material.law + WhyNoFreeAxis());
      }
      material.law = free;
    }
    for (const Eigen::VectorXd& axis : choice.axes) {
      if (!IsInPlane(axis, dimension)) {
        ThrowInputError(path,
                        "the given axis is out of the plane of the mesh; make "
                        "its component z 0");
      }
      material.axes.emplace_back(
          axis.head(std::min<Eigen::Index>(axis.size(), dimension)));
    }
  }
}

/// Gives the scene the chosen origin, and throws where its elements cannot have
/// computed its displacements.
void ChooseOrigin(const std::filesystem::path& path, const MeshFile& mesh,
                  const std::optional<Origin>& choice, Scene& scene) {
  if (scene.origin == Origin::kComputedAtLargeStrains &&
      !HasLargeStrainLaw(scene.materials)) {
    scene.origin = Origin::kMeasured;
  }
  scene.origin = choice.value_or(scene.origin);
  const bool is_measured = std::any_of(
      scene.load_cases.begin(), scene.load_cases.end(),
      [](const LoadCase& load_case) { return IsMeasured(load_case); });
  if (mesh.is_cut && is_measured && scene.origin != Origin::kMeasured) {
    ThrowInputError(
        path,
        "its displacements are said to be computed by the elements of this "
        "scene, but the cells of '" +
            PrintablePath(mesh.path) + "' were cut into " + mesh.Shapes() +
            ", so that other elements computed them; give \"origin\": "
            "\"measured\" (--origin=measured)");
  }
}

/// Throws unless the scene is valid; says which element of the file is wrong.
void Validate(const std::filesystem::path& path, const MeshFile& mesh,
              bool numbers_differ, const Scene& scene) {
  std::string sentence;
  try {
    ValidateScene(scene);
    return;
  } catch (const InvalidElement& error) {
    sentence = error.what();
    if (const std::string name = ElementName(mesh, error.Element());
        !mesh.element_numbers.empty()) {
      sentence += "; it is " + name;
    }
  } catch (const std::invalid_argument& error) {
    sentence = error.what();
  }
  ThrowInputError(
      path, sentence + (numbers_differ ? " (counting only " + mesh.Shapes() +
                                             " and the nodes they use)"
                                       : ""));
}

/// Returns the valid scene without the nodes that no element uses, and their
/// order in the file.
Scene FinishScene(const std::filesystem::path& path, FileScene file_scene,
                  const SceneChoices& choices, SceneReading& reading,
                  std::vector<int>& file_order) {
  std::vector<std::string>& notices = reading.notices;
  const MeshFile& mesh = file_scene.mesh;
  notices.insert(notices.end(), file_scene.notices.begin(),
                 file_scene.notices.end());
  const SceneNodes nodes(mesh, file_scene.scene.mesh);
  for (const std::string& notice : nodes.Notices(mesh)) {
    notices.push_back(PrintablePath(mesh.path) + ": " + notice);
  }
  file_order = nodes.FileOrder();
  if (reading.nodes.numbers.empty()) {
    reading.nodes = nodes.Numbered(mesh);
  }
  Scene scene = nodes.Filter(std::move(file_scene.scene));
  for (LoadCase& load_case : scene.load_cases) {
    if (load_case.supports && AreSame(*load_case.supports, scene.supports)) {
      load_case.supports.reset();
    }
  }
  file_scene.measured_lines.resize(scene.load_cases.size());
  for (std::size_t k = 0; k < scene.load_cases.size(); ++k) {
    std::vector<FileLines>& lines = file_scene.measured_lines[k];
    if (!lines.empty() && scene.load_cases[k].displacement.size() != 0) {
      lines = {nodes.Filter(lines[0])};
    }
    reading.measured_lines.push_back(lines);
  }
  if (file_scene.frames) {
    reading.frames = nodes.Filter(*file_scene.frames);
  }
  ChooseMaterials(path, mesh, choices.regions, scene, notices);
  ChooseLaw(path, choices.law, scene);
  if (!choices.field.empty()) {
    GiveField(choices.field, scene.materials);
  }
  Validate(path, mesh, nodes.NumDropped() > 0 || mesh.has_other_cells, scene);
  ChooseOrigin(path, mesh, choices.origin, scene);
  CheckObserved(path, scene);
  return scene;
}

/// Throws for a path given twice: data counted twice would make the standard
/// errors too small.
void CheckPathsDiffer(const std::vector<std::filesystem::path>& paths) {
  for (std::size_t i = 0; i < paths.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      std::error_code error;
      if (std::filesystem::equivalent(paths[k], paths[i], error)) {
        ThrowInputError(paths[i], "this file is given twice, also as '" +
                                      PrintablePath(paths[k]) +
                                      "'; give each load case only once");
      }
    }
  }
}

// Compares points; two entries that are not numbers count as the same.
bool AreSamePoints(const PointDisplacements& a, const PointDisplacements& b) {
  return a.points.Size() == b.points.Size() &&
         a.points.elements == b.points.elements &&
         a.points.local == b.points.local &&
         ((a.displacement.array() == b.displacement.array()) ||
          (a.displacement.array().isNaN() && b.displacement.array().isNaN()))
             .all();
}

bool AreSameMeasurement(const Mesh& mesh, const LoadCase& a,
                        const LoadCase& b) {
  return IsMeasured(a) && a.displacement.size() == b.displacement.size() &&
         AreSamePoints(a.points, b.points) &&
         a.displacement == b.displacement &&
         a.observed.size() == b.observed.size() &&
         (a.observed == b.observed).all() &&
         AssembleLoads(mesh, a.loads) == AssembleLoads(mesh, b.loads);
}

/// The origin of each of the load cases that were read: "load case 1 of
/// 'first.vtu'".
using CaseNames = std::vector<std::string>;

/// Appends the load cases of `path` to the scene, each of which must be new.
void AddLoadCases(const std::filesystem::path& path,
                  std::vector<LoadCase> load_cases, Scene& scene,
                  CaseNames& names) {
  for (std::size_t i = 0; i < load_cases.size(); ++i) {
    const std::string number = std::to_string(i + 1);
    for (std::size_t k = 0; k < scene.load_cases.size(); ++k) {
      if (AreSameMeasurement(scene.mesh, scene.load_cases[k], load_cases[i])) {
        ThrowInputError(path, "load case " + number +
                                  " has the displacements and forces of " +
                                  names[k] + "; give each load case only once");
      }
    }
    names.push_back("load case " + number + " of '" + PrintablePath(path) +
                    "'");
    scene.load_cases.push_back(std::move(load_cases[i]));
  }
}

/// Gives these load cases the supports of the scene that they come from.
void KeepSupports(const Supports& supports, std::vector<LoadCase>& load_cases) {
  for (LoadCase& load_case : load_cases) {
    if (!load_case.supports) {
      load_case.supports = supports;
    }
  }
}

FileScene ReadFileScene(const std::filesystem::path& path,
                        Measurement measurement, const SceneChoices& choices) {
  return FileExtension(path) == ".json"
             ? ReadJsonScene(path, measurement, choices)
             : SceneFromArrays(ReadMeshFile(path), measurement,
                               choices.section);
}

}  // namespace

SceneReading ReadScene(const std::vector<std::filesystem::path>& paths,
                       Measurement measurement, const SceneChoices& choices) {
  if (paths.empty()) {
    throw std::invalid_argument("no scene file is given; name one");
  }
  CheckPathsDiffer(paths);
  SceneReading reading;
  CaseNames names;
  for (const std::filesystem::path& path : paths) {
    FileScene file_scene = ReadFileScene(path, measurement, choices);
    const std::filesystem::path mesh_path = file_scene.mesh.path;
    const std::string why_no_regions = file_scene.mesh.why_no_regions;
    if (&path == &paths.front()) {
      reading.axis_arrays = file_scene.axis_arrays;
      reading.gaps = file_scene.gaps.found;
    }
    std::vector<int> file_order;
    Scene scene =
        FinishScene(path, std::move(file_scene), choices, reading, file_order);
    if (reading.frames && paths.size() > 1) {
      ThrowInputError(path,
                      "a scene of several frames cannot be combined with other "
                      "files; leave these out, or the key \"frames\"");
    }
    std::vector<LoadCase> load_cases = std::move(scene.load_cases);
    const Origin origin = scene.origin;
    if (&path == &paths.front()) {
      NoteMesh(mesh_path, why_no_regions, scene, reading.notices);
      scene.load_cases.clear();
      reading.scene = std::move(scene);
      reading.file_order = std::move(file_order);
    } else if (const std::string difference =
                   WhyDifferent(reading.scene, scene, choices.regions);
               !difference.empty()) {
      ThrowInputError(path, "this is not a further load case of '" +
                                PrintablePath(paths.front()) + "', because " +
                                difference +
                                "; give files that differ in supports, loads "
                                "and measurements only");
    } else if (!AreSame(reading.scene.supports, scene.supports)) {
      KeepSupports(scene.supports, load_cases);
      reading.notices.push_back(
          PrintablePath(path) + " has other supports than " +
          PrintablePath(paths.front()) + "; each load case keeps its own");
    }
    if (origin != reading.scene.origin && &path != &paths.front()) {
      reading.scene.origin = Origin::kMeasured;
      reading.notices.push_back(
          "some of the files have computed displacements, others measured "
          "ones; all are taken as measured, unless --origin says otherwise");
    }
    AddLoadCases(path, std::move(load_cases), reading.scene, names);
  }
  return reading;
}

}  // namespace elastimate
