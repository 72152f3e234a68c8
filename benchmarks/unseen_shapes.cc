#include "benchmarks/unseen_shapes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "elastimate/core/mesh/facets.h"

namespace elastimate {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

constexpr double kPi = 3.14159265358979323846;

enum Axis { kX, kY, kZ };

bool KeepsAll(const Vector3d& /*centre*/) { return true; }

// The points of the grid with this coordinate.
Region At(Axis axis, double coordinate) {
  return [=](const Vector3d& grid) { return grid(axis) == coordinate; };
}

Region In(const Vector3d& lower, const Vector3d& upper) {
  return [=](const Vector3d& grid) {
    return (grid.array() >= lower.array()).all() &&
           (grid.array() <= upper.array()).all();
  };
}

Eigen::MatrixXi FacetsIn(const VoxelMesh& voxels, const Region& region) {
  return BoundaryFacetsWhere(
      voxels.mesh, [&](int node) { return region(voxels.grid.col(node)); });
}

LoadedShape Pulled(std::string name, const Region& region,
                   const Vector3d& traction) {
  return {std::move(name), [=](const VoxelMesh& voxels) -> std::vector<Load> {
            return {Traction{FacetsIn(voxels, region), traction}};
          }};
}

LoadedShape Pressed(std::string name, const Region& region, double pressure) {
  return {std::move(name), [=](const VoxelMesh& voxels) -> std::vector<Load> {
            return {Pressure{FacetsIn(voxels, region), pressure}};
          }};
}

LoadedShape Weighed(const Vector3d& force_density) {
  return {"weight", [=](const VoxelMesh& /*voxels*/) -> std::vector<Load> {
            return {BodyForce{force_density}};
          }};
}

// Triangles of a mesh: their centres, 3 x n, and areas.
struct Triangles {
  Eigen::Matrix3Xd centre;
  Eigen::VectorXd area;

