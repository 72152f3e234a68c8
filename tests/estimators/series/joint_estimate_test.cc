#include "elastimate/estimators/series/joint_estimate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "elastimate/estimators/registry.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

constexpr double kYoungs = 2e5;
constexpr double kPoisson = 0.3;

Scene OneMaterial() {
  const Mesh mesh = testing::BoxMesh({1, 1, 1}, {1, 1, 1});
  return testing::HeldAtBottom(mesh, mesh, {0, 0, -1});
}

// An estimate of these errors, relative of E, of which noise makes the given
// parts.
FrameEstimate FrameOf(double youngs_modulus, double poisson_ratio,
                      const Eigen::Vector2d& errors,
                      const Eigen::Vector2d& noise) {
  FrameEstimate frame;
  Estimate& estimate = frame.estimate;
  estimate.Accept();
  estimate.element_order = 1;
  estimate.elasticity = {youngs_modulus, poisson_ratio};
  estimate.covariance.setZero();
  estimate.covariance.diagonal() << std::pow(youngs_modulus * errors(0), 2),
      errors(1) * errors(1);
  estimate.parameter_covariance = estimate.covariance;
  ParameterEstimate youngs;
  youngs.name = "youngs_modulus";
  youngs.symbol = "E";
  youngs.is_modulus = true;
  youngs.value = youngs_modulus;
  ParameterEstimate poisson;
  poisson.name = "poisson_ratio";
  poisson.symbol = "nu";
  poisson.value = poisson_ratio;
  estimate.parameters = {youngs, poisson};
  estimate.error_budget.noise = noise;
  return frame;
}

Estimate Join(const std::vector<FrameEstimate>& frames,
              const LoadError& load_error = {}) {
  return JointEstimate(OneMaterial(), {}, *MakeEstimator("iterative-fe"),
                       frames, load_error);
}

TEST(JointEstimate, IsTheMeanOfLeastVariance) {
  const Eigen::Vector2d wide(0.02, 0.02);
  const Eigen::Vector2d narrow(0.01, 0.04);
  const Estimate joint =
      Join({FrameOf(100, 0.30, wide, wide),
            FrameOf(100 * std::exp(0.01), 0.31, narrow, narrow)});
  ASSERT_EQ(joint.status, Status::kOk) << joint.message;
  EXPECT_EQ(joint.estimator, "iterative-fe");
  // Weights of 1 : 4 and of 4 : 1.
  EXPECT_NEAR(std::log(joint.elasticity.youngs_modulus / 100), 0.008, 1e-9);
  EXPECT_NEAR(joint.elasticity.poisson_ratio, 0.302, 1e-9);
  EXPECT_NEAR(*joint.PoissonRatioStandardError(), 0.04 / std::sqrt(5), 1e-9);
  EXPECT_EQ(joint.series->num_used, 2);
}

TEST(JointEstimate, AveragesNoiseAlone) {
  const Eigen::Vector2d errors(0.01, 0.02);
  const std::vector<FrameEstimate> frames(
      100, FrameOf(100, 0.3, errors, errors * std::sqrt(0.5)));
  const Estimate joint = Join(frames, {0.005, false});
  // Half of the variance is common to all frames, and the error of the loads.
  EXPECT_NEAR(*joint.PoissonRatioStandardError(), 0.02 * std::sqrt(0.5 + 0.005),
              1e-9);
  EXPECT_NEAR(*joint.YoungsModulusStandardError() / 100,
              std::sqrt(1e-4 * (0.5 + 0.005) + 2.5e-5), 1e-9);
  EXPECT_NEAR(joint.error_budget.model(1), 0.02 * std::sqrt(0.5), 1e-9);
  EXPECT_NEAR(joint.error_budget.noise(0), std::sqrt(1e-4 * 0.005 + 2.5e-5),
              1e-9);
}

