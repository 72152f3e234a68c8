#include "elastimate/estimators/interface/estimator.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "elastimate/estimators/registry.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

TEST(Estimate, StartsAsAFailure) {
  const Estimate estimate;
  EXPECT_FALSE(estimate.IsUsable());
  EXPECT_EQ(StatusName(estimate.status), "numerical_failure");
  EXPECT_TRUE(estimate.Has(FindingCode::kNotRun));
  EXPECT_EQ(estimate.message, Sentence(estimate.findings.front()));
  EXPECT_FALSE(estimate.elasticity.IsPhysical());
  EXPECT_FALSE(estimate.YoungsModulusStandardError());
  EXPECT_FALSE(estimate.PoissonRatioStandardError());
  EXPECT_FALSE(estimate.Correlation());
}

TEST(Estimate, StandardErrorsComeFromTheCovariance) {
  Estimate estimate;
  estimate.covariance << 9, -1.5, -1.5, 1;
  EXPECT_EQ(estimate.YoungsModulusStandardError(), 3.0);
  EXPECT_EQ(estimate.PoissonRatioStandardError(), 1.0);
  EXPECT_EQ(estimate.Correlation(), -0.5);
}

TEST(StatusName, NamesEveryStatus) {
  EXPECT_EQ(StatusName(Status::kOk), "ok");
  EXPECT_EQ(StatusName(Status::kNotIdentifiable), "not_identifiable");
  EXPECT_EQ(StatusName(Status::kUnphysical), "unphysical");
  EXPECT_EQ(StatusName(Status::kIterationLimit), "iteration_limit");
  EXPECT_EQ(StatusName(Status::kNumericalFailure), "numerical_failure");
}

TEST(EstimatorOptions, DefaultsAreValid) {
  EXPECT_EQ(EstimatorOptions().WhyInvalid(), "");
}

TEST(EstimatorOptions, AcceptBounds) {
  EstimatorOptions options;
  options.poisson_ratio = {-1.0, 0.5};
  options.youngs_modulus = {1e3, 1e6};
  EXPECT_EQ(options.WhyInvalid(), "");
}

struct InvalidOptions {
  std::string name;
  EstimatorOptions options;
  std::string says;
};

EstimatorOptions With(std::optional<double> known, Bounds nu, Bounds youngs,
                      int max_iterations = 50) {
  EstimatorOptions options;
  options.known_poisson_ratio = known;
  options.poisson_ratio = nu;
  options.youngs_modulus = youngs;
  options.max_iterations = max_iterations;
  return options;
}

TEST(EstimatorOptions, SayWhatIsWrong) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const InvalidOptions cases[] = {
      {"nu", With(0.5, {}, {}), "known Poisson's ratio is 0.5"},
      {"nu_nan", With(nan, {}, {}), "known Poisson's ratio is nan"},
      {"both", With(0.3, {0.1, {}}, {}), "known and has bounds"},
      {"nu_bound", With({}, {-1.1, {}}, {}), "Poisson's ratio is -1.1"},
      {"nu_crossed", With({}, {0.4, 0.4}, {}), "are crossed"},
      {"nu_nothing", With({}, {0.499995, 0.5}, {}), "leave nothing"},
      {"nu_bound_nan", With({}, {{}, nan}, {}), "Poisson's ratio is nan"},
      {"youngs_zero", With({}, {}, {0.0, {}}), "Young's modulus is 0"},
      {"youngs_infinite", With({}, {}, {{}, infinity}), "modulus is inf"},
      {"youngs_crossed", With({}, {}, {2.0, 1.0}), "are crossed"},
      {"iterations", With({}, {}, {}, 0), "iterations is 0"}};
  for (const InvalidOptions& invalid : cases) {
    SCOPED_TRACE(invalid.name);
    EXPECT_NE(invalid.options.WhyInvalid().find(invalid.says),
              std::string::npos)
        << invalid.options.WhyInvalid();
  }
}

TEST(Registry, TheDefaultIsTheClosedForm) {
  EXPECT_EQ(EstimatorNames().front(), "closed-form");
}

TEST(Registry, MakesEveryNamedEstimator) {
  for (const std::string_view name : EstimatorNames()) {
    const std::shared_ptr<const Estimator> estimator = MakeEstimator(name);
    EXPECT_EQ(estimator->Name(), name);
    EXPECT_FALSE(estimator->Description().empty());
  }
}

TEST(Registry, ListsTheNamesWhenAskedForAnother) {
  EXPECT_THROWS_WITH(MakeEstimator("magic"),
                     "unknown estimator 'magic'.*closed-form, bounded");
}

}  // namespace
}  // namespace elastimate
