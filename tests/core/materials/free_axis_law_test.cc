#include "elastimate/core/materials/free_axis_law.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "elastimate/core/materials/laws.h"
#include "tests/anisotropy.h"
#include "tests/core/random_values.h"

namespace elastimate {
namespace {

constexpr SectionModel kSolid = SectionModel::kSolid;

const Law& KnownAxisLaw() { return *FindLaw("transversely_isotropic"); }

// Returns the constants of fibres, and of a material that is softer along its
// axis.
std::vector<Eigen::VectorXd> ConstantsOfMaterials() {
  Eigen::VectorXd fibres(5);
  fibres << 9, 3, 0.32, 0.4, 1.5;
  Eigen::VectorXd layers(5);
  layers << 1, 2, 0.1, 0.25, 0.6;
  std::vector<Eigen::VectorXd> all(2);
  all[0] = fibres;
  all[1] = layers;
  return all;
}

// Returns axes along the coordinates, where the chart ends, and between.
std::vector<Eigen::Vector3d> AllAxes() {
  std::vector<Eigen::Vector3d> axes = {{1, 0, 0}, {0, 1, 0},  {0, 0, 1},
                                       {0, 1, 1}, {0, 1, -1}, {1e-6, 0.3, 1}};
  for (unsigned seed = 1; seed <= 10; ++seed) {
    axes.emplace_back(testing::RandomFrame(3, seed).col(0));
  }
  for (Eigen::Vector3d& axis : axes) {
    axis.normalize();
  }
  return axes;
}

// Returns the textbook stiffness in Voigt notation, row by row, for a frame
// whose first direction is the axis.
Eigen::VectorXd TextbookModuli(const Eigen::VectorXd& constants,
                               const Eigen::Vector3d& axis) {
  const Eigen::Vector3d across = axis.unitOrthogonal();
  Eigen::Matrix3d frame;
  frame << axis, across, axis.cross(across);
  const Eigen::MatrixXd stiffness = testing::SeenFromOutside(
      testing::TextbookStiffnessOf(KnownAxisLaw(), constants), frame);
  Eigen::VectorXd moduli(21);
  int k = 0;
  for (int i = 0; i < 6; ++i) {
    for (int j = i; j < 6; ++j) {
      moduli(k++) = stiffness(i, j);
    }
  }
  return moduli;
}

// Returns the angle between two axes, whose signs do not matter.
double AngleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::asin(std::min(1.0, a.cross(b).norm()));
}

TEST(FreeAxisLaw, FindsTheAxisAndTheConstantsOfEachStiffness) {
  const FreeAxisLaw law;
  for (const Eigen::VectorXd& constants : ConstantsOfMaterials()) {
    for (const Eigen::Vector3d& axis : AllAxes()) {
      const Eigen::VectorXd moduli = TextbookModuli(constants, axis);
      const Eigen::VectorXd parameters = law.ParametersOf(moduli, kSolid);
      ASSERT_EQ(parameters.size(), 7);
      EXPECT_LT((parameters.head(5) - constants).norm(), 1e-9);
      EXPECT_LT(AngleBetween(FreeAxisLaw::Axis(parameters), axis), 1e-9);
      EXPECT_GE(FreeAxisLaw::Axis(parameters)(0), 0);
      EXPECT_LE(parameters.tail(2).norm(), M_PI / 2 + 1e-9);
      EXPECT_LT((law.Moduli(parameters, kSolid) - moduli).norm(),
                1e-9 * moduli.norm());
    }
  }
}

TEST(FreeAxisLaw, HasItsJacobiansAtEachAxis) {
  constexpr double kStep = 1e-6;
  const FreeAxisLaw law;
  for (const Eigen::Vector3d& axis : AllAxes()) {
    const Eigen::VectorXd parameters = law.ParametersOf(
        TextbookModuli(ConstantsOfMaterials()[0], axis), kSolid);
    const Eigen::MatrixXd jacobian = law.ModuliJacobian(parameters, kSolid);
    const Eigen::MatrixXd of_axis = FreeAxisLaw::AxisJacobian(parameters);
    for (Eigen::Index i = 0; i < parameters.size(); ++i) {
      Eigen::VectorXd more = parameters;
      Eigen::VectorXd less = parameters;
      more(i) += kStep;
      less(i) -= kStep;
      EXPECT_LT(
          (jacobian.col(i) -
           (law.Moduli(more, kSolid) - law.Moduli(less, kSolid)) / (2 * kStep))
              .norm(),
          1e-8 * jacobian.norm());
      const Eigen::Vector3d end = FreeAxisLaw::Axis(more);
      const Eigen::Vector3d start = FreeAxisLaw::Axis(less);
      // At the rim of the half sphere, the axis may change its sign.
      const Eigen::Vector3d change =
          end - (end.dot(start) > 0 ? start : Eigen::Vector3d(-start));
      const double sign = end.dot(FreeAxisLaw::Axis(parameters)) > 0 ? 1 : -1;
      EXPECT_LT((of_axis.col(i) - sign * change / (2 * kStep)).norm(), 1e-8);
    }
  }
}

// The stiffness has no axis.  The law that is found must be the nearest in the
// norm of the weights.
TEST(FreeAxisLaw, FindsTheNearestStiffness) {
  const FreeAxisLaw law;
  const Eigen::VectorXd moduli =
      TextbookModuli(ConstantsOfMaterials()[0], AllAxes().back()) +
      0.1 * testing::RandomMatrix(21, 1, 1);
  const Eigen::MatrixXd weights = Eigen::MatrixXd::Identity(21, 21) +
                                  0.2 * testing::RandomMatrix(21, 21, 2);
  const Eigen::VectorXd nearest = law.NearestParameters(moduli, weights);
  const auto distance = [&](const Eigen::VectorXd& parameters) {
    return (weights * (law.Moduli(parameters, kSolid) - moduli)).norm();
  };
  for (Eigen::Index i = 0; i < nearest.size(); ++i) {
    for (const double step : {-1e-3, 1e-3}) {
      Eigen::VectorXd other = nearest;
      other(i) += step;
      EXPECT_GT(distance(other), distance(nearest));
    }
  }
  for (const Eigen::Vector3d& axis : AllAxes()) {
    Eigen::VectorXd other = nearest;
    other.tail(2) =
        law.ParametersOf(TextbookModuli(ConstantsOfMaterials()[0], axis),
                         kSolid)
            .tail(2);
    EXPECT_GT(distance(other), distance(nearest));
  }
}

TEST(FreeAxisLaw, HasTheDerivativesOfItsAnisotropy) {
  constexpr double kStep = 1e-6;
  Eigen::VectorXd parameters(7);
  parameters << ConstantsOfMaterials()[0], 0.3, -0.2;
  const Eigen::MatrixXd jacobian = FreeAxisLaw::AnisotropyJacobian(parameters);
  for (Eigen::Index i = 0; i < parameters.size(); ++i) {
    Eigen::VectorXd more = parameters;
    Eigen::VectorXd less = parameters;
    more(i) += kStep;
    less(i) -= kStep;
    EXPECT_LT((jacobian.col(i) -
               (FreeAxisLaw::Anisotropy(more) - FreeAxisLaw::Anisotropy(less)) /
                   (2 * kStep))
                  .norm(),
              1e-8);
  }
  parameters.head(5) << 2.6, 2.6, 0.3, 0.3, 1;
  EXPECT_LT(FreeAxisLaw::Anisotropy(parameters).norm(), 1e-15);
}

TEST(FreeAxisLaw, OfWhatIsAlikeInAllDirectionsHasTheIsotropicConstants) {
  Eigen::VectorXd constants(5);
  constants << 2.6, 2.6, 0.3, 0.3, 1;
  const FreeAxisLaw law;
  const Eigen::VectorXd parameters = law.ParametersOf(
      TextbookModuli(constants, Eigen::Vector3d::UnitY()), kSolid);
  EXPECT_LT((parameters.head(5) - constants).norm(), 1e-9);
  EXPECT_TRUE(parameters.allFinite());
}

TEST(FreeAxisLaw, HasNoParametersNearWhatIsNotPositiveDefinite) {
  const Eigen::VectorXd moduli =
      -TextbookModuli(ConstantsOfMaterials()[0], Eigen::Vector3d::UnitX());
  EXPECT_TRUE(FreeAxisLaw().ParametersOf(moduli, kSolid).array().isNaN().all());
}

}  // namespace
}  // namespace elastimate
