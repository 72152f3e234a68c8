#include "elastimate/io/scene/array_scene.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "elastimate/core/text/numbers.h"
#include "elastimate/io/scene/section.h"
#include "elastimate/io/text/input_error.h"
#include "elastimate/io/text/printable.h"

namespace elastimate {
namespace {

std::string CaseSuffix(int number) {
  return number == 1 ? "" : "_" + std::to_string(number);
}

[[noreturn]] void ThrowMissing(const MeshFile& mesh, const std::string& name) {
  if (!mesh.is_vtk && mesh.node_arrays.empty()) {
    ThrowInputError(mesh.path,
                    "a mesh alone is not a scene, as it has no supports, loads "
                    "and displacements; write a scene.json with "
                    "\"mesh\": \"" +
                        PrintablePath(mesh.path.filename()) +
                        "\", \"supports\" and \"cases\"");
  }
  ThrowInputError(mesh.path, "the point array '" + name +
                                 "' is missing; add it (the point arrays of "
                                 "this file are: " +
                                 ArrayNames(mesh.node_arrays) + ")");
}

/// Returns null when there is no such array.
const Eigen::MatrixXd* FindNodeArray(const MeshFile& mesh,
                                     const std::string& name,
                                     bool one_component_is_enough) {
  const Eigen::MatrixXd* array = FindArray(mesh.node_arrays, name);
  if (array != nullptr && array->rows() != 3 &&
      array->rows() != mesh.Dimension() &&
      !(one_component_is_enough && array->rows() == 1)) {
    ThrowInputError(
        mesh.path, "the point array '" + name + "' has " +
                       std::to_string(array->rows()) + " components; give it " +
                       (one_component_is_enough ? "1 or " : "") +
                       (mesh.Dimension() == 2 ? "2 (or 3 for files that need "
                                                "them)"
                                              : "3"));
  }
  return array;
}

const Eigen::MatrixXd& RequireNodeArray(const MeshFile& mesh,
                                        const std::string& name,
                                        bool one_component_is_enough) {
  const Eigen::MatrixXd* array =
      FindNodeArray(mesh, name, one_component_is_enough);
  if (array == nullptr) {
    ThrowMissing(mesh, name);
  }
  return *array;
}

/// Returns the name of the array of a load case, or of the array for all load
/// cases where it has none.
std::string NameInCase(const MeshFile& mesh, const std::string& name,
                       int number) {
  const std::string own = name + CaseSuffix(number);
  return FindArray(mesh.node_arrays, own) != nullptr ? own : name;
}

Supports ReadSupports(const MeshFile& mesh, int number) {
  Supports supports;
  const std::string fixed = NameInCase(mesh, "fixed", number);
  supports.held = ToComponentMask(mesh.path, "the point array '" + fixed + "'",
                                  mesh, RequireNodeArray(mesh, fixed, true));
  supports.displacement.setZero(mesh.Dimension(), mesh.nodes.cols());
  const std::string name = NameInCase(mesh, "prescribed", number);
  if (const auto* prescribed = FindNodeArray(mesh, name, false)) {
    const Eigen::MatrixXd displacement =
        VectorField(mesh.path, "the point array '" + name + "'", mesh,
                    *prescribed, supports.held);
    supports.displacement =
        supports.held.select(displacement.array(), 0.0).matrix();
  }
  return supports;
}

bool HasOwnSupports(const MeshFile& mesh, int number) {
  const std::string suffix = CaseSuffix(number);
  return number > 1 &&
         (FindArray(mesh.node_arrays, "fixed" + suffix) != nullptr ||
          FindArray(mesh.node_arrays, "prescribed" + suffix) != nullptr);
}

LoadCase ReadLoadCase(const MeshFile& mesh, int number,
                      Measurement measurement) {
  const std::string suffix = CaseSuffix(number);
  const ComponentMask all = AllComponents(mesh);
  LoadCase load_case;
  NodalForces forces = {
      VectorField(mesh.path, "the point array 'force" + suffix + "'", mesh,
                  RequireNodeArray(mesh, "force" + suffix, false), all)};
  forces.force.rightCols(Eigen::Index(mesh.added.size())).setZero();
  load_case.loads.emplace_back(std::move(forces));
  if (HasOwnSupports(mesh, number)) {
    load_case.supports = ReadSupports(mesh, number);
  }
  if (const auto* observed = FindNodeArray(mesh, "observed" + suffix, true)) {
    load_case.observed = ToComponentMask(
        mesh.path, "the point array 'observed" + suffix + "'", mesh, *observed);
  }
  const std::string name = "displacement" + suffix;
  const Eigen::MatrixXd* displacement = FindNodeArray(mesh, name, false);
  if (displacement == nullptr) {
    if (measurement == Measurement::kRequired) {
      ThrowMissing(mesh, name);
    }
    return load_case;
  }
  MarkObserved(mesh, load_case);
  load_case.displacement = VectorField(
      mesh.path, "the point array '" + name + "'", mesh, *displacement,
      load_case.observed.size() > 0 ? load_case.observed : all,
      "correct it or mark it as not measured in the array "
      "'observed" +
          suffix + "'");
  ClearUnobserved(load_case);
  return load_case;
}

/// Counts the first load case and the numbered ones that follow without a gap.
int CountLoadCases(const MeshFile& mesh) {
  int count = 1;
  const auto has_next = [&](const std::string& name) {
    return FindArray(mesh.node_arrays, name + CaseSuffix(count + 1)) != nullptr;
  };
  while (has_next("displacement") || has_next("force")) {
    ++count;
  }
  return count;
}

bool IsNumber(const std::string& text) {
  return !text.empty() &&
         text.find_first_not_of("0123456789") == std::string::npos;
}

/// Throws for an array with the number of no load case, which would otherwise
/// be ignored silently.
void CheckCaseNumbers(const MeshFile& mesh, int num_cases) {
  for (const FileArray& array : mesh.node_arrays) {
    const std::size_t underscore = array.name.find('_');
    const std::string stem = array.name.substr(0, underscore);
    if (underscore == std::string::npos) {
      continue;
    }
    const std::string number = array.name.substr(underscore + 1);
    const bool is_of_supports = stem == "fixed" || stem == "prescribed";
    if (!(is_of_supports && IsNumber(number)) && stem != "displacement" &&
        stem != "force" && stem != "observed") {
      continue;
    }
    bool is_load_case = !IsNumber(number);
    for (int i = 2; i <= num_cases && !is_load_case; ++i) {
      is_load_case = number == std::to_string(i);
    }
    if (!is_load_case) {
      ThrowInputError(mesh.path,
                      "the point array '" + Printable(array.name) +
                          "' belongs to no load case; number the further load "
                          "cases from 2 without a gap (displacement_2, "
                          "force_2, displacement_3, ...)");
    }
  }
}

/// Throws for a name that seems to be a misspelt one of these arrays, without
/// which the scene would be another one.  Other arrays are ignored.
void CheckOptionalNames(const MeshFile& mesh) {
  for (const FileArray& array : mesh.node_arrays) {
    const std::string stem = array.name.substr(0, array.name.find('_'));
    for (const std::string name : {"prescribed", "observed"}) {
      constexpr std::size_t kTelling = 5;  // Letters.
      const bool is_alike =
          std::equal(name.begin(), name.begin() + kTelling, array.name.begin(),
                     array.name.begin() + std::min(array.name.size(), kTelling),
                     [](char a, char b) { return a == (b | 0x20); });
      if (is_alike && stem != name) {
        ThrowInputError(
            mesh.path, "the point array '" + Printable(array.name) +
                           "' is not read; rename it to '" + name +
                           "' if that is meant, and otherwise to another name");
      }
    }
  }
}

void NoteLostForces(FileScene& file_scene) {
  for (std::size_t i = 0; i < file_scene.scene.load_cases.size(); ++i) {
    const auto& force =
        std::get<NodalForces>(file_scene.scene.load_cases[i].loads[0]).force;
    const Eigen::Index lost =
        ((force.array() != 0).colwise().any() && !file_scene.mesh.used).count();
    if (lost > 0) {
      file_scene.notices.push_back(
          PrintablePath(file_scene.mesh.path) + ": the array 'force" +
          CaseSuffix(static_cast<int>(i) + 1) + "' has forces on " +
          Counted(std::size_t(lost), "point") + " that no " +
          file_scene.mesh.Shape() + " uses, and these forces are left out");
    }
  }
}

}  // namespace

FileScene SceneFromArrays(MeshFile mesh, Measurement measurement,
                          const SectionChoice& section) {
  FileScene file_scene;
  file_scene.scene.mesh =
      SceneMesh(mesh, SectionOf(mesh, section), std::move(mesh.elements));
  file_scene.scene.origin = mesh.origin;
  const int num_cases = CountLoadCases(mesh);
  for (int number = 1; number <= num_cases; ++number) {
    file_scene.scene.load_cases.push_back(
        ReadLoadCase(mesh, number, measurement));
  }
  CheckCaseNumbers(mesh, num_cases);
  CheckOptionalNames(mesh);
  file_scene.scene.supports = ReadSupports(mesh, 1);
  file_scene.mesh = std::move(mesh);
  NoteLostForces(file_scene);
  return file_scene;
}

}  // namespace elastimate