  Triangles(const Mesh& mesh, const Eigen::MatrixXi& facets)
      : centre(3, facets.cols()), area(facets.cols()) {
    for (Eigen::Index i = 0; i < facets.cols(); ++i) {
      centre.col(i) = mesh.nodes(Eigen::all, facets.col(i)).rowwise().mean();
      area(i) = FacetArea(mesh, facets.col(i));
    }
  }
};

// Tractions around the axis through the centre of the region, in proportion to
// the distance from it; `largest` [pressure] is that of the furthest facet.
LoadedShape Twisted(const Region& region, Axis axis, double largest) {
  return {"torsion", [=](const VoxelMesh& voxels) {
            const Eigen::MatrixXi facets = FacetsIn(voxels, region);
            const Triangles triangles(voxels.mesh, facets);
            const Vector3d middle =
                triangles.centre * triangles.area / triangles.area.sum();
            Eigen::Matrix3Xd traction(3, facets.cols());
            for (Eigen::Index i = 0; i < facets.cols(); ++i) {
              traction.col(i) =
                  Vector3d::Unit(axis).cross(triangles.centre.col(i) - middle);
            }
            traction *= largest / traction.colwise().norm().maxCoeff();
            std::vector<Load> loads;
            for (Eigen::Index i = 0; i < facets.cols(); ++i) {
              loads.emplace_back(Traction{facets.col(i), traction.col(i)});
            }
            return loads;
          }};
}

// A square, from -1 to 1, with its sides bulged and its corners drawn in: half
// of the way to a circle, where corners would be flat.
Eigen::Vector2d Rounded(double a, double b) {
  constexpr double kBulge = 0.25;
  return {a * std::sqrt(1 - kBulge * b * b), b * std::sqrt(1 - kBulge * a * a)};
}

UnseenShape Dumbbell() {
  UnseenShape shape;
  shape.name = "dumbbell";
  shape.half = Half::kCalibration;
  shape.body = {{10, 4, 4}, KeepsAll, [](const Vector3d& grid) {
                  const double x = grid(0) / 10;
                  const double width = 0.03 * (1 + 0.4 * std::cos(2 * kPi * x));
                  const Eigen::Vector2d section =
                      width * Rounded(grid(1) / 2 - 1, grid(2) / 2 - 1);
                  return Vector3d(0.3 * x, section(0), section(1));
                }};
  shape.clamped = At(kX, 0);
  shape.experiments = {Pulled("tension", At(kX, 10), {40, 0, 0}),
                       Twisted(At(kX, 10), kX, 20)};
  return shape;
}

UnseenShape TwistedPrism() {
  UnseenShape shape;
  shape.name = "twisted prism";
  shape.half = Half::kReport;
  shape.body = {{4, 3, 12}, KeepsAll, [](const Vector3d& grid) {
                  const Eigen::Rotation2Dd turn(kPi / 2 * grid(2) / 12);
                  const Eigen::Vector2d section =
                      turn * Eigen::Vector2d(0.012 * (grid(0) - 2),
                                             0.012 * (grid(1) - 1.5));
                  return Vector3d(section(0), section(1), 0.018 * grid(2));
                }};
  shape.clamped = At(kZ, 0);
  shape.experiments = {Pulled("tension", At(kZ, 12), {0, 0, 50}),
                       Twisted(At(kZ, 12), kZ, 20)};
  return shape;
}

// Around the z axis: of two layers of cells, `num_cells` of them around it and
// six of this height along it.
VoxelBody TubeBody(int num_cells, double height,
                   std::function<double(const Vector3d&)> radius) {
  return {{num_cells, 2, 6},
          KeepsAll,
          [=](const Vector3d& grid) {
            const double angle = 2 * kPi * grid(0) / num_cells;
            return Vector3d(radius(grid) * std::cos(angle),
                            radius(grid) * std::sin(angle), height * grid(2));
          },
          true};
}

UnseenShape ThickTube() {
  UnseenShape shape;
  shape.name = "thick tube";
  shape.half = Half::kCalibration;
  shape.body = TubeBody(
      12, 0.02, [](const Vector3d& grid) { return 0.03 + 0.01 * grid(1); });
  shape.clamped = At(kZ, 0);
  shape.experiments = {Pressed("inner pressure", At(kY, 0), 60),
                       Twisted(At(kZ, 6), kZ, 40)};
  return shape;
}

UnseenShape HollowCone() {
  UnseenShape shape;
  shape.name = "hollow cone";
  shape.half = Half::kReport;
  shape.body = TubeBody(14, 0.018, [](const Vector3d& grid) {
    return 0.05 - 0.004 * grid(2) + 0.006 * grid(1);
  });
  shape.clamped = At(kZ, 0);
  shape.experiments = {Pressed("inner pressure", At(kY, 0), 40),
                       Twisted(At(kZ, 6), kZ, 30)};
  return shape;
}

UnseenShape PlateWithHole() {
  UnseenShape shape;
  shape.name = "plate with a hole";
  shape.half = Half::kCalibration;
  shape.body = {
      {10, 8, 2},
      [](const Vector3d& centre) {
        return std::abs(centre(0) - 5) > 1 || std::abs(centre(1) - 4) > 1;
      },
      [](const Vector3d& grid) {
        // Squares around the middle are circles at the hole.
        const Eigen::Vector2d from = {grid(0) - 5, grid(1) - 4};
        const double square = from.cwiseAbs().maxCoeff();
        const double square_share = std::clamp((square - 1) / 2, 0., 1.);
        const double scale =
            square_share + (1 - square_share) * square / from.norm();
        return Vector3d(0.02 * (5 + scale * from(0)),
                        0.02 * (4 + scale * from(1)), 0.012 * grid(2));
      }};
  shape.clamped = At(kX, 0);
  shape.experiments = {Pulled("tension", At(kX, 10), {50, 0, 0}),
                       Pressed("pressure", At(kZ, 2), 1)};
  return shape;
}

UnseenShape ShallowDome() {
  UnseenShape shape;
  shape.name = "shallow dome";
  shape.half = Half::kReport;
  shape.body = {{12, 12, 1}, KeepsAll, [](const Vector3d& grid) {
                  const double a = grid(0) / 6 - 1;
                  const double b = grid(1) / 6 - 1;
                  const Eigen::Vector2d foot = 0.1 * Rounded(a, b);
                  return Vector3d(
                      foot(0), foot(1),
                      0.03 * (1 - a * a) * (1 - b * b) + 0.01 * grid(2));
                }};
  shape.clamped = [](const Vector3d& grid) {
    return grid(0) == 0 || grid(0) == 12 || grid(1) == 0 || grid(1) == 12;
  };
  shape.experiments = {Pressed("pressure below", At(kZ, 0), 20),
                       Weighed({600, 0, -1200})};
  return shape;
}

UnseenShape LBracket() {
  UnseenShape shape;
  shape.name = "L bracket";
  shape.half = Half::kCalibration;
  shape.body = {
      {8, 4, 8},
      [](const Vector3d& centre) { return centre(0) < 3 || centre(2) > 5; },
      [](const Vector3d& grid) -> Vector3d { return 0.01 * grid; }};
  shape.clamped = At(kZ, 0);
  shape.experiments = {
      Pressed("pressure on the arm", In({3, 0, 8}, {8, 4, 8}), 15),
      Pulled("sideways", At(kX, 8), {0, 20, 0})};
  shape.hexahedra_per_edge = 5;
  return shape;
}

UnseenShape BranchingBody() {
  UnseenShape shape;
  shape.name = "branching body";
  shape.half = Half::kReport;
  shape.body = {{9, 3, 9},
                [](const Vector3d& centre) {
                  return std::abs(centre(0) - 4.5) < 1.5 || centre(2) > 6;
                },
                [](const Vector3d& grid) {
                  // The arms rise: a Y.
                  const double from_middle = grid(0) - 4.5;
                  return Vector3d(
                      0.012 * from_middle, 0.012 * grid(1),
                      0.012 * grid(2) * (1 + 0.02 * from_middle * from_middle));
                }};
  shape.clamped = At(kZ, 0);
  shape.experiments = {
      Pulled("pull on an arm", At(kX, 9), {6, 0, -3}),
      {"arms apart and weight",
       [](const VoxelMesh& voxels) -> std::vector<Load> {
         return {Traction{FacetsIn(voxels, At(kX, 9)), Vector3d(4, 2, 0)},
                 Traction{FacetsIn(voxels, At(kX, 0)), Vector3d(-4, 2, 0)},
                 BodyForce{Vector3d(0, 0, -100)}};
       }}};
  return shape;
}

UnseenShape Arch() {
  UnseenShape shape;
  shape.name = "arch";
  shape.half = Half::kCalibration;
  shape.body = {{16, 3, 3}, KeepsAll, [](const Vector3d& grid) {
                  const double angle = kPi * grid(0) / 16;
                  const double radius = 0.1 + 0.012 * grid(1);
                  return Vector3d(radius * std::cos(angle), 0.012 * grid(2),
                                  radius * std::sin(angle));
                }};
  shape.clamped = [](const Vector3d& grid) {
    return grid(0) == 0 || grid(0) == 16;
  };
  shape.experiments = {Weighed({0, 0, -1500}),
                       Pulled("oblique load on the crown",
                              In({6, 3, 0}, {10, 3, 3}), {30, 15, -60})};
  return shape;
}

UnseenShape RingSector() {
  UnseenShape shape;
  shape.name = "ring sector";
  shape.half = Half::kReport;
  shape.body = {{15, 3, 3}, KeepsAll, [](const Vector3d& grid) {
                  const double angle = 2 * kPi / 3 * grid(0) / 15;
                  const double radius = 0.08 + 0.011 * grid(1);
                  return Vector3d(radius * std::cos(angle),
                                  radius * std::sin(angle), 0.011 * grid(2));
                }};
  shape.clamped = At(kX, 0);
  shape.experiments = {Pulled("in the plane", At(kX, 15), {-4, 2, 0}),
                       Pulled("out of the plane", At(kX, 15), {0, 0, 2})};
  return shape;
}

UnseenShape ConeFrustum() {
  UnseenShape shape;
  shape.name = "cone frustum";
  shape.half = Half::kCalibration;
  shape.body = {{4, 4, 10}, KeepsAll, [](const Vector3d& grid) {
                  const Eigen::Vector2d section =
                      (0.04 - 0.002 * grid(2)) *
                      Rounded(grid(0) / 2 - 1, grid(1) / 2 - 1);
                  return Vector3d(section(0), section(1), 0.015 * grid(2));
                }};
  shape.clamped = At(kZ, 0);
  shape.experiments = {Pulled("oblique", At(kZ, 10), {8, 0, -60}),
                       Twisted(At(kZ, 10), kZ, 40)};
  return shape;
}

UnseenShape SteppedShaft() {
  UnseenShape shape;
  shape.name = "stepped shaft";
  shape.half = Half::kReport;
  shape.body = {{4, 4, 13},
                [](const Vector3d& centre) {
                  return centre(2) < 7 || (std::abs(centre(0) - 2) < 1 &&
                                           std::abs(centre(1) - 2) < 1);
                },
                [](const Vector3d& grid) {
                  const Eigen::Vector2d section =
                      0.03 * Rounded(grid(0) / 2 - 1, grid(1) / 2 - 1);
                  return Vector3d(section(0), section(1), 0.014 * grid(2));
                }};
  shape.clamped = At(kZ, 0);
  shape.experiments = {Pulled("oblique", At(kZ, 13), {4, 2, 40}),
                       Twisted(At(kZ, 13), kZ, 40)};
  return shape;
}

UnseenShape IBeam() {
  UnseenShape shape;
  shape.name = "I beam";
  shape.half = Half::kCalibration;
  shape.body = {
      {10, 5, 6},
      [](const Vector3d& centre) {
        return std::abs(centre(2) - 3) > 2 || std::abs(centre(1) - 2.5) < 0.5;
      },
      [](const Vector3d& grid) {
        return Vector3d(0.025 * grid(0), 0.01 * grid(1), 0.012 * grid(2));
      }};
  shape.clamped = At(kX, 0);
  shape.experiments = {Pulled("bending", At(kX, 10), {0, 1, -8}),
                       Twisted(At(kX, 10), kX, 15)};
  return shape;
}

UnseenShape SlabWithCavity() {
  UnseenShape shape;
  shape.name = "slab with a cavity";
  shape.half = Half::kReport;
  const Region cavity = In({1, 2, 1}, {3, 4, 3});
  shape.body = {{6, 6, 4},
                [=](const Vector3d& centre) { return !cavity(centre); },
                [](const Vector3d& grid) -> Vector3d {
                  return grid.cwiseProduct(Vector3d(0.02, 0.02, 0.015));
                }};
  shape.clamped = At(kZ, 0);
  shape.experiments = {
      Pressed("pressure above", At(kZ, 4), 60),
      Pulled("oblique load above", In({2, 0, 4}, {6, 6, 4}), {40, 0, -80})};
  shape.hexahedra_per_edge = 5;
  return shape;
}

}  // namespace

std::string_view HalfName(Half half) {
  return half == Half::kCalibration ? "calibration" : "report";
}

std::vector<UnseenShape> UnseenShapes() {
  return {Dumbbell(),      TwistedPrism(),  ThickTube(),   HollowCone(),
          PlateWithHole(), ShallowDome(),   LBracket(),    BranchingBody(),
          Arch(),          RingSector(),    ConeFrustum(), SteppedShaft(),
          IBeam(),         SlabWithCavity()};
}

Scene UnmeasuredScene(const UnseenShape& shape, const VoxelMesh& voxels) {
  Scene scene;
  scene.mesh = voxels.mesh;
  scene.supports.held.resize(3, voxels.grid.cols());
  for (Eigen::Index node = 0; node < voxels.grid.cols(); ++node) {
    scene.supports.held.col(node).setConstant(
        shape.clamped(voxels.grid.col(node)));
  }
  scene.supports.displacement.setZero(3, voxels.grid.cols());
  for (const LoadedShape& experiment : shape.experiments) {
    scene.load_cases.emplace_back();
    scene.load_cases.back().loads = experiment.loads(voxels);
  }
  return scene;
}

}  // namespace elastimate
