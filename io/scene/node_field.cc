#include "elastimate/io/scene/node_field.h"

#include "elastimate/io/points/csv_field.h"
#include "elastimate/io/scene/file_scene.h"
#include "elastimate/io/scene/node_selection.h"
#include "elastimate/io/text/printable.h"

namespace elastimate {

std::filesystem::path ResolvePath(const JsonValue& value) {
  const std::string name = value.String();
  if (name.empty()) {
    value.Fail("is empty; give the path of a file");
  }
  return value.File().parent_path() / name;
}

std::vector<Eigen::Index> VectorSizes(const MeshFile& mesh) {
  return mesh.Dimension() == 3 ? std::vector<Eigen::Index>{3}
                               : std::vector<Eigen::Index>{2, 3};
}

Eigen::MatrixXd ReadNodeField(const JsonValue& value, const MeshFile& mesh,
                              const ComponentMask& mask,
                              const std::string& mend,
                              std::vector<FileLines>* lines) {
  if (value.Has("file") == value.Has("array")) {
    value.Fail("must have exactly one of the keys file, array");
  }
  Eigen::MatrixXd field;
  std::filesystem::path file = mesh.path;
  std::string what;
  if (value.Has("file")) {
    RequireNodePositions(mesh);
    file = ResolvePath(value.At("file"));
    const auto num_added = Eigen::Index(mesh.added.size());
    CsvField table =
        ReadCsvField(file, mesh.nodes.cols() - num_added, mesh.Dimension());
    field.setZero(table.values.rows(), mesh.nodes.cols());
    field.leftCols(table.values.cols()) = table.values;
    table.lines.resize(std::size_t(mesh.nodes.cols()), 0);
    if (lines != nullptr) {
      lines->push_back({file, table.lines});
    }
    what = "the row";
  } else {
    field = NamedNodeArray(value.At("array"), mesh, VectorSizes(mesh));
    what = "the point array '" + Printable(value.At("array").String()) + "'";
  }
  return VectorField(file, what, mesh, field, mask, mend);
}

}  // namespace elastimate