// Each of a hundred frames has it in its error, which is that of noise else.
TEST(JointEstimate, CountsTheErrorOfLoadsOnce) {
  const Eigen::Vector2d errors(0.01, 0.02);
  const std::vector<FrameEstimate> frames(100,
                                          FrameOf(100, 0.3, errors, errors));
  const Estimate joint = Join(frames, {0.006, true});
  EXPECT_NEAR(*joint.YoungsModulusStandardError() / 100,
              std::sqrt((1e-4 - 3.6e-5) / 100 + 3.6e-5), 1e-6);
  EXPECT_NEAR(*Join({frames[0]}, {0.006, true}).YoungsModulusStandardError(), 1,
              1e-6);
}

TEST(JointEstimate, DoesNotAverageWhatResidualsShare) {
  const Eigen::Vector2d errors(0.01, 0.02);
  std::vector<FrameEstimate> frames(100, FrameOf(100, 0.3, errors, errors));
  for (FrameEstimate& frame : frames) {
    frame.likeness = 0.5;
    frame.num_alike = 1000;
  }
  const Estimate joint = Join(frames);
  EXPECT_NEAR(*joint.PoissonRatioStandardError(), 0.02 * std::sqrt(0.5 + 0.005),
              1e-6);
  EXPECT_TRUE(joint.Has(FindingCode::kFramesAlike));
  // As large a correlation as chance makes of so few.
  for (FrameEstimate& frame : frames) {
    frame.likeness = 0.05;
    frame.num_alike = 10;
  }
  EXPECT_FALSE(Join(frames).Has(FindingCode::kFramesAlike));
  EXPECT_NEAR(*Join(frames).PoissonRatioStandardError(), 0.002, 1e-6);
}

// Next to nu = 1/2, say, from as much noise under a smaller load.
TEST(JointEstimate, DoesNotTrustAFrameThatKnowsFarMoreThanOthers) {
  const Eigen::Vector2d errors(0.01, 0.01);
  const Eigen::Vector2d small(0.01, 0.0005);
  std::vector<FrameEstimate> frames(6, FrameOf(100, 0.3, errors, errors));
  frames[0] = FrameOf(100, 0.4, small, small);
  for (FrameEstimate& frame : frames) {
    frame.estimate.noise_sd = 0.1;
    frame.load = 3;
  }
  frames[0].load = 1;
  const Estimate joint = Join(frames);
  EXPECT_NEAR(joint.elasticity.poisson_ratio, 0.3, 0.01);
}

TEST(JointEstimate, NamesTheFrameThatDisagrees) {
  const Eigen::Vector2d errors(0.01, 0.02);
  std::vector<FrameEstimate> frames(6, FrameOf(100, 0.3, errors, errors));
  EXPECT_FALSE(Join(frames).Has(FindingCode::kFramesScatter));
  frames[4] = FrameOf(120, 0.3, errors, errors);
  const Estimate joint = Join(frames);
  ASSERT_TRUE(joint.Has(FindingCode::kFramesScatter));
  for (const Finding& finding : joint.findings) {
    if (finding.code == FindingCode::kFramesScatter) {
      EXPECT_NE(finding.text.find("frame 5 most"), std::string::npos);
    }
  }
}

TEST(JointEstimate, LeavesOutWhatIsNotUsable) {
  const Eigen::Vector2d errors(0.01, 0.02);
  FrameEstimate failed;
  FrameEstimate on_bound = FrameOf(300, 0.49, errors, errors);
  on_bound.estimate.parameter_covariance.setConstant(Estimate::kUnknown);
  const Estimate joint =
      Join({failed, FrameOf(100, 0.3, errors, errors), on_bound});
  EXPECT_EQ(joint.status, Status::kOk) << joint.message;
  EXPECT_NEAR(joint.elasticity.youngs_modulus, 100, 1e-9);
  EXPECT_EQ(joint.series->num_used, 1);
  EXPECT_EQ(joint.series->num_frames, 3);
  EXPECT_TRUE(joint.Has(FindingCode::kFramesLeftOut));
  const Estimate none = Join({failed, failed});
  EXPECT_EQ(none.status, Status::kNotIdentifiable);
  EXPECT_TRUE(none.Has(FindingCode::kNoFrameUsable));
}

