#include "elastimate/estimators/misfit/curvature.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace elastimate
