// The command scene: lists what a mesh offers, and writes a first scene.json.

#include <algorithm>
#include <filesystem>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "apps/commands.h"
#include "apps/flags.h"
#include "apps/number_list.h"
#include "apps/outputs.h"
#include "apps/section_flags.h"
#include "elastimate/core/text/numbers.h"
#include "elastimate/io/report/summary_lines.h"
#include "elastimate/io/scene/first_scene.h"
#include "elastimate/io/scene/mesh_reader.h"
#include "elastimate/io/text/file_output.h"
#include "elastimate/io/text/printable.h"

namespace elastimate {
namespace {

// Reads --force=NAME,X,Y,Z.
void ReadForce(FirstScene& scene) {
  const std::size_t comma = FLAGS_force.find(',');
  scene.loaded = FLAGS_force.substr(0, comma);
  const std::string vector =
      comma == std::string::npos ? "" : FLAGS_force.substr(comma + 1);
  const auto num_commas = std::count(vector.begin(), vector.end(), ',');
  if (scene.loaded.empty() || num_commas < 1 || num_commas > 2) {
    throw std::invalid_argument(
        AsGiven("force") +
        "; it needs the name of a surface and the total force on it, as in "
        "--force=TOP,0,0,-5");
  }
  scene.force = NumberList<Eigen::VectorXd>("force", vector, "finite numbers",
                                            num_commas + 1);
}

FirstScene SceneFromFlags() {
  FirstScene scene;
  scene.section = SectionFromFlags();
  if (IsGiven("support")) {
    scene.supports = WordsOf(FLAGS_support);
  }
  if (IsGiven("force")) {
    ReadForce(scene);
  }
  if (IsGiven("points")) {
    scene.points = FLAGS_points;
  }
  return scene;
}

std::string Contents(const MeshFile& mesh) {
  std::ostringstream text;
  AddMeshLine(mesh.Topology(), mesh.elements.cols(), mesh.used.count(),
              mesh.nodes, text);
  for (const MeshName& name : NamesOf(mesh)) {
    AddLine(name.key + " \"" + Printable(name.name) + "\"", name.what, text);
  }
  return text.str();
}

// Returns the file to write: scene.json beside the mesh, which must not be
// there yet, unless --out names one.
std::filesystem::path OutputFile(const std::filesystem::path& mesh) {
  if (IsGiven("out")) {
    return FLAGS_out;
  }
  std::filesystem::path file = mesh.parent_path() / "scene.json";
  if (std::filesystem::exists(file)) {
    throw std::invalid_argument(PrintablePath(file) +
                                " is there already; give --out=FILE.json");
  }
  return file;
}

}  // namespace

int RunScene(const std::vector<std::string>& arguments) {
  if (arguments.size() != 1) {
    throw std::invalid_argument("scene needs one mesh file" +
                                ButGot(arguments));
  }
  const FirstScene scene = SceneFromFlags();
  CheckOutputFlags(arguments, OutFormats::kJson);
  const bool has_content = !scene.supports.empty() || !scene.loaded.empty();
  if (!has_content && (IsGiven("out") || !scene.points.empty())) {
    throw std::invalid_argument(
        "a first scene needs what is held or loaded; give --support=NAME or "
        "--force=NAME,X,Y,Z");
  }
  const MeshFile mesh = ReadMeshFile(arguments[0]);
  std::string text = Contents(mesh);
  StagedFiles files;
  if (has_content) {
    const std::filesystem::path file = OutputFile(arguments[0]);
    files.Add(file, FirstSceneText(file, mesh, scene));
    text += "written to " + PrintablePath(file) +
            "; elastimate check tells what it does\n";
  }
  WriteStandardOutput(text);
  files.Commit();
  std::vector<std::string> notices;
  for (const std::string& notice : mesh.notices) {
    notices.push_back(PrintablePath(mesh.path) + ": " + notice);
  }
  PrintNotices(notices);
  return 0;
}

}  // namespace elastimate
