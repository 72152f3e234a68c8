#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "elastimate/estimators/maps/field_prior.h"
#include "elastimate/estimators/maps/level_fit.h"
#include "elastimate/estimators/maps/map_errors.h"
#include "elastimate/estimators/maps/region_map.h"
#include "elastimate/estimators/maps/sharpen_map.h"
#include "elastimate/estimators/maps/smooth_map.h"
#include "tests/estimators/maps/map_scenes.h"

namespace elastimate::testing {
namespace {

// All stages of a map.
struct Stages {
  MapScene truth;
  FieldSensitivity model;
  MapProblem problem{model, {}, {}};
  FieldPrior prior;
  std::optional<LevelFit> homogeneous;
  std::optional<SmoothMap> smooth;
  MapErrors errors;
  MapState sharpened;
  std::optional<RegionMap> regions;

  Stages(const std::string& name, ElementKind kind, int cells, double noise)
      : truth(MakeMapScene(name, kind, cells, noise)),
        model(truth.scene, SolverKind::kCholesky),
        prior(truth.scene.mesh) {
    homogeneous = FitLevels(
        problem, std::vector<int>(std::size_t(prior.NumElements()), 0),
        Eigen::VectorXd::Zero(1), 0.2);
    smooth = FitSmoothMap(problem, prior, *homogeneous);
    errors = DescribeMap(problem, prior, *smooth);
    sharpened = SharpenMap(problem, prior, *smooth);
    for (const RegionMap& map :
         FitRegions(problem, prior, sharpened, *homogeneous)) {
      regions = regions ? regions : map;
    }
  }

  double ErrorOf(const MapState& state) const {
    return MapError(state.log_moduli, truth.log_moduli);
  }
};

// The errors of each stage at 1 % noise.
TEST(MapStages, ReachTheirFigures) {
  struct Figures {
    const char* name;
    ElementKind kind;
    int cells;
    double smooth;
    double sharpened;
    double regions;
  };
  for (const Figures& figures :
       {Figures{"inc5", ElementKind::kQuad4, 16, 0.3, 0.15, 0.01},
        Figures{"inc2", ElementKind::kQuad4, 16, 0.4, 0.25, 0.01},
        Figures{"two", ElementKind::kQuad4, 16, 0.4, 0.25, 0.02},
        Figures{"lay", ElementKind::kQuad4, 16, 0.3, 0.15, 0.05},
        Figures{"inc5", ElementKind::kHex8, 6, 0.4, 0.2, 0.02}}) {
    Stages stages(figures.name, figures.kind, figures.cells, 0.01);
    ASSERT_TRUE(stages.smooth->has_converged) << figures.name;
    EXPECT_LT(stages.ErrorOf(stages.smooth->state), figures.smooth)
        << figures.name;
    EXPECT_LT(stages.ErrorOf(stages.sharpened), figures.sharpened)
        << figures.name;
    ASSERT_TRUE(stages.regions) << figures.name;
    EXPECT_LT(stages.ErrorOf(stages.regions->fit.state), figures.regions)
        << figures.name;
    EXPECT_GT(stages.regions->log_evidence, stages.smooth->log_evidence)
        << figures.name;
  }
}

// A gradient is no matter of regions.
TEST(MapStages, PreferAFieldForAGradient) {
  Stages stages("grad", ElementKind::kQuad4, 16, 0.01);
  EXPECT_LT(stages.ErrorOf(stages.smooth->state), 0.2);
  EXPECT_GT(stages.ErrorOf(stages.regions->fit.state), 0.3);
  EXPECT_GT(stages.smooth->log_evidence, stages.regions->log_evidence);
}

// The modes of one length tell which of two lengths the evidence prefers.
TEST(MapStages, KnowTheLengthOfTheGreaterEvidence) {
  for (const std::string name : {"grad", "inc5"}) {
    Stages stages(name, ElementKind::kQuad4, 16, 0.01);
    const SmoothMap& map = *stages.smooth;
    const FieldPrior gradual(stages.truth.scene.mesh, FieldPrior::kGradient);
    ASSERT_TRUE(stages.model.MoveTo(map.state.log_moduli,
                                    map.state.poisson_ratio,
                                    std::sqrt(map.variance)));
    const double gain_by_modes =
        LogEvidenceByModes(stages.problem, gradual, stages.prior, map) -
        LogEvidenceByModes(stages.problem, stages.prior, stages.prior, map);
    const MapState& start = stages.homogeneous->state;
    ASSERT_TRUE(
        stages.model.MoveTo(start.log_moduli, start.poisson_ratio, 1e-3));
    const double of_fit =
        FitSmoothMap(stages.problem, gradual, *stages.homogeneous).log_evidence;
    EXPECT_EQ(gain_by_modes > 0, name == "grad") << name;
    EXPECT_EQ(of_fit > map.log_evidence, name == "grad") << name;
  }
}

// gamma, the standard deviations and the resolution are those of the dense
// matrices H and A.
TEST(MapStages, HaveTheErrorsOfDenseMatrices) {
  Stages stages("grad", ElementKind::kQuad4, 8, 0.02);
  const SmoothMap& map = *stages.smooth;
  const Eigen::Index n = stages.prior.NumElements();
  ASSERT_TRUE(
      stages.model.MoveTo(map.state.log_moduli, map.state.poisson_ratio, 0));
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(n, n);
  const Eigen::MatrixXd ones = Eigen::MatrixXd::Ones(n, 1);
  const FlatUnknowns unknowns(stages.problem, map.state, ones);
  const Eigen::MatrixXd a = stages.prior.Apply(identity);
  const Eigen::MatrixXd s = stages.model.Multiply(identity);
  const Eigen::MatrixXd sa = unknowns.Project(s * a);
  const Eigen::MatrixXd h = sa.transpose() * sa;
  const Eigen::MatrixXd covariance =
      (identity / map.ratio + h).ldlt().solve(identity);
  const Eigen::MatrixXd resolution =
      a * (identity - covariance / map.ratio) * a.inverse();
  EXPECT_NEAR(map.effective_number, resolution.trace(),
              0.02 * resolution.trace());
  const Eigen::VectorXd lengths =
      ResolutionLengths(stages.problem, stages.prior, map);
  for (Eigen::Index e = 0; e < n; ++e) {
    const double length =
        std::sqrt(stages.prior.Volumes()(e) / resolution(e, e));
    EXPECT_NEAR(lengths(e), length, 0.05 * length);
  }
  // x + level: the level makes up for the response to x.
  const Eigen::MatrixXd level = unknowns.Solve(s * a).topRows(1);
  const Eigen::MatrixXd field = a - ones * level;
  const Eigen::MatrixXd variances =
      map.variance *
      (field * covariance * field.transpose() +
       Eigen::MatrixXd::Constant(n, n, unknowns.InverseGram()(0, 0)));
  const Eigen::ArrayXd sd = variances.diagonal().cwiseSqrt();
  // 64 draws: 9 % root mean square.
  const Eigen::ArrayXd ratio = stages.errors.log_modulus_sd.array() / sd - 1;
  EXPECT_LT(std::sqrt(ratio.square().mean()), 0.14);
  EXPECT_LT(ratio.abs().maxCoeff(), 0.45);
}

}  // namespace
}  // namespace elastimate::testing
