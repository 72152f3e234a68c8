#include "elastimate/estimators/misfit/material_verdicts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "elastimate/core/equilibrium/simulated_measurement.h"
#include "elastimate/estimators/registry.h"
#include "tests/dense_reference.h"
#include "tests/regions.h"

namespace elastimate {
namespace {

using Combinations = std::vector<std::string>;

const Combinations kVariableLabels = {"E of region 1", "E of region 2",
                                      "nu of region 2"};

// The covariance of ln E, ln E and nu: free by 10 largest errors along a
// direction in units of these, by a tenth across.
Eigen::MatrixXd FreeAlong(const Eigen::Vector3d& direction) {
  const Eigen::Vector3d largest(0.3, 0.3, 0.15);
  const Eigen::Vector3d unit = direction.normalized();
  return largest.asDiagonal() *
         (100 * unit * unit.transpose() + 0.01 * Eigen::Matrix3d::Identity()) *
         largest.asDiagonal();
}

Combinations CombinationsOf(const Eigen::MatrixXd& covariance) {
  return DeterminedCombinations(covariance, Eigen::Vector3d(0.3, 0.3, 0.15),
                                kVariableLabels, {true, true, false});
}

TEST(DeterminedCombinations, AreNamed) {
  EXPECT_EQ(CombinationsOf(FreeAlong({1, -1, 0})),
            Combinations({"the product of E of region 1 and E of region 2"}));
  EXPECT_EQ(CombinationsOf(FreeAlong({1, 1, 0})),
            Combinations({"the ratio of E of region 1 to E of region 2"}));
  EXPECT_EQ(
      CombinationsOf(FreeAlong({1, 0.5, 0})),
      Combinations({"one combination of E of region 1 and E of region 2"}));
  EXPECT_EQ(
      CombinationsOf(FreeAlong({0, 1, 1})),
      Combinations({"one combination of E of region 2 and nu of region 2"}));
  EXPECT_EQ(CombinationsOf(FreeAlong({1, 1, 1})),
            Combinations({"2 combinations of E of region 1, E of region 2 and "
                          "nu of region 2"}));
}

TEST(DeterminedCombinations, AreNoneOfWhatIsDeterminedOrNotAtAll) {
  EXPECT_TRUE(CombinationsOf(1e-4 * Eigen::Matrix3d::Identity()).empty());
  EXPECT_TRUE(CombinationsOf(25 * Eigen::Matrix3d::Identity()).empty());
  EXPECT_TRUE(CombinationsOf(FreeAlong({1, 0, 0})).empty());
}

// Energies by dense matrices: of material i, u^T K_i u / 2.
TEST(MaterialVerdicts, SayWhichPartOfTheEnergyIsWhere) {
  Scene scene =
      testing::TwoRegionScene({ElementKind::kTet4, SectionModel::kSolid}, 2);
  const std::vector<IsotropicElasticity> truth = {{2e3, 0.2}, {5e3, 0.4}};
  testing::MeasureByTextbook(truth, scene);
  const Estimate estimate = MakeEstimator("iterative-fe")->Run(scene, {});
  ASSERT_EQ(estimate.materials.size(), 2U);
  const Eigen::MatrixXd u = testing::SolveByTextbook(scene, truth);
  const auto energy = [&](double share) {
    const Eigen::MatrixXd stiffness = testing::TextbookStiffness(
        scene,
        {{share * truth[0].youngs_modulus, truth[0].poisson_ratio}, truth[1]});
    return (u.transpose() * stiffness * u).trace();
  };
  const double expected = (energy(2) - energy(1)) / energy(1);
  EXPECT_NEAR(*estimate.materials[0].energy_share, expected, 1e-6);
  EXPECT_NEAR(*estimate.materials[1].energy_share, 1 - expected, 1e-6);
  EXPECT_EQ(estimate.materials[0].determination, Determination::kDetermined);
}

// What is left of displacements that are exact is rounding, alike or not.
TEST(MaterialVerdicts, AreSilentAboutRounding) {
  for (const int boxes : {2, 3}) {
    Scene scene = testing::BlockUnderTraction({6, 3, 3}, {3, 1, 1});
    testing::DivideIntoRegions({boxes, 1, 1}, {3, 1, 1}, scene);
    Eigen::VectorXd truth(2 * boxes);
    for (int i = 0; i < boxes; ++i) {
      truth.segment<2>(2 * i) << 1e3 * (i + 1), 0.3;
    }
    MeasureMaterials(truth, scene);
    for (const std::string estimator : {"iterative-fe", "reduced-fe"}) {
      EXPECT_TRUE(MakeEstimator(estimator)
                      ->Run(scene, {})
                      .Sentences(Severity::kWarning)
                      .empty())
          << estimator;
    }
  }
}

// Ten blocks between 1000 and 8000, thirty points on the surface.
class TenBlocks : public ::testing::Test {
 protected:
  TenBlocks() {
    scene_ = testing::BlockUnderTraction({10, 4, 4}, {5, 2, 2});
    testing::DivideIntoRegions({5, 1, 2}, {5, 2, 2}, scene_);
    for (Material& material : scene_.materials) {
      material.known = {{"poisson_ratio", 0.3}};
    }
    Eigen::VectorXd parameters(20);
    for (int i = 0; i < 10; ++i) {
      parameters.segment<2>(2 * i) << kTruth[i], 0.3;
    }
    MeasureMaterials(parameters, scene_);
    ObserveThirtyPoints();
  }

