#include "elastimate/io/scene/file_scene.h"

#include <cmath>
#include <limits>
#include <utility>

#include "elastimate/core/mesh/axis_names.h"
#include "elastimate/core/text/numbers.h"
#include "elastimate/io/text/input_error.h"

namespace elastimate {
namespace {

/// Throws unless values are finite where `mask` is set and an element uses the
/// node.
void RequireFinite(const std::filesystem::path& file, const std::string& what,
                   const MeshFile& mesh, const Eigen::MatrixXd& values,
                   const ComponentMask& mask, const std::string& mend) {
  for (Eigen::Index node = 0; node < values.cols(); ++node) {
    for (Eigen::Index axis = 0; axis < mask.rows() && mesh.used[node]; ++axis) {
      const double value = values(axis, node);
      if (mask(axis, node) && !std::isfinite(value)) {
        ThrowInputError(file, what + " of " + NodeName(mesh, node) + " (" +
                                  kAxisNames[axis] + ") is " +
                                  NumberText(value) + "; " + mend);
      }
    }
  }
}

}  // namespace

Eigen::VectorXi ReadRegions(const MeshFile& mesh) {
  const Eigen::MatrixXd* array =
      FindArray(mesh.element_arrays, mesh.region_array);
  const std::string name =
      "the cell array '" + Printable(mesh.region_array) + "'";
  if (array == nullptr) {
    return {};
  }
  if (array->rows() != 1) {
    ThrowInputError(mesh.path, name + " has " + std::to_string(array->rows()) +
                                   " components; give it one");
  }
  for (Eigen::Index i = 0; i < array->cols(); ++i) {
    const double value = (*array)(0, i);
    if (value != std::floor(value) ||
        std::abs(value) > std::numeric_limits<int>::max()) {
      ThrowInputError(mesh.path, name + " is " + NumberText(value) + " at " +
                                     ElementName(mesh, i) +
                                     "; give it integers below 2^31");
    }
  }
  return array->row(0).transpose().cast<int>();
}

Mesh SceneMesh(const MeshFile& mesh, const Section& section,
               Eigen::MatrixXi elements) {
  return {mesh.kind, section, mesh.nodes.topRows(mesh.Dimension()),
          std::move(elements), ReadRegions(mesh)};
}

Eigen::MatrixXd VectorField(const std::filesystem::path& file,
                            const std::string& what, const MeshFile& mesh,
                            const Eigen::MatrixXd& values,
                            const ComponentMask& mask,
                            const std::string& mend) {
  RequireFinite(file, what, mesh, values, mask, mend);
  if (mesh.Dimension() == 2 && values.rows() == 3) {
    for (Eigen::Index node = 0; node < values.cols(); ++node) {
      if (mesh.used[node] && mask.col(node).any() && values(2, node) != 0) {
        ThrowInputError(file, what + " of " + NodeName(mesh, node) +
                                  " (z) is " + NumberText(values(2, node)) +
                                  ", but the mesh is planar; make it 0");
      }
    }
  }
  return values.topRows(mesh.Dimension());
}

ComponentMask AllComponents(const MeshFile& mesh) {
  ComponentMask all =
      ComponentMask::Constant(mesh.Dimension(), mesh.nodes.cols(), true);
  all.rightCols(Eigen::Index(mesh.added.size())) = false;
  return all;
}

ComponentMask ToComponentMask(const std::filesystem::path& file,
                              const std::string& what, const MeshFile& mesh,
                              const Eigen::MatrixXd& values) {
  const Eigen::MatrixXd numbers =
      values.rows() == 1
          ? Eigen::MatrixXd(values.replicate(mesh.Dimension(), 1))
          : Eigen::MatrixXd(values.topRows(mesh.Dimension()));
  RequireFinite(file, what, mesh, numbers, AllComponents(mesh), "correct it");
  ComponentMask flags = numbers.array() != 0;
  FlagAddedNodes(mesh, flags);
  return flags;
}

void MarkObserved(const MeshFile& mesh, LoadCase& load_case) {
  if (!mesh.added.empty()) {
    const ComponentMask of_file = AllComponents(mesh);
    load_case.observed = load_case.observed.size() == 0
                             ? of_file
                             : ComponentMask(load_case.observed && of_file);
  }
}

void ClearUnobserved(LoadCase& load_case) {
  if (load_case.observed.size() > 0) {
    load_case.displacement =
        (load_case.observed || load_case.displacement.array().isFinite())
            .select(load_case.displacement, 0.0);
  }
}

}  // namespace elastimate
