#include "elastimate/io/dic/point_mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <set>
#include <vector>

#include "tests/throws.h"

namespace elastimate {
namespace {

// Returns the points of a grid of spacing (0.5, 0.25), without those in a hole
// of radius 1 around (2, 2).
Eigen::Matrix2Xd GridWithHole() {
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i <= 8; ++i) {
    for (int j = 0; j <= 16; ++j) {
      const Eigen::Vector2d x(0.5 * i, 0.25 * j);
      if ((x - Eigen::Vector2d(2, 2)).norm() > 1) {
        points.push_back(x);
      }
    }
  }
  Eigen::Matrix2Xd all(2, Eigen::Index(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) {
    all.col(Eigen::Index(i)) = points[i];
  }
  return all;
}

double AreaOf(const Eigen::Matrix2Xd& positions, const PointMesh& mesh) {
  double area = 0;
  for (const auto& element : mesh.elements.colwise()) {
    const Eigen::Index n = element.size();
    for (Eigen::Index i = 0; i < n; ++i) {
      const Eigen::Vector2d a = positions.col(mesh.points[element(i)]);
      const Eigen::Vector2d b =
          positions.col(mesh.points[element((i + 1) % n)]);
      area += (a(0) * b(1) - a(1) * b(0)) / 2;
    }
  }
  return area;
}

TEST(PointMesh, OfAGridIsOfQuadrilateralsAndKeepsTheHole) {
  const Eigen::Matrix2Xd positions = GridWithHole();
  const PointMesh mesh = MeshOfPoints(positions, {});
  EXPECT_EQ(mesh.kind, ElementKind::kQuad4);
  // A cell is there unless it has a corner in the hole.
  int cells = 0;
  for (int i = 0; i < 8; ++i) {
    for (int j = 0; j < 16; ++j) {
      bool is_whole = true;
      for (int k = 0; k < 4; ++k) {
        const Eigen::Vector2d x(0.5 * (i + k % 2), 0.25 * (j + k / 2));
        is_whole = is_whole && (x - Eigen::Vector2d(2, 2)).norm() > 1;
      }
      cells += is_whole ? 1 : 0;
    }
  }
  EXPECT_EQ(mesh.elements.cols(), cells);
  EXPECT_NEAR(AreaOf(positions, mesh), cells * 0.125, 1e-12);
}

// One lost point lies inside, two lie beside each other, and one is on the rim.
// Points of the hole may not be lost.
TEST(GapsOfGrids, AreLostWhereTheyAreSmall) {
  const Eigen::Matrix2Xd whole = GridWithHole();
  EXPECT_EQ(GapsOf(whole).lost.cols(), 0);
  ASSERT_EQ(GapsOf(whole).doubtful.size(), 1);
  EXPECT_LT((GapsOf(whole).doubtful[0].rowwise().mean() - Eigen::Vector2d(2, 2))
                .norm(),
            1e-9);
  const std::vector<Eigen::Vector2d> lost = {
      {0.5, 0.5}, {3.5, 3.5}, {3.5, 3.25}, {0, 2}};
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < whole.cols(); ++i) {
    const bool is_lost =
        std::any_of(lost.begin(), lost.end(), [&](const Eigen::Vector2d& x) {
          return (x - whole.col(i)).norm() < 1e-9;
        });
    if (!is_lost) {
      kept.push_back(i);
    }
  }
  ASSERT_EQ(Eigen::Index(kept.size()), whole.cols() - 4);
  const Eigen::Matrix2Xd found =
      GapsOf(Eigen::Matrix2Xd(whole(Eigen::all, kept))).lost;
  ASSERT_EQ(found.cols(), 4);
  for (const Eigen::Vector2d& x : lost) {
    EXPECT_LT((found.colwise() - x).colwise().norm().minCoeff(), 1e-9);
  }
  EXPECT_EQ(GapsOf(Eigen::Matrix2Xd::Random(2, 30)).lost.cols(), 0);
  EXPECT_TRUE(GapsOf(Eigen::Matrix2Xd::Random(2, 30)).doubtful.empty());
}

// Returns those of 21 x 8 points for which `is_there`.
Eigen::Matrix2Xd GridWhere(const std::function<bool(int, int)>& is_there) {
  Eigen::Matrix2Xd points(2, 0);
  for (int i = 0; i < 21; ++i) {
    for (int j = 0; j < 8; ++j) {
      if (is_there(i, j)) {
        points.conservativeResize(Eigen::NoChange, points.cols() + 1);
        points.rightCols<1>() << i, j;
      }
    }
  }
  return points;
}

Eigen::Index NumLost(const std::function<bool(int, int)>& is_there) {
  return GapsOf(GridWhere(is_there)).lost.cols();
}

std::vector<Eigen::Index> DoubtfulSizes(
    const std::function<bool(int, int)>& is_there) {
  std::vector<Eigen::Index> sizes;
  for (const Eigen::Matrix2Xd& gap : GapsOf(GridWhere(is_there)).doubtful) {
    sizes.push_back(gap.cols());
  }
  return sizes;
}

TEST(GapsOfGrids, AreLostRowsAndColumns) {
  EXPECT_EQ(NumLost([](int, int j) { return j != 2; }), 21);
  EXPECT_EQ(NumLost([](int, int j) { return j != 2 && j != 3; }), 42);
  EXPECT_EQ(NumLost([](int i, int) { return i != 9; }), 8);
  // A lost row ends at a hole, and a lost column is interrupted by it.
  const auto is_in_hole = [](int i, int j) {
    return i > 6 && i < 14 && j > 0 && j < 7;
  };
  EXPECT_EQ(NumLost([&](int i, int j) {
              return !is_in_hole(i, j) && (j != 3 || i >= 7);
            }),
            7);
  EXPECT_EQ(NumLost([&](int i, int j) { return !is_in_hole(i, j) && i != 9; }),
            2);
}

// A slot inside, one that is open at one end, a bite out of the free edge and a
// step of it: either the specimen has them, or the camera lost points.
TEST(GapsOfGrids, AreDoubtfulWhereTheSpecimenMayEnd) {
  using ::testing::ElementsAre;
  EXPECT_THAT(
      DoubtfulSizes([](int i, int j) { return j != 3 || i < 5 || i > 15; }),
      ElementsAre(11));
  EXPECT_THAT(DoubtfulSizes([](int i, int j) { return j != 3 || i > 15; }),
              ElementsAre(16));
  EXPECT_THAT(
      DoubtfulSizes([](int i, int j) { return j < 6 || i < 5 || i > 7; }),
      ElementsAre(6));
  EXPECT_THAT(DoubtfulSizes([](int i, int j) {
                return (j < 7 || i > 9) && (i != 15 || j < 2 || j > 4);
              }),
              ElementsAre(10, 3));
  // More places than half of the points are beside the specimen.
  EXPECT_THAT(DoubtfulSizes([](int i, int j) { return j < 5 || i < 2; }),
              ElementsAre());
}

TEST(PointMesh, OfScatteredPointsIsOfTrianglesWithoutGaps) {
  Eigen::Matrix2Xd positions = GridWithHole();
  std::mt19937_64 generator(1);
  std::uniform_real_distribution<double> noise(-0.05, 0.05);
  for (double& x : positions.reshaped()) {
    x += noise(generator);
  }
  const PointMesh mesh = MeshOfPoints(positions, 0.9);
  EXPECT_EQ(mesh.kind, ElementKind::kTri3);
  EXPECT_EQ(Eigen::Index(mesh.points.size()), positions.cols());
  // The area is a square of 4 x 4 without a hole of pi, apart from triangles
  // along the rims.
  EXPECT_NEAR(AreaOf(positions, mesh), 16 - M_PI, 1.2);
  for (const auto& element : mesh.elements.colwise()) {
    for (int i = 0; i < 3; ++i) {
      EXPECT_LE((positions.col(mesh.points[element(i)]) -
                 positions.col(mesh.points[element((i + 1) % 3)]))
                    .norm(),
                0.9);
    }
  }
}

TEST(PointMesh, LeavesOutWhatDoesNotHangTogether) {
  Eigen::Matrix2Xd positions(2, 9);
  positions << 0, 1, 0, 1.1, 0, 1, 50, 51, 50,  //
      0, 0, 1.1, 1, 2, 2.1, 50, 50.1, 51;
  const PointMesh mesh = MeshOfPoints(positions, 2.0);
  EXPECT_EQ(std::set<Eigen::Index>(mesh.points.begin(), mesh.points.end()),
            (std::set<Eigen::Index>{0, 1, 2, 3, 4, 5}));
}

TEST(PointMesh, TellsPointsThatMakeNone) {
  EXPECT_THROWS_WITH(MeshOfPoints(Eigen::Matrix2Xd::Zero(2, 2), {}),
                     "fewer than three points");
  EXPECT_THROWS_WITH(MeshOfPoints(Eigen::Matrix2Xd::Random(2, 30), 1e-6),
                     "give a larger \"max_edge\"");
  Eigen::Matrix2Xd line(2, 5);
  line << 0, 1, 2, 3, 4, 0, 0, 0, 0, 0;
  EXPECT_THROWS_WITH(MeshOfPoints(line, {}), "all points lie on one line");
  line.row(1) = line.row(0) / 3;
  EXPECT_THROWS_WITH(MeshOfPoints(line, {}), "all points lie on one line");
}

}  // namespace
}  // namespace elastimate
