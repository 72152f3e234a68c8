#include <cmath>
#include <iostream>
#include <sstream>
#include <stdexcept>

#include "apps/commands.h"
#include "apps/flags.h"
#include "apps/progress.h"
#include "elastimate/core/mesh.h"
#include "elastimate/io/example_scenes.h"
#include "elastimate/io/file_output.h"
#include "elastimate/io/vtu_writer.h"

namespace elastimate {
namespace {

// Three numbers separated by commas.
template <typename T>
Eigen::Matrix<T, 3, 1> Triple(const std::string& flag,
                              const std::string& value) {
  std::istringstream text(value);
  Eigen::Matrix<T, 3, 1> triple;
  char comma[2] = {};
  const bool read = bool(text >> triple(0) >> comma[0] >> triple(1) >>
                         comma[1] >> triple(2)) &&
                    comma[0] == ',' && comma[1] == ',' &&
                    text.peek() == std::istringstream::traits_type::eof();
  if (!read) {
    throw std::invalid_argument("--" + flag + "=" + value +
                                "; it needs three numbers, as in --" + flag +
                                "=1,2,3");
  }
  return triple;
}

void RejectFlags(const std::string& geometry,
                 const std::vector<std::string>& flags) {
  for (const std::string& flag : flags) {
    if (IsGiven(flag)) {
      throw std::invalid_argument("generate " + geometry + " takes no flag --" +
                                  flag + "; see elastimate --help");
    }
  }
}

Scene CuboidFromFlags() {
  RejectFlags("cuboid", {"tetrahedra", "length"});
  CuboidOptions options;
  options.cells = Triple<int>("cells", FLAGS_cells);
  options.size = Triple<double>("size", FLAGS_size);
  options.force = Triple<double>("force", FLAGS_force);
  return CuboidScene(options);
}

Scene OrganFromFlags() {
  RejectFlags("organ", {"cells", "size"});
  OrganOptions options;
  options.tetrahedra = FLAGS_tetrahedra;
  options.length = FLAGS_length;
  if (IsGiven("force")) {
    options.force = Triple<double>("force", FLAGS_force);
  }
  return OrganScene(options);
}

}  // namespace

int RunGenerate(const std::vector<std::string>& arguments) {
  if (arguments.size() != 1 ||
      (arguments[0] != "cuboid" && arguments[0] != "organ")) {
    throw std::invalid_argument("generate needs one geometry: cuboid or organ");
  }
  if (FLAGS_out.empty()) {
    throw std::invalid_argument("generate needs --out=FILE.vtu");
  }
  CheckWritable(FLAGS_out);
  const Progress progress("meshing");
  const Scene scene =
      arguments[0] == "cuboid" ? CuboidFromFlags() : OrganFromFlags();
  WriteVtu(FLAGS_out, scene.mesh, SceneFields(scene));
  constexpr double kDegreesPerRadian = 57.295779513082323;
  std::cout << scene.mesh.NumNodes() << " nodes, " << scene.mesh.NumElements()
            << " tetrahedra, smallest dihedral angle "
            << kDegreesPerRadian * SmallestDihedralAngles(scene.mesh).minCoeff()
            << " degrees\n";
  return 0;
}

}  // namespace elastimate