TEST(JointEstimate, TellsOfAMaterialThatIsNotLinear) {
  std::vector<FrameEstimate> frames;
  const Eigen::Vector2d errors(0.01, 0.02);
  for (int i = 1; i <= 8; ++i) {
    frames.push_back(FrameOf(100 * std::exp(-0.02 * i), 0.3, errors, errors));
    frames.back().load = 10 * i;
  }
  const Estimate joint = Join(frames);
  ASSERT_TRUE(joint.series->trend.has_value());
  EXPECT_TRUE(joint.series->trend->is_over_load);
  EXPECT_NEAR(joint.series->trend->change(0), -0.14, 1e-9);
  EXPECT_TRUE(joint.Has(FindingCode::kTrendOverFrames));
  for (FrameEstimate& frame : frames) {
    frame.load = 10;
  }
  EXPECT_FALSE(Join(frames).series->trend->is_over_load);
}

TEST(JointEstimate, SharesWhatMostFramesFound) {
  const Eigen::Vector2d errors(0.01, 0.02);
  std::vector<FrameEstimate> frames(3, FrameOf(100, 0.3, errors, errors));
  const Finding finding = {FindingCode::kSmoothResidual, Severity::kWarning,
                           "it is smooth", "look"};
  frames[0].estimate.Add(finding);
  EXPECT_FALSE(Join(frames).Has(FindingCode::kSmoothResidual));
  frames[2].estimate.Add(finding);
  EXPECT_TRUE(Join(frames).Has(FindingCode::kSmoothResidual));
}

// Of many series: the scores of the joint estimate, and how often a trend is
// found.  `scatter` is that between frames, in standard deviations of noise.
struct Scores {
  Eigen::Vector2d mean_square = Eigen::Vector2d::Zero();
  double share_of_trends = 0;
};

Scores ScoresOf(int num_series, double scatter) {
  constexpr int kFrames = 12;
  std::mt19937_64 generator(7);
  std::normal_distribution<double> normal;
  Scores scores;
  for (int i = 0; i < num_series; ++i) {
    std::vector<FrameEstimate> frames;
    for (int k = 1; k <= kFrames; ++k) {
      const Eigen::Vector2d errors = Eigen::Vector2d(0.02, 0.03) / k;
      frames.push_back(FrameOf(
          kYoungs * std::exp(scatter * errors(0) * normal(generator)),
          kPoisson + scatter * errors(1) * normal(generator), errors, errors));
      frames.back().load = k;
    }
    const Estimate joint = Join(frames);
    scores.mean_square +=
        Eigen::Vector2d(std::pow((joint.elasticity.youngs_modulus - kYoungs) /
                                     *joint.YoungsModulusStandardError(),
                                 2),
                        std::pow((joint.elasticity.poisson_ratio - kPoisson) /
                                     *joint.PoissonRatioStandardError(),
                                 2)) /
        num_series;
    scores.share_of_trends +=
        double(joint.Has(FindingCode::kTrendOverFrames)) / num_series;
  }
  return scores;
}

// chi^2 of 400 series has a relative standard deviation of .07; errors are
// never below those of noise, so that scores are somewhat below 1.
TEST(JointEstimateStatistics, ErrorsAreTrueOfIndependentFrames) {
  const Scores scores = ScoresOf(400, 1);
  EXPECT_LT(scores.mean_square.maxCoeff(), 1.2);
  EXPECT_GT(scores.mean_square.minCoeff(), 0.6);
  // Of a probability of .01.
  EXPECT_LT(scores.share_of_trends, 0.03);
}

TEST(JointEstimateStatistics, ErrorsAreTrueOfFramesThatScatterMore) {
  const Scores scores = ScoresOf(400, 3);
  EXPECT_LT(scores.mean_square.maxCoeff(), 1.35);
  EXPECT_GT(scores.mean_square.minCoeff(), 0.7);
  EXPECT_LT(scores.share_of_trends, 0.03);
}

}  // namespace
}  // namespace elastimate
