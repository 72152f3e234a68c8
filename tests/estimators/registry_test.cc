// Tests of estimators that a program adds to those of the library.

#include "elastimate/estimators/registry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>

#include "elastimate/estimators/force_balance/closed_form.h"
#include "tests/regions.h"
#include "tests/scenes.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

// This estimator says what it is told to say.
class Parrot : public Estimator {
 public:
  Parrot(std::string_view name, std::function<void(Estimate&)> fill)
      : name_(name), fill_(std::move(fill)) {}

  std::string_view Name() const override { return name_; }
  std::string_view Description() const override { return "repeats"; }
  Capabilities WhatItTakes() const override {
    Capabilities capabilities;
    capabilities.takes_materials = true;
    return capabilities;
  }

 protected:
  Estimate DoRun(const Scene& /*scene*/,
                 const EstimatorOptions& /*options*/) const override {
    Estimate estimate;
    fill_(estimate);
    return estimate;
  }

 private:
  std::string name_;
  std::function<void(Estimate&)> fill_;
};

Scene MeasuredCuboid() {
  Scene scene = testing::SmallScene("cuboid");
  Measure({5e4, 0.3}, scene);
  return scene;
}

// One load case on two materials.
Scene MeasuredHalves() {
  Scene scene = testing::BlockUnderTraction({1, 1, 2}, {1, 1, 2});
  testing::DivideIntoRegions({1, 1, 2}, {1, 1, 2}, scene);
  testing::MeasureByTextbook({{1e4, 0.3}, {2e4, 0.3}}, scene);
  return scene;
}

// Sets E = 5 +- 1, and nu = 0.25 without an error.
void SayYoungsModulus(Estimate& estimate) {
  estimate.elasticity = {5, 0.25};
  estimate.covariance(0, 0) = 1;
  estimate.Accept();
}

TEST(Registry, KnowsAnEstimatorOfTheProgram) {
  RegisterEstimator(std::make_shared<Parrot>("parrot", [](Estimate& estimate) {
    SayYoungsModulus(estimate);
    estimate.covariance(1, 1) = 0.01 * 0.01;
  }));
  EXPECT_THAT(EstimatorNames(), Contains("parrot"));
  const Estimate estimate =
      MakeEstimator("parrot")->Run(MeasuredCuboid(), EstimatorOptions());
  EXPECT_TRUE(estimate.IsUsable()) << estimate.message;
  EXPECT_EQ(estimate.estimator, "parrot");
  EXPECT_EQ(estimate.parameters[0].value, 5);
  EXPECT_EQ(estimate.parameters[0].standard_error, 1);
}

TEST(Registry, RefusesWhatHasNoNameOfItsOwn) {
  EXPECT_THROWS_WITH(RegisterEstimator(nullptr), "null pointer");
  EXPECT_THROWS_WITH(
      RegisterEstimator(std::make_shared<Parrot>("", SayYoungsModulus)),
      "has no name");
  EXPECT_THROWS_WITH(RegisterEstimator(std::make_shared<ClosedForm>()),
                     "there is an estimator 'closed-form' already");
}

TEST(EstimatorBase, FailsAnEstimateWithoutErrorsOrAReason) {
  const Parrot parrot("silent", SayYoungsModulus);
  const Scene scene = MeasuredCuboid();
  const Estimate estimate = parrot.Run(scene, {});
  EXPECT_EQ(estimate.status, Status::kNumericalFailure);
  EXPECT_TRUE(estimate.Has(FindingCode::kErrorsMissing));
  EXPECT_THAT(estimate.message,
              HasSubstr("the estimator silent returned neither a standard "
                        "error of nu nor a reason"));
  EXPECT_FALSE(estimate.YoungsModulusStandardError());
  PreparedEstimator prepared = parrot.Prepare(scene, {});
  EXPECT_TRUE(prepared.Run({scene.load_cases[0].displacement})
                  .Has(FindingCode::kErrorsMissing));
}

TEST(EstimatorBase, TakesAReasonOrAKnownValueForAnError) {
  const Scene scene = MeasuredCuboid();
  EXPECT_TRUE(Parrot("excused",
                     [](Estimate& estimate) {
                       SayYoungsModulus(estimate);
                       estimate.why_no_standard_error = "it is a parrot";
                     })
                  .Run(scene, {})
                  .IsUsable());
  EstimatorOptions known;
  known.known_poisson_ratio = 0.25;
  EXPECT_TRUE(Parrot("known", SayYoungsModulus).Run(scene, known).IsUsable());
}

TEST(EstimatorBase, FailsSeveralMaterialsWithoutParametersOrCovariance) {
  const Scene scene = MeasuredHalves();
  EXPECT_THAT(Parrot("empty", SayYoungsModulus).Run(scene, {}).message,
              HasSubstr("returned neither parameters of the materials"));
  EXPECT_THAT(Parrot("short",
                     [](Estimate& estimate) {
                       SayYoungsModulus(estimate);
                       estimate.parameters.resize(4);
                     })
                  .Run(scene, {})
                  .message,
              HasSubstr("returned neither a covariance of its 4 parameters"));
}

// Only the PreparedEstimator keeps this estimator alive until it runs.
TEST(PreparedEstimator, KeepsTheEstimatorThatNobodyElseHas) {
  const Scene scene = MeasuredCuboid();
  const auto fill = [](Estimate& estimate) {
    SayYoungsModulus(estimate);
    estimate.why_no_standard_error = "it is a parrot";
  };
  PreparedEstimator prepared =
      std::make_shared<Parrot>("lost", fill)->Prepare(scene, {});
  const Estimate estimate = prepared.Run({scene.load_cases[0].displacement});
  EXPECT_EQ(estimate.elasticity.youngs_modulus, 5);
  EXPECT_EQ(estimate.estimator, "lost");
}

template <class E, class = void>
struct CanPrepare : std::false_type {};
template <class E>
struct CanPrepare<E, std::void_t<decltype(std::declval<E>().Prepare(
                         std::declval<const Scene&>(), EstimatorOptions()))>>
    : std::true_type {};

TEST(PreparedEstimator, TakesNoTemporaryEstimator) {
  EXPECT_TRUE(CanPrepare<const ClosedForm&>::value);
  EXPECT_FALSE(CanPrepare<ClosedForm>::value);
  EXPECT_FALSE((std::is_constructible_v<PreparedEstimator, ClosedForm,
                                        const Scene&, EstimatorOptions>));
}

}  // namespace
}  // namespace elastimate
