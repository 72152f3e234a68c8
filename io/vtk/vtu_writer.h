#ifndef ELASTIMATE_IO_VTK_VTU_WRITER_H_
#define ELASTIMATE_IO_VTK_VTU_WRITER_H_

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// A named array of a result file: one column per point or cell.
struct Field {
  std::string name;
  Eigen::MatrixXd values;  ///< num_components x num_points (or num_cells).
};

/// The point and cell arrays of a VTU file beside its mesh.
struct Fields {
  std::vector<Field> point;
  std::vector<Field> cell;
  Origin origin = Origin::kMeasured;
};

/// Returns what ends the names of the arrays of load case `k`, from 0 on: "" of
/// the first one, "_2" of the second one.
[[nodiscard]] std::string CaseSuffix(std::size_t k);

/// Returns the arrays that ReadScene reads back as `scene`: `fixed`,
/// `prescribed` when a support is held away from zero, and `region`.  For each
/// load case k, with suffix `_k` for k > 1, these are `force` (the loads
/// assembled to consistent nodal forces), `displacement` and `observed` where
/// there are any.  The field data have `computed` where elements of the
/// mesh computed the displacements: 1, or 2 with laws of large strains.
[[nodiscard]] Fields SceneFields(const Scene& scene);

/// Returns the mesh with its fields as the content of a VTU file (binary,
/// Float64) that ParaView opens.  A planar mesh and its vectors lie at z = 0,
/// with `model` and `thickness` as field data.  Point i is node `file_order[i]`
/// (SceneReading::file_order), or node i where that is empty.  Throws
/// std::invalid_argument, naming the file, for fields that do not fit the mesh.
std::string VtuContent(const std::filesystem::path& path, const Mesh& mesh,
                       const Fields& fields,
                       const std::vector<int>& file_order = {});

/// Writes the mesh with its fields as a VTU file.  The file appears whole or
/// not at all.  Throws std::invalid_argument, naming the file, when it cannot
/// be written.
void WriteVtu(const std::filesystem::path& path, const Mesh& mesh,
              const Fields& fields, const std::vector<int>& file_order = {});

}  // namespace elastimate

#endif  // ELASTIMATE_IO_VTK_VTU_WRITER_H_
