#include "elastimate/estimators/interface/judge.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "elastimate/estimators/interface/parameter_judge.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

Estimate Measured() {
  Estimate estimate;
  estimate.elasticity = {100, 0.3};
  estimate.covariance.setIdentity();
  estimate.displacement_residual = 0.01;
  estimate.force_residual = 0.01;
  return estimate;
}

Estimate Judged(const Evidence& evidence,
                const EstimatorOptions& options = EstimatorOptions()) {
  Estimate estimate = Measured();
  Judge(evidence, options, estimate);
  return estimate;
}

Scene OneCube() {
  const Mesh mesh = testing::BoxMesh({1, 1, 1}, {1, 1, 1});
  return testing::HeldAtBottom(mesh, mesh, Eigen::Vector3d::Zero());
}

TEST(Judge, AcceptsWhatNothingSpeaksAgainst) {
  const Estimate estimate = Judged({});
  EXPECT_TRUE(estimate.IsUsable());
  EXPECT_TRUE(estimate.findings.empty());
  EXPECT_EQ(estimate.message, "");
  EXPECT_TRUE(estimate.covariance.isIdentity());
}

TEST(Judge, TakesTheFirstErrorForTheReason) {
  Evidence evidence;
  evidence.end = End::kSearchFailed;
  evidence.correction = 1;
  evidence.outlier_change = {0.5, 0};
  Estimate estimate = Judged(evidence);
  EXPECT_EQ(estimate.status, Status::kNumericalFailure);
  EXPECT_TRUE(estimate.Has(FindingCode::kNumericalFailure));
  EXPECT_FALSE(estimate.Has(FindingCode::kResidualAboveNoise));
  EXPECT_TRUE(estimate.Has(FindingCode::kOutliers));
  evidence.do_displacements_oppose_loads = true;
  estimate = Judged(evidence);
  EXPECT_EQ(estimate.status, Status::kUnphysical);
  EXPECT_FALSE(estimate.Has(FindingCode::kNumericalFailure));
}

// A ratio that a wrong model pulls to its limit is no estimate; a material may
// be that of a limit.
TEST(Judge, RatiosAtTheirLimitNeedAModelThatFits) {
  Evidence evidence;
  evidence.ratios_at_limit = {"nu of region 1"};
  EXPECT_TRUE(Judged(evidence).IsUsable());
  Estimate estimate = Measured();
  estimate.is_model_in_doubt = true;
  Judge({}, {}, estimate);
  EXPECT_TRUE(estimate.IsUsable());
  Judge(evidence, {}, estimate);
  EXPECT_FALSE(estimate.IsUsable());
  EXPECT_TRUE(estimate.IsRefusedFor(FindingCode::kParametersNearLimits));
}

TEST(Judge, WarnsOfAMeshErrorThatIsUnknown) {
  Scene scene = OneCube();
  for (const Origin origin : {Origin::kMeasured, Origin::kComputed}) {
    scene.origin = origin;
    Estimate estimate = Measured();
    estimate.covariance = Eigen::Vector2d(1, 1e-6).asDiagonal();
    Judge({}, {}, estimate);
    FinishEstimate("virtual-fields", scene, {}, {}, estimate);
    ASSERT_TRUE(estimate.IsUsable()) << estimate.message;
    EXPECT_EQ(estimate.Has(FindingCode::kMeshErrorUnknown),
              origin == Origin::kMeasured);
  }
}

TEST(Judge, SpeaksOfErrorBarsWhereThereAreSome) {
  Scene scene = OneCube();
  scene.origin = Origin::kComputed;
  Evidence evidence;
  evidence.virtual_work_error = 0.1;
  for (const bool is_usable : {false, true}) {
    evidence.do_displacements_oppose_loads = !is_usable;
    Estimate estimate = Measured();
    Judge(evidence, {}, estimate);
    estimate.covariance = Eigen::Vector2d(1, 1e-6).asDiagonal();
    FinishEstimate("virtual-fields", scene, {}, {}, estimate);
    ASSERT_EQ(estimate.IsUsable(), is_usable);
    const std::vector<std::string> warnings =
        estimate.Sentences(Severity::kWarning);
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_EQ(
        warnings[0].find("which the error bars include") != std::string::npos,
        is_usable);
  }
}

