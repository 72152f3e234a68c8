#include "elastimate/estimators/misfit/curvature.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "elastimate/core/equilibrium/simulated_measurement.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

constexpr double kYoungsModulus = 5e4;

// With exact displacements u of a known Poisson's ratio: those of ln E + m are
// u exp(-m), so that the square sum rises to (exp(-m) - 1)^2 of that of u, of
// which a quadratic misfit rises to m^2.
class Curvature : public ::testing::Test {
 protected:
  Curvature() : scene_(testing::SmallScene("cuboid")) {
    scene_.materials = {{"isotropic", {}, {{"poisson_ratio", 0.3}}, {}}};
    Measure({kYoungsModulus, 0.3}, scene_);
    misfit_.emplace(scene_, EstimatorOptions());
  }

  double Added(double standard_error) {
    const Eigen::VectorXd x =
        misfit_->Free().VariablesOf(Eigen::Vector2d(kYoungsModulus, 0.3));
    Eigen::VectorXd rows;
    EXPECT_TRUE(misfit_->Evaluate(x, &rows, nullptr));
    return CovarianceOfCurvature(
        x, Eigen::MatrixXd::Constant(1, 1, standard_error * standard_error),
        Eigen::VectorXd::Zero(1), *misfit_)(0, 0);
  }

  Scene scene_;
  std::optional<DisplacementMisfit> misfit_;
};

TEST_F(Curvature, OfAModulusIsThatOfItsLogarithm) {
  // Two standard errors of 0.5 raise the square sum to 0.4 of what they mean,
  // so that twice as far is looked at.
  for (const auto& [standard_error, move] :
       {std::pair(0.2, 0.4), std::pair(0.5, 2.0)}) {
    const double part = std::pow(std::expm1(-move) / move, 2);
    EXPECT_NEAR(Added(standard_error),
                (1 / part - 1) * standard_error * standard_error, 1e-6);
  }
}

TEST_F(Curvature, OfASmallErrorCostsNothing) {
  EXPECT_EQ(Added(0.05), 0);
  EXPECT_EQ(misfit_->Model().WorkDone().factorizations, 1);
}

// With exact displacements of a known modulus, so that the square sum at
// another ratio is that of the change of the displacements.
class AcrossRange : public ::testing::Test {
 protected:
  explicit AcrossRange(double poisson_ratio = 0.499)
      : poisson_ratio_(poisson_ratio) {
    scene_.materials = {
        {"isotropic", {}, {{"youngs_modulus", kYoungsModulus}}, {}}};
    exact_ = Displacement(poisson_ratio);
    Measure({kYoungsModulus, poisson_ratio}, scene_);
    misfit_.emplace(scene_, EstimatorOptions());
  }

  Eigen::MatrixXd Displacement(double poisson_ratio) const {
    Scene scene = scene_;
    Measure({kYoungsModulus, poisson_ratio}, scene);
    return scene.load_cases[0].displacement;
  }

  double Move(double share) const {
    return share *
           (poisson_ratio_ - *misfit_->Free().VariableBounds()[0].lower);
  }

  // The rise of the square sum where the ratio is this share of its range
  // farther inside.
  double Rise(double share) const {
    const double moved = poisson_ratio_ - Move(share);
    return (Displacement(moved) - exact_).squaredNorm() / exact_.squaredNorm();
  }

  double Added(double variance, double standard_error) {
    const Eigen::VectorXd x = Eigen::VectorXd::Constant(1, poisson_ratio_);
    return CovarianceAcrossRange(
        x, Eigen::MatrixXd::Constant(1, 1, standard_error * standard_error),
        variance, x, *misfit_)(0, 0);
  }

  double poisson_ratio_;
  Scene scene_ = testing::SmallScene("cuboid");
  Eigen::MatrixXd exact_;
  std::optional<DisplacementMisfit> misfit_;
};

TEST_F(AcrossRange, ADipIsAsWideAsFarLooksSay) {
  const double standard_error = 1e-3;
  for (const double chi_square :
       {0.5, 4.0}) {  // Of a look at 1/8 of the range.
    const double variance = Rise(1.0 / 8) / chi_square;
    double largest = 0;
    for (const double share : {1.0 / 32, 1.0 / 8, 1.0 / 2}) {
      const double move = Move(share);
      const double of_look = Rise(share) / variance;
      if (of_look < 9) {
        largest = std::max(largest, move * move / std::max(of_look, 1.0));
      }
    }
    EXPECT_GT(largest, 1e3 * standard_error * standard_error);
    EXPECT_NEAR(Added(variance, standard_error),
                largest - standard_error * standard_error, 1e-6 * largest);
  }
}

TEST_F(AcrossRange, NothingIsAddedToALargerError) {
  EXPECT_EQ(Added(Rise(1.0 / 8) / 4, 1), 0);
}

TEST_F(AcrossRange, NothingIsAddedToWhatIsWellKnown) {
  EXPECT_EQ(Added(Rise(1.0 / 32) / 30, 1e-9), 0);
}

class AcrossRangeFarFromEnds : public AcrossRange {
 protected:
  AcrossRangeFarFromEnds() : AcrossRange(0.45) {}
};

TEST_F(AcrossRangeFarFromEnds, CostsNothing) {
  EXPECT_EQ(Added(1, 1e-9), 0);
  EXPECT_EQ(misfit_->Model().WorkDone().factorizations, 0);
}

}  // namespace
}  // namespace elastimate
