#include "elastimate/estimators/material_fit/shear_modulus.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "elastimate/core/equilibrium/simulated_measurement.h"
#include "elastimate/core/mesh/facets.h"
#include "elastimate/estimators/interface/judge.h"
#include "elastimate/estimators/registry.h"
#include "tests/element_kinds.h"
#include "tests/scenes.h"
#include "tests/shapes.h"

namespace elastimate {
namespace {

constexpr double kYoungsModulusOfBar = 5e4;

Scene TwistedBar(double poisson_ratio) {
  Scene scene = testing::LoadedScene(
      testing::BoxMesh({3, 3, 5}, {0.3, 0.3, 0.8}), "torsion");
  testing::MeasureInCutWorld({kYoungsModulusOfBar, poisson_ratio}, scene);
  testing::AddNoise(0.02, 1, scene);
  return scene;
}

Estimate FitAtSmallStrains(const std::string& estimator, const Scene& scene) {
  EstimatorOptions options;
  options.kinematics = Kinematics::kSmall;
  return MakeEstimator(estimator)->Run(scene, options);
}

struct Torsion {
  std::string estimator;
  double poisson_ratio;
};

class ShearModulus : public ::testing::TestWithParam<Torsion> {};

TEST_P(ShearModulus, IsWhatTorsionDetermines) {
  const double nu = GetParam().poisson_ratio;
  const IsotropicElasticity truth = {kYoungsModulusOfBar, nu};
  const Estimate estimate =
      FitAtSmallStrains(GetParam().estimator, TwistedBar(nu));
  ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
  ASSERT_TRUE(estimate.shear_modulus.has_value());
  const double error = estimate.shear_modulus->standard_error;
  EXPECT_LT(std::abs(estimate.ShearModulus() - truth.ShearModulus()),
            3 * error);
  EXPECT_LT(error, 0.05 * truth.ShearModulus());
  EXPECT_EQ(estimate.ShearModulusStandardError(), error);
  EXPECT_TRUE(estimate.Has(FindingCode::kParametersUndetermined));
  for (const ParameterEstimate& parameter : estimate.parameters) {
    ASSERT_TRUE(parameter.interval.has_value()) << parameter.name;
    const double true_value =
        parameter.is_modulus ? truth.youngs_modulus : truth.poisson_ratio;
    EXPECT_LT(parameter.interval->lower, true_value) << parameter.name;
    EXPECT_GT(parameter.interval->upper, true_value) << parameter.name;
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, ShearModulus,
    ::testing::Values(Torsion{"reduced-fe", 0.3}, Torsion{"iterative-fe", 0.3},
                      Torsion{"auto", 0.45}),
    [](const auto& test) {
      std::string name = test.param.estimator;
      name.erase(std::remove(name.begin(), name.end(), '-'), name.end());
      return name;
    });

// Exact data of simple shear leave one direction free.
TEST(ShearModulusOf, ABlockInSimpleShear) {
  const Estimate estimate =
      FitAtSmallStrains("reduced-fe", testing::ShearedBlock());
  ASSERT_TRUE(estimate.shear_modulus.has_value()) << estimate.message;
  EXPECT_NEAR(estimate.shear_modulus->value, 5e4 / 2.6, 1e-6 * 5e4);
  EXPECT_EQ(estimate.status, Status::kOk) << estimate.message;
}

// Pressure from all sides acts on the bulk modulus alone.
// Exact data of the same elements take a certificate with them.
TEST(ShearModulusOf, APreparedFitIsTheSame) {
  const Scene scene = testing::ShearedBlock();
  for (const std::string name : {"reduced-fe", "iterative-fe"}) {
    PreparedEstimator prepared = MakeEstimator(name)->Prepare(scene, {});
    for (int frame = 0; frame < 2; ++frame) {
      const Estimate estimate =
          prepared.Run({scene.load_cases[0].displacement});
      ASSERT_TRUE(estimate.shear_modulus.has_value()) << estimate.message;
      EXPECT_NEAR(estimate.shear_modulus->value, 5e4 / 2.6, 1e-6 * 5e4);
    }
  }
}

TEST(ShearModulusOf, PressureIsNotDetermined) {
  constexpr double kPressure = 50;
  const Mesh mesh = testing::BoxMesh({2, 2, 2}, {1, 1, 1});
  Scene scene = testing::HeldAtBottom(mesh, mesh, Eigen::Vector3d::Zero());
  scene.supports.held.setConstant(false);
  scene.load_cases[0].loads.clear();
  const Eigen::MatrixXi facets = BoundaryFacets(mesh);
  for (int axis = 0; axis < 3; ++axis) {
    testing::HoldPlane(axis, 0, 0, scene);
    std::vector<Eigen::Index> of_face;
    for (Eigen::Index i = 0; i < facets.cols(); ++i) {
      if (mesh.nodes(axis, facets.col(i)).minCoeff() > 0.999) {
        of_face.push_back(i);
      }
    }
    scene.load_cases[0].loads.emplace_back(Traction{
        facets(Eigen::all, of_face), -kPressure * Eigen::Vector3d::Unit(axis)});
  }
  Measure({5e4, 0.3}, scene);
  const Estimate estimate = FitAtSmallStrains("reduced-fe", scene);
  EXPECT_TRUE(estimate.IsRefusedFor(FindingCode::kParametersUndetermined))
      << estimate.message;
  EXPECT_FALSE(estimate.shear_modulus.has_value());
}

TEST(ShearModulusOf, AGivenRatioIsNotLookedFor) {
  EstimatorOptions options;
  options.kinematics = Kinematics::kSmall;
  options.known_poisson_ratio = 0.3;
  const Estimate estimate =
      MakeEstimator("reduced-fe")->Run(TwistedBar(0.3), options);
  EXPECT_FALSE(estimate.shear_modulus.has_value());
  EXPECT_EQ(estimate.status, Status::kOk) << estimate.message;
}

// These fits have an E that is known for each nu.
class ShearModulusOfFits : public ::testing::Test {
 protected:
  static Estimate Fitted(double youngs_modulus, double nu, double error_of_e,
                         double error_of_nu, bool is_nu_known) {
    Estimate estimate;
    estimate.Accept();
    estimate.why_no_standard_error.clear();
    estimate.elasticity = {youngs_modulus, nu};
    estimate.parameters.resize(2);
    estimate.parameters[0].name = "youngs_modulus";
    estimate.parameters[0].symbol = "E";
    estimate.parameters[0].is_modulus = true;
    estimate.parameters[0].value = youngs_modulus;
    estimate.parameters[1].name = "poisson_ratio";
    estimate.parameters[1].symbol = "nu";
    estimate.parameters[1].value = nu;
    estimate.parameters[1].is_known = is_nu_known;
    estimate.parameters[1].limits = {-1, 0.5};
    estimate.parameter_covariance =
        Eigen::Vector2d(std::pow(error_of_e * youngs_modulus, 2),
                        is_nu_known ? testing::kNan : error_of_nu * error_of_nu)
            .asDiagonal();
    estimate.displacement_residual = 0.01;
    return estimate;
  }

  // Returns what is found for an estimate of E +- 50 % and nu +- 0.3, or of
  // unknown errors.
  Estimate Found(const std::function<double(double)>& youngs_modulus,
                 bool are_errors_known = true) {
    const Scene scene = testing::ShearedBlock();
    Estimate estimate = Fitted(youngs_modulus(0.1), 0.1, 0.5, 0.3, false);
    if (!are_errors_known) {
      estimate.parameter_covariance.setConstant(testing::kNan);
    }
    ratios_.clear();
    FindShearModulus(
        scene, {},
        [&](const EstimatorOptions& options) {
          const double nu = *options.known_poisson_ratio;
          ratios_.push_back(nu);
          return Fitted(youngs_modulus(nu), nu, 0.02, 0, true);
        },
        estimate);
    FinishEstimate("reduced-fe", scene, {}, {}, estimate);
    return estimate;
  }

  std::vector<double> ratios_;
};

// Where E is constant, mu changes with 1 / (1 + nu).
TEST_F(ShearModulusOfFits, IsAsUncertainAsItsChange) {
  const Estimate estimate = Found([](double) { return 100; });
  ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
  EXPECT_NEAR(estimate.ShearModulus(), 50 / std::sqrt(0.8 * 1.4), 1e-9);
  EXPECT_NEAR(*estimate.ShearModulusStandardError() / estimate.ShearModulus(),
              std::hypot(std::log(1.4 / 0.8) / 2, 0.02), 1e-9);
}

TEST_F(ShearModulusOfFits, IsWhatIsTheSame) {
  const Estimate estimate = Found([](double nu) { return 100 * (1 + nu); });
  ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
  ASSERT_EQ(ratios_.size(), 3);
  EXPECT_NEAR(ratios_[0], -0.2, 1e-12);
  EXPECT_NEAR(ratios_[2], 0.4, 1e-12);
  EXPECT_NEAR(estimate.ShearModulus(), 50, 1e-9);
  EXPECT_NEAR(*estimate.ShearModulusStandardError(), 1, 1e-9);
}

TEST_F(ShearModulusOfFits, ReachesToTheFurthestWhereErrorsAreUnknown) {
  const Estimate estimate =
      Found([](double nu) { return 100 * (1 + nu); }, false);
  ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
  EXPECT_NEAR(estimate.ShearModulus(), 50, 1e-9);
  EXPECT_NEAR(*estimate.PoissonRatioStandardError(), 1, 1e-12);  // To -0.9.
  EXPECT_GT(estimate.parameters[0].interval->upper, 149);
  EXPECT_LT(estimate.parameters[0].interval->lower, 10);
}

TEST_F(ShearModulusOfFits, IsNoneWhereItChanges) {
  const Estimate estimate =
      Found([](double nu) { return 100 * std::pow(1 - 2 * nu, 2); });
  EXPECT_EQ(estimate.status, Status::kNotIdentifiable);
  EXPECT_FALSE(estimate.shear_modulus.has_value());
}

}  // namespace
}  // namespace elastimate