TEST(Judge, SaysTheSameWhenAskedAgain) {
  Evidence evidence;
  evidence.outlier_change = {0.5, 0};
  evidence.above_noise = {ResidualKind::kDisplacement, 2};
  Estimate estimate = Judged(evidence);
  EXPECT_TRUE(estimate.IsUsable());
  ASSERT_EQ(estimate.findings.size(), 2U);
  evidence.do_displacements_oppose_loads = true;
  for (int i = 0; i < 2; ++i) {
    Judge(evidence, {}, estimate);
    EXPECT_EQ(estimate.status, Status::kUnphysical);
    EXPECT_EQ(estimate.findings.size(), 3U);
    EXPECT_TRUE(estimate.covariance.array().isNaN().all());
  }
}

TEST(Judge, WarnsWhereAnErrorOfTheSameCodeIsGone) {
  Evidence evidence;
  evidence.above_noise = {ResidualKind::kVirtualWork, 2};
  evidence.correction = 1;
  Estimate estimate = Judged(evidence);
  EXPECT_TRUE(estimate.IsRefusedFor(FindingCode::kResidualAboveNoise));
  EXPECT_EQ(estimate.findings.size(), 1U);
  evidence.correction.reset();
  Judge(evidence, {}, estimate);
  EXPECT_TRUE(estimate.IsUsable());
  EXPECT_TRUE(estimate.Has(FindingCode::kResidualAboveNoise));
}

TEST(Judge, WarnsBeforeItRefuses) {
  const auto severity_of = [](const Evidence& evidence) {
    const Estimate estimate = Judged(evidence);
    EXPECT_LE(estimate.findings.size(), 1U);
    return estimate.findings.empty() ? Severity::kNotice
                                     : estimate.findings.front().severity;
  };
  Evidence imbalance;
  Evidence contradicted;
  for (const auto& [size, severity] : {std::pair(0.005, Severity::kNotice),
                                       std::pair(0.05, Severity::kWarning),
                                       std::pair(0.15, Severity::kError)}) {
    imbalance.load_imbalance = size;
    EXPECT_EQ(severity_of(imbalance), severity) << size;
    // The score decides whether, the change of E how bad it is.
    contradicted.known_ratio = {"nu", 0.1, 0.4, size < 0.01 ? 0.1 : 0.001,
                                size};
    EXPECT_EQ(severity_of(contradicted), severity) << size;
  }
}

TEST(Judge, ABoundIsContradictedWhereItMattersAndIsSignificant) {
  Evidence evidence;
  evidence.bound_excess = {26, 1, 120, 100, "E"};
  EXPECT_TRUE(Judged(evidence).IsRefusedFor(FindingCode::kParametersOnBounds));
  evidence.bound_excess = {24, 1, 120, 100, "E"};
  EXPECT_TRUE(Judged(evidence).IsUsable());
  evidence.bound_excess = {26, 1, 105, 100, "E"};
  EXPECT_TRUE(Judged(evidence).IsUsable());
}

// Noise of virtual fields next to nu = 1/2 left E open by any factor, of which
// there is no standard error, and that passed for none.
TEST(Judge, AYoungsModulusWithoutLimitIsNoEstimate) {
  const Scene scene = testing::SmallScene("cuboid");
  Estimate estimate = Measured();
  estimate.Accept();
  estimate.covariance << std::numeric_limits<double>::infinity(), 0, 0, 1e-4;
  FinishEstimate("some", scene, {}, {}, estimate);
  EXPECT_EQ(estimate.status, Status::kNotIdentifiable);
  EXPECT_TRUE(estimate.Has(FindingCode::kParametersUndetermined));
}

