#include "elastimate/io/dic/measured_mesh.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "elastimate/core/mesh/nearest_points.h"
#include "elastimate/core/text/numbers.h"
#include "elastimate/io/dic/dic_file.h"
#include "elastimate/io/dic/point_mesh.h"
#include "elastimate/io/mesh/mesh_file_check.h"
#include "elastimate/io/points/table_options.h"
#include "elastimate/io/text/input_error.h"
#include "elastimate/io/text/printable.h"

namespace elastimate {
namespace {

// Points that are closer than this share of the least distance between two
// points are the same.
constexpr double kSamePosition = 1e-3;

double LeastDistance(const Eigen::Matrix2Xd& points) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [a, b] : NearestPairs(points, 1)) {
    least = std::min(least, (points.col(a) - points.col(b)).norm());
  }
  return least;
}

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

// Tells whether gaps of the grid are filled; nothing where nobody says so.
std::optional<bool> ReadGaps(const JsonValue& mesh) {
  if (!mesh.Has("gaps")) {
    return std::nullopt;
  }
  const JsonValue gaps = mesh.At("gaps");
  if (gaps.String() != "filled" && gaps.String() != "open") {
    gaps.Fail("is \"" + Printable(gaps.String()) +
              "\"; make it \"filled\" or \"open\", or leave it out");
  }
  return gaps.String() == "filled";
}

// Adds nodes without a displacement at `places`.
void AddUnmeasured(const Eigen::Matrix2Xd& places, DicFrame& frame) {
  const Eigen::Index num_points = frame.positions.cols();
  frame.positions.conservativeResize(2, num_points + places.cols());
  frame.positions.rightCols(places.cols()) = places;
  frame.displacement.conservativeResize(2, num_points + places.cols());
  frame.displacement.rightCols(places.cols())
      .setConstant(std::numeric_limits<double>::quiet_NaN());
  frame.lines.resize(num_points + places.cols(), 0);
}

DicFrame WithGapsFilled(std::optional<bool> are_filled, DicFrame frame,
                        PointGaps& gaps) {
  const GridGaps of_grid = GapsOf(frame.positions);
  gaps.found.clear();
  AddUnmeasured(of_grid.lost, frame);
  for (std::size_t i = 0; i < of_grid.doubtful.size(); ++i) {
    const Eigen::Matrix2Xd& gap = of_grid.doubtful[i];
    const bool is_filled =
        are_filled.value_or(i < gaps.is_filled.size() && gaps.is_filled[i]);
    gaps.found.push_back({gap.cols(), gap.rowwise().mean(), is_filled});
    if (is_filled) {
      AddUnmeasured(gap, frame);
    }
  }
  return frame;
}

PointMesh MeshOf(const std::filesystem::path& path, const DicFrame& frame,
                 std::optional<double> max_edge) {
  try {
    return MeshOfPoints(frame.positions, max_edge);
  } catch (const std::invalid_argument& error) {
    ThrowInputError(path, error.what());
  }
}

Eigen::Index NumBeside(const DicFrame& frame, const PointMesh& points) {
  return frame.positions.cols() - Eigen::Index(points.points.size());
}

// Tells whether more than a few points are beside the mesh, which would bear
// the force of the whole specimen as a part of it.
bool AreManyBeside(const DicFrame& frame, const PointMesh& points) {
  constexpr double kMostBeside = 0.05;
  return static_cast<double>(NumBeside(frame, points)) >
         kMostBeside * static_cast<double>(frame.positions.cols());
}

// Throws where nodes without a measurement are more than a third, which may as
// well be beside the specimen.
void CheckShareOfFilled(const std::filesystem::path& path,
                        const DicFrame& measured, const DicFrame& filled) {
  const Eigen::Index size = filled.positions.cols();
  const Eigen::Index num_filled = size - measured.positions.cols();
  if (3 * num_filled > size) {
    ThrowInputError(path,
                    "its grid has no point at " + std::to_string(num_filled) +
                        " of " + std::to_string(size) +
                        " places; give \"gaps\": \"filled\" if the specimen "
                        "is there, or \"gaps\": \"open\" if it is not");
  }
}

void CheckPointsBeside(const std::filesystem::path& path, const DicFrame& frame,
                       const PointMesh& points) {
  if (AreManyBeside(frame, points)) {
    ThrowInputError(
        path,
        "the mesh of its points has several parts, of which the largest "
        "is without " +
            std::to_string(NumBeside(frame, points)) + " of the " +
            std::to_string(frame.positions.cols()) +
            " points; leave out points that are not of the specimen, or "
            "give \"max_edge\" above the distance between the parts");
  }
}

