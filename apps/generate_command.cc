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
#include "elastimate/core/mesh/mesh.h"
#include "elastimate/io/examples/example_scenes.h"
#include "elastimate/io/text/file_output.h"
#include "elastimate/io/vtk/vtu_writer.h"

namespace elastimate {
namespace {

// Three numbers separated by commas; `kind` names them.
template <typename T>
Eigen::Matrix<T, 3, 1> Triple(const std::string& flag, const std::string& value,
                              const std::string& kind) {
  std::istringstream text(value);
  Eigen::Matrix<T, 3, 1> triple;
  char comma[2] = {};
  const bool read = bool(text >> triple(0) >> comma[0] >> triple(1) >>
                         comma[1] >> triple(2)) &&
                    comma[0] == ',' && comma[1] == ',' &&
                    text.peek() == std::istringstream::traits_type::eof();
  if (!read) {
    throw std::invalid_argument(AsGiven(flag) + "; it needs three " + kind +
                                ", as in --" + flag + "=1,2,3");
  }
  return triple;
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

Scene CuboidFromFlags() {
  CuboidOptions options;
  options.cells = Triple<int>("cells", FLAGS_cells, "integers below 2^31");
  options.size = Triple<double>("size", FLAGS_size, "finite numbers");
  if (IsGiven("force")) {
    options.force = Triple<double>("force", FLAGS_force, "finite numbers");
  }
  return FlagsNamed([&] { return CuboidScene(options); });
}

Scene OrganFromFlags() {
  OrganOptions options;
  options.tetrahedra = FLAGS_tetrahedra;
  options.length = FLAGS_length;
  if (IsGiven("force")) {
    options.force = Triple<double>("force", FLAGS_force, "finite numbers");
  }
  return FlagsNamed([&] { return OrganScene(options); });
}

Scene SceneFromFlags(const std::string& geometry) {
  if (geometry == "cuboid") {
    RejectFlags("cuboid", {"tetrahedra", "length"});
    return CuboidFromFlags();
  }
  RejectFlags("organ", {"cells", "size"});
  return OrganFromFlags();
}

}  // namespace

int RunGenerate(const std::vector<std::string>& arguments) {
  if (arguments.size() != 1 ||
      (arguments[0] != "cuboid" && arguments[0] != "organ")) {
    throw std::invalid_argument("generate needs one geometry, cuboid or organ" +
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
  text << scene.mesh.NumNodes() << " nodes, " << scene.mesh.NumElements()
       << " tetrahedra, smallest dihedral angle "
       << kDegreesPerRadian * SmallestDihedralAngles(scene.mesh).minCoeff()
       << " degrees\n";
  WriteStandardOutput(text.str());
  files.Commit();
  return 0;
}

}  // namespace elastimate
