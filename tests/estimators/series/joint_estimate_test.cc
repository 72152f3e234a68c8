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

// Returns an estimate with these errors (that of E is relative), and with the
// part of them that noise makes.
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
  // The errors of E are 2 : 1, so its weights are 1 : 4.  Those of nu are 4 :
  // 1.
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
  // Half of the variance is common to all frames and is not averaged.  The
  // error of the loads is not averaged either.
  EXPECT_NEAR(*joint.PoissonRatioStandardError(), 0.02 * std::sqrt(0.5 + 0.005),
              1e-9);
  EXPECT_NEAR(*joint.YoungsModulusStandardError() / 100,
              std::sqrt(1e-4 * (0.5 + 0.005) + 2.5e-5), 1e-9);
  EXPECT_NEAR(joint.error_budget.model(1), 0.02 * std::sqrt(0.5), 1e-9);
  EXPECT_NEAR(joint.error_budget.noise(0), std::sqrt(1e-4 * 0.005 + 2.5e-5),
              1e-9);
}

// The part of the variance that is no noise consists of nine parts.  Large
// strains make four of them, and an unknown thickness and other values that fit
// as well make one each.
TEST(JointEstimate, TellsWhatStrainsAndThicknessDoFromTheModel) {
  const Eigen::Vector2d errors(0.03, 0.06);
  std::vector<FrameEstimate> frames(
      100, FrameOf(100, 0.3, errors * std::sqrt(1.1), errors * std::sqrt(0.1)));
  for (FrameEstimate& frame : frames) {
    frame.estimate.error_budget.kinematics = errors * 2 / 3;
    frame.estimate.error_budget.section = errors / 3;
    frame.estimate.error_budget.curvature = errors / 3;
    frame.estimate.deformation = {0.02, 0.01};
  }
  frames[7].estimate.deformation = {0.03, 0.005};
  const Estimate joint = Join(frames);
  EXPECT_NEAR(joint.error_budget.kinematics(0), 0.02, 1e-9);
  EXPECT_NEAR(joint.error_budget.kinematics(1), 0.04, 1e-9);
  EXPECT_NEAR(joint.error_budget.section(0), 0.01, 1e-9);
  EXPECT_NEAR(joint.error_budget.curvature(0), 0.01, 1e-9);
  EXPECT_NEAR(joint.error_budget.model(0), 0.01 * std::sqrt(3), 1e-9);
  EXPECT_NEAR(joint.error_budget.model(1), 0.02 * std::sqrt(3), 1e-9);
  EXPECT_EQ(joint.deformation.strain, 0.03);
  EXPECT_EQ(joint.deformation.rotation, 0.01);
  // Frames of small strains have no error of kinematics.  If half of the frames
  // have none, the joint estimate has half of it.
  for (std::size_t i = 0; i < 50; ++i) {
    frames[i].estimate.error_budget.kinematics = {};
  }
  EXPECT_NEAR(Join(frames).error_budget.kinematics(0), 0.01, 1e-9);
  for (FrameEstimate& frame : frames) {
    frame.estimate.error_budget.kinematics = {};
  }
  EXPECT_EQ(Join(frames).error_budget.kinematics.size(), 0);
}

// The error of each of a hundred frames includes that of the load; the rest is
// noise.
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
  // Chance makes such a correlation of so few residuals.
  for (FrameEstimate& frame : frames) {
    frame.likeness = 0.05;
    frame.num_alike = 10;
  }
  EXPECT_FALSE(Join(frames).Has(FindingCode::kFramesAlike));
  EXPECT_NEAR(*Join(frames).PoissonRatioStandardError(), 0.002, 1e-6);
}

// With as much noise under a smaller load, a frame cannot know nu better than
// the others.  Next to nu = 1/2, its standard error may claim so.
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
  EXPECT_TRUE(none.IsRefusedFor(FindingCode::kFramesLeftOut));
}

