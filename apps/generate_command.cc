#include <algorithm>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "apps/commands.h"
#include "apps/flags.h"
#include "apps/number_list.h"
#include "apps/outputs.h"
#include "apps/progress.h"
#include "apps/section_flags.h"
#include "elastimate/core/mesh/mesh.h"
#include "elastimate/io/examples/example_scenes.h"
#include "elastimate/io/text/file_output.h"
#include "elastimate/io/vtk/vtu_writer.h"

namespace elastimate {
namespace {

void RejectFlags(const std::string& geometry,
                 const std::vector<std::string>& flags) {
  const auto given = std::find_if(flags.begin(), flags.end(), IsGiven);
  if (given != flags.end()) {
    throw std::invalid_argument("generate " + geometry + " takes no flag --" +
                                *given + "; see elastimate generate --help");
  }
}

// Names flags in the library's sentences, which begin with an option of the
// same name.
template <typename Make>
Scene FlagsNamed(Make make) {
  try {
    return make();
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(std::string("--") + error.what());
  }
}

// Returns the kind of --elements, or `otherwise` where it is not given.
ElementKind KindFromFlag(ElementKind otherwise) {
  if (!IsGiven("elements")) {
    return otherwise;
  }
  for (const ElementKind kind : kElementKinds) {
    if (TopologyOf(kind).name == FLAGS_elements) {
      return kind;
    }
  }
  throw std::invalid_argument(AsGiven("elements") +
                              "; it must be tet4, hex8, tri3 or quad4");
}

Scene CuboidFromFlags() {
  CuboidOptions options;
  options.cells =
      NumberList<Eigen::Vector3i>("cells", FLAGS_cells, "integers below 2^31");
  options.size =
      NumberList<Eigen::Vector3d>("size", FLAGS_size, "finite numbers");
  if (IsGiven("force")) {
    options.force =
        NumberList<Eigen::Vector3d>("force", FLAGS_force, "finite numbers");
  }
  options.kind = KindFromFlag(options.kind);
  return FlagsNamed([&] { return CuboidScene(options); });
}

void SetSectionFromFlags(Section& section) {
  const SectionChoice choice = SectionFromFlags();
  section.model = choice.model.value_or(section.model);
  section.thickness = choice.thickness.value_or(section.thickness);
}

Scene RectangleFromFlags() {
  RectangleOptions options;
  if (IsGiven("cells")) {
    options.cells = NumberList<Eigen::Vector2i>("cells", FLAGS_cells,
                                                "integers below 2^31");
  }
  if (IsGiven("size")) {
    options.size =
        NumberList<Eigen::Vector2d>("size", FLAGS_size, "finite numbers");
  }
  if (IsGiven("force")) {
    options.force =
        NumberList<Eigen::Vector2d>("force", FLAGS_force, "finite numbers");
  }
  options.kind = KindFromFlag(options.kind);
  SetSectionFromFlags(options.section);
  return FlagsNamed([&] { return RectangleScene(options); });
}

PlateEnds EndsFromFlags() {
  if (FLAGS_ends != "traction" && FLAGS_ends != "grips") {
    throw std::invalid_argument(AsGiven("ends") +
                                "; it must be traction or grips");
  }
  const bool has_grips = FLAGS_ends == "grips";
  const std::string other = has_grips ? "force" : "elongation";
  if (IsGiven(other)) {
    throw std::invalid_argument(
        AsGiven(other) + " is not for --ends=" + FLAGS_ends +
        (has_grips ? ", which move by --elongation; leave it out"
                   : "; leave it out, or give --ends=grips"));
  }
  return has_grips ? PlateEnds::kGrips : PlateEnds::kTraction;
}

Scene PlateFromFlags() {
  PlateOptions options;
  options.ends = EndsFromFlags();
  if (IsGiven("size")) {
    options.size =
        NumberList<Eigen::Vector2d>("size", FLAGS_size, "finite numbers");
  }
  if (IsGiven("hole")) {
    options.hole = FLAGS_hole;
  }
  if (IsGiven("cells")) {
    options.cells = NumberList<Eigen::Matrix<int, 1, 1>>(
        "cells", FLAGS_cells, "integer below 2^31")(0);
  }
  if (IsGiven("force")) {
    options.force = NumberList<Eigen::Matrix<double, 1, 1>>(
        "force", FLAGS_force, "finite number")(0);
  }
  if (IsGiven("elongation")) {
    options.elongation = FLAGS_elongation;
  }
  options.kind = KindFromFlag(options.kind);
  SetSectionFromFlags(options.section);
  return FlagsNamed([&] { return PlateScene(options); });
}

Scene OrganFromFlags() {
  OrganOptions options;
  options.tetrahedra = FLAGS_tetrahedra;
  options.length = FLAGS_length;
  if (IsGiven("force")) {
    options.force =
        NumberList<Eigen::Vector3d>("force", FLAGS_force, "finite numbers");
  }
  return FlagsNamed([&] { return OrganScene(options); });
}

/// A geometry that can be generated, and the flags that do not go with it.
struct Geometry {
  const char* name;
  Scene (*make)();
  std::vector<std::string> others;
};

const std::vector<Geometry>& Geometries() {
  static const std::vector<Geometry> geometries = {
      {"cuboid",
       CuboidFromFlags,
       {"tetrahedra", "length", "hole", "ends", "elongation", "model",
        "thickness"}},
      {"organ",
       OrganFromFlags,
       {"cells", "size", "elements", "hole", "ends", "elongation", "model",
        "thickness"}},
      {"plate", PlateFromFlags, {"tetrahedra", "length"}},
      {"rectangle",
       RectangleFromFlags,
       {"tetrahedra", "length", "hole", "ends", "elongation"}}};
  return geometries;
}

const Geometry& GeometryFromArguments(
    const std::vector<std::string>& arguments) {
  const auto found = std::find_if(
      Geometries().begin(), Geometries().end(), [&](const Geometry& geometry) {
        return arguments == std::vector<std::string>{geometry.name};
      });
  if (found == Geometries().end()) {
    throw std::invalid_argument(
        "generate needs one geometry, cuboid, organ, plate or rectangle" +
        ButGot(arguments));
  }
  return *found;
}

}  // namespace

int RunGenerate(const std::vector<std::string>& arguments) {
  const Geometry& geometry = GeometryFromArguments(arguments);
  if (FLAGS_out.empty()) {
    throw std::invalid_argument(
        "generate needs a file to write; give --out=FILE.vtu");
  }
  CheckOutputFlags({});
  std::optional<Progress> progress("meshing");
  RejectFlags(geometry.name, geometry.others);
  const Scene scene = geometry.make();
  StagedFiles files;
  files.Add(FLAGS_out, VtuContent(FLAGS_out, scene.mesh, SceneFields(scene)));
  progress.reset();
  constexpr double kDegreesPerRadian = 57.295779513082323;
  std::ostringstream text;
  text << scene.mesh.NumNodes() << " nodes, " << scene.mesh.NumElements() << " "
       << scene.mesh.Topology().ShapeName(scene.mesh.NumElements());
  if (scene.mesh.kind == ElementKind::kTet4) {
    text << ", smallest dihedral angle "
         << kDegreesPerRadian * SmallestDihedralAngles(scene.mesh).minCoeff()
         << " degrees";
  }
  text << "\n";
  WriteStandardOutput(text.str());
  files.Commit();
  return 0;
}

}  // namespace elastimate
