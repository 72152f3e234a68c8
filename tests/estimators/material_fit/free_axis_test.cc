// Materials whose axis is to be found.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "elastimate/core/equilibrium/simulated_measurement.h"
#include "elastimate/core/scene/quadratic_scene.h"
#include "elastimate/estimators/material_fit/material_fit.h"
#include "elastimate/estimators/registry.h"
#include "tests/anisotropy.h"
#include "tests/element_kinds.h"
#include "tests/regions.h"
#include "tests/scenes.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

constexpr char kFreeAxis[] = "transversely_isotropic_free_axis";
constexpr double kRadianOfDegrees = 0.017453292519943295;

Eigen::VectorXd ConstantsOfLayers() {
  Eigen::VectorXd constants(5);
  constants << 2e4, 3e4, 0.2, 0.3, 0.8e4;
  return constants;
}

// Displacements of these materials in a scene, as measured.
void MeasureMaterials(const std::vector<Material>& materials,
                      const Eigen::VectorXd& parameters, Scene& scene) {
  Scene known = scene;
  known.materials = materials;
  elastimate::MeasureMaterials(parameters, known);
  known.materials = scene.materials;
  scene = known;
}

// One load of a clamped block of a material with this axis, which is not known.
Scene BlockOfAxis(const Eigen::VectorXd& constants, const Eigen::Vector3d& axis,
                  int cells) {
  Scene scene =
      testing::SceneOfKind({ElementKind::kTet4, SectionModel::kSolid}, cells);
  Material known = {"transversely_isotropic", {}, {}, {}, {axis}};
  MeasureMaterials({known}, constants, scene);
  scene.materials = {{kFreeAxis, {}, {}, {}}};
  return scene;
}

Eigen::VectorXd ConstantsOfBar() {
  Eigen::VectorXd constants(5);
  constants << 3000, 1000, 0.3, 0.35, 500;
  return constants;
}

// One slanted traction on an end of a bar of fibres with this axis, which is
// not known.
Scene PulledBarOfAxis(const Eigen::Vector3d& axis) {
  Scene scene = testing::BlockUnderTraction({4, 4, 6}, {2, 2, 3});
  std::get<Traction>(scene.load_cases[0].loads[0]).traction =
      Eigen::Vector3d(0.02, 0.01, 0.03);
  MeasureMaterials({{"transversely_isotropic", {}, {}, {}, {axis}}},
                   ConstantsOfBar(), scene);
  scene.materials = {{kFreeAxis, {}, {}, {}}};
  return scene;
}

Estimate RunOn(const Scene& scene, const std::string& estimator) {
  return MakeEstimator(estimator)->Run(scene, {});
}

// Without ends [rad].
double AngleOfAxes(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::asin(std::min(1.0, a.cross(b).norm() / a.norm() / b.norm()));
}

TEST(FreeAxis, IsFoundExactlyWithoutNoise) {
  for (const Eigen::VectorXd& constants :
       {testing::ConstantsOfFibres(), ConstantsOfLayers()}) {
    for (const Eigen::Vector3d& axis :
         {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0),
          Eigen::Vector3d(0, 0, -2), Eigen::Vector3d(-1, 2, 3)}) {
      const Scene scene = BlockOfAxis(constants, axis, 3);
      for (const std::string estimator : {"iterative-fe", "reduced-fe"}) {
        const Estimate estimate = RunOn(scene, estimator);
        ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
        ASSERT_EQ(estimate.axes.size(), 1U);
        EXPECT_LT(AngleOfAxes(estimate.axes[0].direction.value(), axis), 1e-5);
        EXPECT_NEAR(estimate.axes[0].direction->norm(), 1, 1e-12);
        ASSERT_EQ(estimate.parameters.size(), 7U);
        for (Eigen::Index i = 0; i < 5; ++i) {
          EXPECT_NEAR(
              (estimate.parameters[i].value - constants(i)) / constants(i), 0,
              1e-5)
              << estimator << " " << estimate.parameters[i].name;
        }
      }
    }
  }
}

// A misfit has minima near wrong axes.  Where noise hides which of them is the
// least, the axis is not determined.
TEST(FreeAxisStatistics, IsThatOfTheLeastMisfit) {
  constexpr int kSeeds = 3;
  int num_usable = 0;
  for (const Eigen::Vector3d& axis :
       {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0),
        Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(1, 1, 1)}) {
    const Scene exact = PulledBarOfAxis(axis);
    for (int seed = 1; seed <= kSeeds; ++seed) {
      for (const double noise : {2e-2, 5e-2}) {
        Scene scene = exact;
        testing::AddNoise(noise, seed, scene);
        for (const std::string estimator : {"iterative-fe", "reduced-fe"}) {
          const Estimate estimate = RunOn(scene, estimator);
          ASSERT_EQ(estimate.axes.size(), 1U);
          if (estimate.IsUsable()) {
            ++num_usable;
            EXPECT_LT(AngleOfAxes(estimate.axes[0].direction.value(), axis),
                      5 * *estimate.axes[0].standard_error)
                << estimator << " " << axis.transpose() << " " << seed;
          }
        }
      }
    }
  }
  EXPECT_GT(num_usable, 15);
}

