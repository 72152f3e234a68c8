#include <algorithm>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "apps/commands.h"
#include "apps/flags.h"
#include "apps/outputs.h"
#include "apps/progress.h"
#include "apps/section_flags.h"
#include "elastimate/core/mesh/mesh.h"
#include "elastimate/io/examples/example_scenes.h"
#include "elastimate/io/text/file_output.h"
#include "elastimate/io/vtk/vtu_writer.h"

namespace elastimate {
namespace {

// As many numbers as `Vector` has, separated by commas; `kind` names them.
template <typename Vector>
Vector Numbers(const std::string& flag, const std::string& value,
               const std::string& kind) {
  std::istringstream text(value);
  Vector numbers;
  bool is_read = true;
  for (Eigen::Index i = 0; i < numbers.size(); ++i) {
    char comma = ',';
    is_read = is_read && (i == 0 || bool(text >> comma)) && comma == ',' &&
              bool(text >> numbers(i));
  }
  if (!is_read || text.peek() != std::istringstream::traits_type::eof()) {
    const bool is_triple = numbers.size() == 3;
    throw std::invalid_argument(
        AsGiven(flag) + "; it needs " + (is_triple ? "three " : "two ") + kind +
        ", as in --" + flag + (is_triple ? "=1,2,3" : "=1,2"));
  }
  return numbers;
}

void RejectFlags(const std::string& geometry,
                 const std::vector<std::string>& flags) {
  const auto given = std::find_if(flags.begin(), flags.end(), IsGiven);
  if (given != flags.end()) {
    throw std::invalid_argument("generate " + geometry + " takes no flag --" +
                                *given + "; see elastimate --help");
  }
}

// The library's sentences begin with an option, which has the name of its flag.
template <typename Make>
Scene FlagsNamed(Make make) {
  try {
    return make();
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(std::string("--") + error.what());
  }
}

// That of --elements, or `otherwise` where it is not given.
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
                              "; it is tet4, hex8, tri3 or quad4");
}

Scene CuboidFromFlags() {
  CuboidOptions options;
  options.cells =
      Numbers<Eigen::Vector3i>("cells", FLAGS_cells, "integers below 2^31");
  options.size = Numbers<Eigen::Vector3d>("size", FLAGS_size, "finite numbers");
  if (IsGiven("force")) {
    options.force =
        Numbers<Eigen::Vector3d>("force", FLAGS_force, "finite numbers");
  }
  options.kind = KindFromFlag(options.kind);
  return FlagsNamed([&] { return CuboidScene(options); });
}

Scene RectangleFromFlags() {
  RectangleOptions options;
  if (IsGiven("cells")) {
    options.cells =
        Numbers<Eigen::Vector2i>("cells", FLAGS_cells, "integers below 2^31");
  }
  if (IsGiven("size")) {
    options.size =
        Numbers<Eigen::Vector2d>("size", FLAGS_size, "finite numbers");
  }
  if (IsGiven("force")) {
    options.force =
        Numbers<Eigen::Vector2d>("force", FLAGS_force, "finite numbers");
  }
  options.kind = KindFromFlag(options.kind);
  const SectionChoice section = SectionFromFlags();
  options.section.model = section.model.value_or(options.section.model);
  options.section.thickness =
      section.thickness.value_or(options.section.thickness);
  return FlagsNamed([&] { return RectangleScene(options); });
}

Scene OrganFromFlags() {
  OrganOptions options;
  options.tetrahedra = FLAGS_tetrahedra;
  options.length = FLAGS_length;
  if (IsGiven("force")) {
    options.force =
        Numbers<Eigen::Vector3d>("force", FLAGS_force, "finite numbers");
  }
  return FlagsNamed([&] { return OrganScene(options); });
}

Scene SceneFromFlags(const std::string& geometry) {
  if (geometry == "cuboid") {
    RejectFlags("cuboid", {"tetrahedra", "length", "model", "thickness"});
    return CuboidFromFlags();
  }
  if (geometry == "rectangle") {
    RejectFlags("rectangle", {"tetrahedra", "length"});
    return RectangleFromFlags();
  }
  RejectFlags("organ", {"cells", "size", "elements", "model", "thickness"});
  return OrganFromFlags();
}

}  // namespace

int RunGenerate(const std::vector<std::string>& arguments) {
  if (arguments.size() != 1 ||
      (arguments[0] != "cuboid" && arguments[0] != "organ" &&
       arguments[0] != "rectangle")) {
    throw std::invalid_argument(
        "generate needs one geometry, cuboid, organ or rectangle" +
        ButGot(arguments));
  }
  if (FLAGS_out.empty()) {
    throw std::invalid_argument("generate needs --out=FILE.vtu");
  }
  CheckOutputFlags({});
  std::optional<Progress> progress("meshing");
  const Scene scene = SceneFromFlags(arguments[0]);
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