  // Noise relative to the root mean square of what is observed.
  Estimate Run(double noise, unsigned seed) const {
    Scene scene = scene_;
    LoadCase& load_case = scene.load_cases[0];
    double square_sum = 0;
    for (const int node : points_) {
      square_sum += load_case.displacement.col(node).squaredNorm();
    }
    std::mt19937_64 generator(seed);
    std::normal_distribution<double> error(
        0, noise * std::sqrt(square_sum / (3 * double(points_.size()))));
    for (double& value : load_case.displacement.reshaped()) {
      value += error(generator);
    }
    return MakeEstimator("iterative-fe")->Run(scene, {});
  }

  static constexpr double kTruth[10] = {1000, 4500, 2000, 8000, 3000,
                                        6500, 1500, 5500, 2500, 7000};

 private:
  void ObserveThirtyPoints() {
    const Eigen::MatrixXd& nodes = scene_.mesh.nodes;
    for (int i = 0; i < nodes.cols(); ++i) {
      const Eigen::Vector3d x = nodes.col(i);
      const bool is_on_surface =
          x(0) == 0 || x(0) == 5 || x(1) == 0 || x(1) == 2 || x(2) == 2;
      if (x(2) > 0 && is_on_surface) {
        points_.push_back(i);
      }
    }
    std::mt19937_64 generator(3);
    for (std::size_t i = points_.size() - 1; i > 0; --i) {
      std::swap(points_[i], points_[generator() % (i + 1)]);
    }
    points_.resize(30);
    LoadCase& load_case = scene_.load_cases[0];
    load_case.observed.setConstant(3, nodes.cols(), false);
    for (const int node : points_) {
      load_case.observed.col(node).setConstant(true);
    }
  }

  Scene scene_;
  std::vector<int> points_;
};

using TenBlocksStatistics = TenBlocks;

// What is called determined is true to its errors, and there is much of it.  A
// usable estimate says so where not all is determined.
TEST_F(TenBlocksStatistics, AreKnownAsFarAsIsSaid) {
  constexpr int kMeasurements = 8;
  for (const double noise : {0.01, 0.1}) {
    int num_determined = 0;
    int num_covering = 0;
    double largest_score = 0;
    for (unsigned seed = 1; seed <= kMeasurements; ++seed) {
      const Estimate estimate = Run(noise, seed);
      ASSERT_EQ(estimate.materials.size(), 10U);
      bool are_all_determined = true;
      for (int i = 0; i < 10; ++i) {
        if (estimate.materials[i].determination != Determination::kDetermined) {
          are_all_determined = false;
          continue;
        }
        const ParameterEstimate& modulus = estimate.parameters[2 * i];
        ASSERT_TRUE(modulus.interval);
        ++num_determined;
        num_covering += modulus.interval->lower <= kTruth[i] &&
                                kTruth[i] <= modulus.interval->upper
                            ? 1
                            : 0;
        largest_score = std::max(largest_score,
                                 std::abs(std::log(modulus.value / kTruth[i])) *
                                     modulus.value / *modulus.standard_error);
      }
      EXPECT_EQ(estimate.Has(FindingCode::kParametersUndetermined),
                !are_all_determined)
          << estimate.message;
      EXPECT_TRUE(estimate.IsUsable() || !are_all_determined)
          << estimate.message;
    }
    EXPECT_GT(num_determined, (noise < 0.05 ? 8 : 4) * kMeasurements) << noise;
    // The combinations of one measurement are alike.
    EXPECT_GT(double(num_covering) / num_determined, 0.85) << noise;
    EXPECT_LT(largest_score, 6) << noise;
  }
}

}  // namespace
}  // namespace elastimate
