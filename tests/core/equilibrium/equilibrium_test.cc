#include "elastimate/core/equilibrium/equilibrium.h"

#include <gtest/gtest.h>

#include "tests/regions.h"

namespace elastimate {
namespace {

using testing::KindOfSection;

class EquilibriumOfKinds : public ::testing::TestWithParam<KindOfSection> {
 protected:
  EquilibriumOfKinds() {
    // Two load cases, and a support that moves.
    scene_.load_cases.push_back(scene_.load_cases[0]);
    BodyForce weight;
    weight.force_density =
        Eigen::VectorXd::LinSpaced(scene_.mesh.Dimension(), -0.3, 0.5);
    scene_.load_cases[1].loads = {weight};
    testing::DisplaceSupports(scene_);
  }

  Scene scene_ = testing::TwoRegionScene(GetParam());
  Eigen::Vector4d parameters_{2, 0.1, 5, 0.4};
};

TEST_P(EquilibriumOfKinds, IsThatOfTheTextbook) {
  const Eigen::MatrixXd expected =
      testing::SolveByTextbook(scene_, {{2, 0.1}, {5, 0.4}});
  Equilibrium equilibrium(scene_, SolverKind::kCholesky);
  const MaterialParameters& chart = equilibrium.Forces().Parameters();
  ASSERT_TRUE(equilibrium.Solve(chart.Moduli(parameters_)));
  EXPECT_LT((equilibrium.Displacement() - expected).norm(),
            1e-10 * expected.norm());
}

TEST_P(EquilibriumOfKinds, HasItsSensitivities) {
  Equilibrium equilibrium(scene_, SolverKind::kCholesky);
  const MaterialParameters& chart = equilibrium.Forces().Parameters();
  ASSERT_TRUE(equilibrium.Solve(chart.Moduli(parameters_)));
  const Eigen::MatrixXd sensitivities =
      equilibrium.Sensitivities(chart.ModuliJacobian(parameters_));
  for (Eigen::Index i = 0; i < 4; ++i) {
    const double step = 1e-6 * parameters_(i);
    Eigen::Vector4d changed = parameters_;
    changed(i) += step;
    ASSERT_TRUE(equilibrium.Solve(chart.Moduli(changed)));
    Eigen::MatrixXd slope = equilibrium.Displacement();
    changed(i) -= 2 * step;
    ASSERT_TRUE(equilibrium.Solve(chart.Moduli(changed)));
    slope = (slope - equilibrium.Displacement()) / (2 * step);
    for (Eigen::Index k = 0; k < 2; ++k) {
      EXPECT_LT((slope.col(k) - sensitivities.col(4 * k + i)).norm(),
                1e-6 * slope.norm());
    }
  }
}

TEST_P(EquilibriumOfKinds, RefusesAStiffnessThatIsNotPositive) {
  Equilibrium equilibrium(scene_, SolverKind::kCholesky);
  const MaterialParameters& chart = equilibrium.Forces().Parameters();
  EXPECT_FALSE(
      equilibrium.Solve(chart.Moduli(Eigen::Vector4d(2, 0.1, -5, 0.4))));
  EXPECT_TRUE(equilibrium.Solve(chart.Moduli(parameters_)));
}

INSTANTIATE_TEST_SUITE_P(Kinds, EquilibriumOfKinds,
                         ::testing::ValuesIn(testing::AllKindsOfSections()),
                         [](const auto& info) {
                           return testing::NameOf(info.param);
                         });

}  // namespace
}  // namespace elastimate