// Torsion determines neither E nor nu.  A hundredth of the variance of mu is
// common to all frames.
TEST(JointEstimate, JoinsShearModuliThatAreAllThatIsDetermined) {
  std::vector<FrameEstimate> frames;
  for (int i = 0; i < 100; ++i) {
    FrameEstimate frame = FrameOf(100, 0.2, {0.5, 0.4}, {0.1, 0.1});
    frame.estimate.shear_modulus = ModulusEstimate{
        40 * std::exp(i % 2 == 0 ? 0.02 : -0.02), 0.8, 0.8 * std::sqrt(0.99)};
    frames.push_back(frame);
  }
  frames[3].estimate.shear_modulus->standard_error = 0.7;
  frames[3].estimate.parameters[0].value = 99;
  const Estimate joint = Join(frames);
  ASSERT_EQ(joint.status, Status::kOk) << joint.message;
  EXPECT_EQ(joint.series->num_used, 100);
  EXPECT_NEAR(joint.ShearModulus() / 40, 1, 1e-3);
  EXPECT_NEAR(*joint.ShearModulusStandardError() / 40,
              0.02 * std::sqrt(0.01 + 0.99 / 100), 1e-4);
  // E and nu are those of the frame that knows mu best.
  EXPECT_TRUE(joint.Has(FindingCode::kParametersUndetermined));
  EXPECT_EQ(joint.elasticity.youngs_modulus, 99);
  // They are joined again where most frames determine them.
  for (std::size_t i = 0; i < 60; ++i) {
    frames[i] = FrameOf(100, 0.2, {0.05, 0.04}, {0.05, 0.04});
  }
  const Estimate of_both = Join(frames);
  EXPECT_FALSE(of_both.shear_modulus.has_value());
  EXPECT_EQ(of_both.series->num_used, 60);
}

// Sixty frames determine mu alone, and forty determine E = 100 and nu = 0.25,
// so that mu = 40 as well.  Its relative error, by d ln mu = d ln E - d nu / (1
// + nu), is that of the others.  Half of their variance is common to all
// frames.
TEST(JointEstimate, JoinsShearModuliOfFramesThatDetermineAll) {
  std::vector<FrameEstimate> frames;
  for (int i = 0; i < 60; ++i) {
    const double modulus = 40 * std::exp(i % 2 == 0 ? 0.02 : -0.02);
    frames.push_back(FrameOf(100, 0.2, {0.5, 0.4}, {0.1, 0.1}));
    frames.back().estimate.shear_modulus =
        ModulusEstimate{modulus, 0.02 * modulus, 0.02 * modulus};
  }
  const Eigen::Vector2d errors(0.012, 0.02);
  frames.resize(100, FrameOf(100, 0.25, errors, errors * std::sqrt(0.5)));
  const Estimate joint = Join(frames);
  ASSERT_EQ(joint.status, Status::kOk) << joint.message;
  EXPECT_EQ(joint.series->num_used, 100);
  EXPECT_NEAR(joint.ShearModulus(), 40, 1e-9);
  const double of_noise = 0.02 * std::sqrt(60 + 40 * 0.5) / 100;
  const double common = 0.02 * std::sqrt(0.5) * 40 / 100;
  EXPECT_NEAR(joint.shear_modulus->of_noise / 40, of_noise, 1e-9);
  EXPECT_NEAR(*joint.ShearModulusStandardError() / 40,
              std::hypot(of_noise, common), 1e-9);
}

// Returns frames that determine mu alone, which falls by 14 % while the load
// grows.  Noise makes all of its error.
std::vector<FrameEstimate> FramesOfShearModulus() {
  std::vector<FrameEstimate> frames;
  for (int i = 1; i <= 8; ++i) {
    const double modulus = 40 * std::exp(-0.02 * i);
    frames.push_back(FrameOf(100, 0.2, {0.5, 0.4}, {0.1, 0.1}));
    frames.back().load = 10 * i;
    frames.back().estimate.shear_modulus =
        ModulusEstimate{modulus, 0.01 * modulus, 0.01 * modulus};
  }
  return frames;
}

TEST(JointEstimate, TellsHowTheShearModulusChanges) {
  const Estimate joint = Join(FramesOfShearModulus());
  ASSERT_TRUE(joint.series->trend.has_value());
  const Trend& trend = *joint.series->trend;
  ASSERT_EQ(trend.change.size(), 3);
  EXPECT_EQ(joint.ParametersAndShearModulus()[2].name, "shear_modulus");
  EXPECT_NEAR(trend.change(2), -0.14, 1e-9);
  // The squares of the distances of the loads 10 to 80 from 45 have the sum
  // 4200.
  EXPECT_NEAR(trend.standard_error(2), 70 * 0.01 / std::sqrt(4200), 1e-9);
  EXPECT_LT(trend.p_value(2), 1e-3);
  // E and nu are those of one frame.
  EXPECT_TRUE(std::isnan(trend.change(0)));
  EXPECT_TRUE(std::isnan(trend.change(1)));
  EXPECT_TRUE(joint.Has(FindingCode::kTrendOverFrames));
  for (const Finding& finding : joint.findings) {
    if (finding.code == FindingCode::kTrendOverFrames) {
      EXPECT_EQ(finding.text.rfind("mu changes by -14 % +- 1.1 %", 0), 0)
          << finding.text;
    }
  }
}