// A fit without outliers starts where an earlier one ended, which knows of one
// axis only.
TEST(FreeAxis, HasARivalWhereOutliersAreLeftOutOrElementsAreQuadratic) {
  const Eigen::Vector3d axis = {0, 1, 0};
  EstimatorOptions options;
  options.refinement = Refine::kNever;
  for (const Origin origin : {Origin::kComputed, Origin::kMeasured}) {
    Scene scene = PulledBarOfAxis(axis);
    if (origin == Origin::kMeasured) {
      scene = QuadraticScene(scene);
      scene.load_cases[0].observed.resize(0, 0);
      MeasureMaterials({{"transversely_isotropic", {}, {}, {}, {axis}}},
                       ConstantsOfBar(), scene);
      scene.materials = {{kFreeAxis, {}, {}, {}}};
    }
    scene.origin = origin;
    testing::AddNoise(8e-2, 3, scene);
    Eigen::MatrixXd& u = scene.load_cases[0].displacement;
    u.col(u.cols() / 2).array() += 5 * u.cwiseAbs().maxCoeff();
    const MaterialFit fit =
        FitMaterialsFrom(std::nullopt, scene, options, Descent::kReduced);
    EXPECT_EQ(fit.estimate.outliers.size(), 1U);
    EXPECT_TRUE(fit.has_rival_axis);
  }
}

// A specimen of an isotropic and a fibrous half, with the error of the axis
// beside those of its moduli.
TEST(FreeAxis, IsFoundInARegion) {
  Scene scene =
      testing::SceneOfKind({ElementKind::kTet4, SectionModel::kSolid}, 5);
  const double middle = scene.mesh.nodes.row(0).mean();
  scene.mesh.regions.resize(scene.mesh.NumElements());
  for (Eigen::Index e = 0; e < scene.mesh.NumElements(); ++e) {
    double x = 0;
    for (const int node : scene.mesh.elements.col(e)) {
      x += scene.mesh.nodes(0, node) / 4;
    }
    scene.mesh.regions(e) = x < middle ? 7 : 3;
  }
  const Eigen::Vector3d axis = {1, 1, -0.5};
  Eigen::VectorXd parameters(7);
  parameters << 5e4, 0.3, testing::ConstantsOfFibres();
  MeasureMaterials({{"isotropic", {7}, {}, {}},
                    {"transversely_isotropic", {3}, {}, {}, {axis}}},
                   parameters, scene);
  scene.materials = {{"isotropic", {7}, {}, {}}, {kFreeAxis, {3}, {}, {}}};
  testing::AddNoise(1e-3, 1, scene);
  const Estimate estimate = RunOn(scene, "auto");
  ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
  ASSERT_EQ(estimate.axes.size(), 1U);
  EXPECT_EQ(estimate.axes[0].Label(), "the axis of region 3");
  EXPECT_EQ(estimate.axes[0].first_rotation, 7U);
  EXPECT_LT(AngleOfAxes(estimate.axes[0].direction.value(), axis),
            5 * *estimate.axes[0].standard_error);
  EXPECT_LT(*estimate.axes[0].standard_error, kRadianOfDegrees);
}

// Some of its constants may be known.
TEST(FreeAxis, IsFoundBesideWhatIsKnown) {
  const Eigen::Vector3d axis = {1, -1, 2};
  Scene scene = BlockOfAxis(testing::ConstantsOfFibres(), axis, 4);
  scene.materials[0].known = {{"youngs_modulus_L", 9e4},
                              {"poisson_ratio_TT", 0.4}};
  testing::AddNoise(1e-3, 1, scene);
  const Estimate estimate = RunOn(scene, "iterative-fe");
  ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
  EXPECT_EQ(estimate.parameters[0].value, 9e4);
  EXPECT_LT(AngleOfAxes(estimate.axes[0].direction.value(), axis),
            5 * *estimate.axes[0].standard_error);
}

// The axis of what is alike in all directions is said not to be determined.
TEST(AxisOfIsotropyStatistics, IsNotDetermined) {
  Eigen::VectorXd constants(5);
  constants << 5e4, 5e4, 0.3, 0.3, 5e4 / 2.6;
  const Scene exact = BlockOfAxis(constants, {0, 0, 1}, 4);
  for (int seed = 0; seed <= 8; ++seed) {
    Scene scene = exact;
    if (seed > 0) {
      testing::AddNoise(1e-2, seed, scene);
    }
    for (const std::string estimator : {"iterative-fe", "auto"}) {
      const Estimate estimate = RunOn(scene, estimator);
      EXPECT_FALSE(estimate.IsUsable()) << seed << " " << estimator;
      if (seed == 0) {
        continue;  // Exact displacements may be refused for another reason.
      }
      EXPECT_NE(estimate.message.find("the material may be isotropic"),
                std::string::npos)
          << seed << " " << estimator << " " << estimate.message;
      EXPECT_EQ(estimate.status, Status::kNotIdentifiable);
    }
  }
}

