// The command check: tells what a scene does, before anything is estimated.

#include <algorithm>
#include <optional>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "apps/commands.h"
#include "apps/flags.h"
#include "apps/outputs.h"
#include "apps/progress.h"
#include "apps/section_flags.h"
#include "elastimate/core/mesh/axis_names.h"
#include "elastimate/core/mesh/bounding_box.h"
#include "elastimate/core/mesh/mesh_points.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/core/scene/rigid_motion.h"
#include "elastimate/core/text/numbers.h"
#include "elastimate/io/report/summary_lines.h"
#include "elastimate/io/scene/scene_reader.h"
#include "elastimate/io/text/file_output.h"
#include "elastimate/io/text/printable.h"
#include "elastimate/io/vtk/vtu_writer.h"

namespace elastimate {
namespace {

void AddMesh(const Mesh& mesh, std::ostringstream& text) {
  AddMeshLine(mesh.Topology(), mesh.NumElements(), mesh.NumNodes(), mesh.nodes,
              text);
  const std::set<int> regions(mesh.regions.begin(), mesh.regions.end());
  if (regions.size() > 1) {
    AddLine("regions", std::to_string(regions.size()), text);
  }
  if (mesh.Dimension() == 2) {
    AddLine("section",
            std::string(SectionModelName(mesh.section.model)) + ", thickness " +
                NumberText(mesh.section.thickness),
            text);
  }
}

// Adds how many nodes are held, in which components, and how many of them away
// from zero.
void AddSupports(const std::string& name, const Supports& supports,
                 std::ostringstream& text) {
  const Eigen::Index num_held = supports.held.colwise().any().count();
  std::string components;
  for (Eigen::Index axis = 0; axis < supports.held.rows(); ++axis) {
    const Eigen::Index count = supports.held.row(axis).count();
    components += (axis == 0 ? "" : ", ") + std::string("u") +
                  std::string(kAxisNames[axis]) + " of " +
                  std::to_string(count);
  }
  const Eigen::Index num_moved =
      (supports.held && supports.displacement.array() != 0)
          .colwise()
          .any()
          .count();
  AddLine(name,
          num_held == 0
              ? "nothing is held"
              : "held are " + Counted(std::size_t(num_held), "node") + ": " +
                    components +
                    (num_moved > 0 ? "; " + std::to_string(num_moved) +
                                         " of them away from zero"
                                   : ""),
          text);
}

// Returns "120 points, of up to 0.3 (5 % of the size of the mesh)".
std::string Measured(const Mesh& mesh, const LoadCase& load_case) {
  const bool has_points = load_case.points.points.Size() > 0;
  Eigen::MatrixXd displacement =
      has_points ? load_case.points.displacement : load_case.displacement;
  Eigen::Index num_measured = displacement.cols();
  if (displacement.size() == 0) {
    return "nothing; estimate needs displacements";
  }
  if (has_points) {
    displacement = displacement.array().isNaN().select(0.0, displacement);
  } else if (load_case.observed.size() > 0) {
    displacement = load_case.observed.select(displacement, 0.0);
    num_measured = load_case.observed.colwise().any().count();
  }
  const double largest = displacement.colwise().norm().maxCoeff();
  return Counted(std::size_t(num_measured), has_points ? "point" : "node") +
         (has_points ? " located in elements" : "") +
         ", largest displacement " + NumberText(largest, 3) + " (" +
         PercentOf(largest / DiagonalOf(mesh.nodes),
                   "the diagonal of the mesh") +
         ")" +
         (load_case.noise_sd ? ", noise " + NumberText(*load_case.noise_sd, 3)
                             : "");
}

// Adds the force on components that supports hold, which changes nothing.
void AddForceOnSupports(const Scene& scene, std::size_t load_case,
                        const std::string& of_case, std::ostringstream& text) {
  constexpr double kRounding = 1e-12;  // Relative to the largest force.
  const Eigen::MatrixXd force =
      AssembleLoads(scene.mesh, scene.load_cases[load_case].loads);
  const Eigen::MatrixXd on_held =
      SupportsOf(scene, Eigen::Index(load_case)).held.select(force, 0.0);
  const double rounding = kRounding * force.cwiseAbs().maxCoeff();
  const Eigen::Index num_nodes =
      (on_held.array().abs() > rounding).colwise().any().count();
  if (num_nodes > 0) {
    AddLine("force on supports" + of_case,
            VectorText(on_held.rowwise().sum(), rounding) +
                " of the loads is on " +
                Counted(std::size_t(num_nodes), "node") +
                " held in its direction, where it deforms nothing",
            text);
  }
}

void AddLoadCases(const Scene& scene, std::ostringstream& text) {
  constexpr std::size_t kMany = 8;
  const std::size_t count = scene.load_cases.size();
  for (std::size_t i = 0; i < std::min(count, kMany); ++i) {
    const LoadCase& load_case = scene.load_cases[i];
    const std::string of_case =
        count == 1 ? "" : " of case " + std::to_string(i + 1);
    if (load_case.supports) {
      AddSupports("supports" + of_case, *load_case.supports, text);
    }
    AddForceOnSupports(scene, i, of_case, text);
    AddLine("measured" + of_case, Measured(scene.mesh, load_case), text);
    for (const Resultant& resultant : load_case.resultants) {
      AddLine("resultant" + of_case,
              VectorText(resultant.force) + " on " +
                  Counted(resultant.nodes.size(), "held node"),
              text);
    }
  }
  if (count > kMany) {
    AddLine("measured",
            "and " + std::to_string(count - kMany) + " more load cases", text);
  }
}

}  // namespace

int RunCheck(const std::vector<std::string>& arguments) {
  if (arguments.empty()) {
    throw std::invalid_argument("check needs a scene" + ButGot(arguments));
  }
  CheckOutputFlags(arguments);
  std::optional<Progress> progress("reading");
  SceneChoices choices;
  choices.section = SectionFromFlags();
  const SceneReading reading = ReadScene({arguments.begin(), arguments.end()},
                                         Measurement::kOptional, choices);
  const Scene& scene = reading.scene;
  std::ostringstream text;
  AddMesh(scene.mesh, text);
  AddSupports("supports", scene.supports, text);
  const std::string why_not_held = WhyNotHeld(scene);
  AddLine("motion without strain",
          why_not_held.empty() ? "none, the supports hold the specimen"
                               : why_not_held,
          text);
  AddLoadLines(scene, text);
  AddLoadCases(scene, text);
  if (reading.frames) {
    AddLine("frames", std::to_string(reading.frames->files.size()), text);
  }
  StagedFiles files;
  if (!FLAGS_out.empty()) {
    files.Add(FLAGS_out, VtuContent(FLAGS_out, scene.mesh, SceneFields(scene),
                                    reading.file_order));
  }
  progress.reset();
  WriteStandardOutput(text.str());
  files.Commit();
  PrintNotices(reading.notices);
  return 0;
}

}  // namespace elastimate