TEST(JointEstimate, CountsTheErrorOfLoadsInEBesideAShearModulus) {
  const Estimate joint = Join(FramesOfShearModulus(), {0.1, false});
  EXPECT_NEAR(*joint.YoungsModulusStandardError() / 100, std::hypot(0.5, 0.1),
              1e-9);
  EXPECT_NEAR(joint.error_budget.noise(0), std::hypot(0.1, 0.1), 1e-9);
  EXPECT_NEAR(*joint.PoissonRatioStandardError(), 0.4, 1e-9);
  // Frames that have the error of the loads already need it no more.
  const Estimate with_it = Join(FramesOfShearModulus(), {0.005, true});
  EXPECT_NEAR(*with_it.YoungsModulusStandardError() / 100, 0.5, 1e-9);
}

// An error that may be common to all frames does not average out.
TEST(JointEstimate, DoesNotKnowTheNoiseOfAShearModulusThatNoFrameKnows) {
  std::vector<FrameEstimate> frames = FramesOfShearModulus();
  EXPECT_TRUE(std::isfinite(Join(frames).shear_modulus->of_noise));
  for (FrameEstimate& frame : frames) {
    frame.estimate.shear_modulus = ModulusEstimate{40, 0.8};
  }
  const Estimate joint = Join(frames);
  ASSERT_TRUE(joint.shear_modulus.has_value());
  EXPECT_NEAR(joint.shear_modulus->standard_error, 0.8, 1e-9);
  EXPECT_TRUE(std::isnan(joint.shear_modulus->of_noise));
}

