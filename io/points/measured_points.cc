#include "elastimate/io/points/measured_points.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <utility>

#include "elastimate/core/mesh/bounding_box.h"
#include "elastimate/io/points/points_file.h"
#include "elastimate/io/points/table_options.h"
#include "elastimate/io/text/input_error.h"
#include "elastimate/io/text/printable.h"

namespace elastimate {
namespace {

std::vector<std::filesystem::path> FilesOf(const JsonValue& points) {
  const std::filesystem::path folder = points.File().parent_path();
  if (points.IsString()) {
    return {folder / points.String()};
  }
  if (points.ListSize() == 0) {
    points.Fail(
        "must be the name of a file of points, or a list of such names");
  }
  std::vector<std::filesystem::path> files;
  for (const JsonValue& name : points.Items()) {
    files.push_back(folder / name.String());
    // Its noise would count as that of two measurements.
    if (std::find(files.begin(), files.end() - 1, files.back()) !=
        files.end() - 1) {
      name.Fail("is named before; give each file of points once");
    }
  }
  return files;
}

double ToleranceOf(const JsonValue& displacement, const Mesh& mesh) {
  if (!displacement.Has("tolerance")) {
    return kUsualPointTolerance * DiagonalOf(mesh.nodes);
  }
  const double tolerance = displacement.At("tolerance").Number();
  if (!(tolerance >= 0)) {
    displacement.At("tolerance").Fail("must not be negative");
  }
  return tolerance;
}

std::string PositionText(const Eigen::VectorXd& position) {
  std::ostringstream text;
  for (Eigen::Index i = 0; i < position.size(); ++i) {
    text << (i == 0 ? "(" : ", ") << position[i];
  }
  text << ")";
  return text.str();
}

std::string LengthText(double length) {
  std::ostringstream text;
  text.precision(3);
  text << length;
  return text.str();
}

// A number of three digits that is above a positive length, and hardly more.
double RoundedUp(double length) {
  const double unit = std::pow(10, std::floor(std::log10(length)) - 2);
  return unit * std::ceil(length * (1 + 1e-9) / unit);
}

// Tells what to do with points that lie up to `distance` outside the mesh.
std::string MendOfPointsOutside(double distance, double diagonal) {
  // Points farther away than this share of the diagonal were not measured on
  // this mesh.
  constexpr double kLargestPart = 0.02;
  return distance > kLargestPart * diagonal
             ? "check that the points have the origin, the axes (with their "
               "signs) and the \"unit\" of the mesh, and are positions before "
               "the load"
             : "use the mesh's axes and its \"unit\", leave it out, or give "
               "the "
               "\"tolerance\" " +
                   LengthText(RoundedUp(distance)) +
                   ", which takes all points of the file";
}

void CheckDistances(const std::filesystem::path& path, const PointsFile& file,
                    const Eigen::VectorXd& distance, double tolerance,
                    double diagonal, std::vector<std::string>& notices) {
  for (Eigen::Index point = 0; point < distance.size(); ++point) {
    if (distance(point) > tolerance) {
      ThrowInputError(
          path, "line " + std::to_string(file.lines[point]) + ": the point " +
                    PositionText(file.positions.col(point)) + " lies " +
                    LengthText(distance(point)) +
                    " outside the mesh, more than the tolerance of " +
                    LengthText(tolerance) + "; " +
                    MendOfPointsOutside(distance.maxCoeff(), diagonal));
    }
  }
  const Eigen::Index num_outside = (distance.array() > 0).count();
  if (num_outside > 0) {
    notices.push_back(PrintablePath(path) + ": " + std::to_string(num_outside) +
                      " of " + std::to_string(distance.size()) +
                      " points lie outside the mesh, up to " +
                      LengthText(distance.maxCoeff()) +
                      "; they count as the nearest points of its surface");
  }
}

// All files lie over one mesh, so that they have its unit, whatever that is.
void CheckUnit(const std::filesystem::path& path, const std::string& own,
               std::string& unit) {
  if (!own.empty() && !unit.empty() && own != unit) {
    ThrowInputError(
        path, "the positions are in " + own +
                  ", but those of another file of the scene are in " + unit +
                  "; give \"unit\", the unit of the mesh");
  }
  unit = own.empty() ? unit : own;
}

// Points that were measured in another unit than the mesh has may all lie in a
// corner of it.
void CheckSpan(const std::filesystem::path& path, const PointsFile& file,
               const Mesh& mesh, const TableOptions& options) {
  constexpr double kLeastSpan = 0.01;
  constexpr Eigen::Index kFewPoints = 3;
  const double span = DiagonalOf(file.positions);
  const double size = DiagonalOf(mesh.nodes);
  if (file.positions.cols() > kFewPoints && span < kLeastSpan * size &&
      !options.unit) {
    ThrowInputError(
        path, "its points span " + LengthText(span) +
                  (file.unit.empty() ? "" : " " + file.unit) +
                  ", but the mesh spans " + LengthText(size) +
                  "; give \"unit\", the unit of the mesh, beside \"points\"");
  }
}

// The columns of `b` behind those of `a`.
Eigen::MatrixXd Append(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  Eigen::MatrixXd both(b.rows(), a.cols() + b.cols());
  both << a, b;
  return both;
}

void AppendPoints(const PointsFile& file, const MeshPoints& points,
                  PointDisplacements& all) {
  all.points.elements.conservativeResize(all.points.Size() + points.Size());
  all.points.elements.tail(points.Size()) = points.elements;
  all.points.local = Append(all.points.local, points.local);
  all.displacement = Append(all.displacement, file.displacement);
  if (file.noise_sd.size() != 0) {
    all.noise_sd = Append(all.noise_sd, file.noise_sd);
  }
}

}  // namespace

PointDisplacements ReadMeasuredPoints(const JsonValue& displacement,
                                      const Mesh& mesh,
                                      const PointLocator& locator,
                                      std::string& unit,
                                      std::vector<std::string>& notices,
                                      std::vector<FileLines>& lines) {
  displacement.CheckKeys(WithTableKeys({"points", "tolerance"}));
  const TableOptions options = ReadTableOptions(displacement, mesh.Dimension());
  const double tolerance = ToleranceOf(displacement, mesh);
  PointDisplacements all;
  all.points.local.resize(mesh.Dimension(), 0);
  all.displacement.resize(mesh.Dimension(), 0);
  all.noise_sd.resize(mesh.Dimension(), 0);
  for (const std::filesystem::path& path : FilesOf(displacement.At("points"))) {
    const PointsFile file = ReadPointsFile(path, mesh.Dimension(), options);
    CheckUnit(path, file.unit, unit);
    notices.insert(notices.end(), file.notices.begin(), file.notices.end());
    const LocatedPoints located = locator.Locate(file.positions);
    CheckSpan(path, file, mesh, options);
    CheckDistances(path, file, located.distance, tolerance,
                   DiagonalOf(mesh.nodes), notices);
    AppendPoints(file, located.points, all);
    lines.push_back({path, file.lines});
    if (all.noise_sd.cols() != 0 && all.noise_sd.cols() != all.points.Size()) {
      ThrowInputError(path,
                      "only some files of the load case have columns of "
                      "standard deviations; give them in all files or in none");
    }
  }
  if (all.noise_sd.cols() == 0) {
    all.noise_sd.resize(0, 0);
  }
  return all;
}

}  // namespace elastimate
