#include "elastimate/io/scene/measured_mesh.h"

#include <optional>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "elastimate/io/dic/dic_file.h"
#include "elastimate/io/dic/point_mesh.h"
#include "elastimate/io/scene/mesh_file_check.h"
#include "elastimate/io/text/input_error.h"
#include "elastimate/io/text/printable.h"

namespace elastimate {
namespace {

std::optional<double> ReadLength(const JsonValue& mesh,
                                 const std::string& key) {
  if (!mesh.Has(key)) {
    return std::nullopt;
  }
  const double length = mesh.At(key).Number();
  if (!(length > 0)) {
    mesh.At(key).Fail("must be positive");
  }
  return length;
}

DicOptions ReadDicOptions(const JsonValue& mesh) {
  DicOptions options;
  if (mesh.Has("format")) {
    const JsonValue format = mesh.At("format");
    options.format = format.String();
    if (("auto, " + DicFormatNames() + ", ").find(options.format + ", ") ==
        std::string::npos) {
      format.Fail("is \"" + Printable(options.format) +
                  "\"; the formats known here are auto, " + DicFormatNames());
    }
  }
  if (mesh.Has("columns")) {
    const JsonValue columns = mesh.At("columns");
    columns.CheckKeys({"x", "y", "u", "v"});
    options.columns = {columns.At("x").String(), columns.At("y").String(),
                       columns.At("u").String(), columns.At("v").String()};
  }
  options.length_per_pixel = ReadLength(mesh, "length_per_pixel");
  options.flip_y = mesh.Has("flip_y") && mesh.At("flip_y").Boolean();
  return options;
}

PointMesh MeshOf(const std::filesystem::path& path, const DicFrame& frame,
                 std::optional<double> max_edge) {
  try {
    return MeshOfPoints(frame.positions, max_edge);
  } catch (const std::invalid_argument& error) {
    ThrowInputError(path, error.what());
  }
}

std::string Description(const std::filesystem::path& path,
                        const DicFrame& frame, const PointMesh& points,
                        const MeshFile& mesh) {
  const Eigen::Vector2d size =
      (mesh.nodes.rowwise().maxCoeff() - mesh.nodes.rowwise().minCoeff())
          .head<2>();
  const Eigen::Index num_beside = frame.positions.cols() - mesh.nodes.cols();
  std::ostringstream text;
  text << PrintablePath(path) << ": " << mesh.elements.cols() << " "
       << mesh.Shapes() << " of " << mesh.nodes.cols() << " points ("
       << frame.format << "), " << size(0) << " x " << size(1);
  if (points.max_edge > 0) {
    text << ", edges up to " << points.max_edge;
  }
  if (frame.num_invalid + num_beside > 0) {
    text << "; " << frame.num_invalid << " points without a measurement and "
         << num_beside << " beside the mesh are left out";
  }
  text << "; where a specimen is wider than its measured points, give the "
          "share of the force that their width carries";
  return text.str();
}

}  // namespace

MeshFile ReadMeasuredMesh(const JsonValue& mesh,
                          std::vector<std::string>& notices) {
  mesh.CheckKeys({"points", "format", "columns", "length_per_pixel", "flip_y",
                  "max_edge"});
  const JsonValue name = mesh.At("points");
  if (name.String().empty()) {
    name.Fail("is empty; give the path of a file");
  }
  const std::filesystem::path path = name.File().parent_path() / name.String();
  const DicFrame frame = ReadDicFile(path, ReadDicOptions(mesh));
  const PointMesh points = MeshOf(path, frame, ReadLength(mesh, "max_edge"));
  MeshFile file;
  file.path = path;
  file.kind = points.kind;
  file.elements = points.elements;
  file.nodes.setZero(3, Eigen::Index(points.points.size()));
  file.nodes.topRows(2) = frame.positions(Eigen::all, points.points);
  file.node_arrays.push_back(
      {"displacement", frame.displacement(Eigen::all, points.points)});
  CheckMeshFile(file);
  notices.push_back(Description(path, frame, points, file));
  return file;
}

}  // namespace elastimate