// A shear modulus that is known better does not take the place of a modulus
// that is determined itself.
TEST(JointEstimate, AveragesAModulusBesideAShearModulus) {
  FrameEstimate frame = FrameOf(100, 0.2, {0.1, 0.3}, {0.1, 0.3});
  frame.estimate.parameters[0].standard_error = 10;
  frame.estimate.shear_modulus = ModulusEstimate{40, 0.8, 0.8};
  const Estimate joint = Join(std::vector<FrameEstimate>(100, frame));
  EXPECT_EQ(joint.series->num_used, 100);
  EXPECT_NEAR(*joint.YoungsModulusStandardError() / 100, 0.1 / std::sqrt(100),
              0.005);
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

// Returns a series of 200 frames that scatter by noise alone.  The error of the
// elements is far larger, has another correlation of E and nu, and is the same
// in all frames.
std::vector<FrameEstimate> FramesOfOneElementError(std::mt19937_64& generator,
                                                   double more_noise = 1) {
  std::normal_distribution<double> normal;
  const Eigen::Vector2d noise(0.004, 0.003);
  const Eigen::Vector2d elements(0.032, -0.0155);
  std::vector<FrameEstimate> frames;
  for (int k = 0; k < 200; ++k) {
    const double x = normal(generator);
    const double y = 0.8 * x + 0.6 * normal(generator);
    frames.push_back(FrameOf(kYoungs * std::exp(more_noise * noise(0) * x),
                             kPoisson + more_noise * noise(1) * y, noise,
                             noise));
    Estimate& estimate = frames.back().estimate;
    const double of_frame = 1 + 0.05 * normal(generator);
    const double size = of_frame * of_frame;
    const Eigen::Vector2d to_value(estimate.elasticity.youngs_modulus, 1);
    const double covariance =
        0.8 * noise(0) * noise(1) + size * elements(0) * elements(1);
    estimate.covariance << std::pow(noise(0), 2) +
                               size * std::pow(elements(0), 2),
        covariance, covariance,
        std::pow(noise(1), 2) + size * std::pow(elements(1), 2);
    estimate.covariance =
        to_value.asDiagonal() * estimate.covariance * to_value.asDiagonal();
    estimate.parameter_covariance = estimate.covariance;
  }
  return frames;
}

TEST(JointEstimate, IsNotMisledByWhatElementsAddToTheErrors) {
  std::mt19937_64 generator(3);
  constexpr int kSeries = 40;
  double square_sum = 0;
  for (int i = 0; i < kSeries; ++i) {
    const Estimate joint = Join(FramesOfOneElementError(generator));
    EXPECT_FALSE(joint.Has(FindingCode::kFramesScatter));
    const double of_noise = 0.003 / std::sqrt(200);
    EXPECT_NEAR(joint.error_budget.noise(1), of_noise, 0.3 * of_noise);
    EXPECT_NEAR(*joint.PoissonRatioStandardError(), 0.0155, 0.002);
    square_sum +=
        std::pow((joint.elasticity.poisson_ratio - kPoisson) / of_noise, 2);
  }
  // chi^2 of 40 degrees of freedom has a standard deviation of 9.
  EXPECT_NEAR(square_sum, kSeries, 4 * 9);
  // A scatter that no error explains is a finding.
  EXPECT_TRUE(Join(FramesOfOneElementError(generator, 20))
                  .Has(FindingCode::kFramesScatter));
}

// Each frame estimates its noise from four degrees of freedom.
TEST(JointEstimate, IsNotMisledByNoiseThatFewDegreesOfFreedomTell) {
  constexpr int kSeries = 100;
  constexpr double kFreedom = 4;
  std::mt19937_64 generator(5);
  std::normal_distribution<double> normal;
  std::chi_squared_distribution<double> chi_squared(kFreedom);
  int num_alarms = 0;
  Eigen::Vector2d square_sum = Eigen::Vector2d::Zero();
  for (int i = 0; i < kSeries; ++i) {
    std::vector<FrameEstimate> frames;
    for (int k = 0; k < 200; ++k) {
      const double noise = std::sqrt(chi_squared(generator) / kFreedom);
      const Eigen::Vector2d errors = noise * Eigen::Vector2d(0.02, 0.03);
      frames.push_back(FrameOf(kYoungs * std::exp(0.02 * normal(generator)),
                               kPoisson + 0.03 * normal(generator), errors,
                               errors));
      frames.back().estimate.noise_sd = noise;
      frames.back().estimate.noise_degrees_of_freedom = kFreedom;
    }
    const Estimate joint = Join(frames);
    num_alarms += joint.Has(FindingCode::kFramesScatter) ? 1 : 0;
    square_sum +=
        Eigen::Vector2d(std::pow((joint.elasticity.youngs_modulus - kYoungs) /
                                     *joint.YoungsModulusStandardError(),
                                 2),
                        std::pow((joint.elasticity.poisson_ratio - kPoisson) /
                                     *joint.PoissonRatioStandardError(),
                                 2));
  }
  // A scatter is a finding when its probability is below .001.
  EXPECT_LE(num_alarms, 2);
  // chi^2 of 100 degrees of freedom has a standard deviation of 14.
  EXPECT_LT(square_sum.maxCoeff(), kSeries + 4 * 14);
  EXPECT_GT(square_sum.minCoeff(), kSeries - 4 * 14);
}

// Holds the mean squares of the standard scores of E and nu over many series,
// and how often a trend and a scatter are found.  ScoresOf simulates frames
// that scatter by `scatter` standard deviations of their noise.
struct Scores {
  Eigen::Vector2d mean_square = Eigen::Vector2d::Zero();
  double share_of_trends = 0;
  double share_of_scatters = 0;
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
    scores.share_of_scatters +=
        double(joint.Has(FindingCode::kFramesScatter)) / num_series;
  }
  return scores;
}

// The chi^2 of 400 series has a relative standard deviation of .07.  Joint
// errors are never below those of noise, so that the scores are somewhat below
// 1.
TEST(JointEstimateStatistics, ErrorsAreTrueOfIndependentFrames) {
  const Scores scores = ScoresOf(400, 1);
  EXPECT_LT(scores.mean_square.maxCoeff(), 1.2);
  EXPECT_GT(scores.mean_square.minCoeff(), 0.6);
  // By chance a trend is found with a probability of .01, a scatter with .001.
  EXPECT_LT(scores.share_of_trends, 0.03);
  EXPECT_LE(scores.share_of_scatters, 0.01);
}

TEST(JointEstimateStatistics, ErrorsAreTrueOfFramesThatScatterMore) {
  const Scores scores = ScoresOf(400, 3);
  EXPECT_LT(scores.mean_square.maxCoeff(), 1.35);
  EXPECT_GT(scores.mean_square.minCoeff(), 0.7);
  EXPECT_GT(scores.share_of_scatters, 0.9);
  EXPECT_LT(scores.share_of_trends, 0.03);
}

}  // namespace
}  // namespace elastimate