TEST(FreeAxis, IsRefusedByWhatCannotFindIt) {
  const Scene scene = BlockOfAxis(testing::ConstantsOfFibres(), {0, 0, 1}, 2);
  for (const std::string estimator :
       {"closed-form", "bounded", "virtual-fields"}) {
    EXPECT_THROWS_WITH(
        RunOn(scene, estimator),
        "it takes only materials whose axis is known; use "
        "--estimator=iterative-fe or --estimator=reduced-fe, or give the axis");
  }
  Scene beside = scene;
  beside.materials[0].axes = {Eigen::Vector3d(1, 0, 0)};
  EXPECT_THROWS_WITH(RunOn(beside, "iterative-fe"),
                     "finds its axis; leave it out");
}

struct AxisStatistics {
  std::string estimator;
  bool are_layers;
};

class FreeAxisStatistics : public ::testing::TestWithParam<AxisStatistics> {};

// One load, 1 % of noise.  chi^2 of both rotations by their covariance is below
// 5.99 in 95 %, and standard scores of 20 seeds have the variance 1, with a
// standard deviation of .32, and cover 95 % with one of 4.9 %; 5 of them.
TEST_P(FreeAxisStatistics, ErrorsOfAxisAndConstantsAreThoseTheyState) {
  constexpr int kSeeds = 20;
  const Eigen::VectorXd constants = GetParam().are_layers
                                        ? ConstantsOfLayers()
                                        : testing::ConstantsOfFibres();
  const Eigen::Vector3d axis = Eigen::Vector3d(1, -2, 2) / 3;
  const Scene exact = BlockOfAxis(constants, axis, 5);
  Eigen::ArrayXd squares = Eigen::ArrayXd::Zero(5);
  int num_usable = 0;
  int num_covered = 0;
  double angle_square_sum = 0;
  double error_square_sum = 0;
  double chi_square_sum = 0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    Scene scene = exact;
    testing::AddNoise(1e-2, seed, scene);
    const Estimate estimate = RunOn(scene, GetParam().estimator);
    if (!estimate.IsUsable()) {
      continue;
    }
    ++num_usable;
    for (Eigen::Index i = 0; i < 5; ++i) {
      const ParameterEstimate& parameter = estimate.parameters[i];
      squares(i) += std::pow(
          (parameter.value - constants(i)) / *parameter.standard_error, 2);
    }
    // The rotation of the axis, of either end.
    const double angle = std::acos(axis(0));
    const Eigen::Vector2d truth =
        angle / std::sin(angle) * Eigen::Vector2d(-axis(2), axis(1));
    const Eigen::Vector2d deviation =
        Eigen::Vector2d(estimate.parameters[5].value,
                        estimate.parameters[6].value) -
        truth;
    const Eigen::Matrix2d covariance =
        estimate.parameter_covariance.block<2, 2>(5, 5);
    const double determinant = covariance(0, 0) * covariance(1, 1) -
                               covariance(0, 1) * covariance(1, 0);
    const double chi_square =
        (covariance(1, 1) * deviation(0) * deviation(0) -
         2 * covariance(0, 1) * deviation(0) * deviation(1) +
         covariance(0, 0) * deviation(1) * deviation(1)) /
        determinant;
    chi_square_sum += chi_square;
    num_covered += chi_square < 5.99 ? 1 : 0;
    angle_square_sum +=
        std::pow(AngleOfAxes(estimate.axes[0].direction.value(), axis), 2);
    error_square_sum += std::pow(*estimate.axes[0].standard_error, 2);
  }
  EXPECT_GE(num_usable, kSeeds - 2);
  EXPECT_GE(num_covered, (0.95 - 5 * 0.049) * num_usable);
  // chi^2 of 2 degrees of freedom has a standard deviation of 2.
  EXPECT_NEAR(chi_square_sum / num_usable, 2, 5 * 2 / std::sqrt(num_usable));
  for (Eigen::Index i = 0; i < 5; ++i) {
    EXPECT_NEAR(squares(i) / num_usable, 1, 5 * 0.32) << i;
  }
  const double angle = std::sqrt(angle_square_sum / num_usable);
  const double error = std::sqrt(error_square_sum / num_usable);
  RecordProperty("angle_deg", std::to_string(angle / kRadianOfDegrees));
  RecordProperty("error_deg", std::to_string(error / kRadianOfDegrees));
  // The error is that of the direction in which it is largest.
  EXPECT_LT(angle, 2 * error);
  EXPECT_LT(error, 2 * kRadianOfDegrees);
}

INSTANTIATE_TEST_SUITE_P(All, FreeAxisStatistics,
                         ::testing::Values(AxisStatistics{"iterative-fe",
                                                          false},
                                           AxisStatistics{"reduced-fe", true}),
                         [](const auto& info) {
                           return std::string(info.param.are_layers ? "layers"
                                                                    : "fibres");
                         });

}  // namespace
}  // namespace elastimate