std::string Description(const std::filesystem::path& path,
                        const DicFrame& frame, const PointMesh& points,
                        const MeshFile& mesh) {
  const Eigen::Vector2d size =
      (mesh.nodes.rowwise().maxCoeff() - mesh.nodes.rowwise().minCoeff())
          .head<2>();
  const Eigen::Index num_beside = NumBeside(frame, points);
  const Eigen::Index num_lost =
      FindArray(mesh.node_arrays, "displacement")->array().isNaN().count() / 2;
  std::ostringstream text;
  text << PrintablePath(path) << ": the mesh of its points (format "
       << frame.format << ") has " << mesh.elements.cols() << " "
       << mesh.Shapes() << " and " << mesh.nodes.cols() << " nodes, and is "
       << size(0) << " x " << size(1) << " in size";
  if (points.max_edge > 0) {
    text << ", with edges up to " << points.max_edge;
  }
  if (frame.num_invalid + num_beside > 0) {
    text << "; " << frame.num_invalid << " points without a measurement and "
         << num_beside << " that are not connected to it are left out";
  }
  if (num_lost > 0) {
    text << "; gaps of the grid are filled with "
         << Counted(std::size_t(num_lost), "node") << " without a measurement";
  }
  return text.str();
}

}  // namespace

MeshFile ReadMeasuredMesh(const JsonValue& mesh, PointGaps& gaps,
                          std::vector<std::string>& notices) {
  mesh.CheckKeys(WithTableKeys({"points", "max_edge", "margin", "gaps"}));
  const JsonValue name = mesh.At("points");
  if (name.String().empty()) {
    name.Fail("is empty; give the path of a file");
  }
  const std::filesystem::path path = name.File().parent_path() / name.String();
  const std::optional<double> max_edge = ReadLength(mesh, "max_edge");
  const std::optional<bool> are_filled = ReadGaps(mesh);
  const DicFrame measured = ReadDicFile(path, ReadTableOptions(mesh, 2));
  DicFrame frame = WithGapsFilled(are_filled, measured, gaps);
  PointMesh points = MeshOf(path, frame, max_edge);
  if (!are_filled && gaps.is_filled.empty() && AreManyBeside(frame, points)) {
    // Gaps that take the specimen apart are none of it.
    frame = WithGapsFilled(true, measured, gaps);
    points = MeshOf(path, frame, max_edge);
  }
  if (are_filled) {
    gaps.found.clear();
  } else {
    CheckShareOfFilled(path, measured, frame);
  }
  CheckPointsBeside(path, frame, points);
  MeshFile file;
  file.path = path;
  file.kind = points.kind;
  file.elements = points.elements;
  file.nodes.setZero(3, Eigen::Index(points.points.size()));
  file.nodes.topRows(2) = frame.positions(Eigen::all, points.points);
  file.node_arrays.push_back(
      {"displacement", frame.displacement(Eigen::all, points.points)});
  for (const Eigen::Index point : points.points) {
    file.node_lines.push_back(frame.lines[point]);
  }
  CheckMeshFile(file);
  notices.push_back(Description(path, frame, points, file));
  notices.insert(notices.end(), frame.notices.begin(), frame.notices.end());
  return file;
}

void ReadMeasuredFrame(const std::filesystem::path& path,
                       const TableOptions& options,
                       const Eigen::Matrix2Xd& nodes, LoadCase& load_case) {
  const DicFrame frame = ReadDicFile(path, options);
  load_case.displacement.setZero(2, nodes.cols());
  load_case.observed.setConstant(2, nodes.cols(), false);
  const double tolerance = kSamePosition * LeastDistance(nodes);
  Eigen::Index num_found = 0;
  if (frame.positions.cols() > 0) {
    const std::vector<NearestPoint> nearest =
        NearestPoints(frame.positions, nodes);
    for (Eigen::Index node = 0; node < nodes.cols(); ++node) {
      if (nearest[node].distance <= tolerance) {
        load_case.displacement.col(node) =
            frame.displacement.col(nearest[node].index);
        load_case.observed.col(node).setConstant(true);
        ++num_found;
      }
    }
  }
  if (2 * num_found < nodes.cols()) {
    ThrowInputError(path,
                    "only " + std::to_string(num_found) + " of the " +
                        std::to_string(nodes.cols()) +
                        " points of the mesh have the same position in this "
                        "frame; give frames that share one reference image");
  }
}

}  // namespace elastimate
