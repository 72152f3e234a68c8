#include "elastimate/estimators/misfit/across_range.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "elastimate/core/equilibrium/simulated_measurement.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

constexpr double kStiffness = 5e4;

// With exact displacements of a known modulus, so that the square sum at
// another ratio is that of the change of the displacements.
class AcrossRange : public ::testing::Test {
 protected:
  explicit AcrossRange(double poisson_ratio = 0.499)
      : poisson_ratio_(poisson_ratio) {
    scene_.materials = {
        {"isotropic", {}, {{"youngs_modulus", kStiffness}}, {}}};
    exact_ = Displacement(poisson_ratio);
    Measure({kStiffness, poisson_ratio}, scene_);
    misfit_.emplace(scene_, EstimatorOptions());
  }

  Eigen::MatrixXd Displacement(double poisson_ratio) const {
    Scene scene = scene_;
    Measure({kStiffness, poisson_ratio}, scene);
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

TEST_F(AcrossRangeFarFromEnds, CostsNothingWhereTheErrorIsSmall) {
  EXPECT_EQ(Added(1, 0.02), 0);
  EXPECT_EQ(misfit_->Model().WorkDone().factorizations, 0);
}

// Such a look finds a second minimum, as at -nu in bending.
TEST_F(AcrossRangeFarFromEnds, WidensWhereAnotherValueFitsAsWell) {
  const double standard_error = 0.05;
  const double half_way = Move(1.0 / 2);
  const double variance = Rise(1.0 / 2) / 4;
  EXPECT_GT(Added(variance, standard_error),
            half_way * half_way / 4 - standard_error * standard_error);
  EXPECT_EQ(Added(Rise(1.0 / 4) / 10, standard_error), 0);
}

}  // namespace
}  // namespace elastimate