// A slender beam that bends tells E, whatever nu is.
TEST(Judge, AModulusIsUsableWithoutTheRatioBesideIt) {
  const Scene scene = testing::SmallScene("cuboid");
  const auto with_errors = [&](double relative, double of_nu) {
    Estimate estimate = Measured();
    estimate.Accept();
    const double of_e = relative * estimate.elasticity.youngs_modulus;
    estimate.covariance << of_e * of_e, 0, 0, of_nu * of_nu;
    FinishEstimate("some", scene, {}, {}, estimate);
    return estimate;
  };
  EXPECT_FALSE(
      with_errors(0.02, 0.1).Has(FindingCode::kParametersUndetermined));
  const Estimate usable = with_errors(0.02, 0.2);
  EXPECT_EQ(usable.status, Status::kOk);
  EXPECT_EQ(usable.Sentences(Severity::kWarning)[0].find(
                "the data do not determine nu (+- 0.2)"),
            0);
  EXPECT_TRUE(usable.parameters[0].IsDetermined());
  EXPECT_FALSE(usable.parameters[1].IsDetermined());
  // A determined ratio alone makes no estimate usable.
  EXPECT_EQ(with_errors(0.4, 0.1).status, Status::kNotIdentifiable);
  EXPECT_EQ(with_errors(0.02, std::numeric_limits<double>::infinity()).status,
            Status::kNotIdentifiable);
}

// A fit without the outliers is too far from nu = 1/2 for a linear model.
TEST(Judge, ARatioThatOutliersMayPullToItsLimitIsNoEstimate) {
  Evidence evidence;
  evidence.ratios_at_limit = {"nu"};
  EXPECT_TRUE(Judged(evidence).IsUsable());
  evidence.outlier_change = {0.02, 0};
  const Estimate estimate = Judged(evidence);
  EXPECT_FALSE(estimate.IsUsable());
  EXPECT_NE(estimate.message.find("--loss=huber"), std::string::npos)
      << estimate.message;
}

TEST(Judge, ALargeResidualThatIsSmoothIsNoNoise) {
  Evidence evidence;
  evidence.smooth_part = 0.25;
  EXPECT_EQ(Judged(evidence).status, Status::kNotIdentifiable);
  evidence.smooth_part = 0.15;
  EXPECT_TRUE(Judged(evidence).findings.empty());
  evidence.smooth_part = 0;
  Estimate estimate = Measured();
  estimate.displacement_residual = 0.25;
  Judge(evidence, {}, estimate);
  EXPECT_TRUE(estimate.IsUsable());
  EXPECT_TRUE(estimate.Has(FindingCode::kResidualAboveNoise));
}

// Two materials, of the second of which too little is known; elements miss this
// part of it.
Estimate OfTwoMaterials(double missed) {
  Estimate estimate = Measured();
  estimate.Accept();
  estimate.parameters.resize(2);
  for (int i = 0; i < 2; ++i) {
    ParameterEstimate& parameter = estimate.parameters[std::size_t(i)];
    parameter.symbol = "E";
    parameter.value = 100;
    parameter.is_modulus = true;
    parameter.regions = {i + 1};
  }
  estimate.parameter_covariance =
      Eigen::Vector2d(1, 60 * 60).asDiagonal().toDenseMatrix();
  estimate.error_budget.noise = Eigen::Vector2d(0.01, 0.1);
  estimate.error_budget.discretization = Eigen::Vector2d(0, missed);
  return estimate;
}

// What is to be done depends on what the errors come from.
TEST(JudgeParameters, SaysWhatLeavesThemUndetermined) {
  Estimate by_data = OfTwoMaterials(0.1);
  JudgeParameters(by_data);
  EXPECT_TRUE(by_data.IsUsable());
  ASSERT_EQ(by_data.findings.size(), 1U);
  EXPECT_EQ(
      Sentence(by_data.findings[0]),
      "the data do not determine E of region 2 (+- 60 %); give what is known "
      "(--nu, or \"known\" of a material), join regions, or add load cases");
  EXPECT_FALSE(AreUndeterminedByElements(by_data));

  Estimate by_elements = OfTwoMaterials(0.59);
  by_elements.element_order = 2;
  JudgeParameters(by_elements);
  ASSERT_EQ(by_elements.findings.size(), 1U);
  EXPECT_EQ(Sentence(by_elements.findings[0]),
            "the elements are too coarse to determine E of region 2 (+- 60 %); "
            "use a finer mesh");
  EXPECT_TRUE(AreUndeterminedByElements(by_elements));

  Estimate on_bound = OfTwoMaterials(0.1);
  on_bound.active_bounds = {"E of region 2 (lower)"};
  JudgeParameters(on_bound);
  EXPECT_NE(on_bound.message.find("check the bounds"), std::string::npos)
      << on_bound.message;
}

}  // namespace
}  // namespace elastimate
