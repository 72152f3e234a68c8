// Tests of materials whose stiffness depends on the direction, in the
// estimators that take materials.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "elastimate/core/equilibrium/simulated_measurement.h"
#include "elastimate/core/materials/laws.h"
#include "elastimate/estimators/registry.h"
#include "tests/anisotropy.h"
#include "tests/element_kinds.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

constexpr double kUnit = 4e3;

struct LawAndEstimator {
  const Law* law;
  SectionModel model;
  std::string estimator;
};

std::string NameOfCase(const std::string& law, const std::string& estimator,
                       SectionModel model) {
  std::string name =
      law + "_" + estimator + "_" + std::string(SectionModelName(model));
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

std::vector<LawAndEstimator> AllLawsAndEstimators() {
  std::vector<LawAndEstimator> all;
  for (const SectionModel model :
       {SectionModel::kSolid, SectionModel::kPlaneStress}) {
    for (const Law* const law : Laws()) {
      for (const std::string_view name : EstimatorNames()) {
        if (!law->BlockEntries().empty() && law->Takes(model) &&
            law->ForLargeStrains() == nullptr &&
            MakeEstimator(name)->WhatItTakes().takes_materials) {
          all.push_back({law, model, std::string(name)});
        }
      }
    }
  }
  return all;
}

// Returns a scene of one material with this law.  Its axes are those of a
// random frame.
Scene SceneOfLaw(const Law& law, SectionModel model, int cells) {
  const bool is_solid = model == SectionModel::kSolid;
  Scene scene = testing::SceneOfKind(
      {is_solid ? ElementKind::kTet4 : ElementKind::kTri3, model}, cells);
  const Eigen::MatrixXd frame = testing::RandomFrame(scene.mesh.Dimension(), 1);
  Material material = {std::string(law.Name()), {}, {}, {}};
  for (int i = 0; i < law.NumAxes(); ++i) {
    material.axes.emplace_back(frame.col(i));
  }
  scene.materials = {material};
  return scene;
}

// The tolerance is relative to the unit in which errors are measured.
void ExpectNear(const Estimate& estimate, const Eigen::VectorXd& expected,
                double tolerance) {
  ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
  ASSERT_EQ(estimate.parameters.size(), expected.size());
  for (Eigen::Index i = 0; i < expected.size(); ++i) {
    const ParameterEstimate& parameter = estimate.parameters[i];
    EXPECT_NEAR((parameter.value - expected(i)) / parameter.ErrorUnit(), 0,
                tolerance)
        << parameter.name;
  }
}

class Anisotropy : public ::testing::TestWithParam<LawAndEstimator> {
 protected:
  const Law& law_ = *GetParam().law;
  Eigen::VectorXd truth_ = testing::UnlikeTypical(law_, kUnit);
  Scene scene_ = SceneOfLaw(law_, GetParam().model, 4);

  bool IsDirect() const {
    return GetParam().estimator == "closed-form" ||
           GetParam().estimator == "bounded";
  }
  Estimate Run(const Scene& scene) const {
    return MakeEstimator(GetParam().estimator)->Run(scene, {});
  }
};

TEST_P(Anisotropy, IsFoundExactlyWithoutNoise) {
  MeasureMaterials(truth_, scene_);
  const Estimate estimate = Run(scene_);
  ExpectNear(estimate, truth_, IsDirect() ? 1e-8 : 1e-6);
  ASSERT_EQ(estimate.stiffnesses.size(), 1);
  const Eigen::MatrixXd expected = testing::TextbookStiffnessOf(law_, truth_);
  EXPECT_LT((estimate.stiffnesses[0].value - expected).norm(),
            1e-5 * expected.norm());
}

// A scene that is turned as a whole has the same parameters, whatever the
// noise.
TEST_P(Anisotropy, IsTheSameInATurnedScene) {
  MeasureMaterials(truth_, scene_);
  testing::AddNoise(1e-3, 3, scene_);
  const Estimate expected = Run(scene_);
  Scene turned = scene_;
  const Eigen::MatrixXd turn = testing::RandomFrame(scene_.mesh.Dimension(), 2);
  turned.mesh.nodes = turn * scene_.mesh.nodes;
  turned.supports.displacement = turn * scene_.supports.displacement;
  for (LoadCase& load_case : turned.load_cases) {
    load_case.displacement = turn * load_case.displacement;
    for (Load& load : load_case.loads) {
      Eigen::MatrixXd& force = std::get<NodalForces>(load).force;
      force = turn * force;
    }
  }
  for (Eigen::MatrixXd& axis : turned.materials[0].axes) {
    axis = turn * axis;
  }
  const Estimate actual = Run(turned);
  ASSERT_EQ(actual.status, expected.status);
  ASSERT_EQ(actual.parameters.size(), expected.parameters.size());
  for (std::size_t i = 0; i < expected.parameters.size(); ++i) {
    EXPECT_NEAR((actual.parameters[i].value - expected.parameters[i].value) /
                    expected.parameters[i].ErrorUnit(),
                0, IsDirect() ? 1e-7 : 1e-4)
        << expected.parameters[i].name;
  }
}

TEST_P(Anisotropy, ScalesWithTheUnitOfPressure) {
  MeasureMaterials(truth_, scene_);
  for (LoadCase& load_case : scene_.load_cases) {
    for (Load& load : load_case.loads) {
      std::get<NodalForces>(load).force *= 1e7;
    }
  }
  Eigen::VectorXd expected = truth_;
  for (Eigen::Index i = 0; i < expected.size(); ++i) {
    const LawParameter& parameter = law_.Parameters()[i];
    expected(i) *= parameter.is_modulus || parameter.beside ? 1e7 : 1;
  }
  ExpectNear(Run(scene_), expected, IsDirect() ? 1e-8 : 1e-6);
}

// Where a parameter is known, the fit takes the parameters themselves as
// variables.
TEST_P(Anisotropy, OfWhichSomethingIsKnownIsFound) {
  MeasureMaterials(truth_, scene_);
  for (const Eigen::Index known : {Eigen::Index(0), truth_.size() - 2}) {
    scene_.materials[0].known = {
        {std::string(law_.Parameters()[known].name), truth_(known)}};
    const Estimate estimate = Run(scene_);
    ExpectNear(estimate, truth_, 1e-5);
    EXPECT_TRUE(estimate.parameters[known].is_known);
    EXPECT_FALSE(estimate.parameters[known].standard_error.has_value());
  }
}

INSTANTIATE_TEST_SUITE_P(All, Anisotropy,
                         ::testing::ValuesIn(AllLawsAndEstimators()),
                         [](const auto& info) {
                           return NameOfCase(
                               std::string(info.param.law->Name()),
                               info.param.estimator, info.param.model);
                         });

TEST(AnisotropyOfClosedForm, IsNotUsableWhereTheStiffnessIsNotPositive) {
  const Law& law = *FindLaw("anisotropic");
  Scene scene = SceneOfLaw(law, SectionModel::kSolid, 3);
  MeasureMaterials(testing::UnlikeTypical(law, kUnit), scene);
  testing::AddNoise(0.2, 1, scene);
  const Estimate estimate = MakeEstimator("closed-form")->Run(scene, {});
  EXPECT_FALSE(estimate.IsUsable());
}

// The expected standard errors of the stiffness follow from the covariance of
// the parameters to first order, by differences of the chart.
TEST(AnisotropyOfStiffness, HasTheErrorsOfTheDeltaMethod) {
  const Law& law = *FindLaw("transversely_isotropic");
  Scene scene = SceneOfLaw(law, SectionModel::kSolid, 3);
  const Eigen::VectorXd truth = testing::UnlikeTypical(law, kUnit);
  MeasureMaterials(truth, scene);
  testing::AddNoise(1e-3, 1, scene);
  const Estimate estimate = MakeEstimator("iterative-fe")->Run(scene, {});
  ASSERT_TRUE(estimate.IsUsable()) << estimate.message;
  Eigen::VectorXd parameters(5);
  for (Eigen::Index i = 0; i < 5; ++i) {
    parameters(i) = estimate.parameters[i].value;
  }
  Eigen::MatrixXd jacobian(36, 5);
  for (Eigen::Index i = 0; i < 5; ++i) {
    const double step = 1e-5 * parameters(i);
    Eigen::VectorXd more = parameters;
    Eigen::VectorXd less = parameters;
    more(i) += step;
    less(i) -= step;
    jacobian.col(i) = (testing::TextbookStiffnessOf(law, more) -
                       testing::TextbookStiffnessOf(law, less))
                          .reshaped() /
                      (2 * step);
  }
  const Eigen::VectorXd expected =
      (jacobian * estimate.parameter_covariance * jacobian.transpose())
          .diagonal()
          .cwiseMax(0)
          .cwiseSqrt();
  EXPECT_LT(
      (estimate.stiffnesses[0].standard_error.reshaped() - expected).norm(),
      1e-6 * expected.norm());
}

struct LawStatistics {
  std::string law;
  SectionModel model;
  std::string estimator;
};

class AnisotropyStatistics : public ::testing::TestWithParam<LawStatistics> {};

// Over 16 seeds the mean square of standard scores has the standard deviation
// .35, and the coverage of 95 % has one of 5.4 %.  The tolerance is 5 of these,
// since there are up to 21 parameters.
TEST_P(AnisotropyStatistics, StandardErrorsAreThoseOfTheErrors) {
  constexpr int kSeeds = 16;
  const Law& law = *FindLaw(GetParam().law, GetParam().model);
  const Eigen::VectorXd truth = testing::UnlikeTypical(law, kUnit);
  Scene exact = SceneOfLaw(law, GetParam().model,
                           GetParam().model == SectionModel::kSolid ? 5 : 16);
  MeasureMaterials(truth, exact);
  Eigen::ArrayXd squares = Eigen::ArrayXd::Zero(truth.size());
  Eigen::ArrayXd inside = Eigen::ArrayXd::Zero(truth.size());
  int usable = 0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    Scene scene = exact;
    testing::AddNoise(1e-2, seed, scene);
    const Estimate estimate =
        MakeEstimator(GetParam().estimator)->Run(scene, {});
    if (!estimate.IsUsable()) {
      continue;
    }
    ++usable;
    for (Eigen::Index i = 0; i < truth.size(); ++i) {
      const ParameterEstimate& parameter = estimate.parameters[i];
      const double score =
          (parameter.value - truth(i)) / *parameter.standard_error;
      squares(i) += score * score;
      inside(i) += parameter.interval->lower <= truth(i) &&
                   truth(i) <= parameter.interval->upper;
    }
  }
  EXPECT_GE(usable, kSeeds - 1);
  for (Eigen::Index i = 0; i < truth.size(); ++i) {
    EXPECT_NEAR(squares(i) / usable, 1, 5 * 0.35) << law.Parameters()[i].name;
    EXPECT_GE(inside(i) / usable, 0.95 - 5 * 0.054) << law.Parameters()[i].name;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Laws, AnisotropyStatistics,
    ::testing::Values(
        LawStatistics{"transversely_isotropic", SectionModel::kSolid,
                      "iterative-fe"},
        LawStatistics{"transversely_isotropic", SectionModel::kSolid,
                      "virtual-fields"},
        LawStatistics{"orthotropic", SectionModel::kSolid, "reduced-fe"},
        LawStatistics{"anisotropic", SectionModel::kSolid, "reduced-fe"},
        LawStatistics{"orthotropic", SectionModel::kPlaneStress,
                      "iterative-fe"}),
    [](const auto& info) {
      return NameOfCase(info.param.law, info.param.estimator, info.param.model);
    });

}  // namespace
}  // namespace elastimate
