#include "elastimate/estimators/plan/map_plan.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/estimators/maps/field_prior.h"
#include "elastimate/estimators/maps/field_sensitivity.h"
#include "elastimate/estimators/plan/sized_loads.h"

namespace elastimate {
namespace {

double SupportedParameters(const Eigen::MatrixXd& information,
                           const FieldPrior& prior) {
  const Eigen::VectorXd of_level = information.rowwise().sum();
  Eigen::MatrixXd without_level = information;
  if (of_level.sum() > 0) {
    without_level -= of_level * of_level.transpose() / of_level.sum();
  }
  const Eigen::MatrixXd half = prior.ApplyTransposed(without_level);
  const Eigen::ArrayXd gains =
      kExpectedSpread * kExpectedSpread *
      DecomposeSymmetric(prior.ApplyTransposed(half.transpose()))
          .values.array()
          .max(0);
  return (gains / (1 + gains)).sum();
}

Scene OfElements(const Scene& scene, double poisson_ratio) {
  Scene of_elements = WithMaterialOfEachElement(scene);
  for (Material& material : of_elements.materials) {
    material.known = {{"poisson_ratio", poisson_ratio}};
  }
  return of_elements;
}

}  // namespace

MapPlan PlanMap(const Scene& scene,
                const std::vector<CandidateLoad>& candidates,
                const IsotropicElasticity& elasticity, double relative_noise,
                SolverKind solver) {
  const Eigen::Index n = scene.mesh.NumElements();
  if (n > kMostElementsOfPlan) {
    throw std::invalid_argument(
        "a plan of a map takes meshes of up to " +
        std::to_string(kMostElementsOfPlan) + " elements, and this one has " +
        std::to_string(n) + "; give a coarser mesh of the specimen");
  }
  const SizedLoads sized = SizeLoads(
      OfElements(scene, elasticity.poisson_ratio), candidates,
      Eigen::Vector2d(elasticity.youngs_modulus, elasticity.poisson_ratio)
          .replicate(n, 1),
      relative_noise, solver, PlannedElements::kOfMesh);
  const FieldPrior prior(scene.mesh);
  MapPlan plan = {SupportedParameters(sized.known, prior), {}};
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const SizedCandidate& candidate = sized.candidates[i];
    plan.loads.push_back(
        {i, SupportedParameters(sized.known + candidate.information, prior),
         candidate.factor});
  }
  std::stable_sort(plan.loads.begin(), plan.loads.end(),
                   [](const PlannedMapLoad& a, const PlannedMapLoad& b) {
                     return a.supported_parameters > b.supported_parameters;
                   });
  return plan;
}

}  // namespace elastimate
