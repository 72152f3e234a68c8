#include "elastimate/estimators/misfit/element_change.h"

#include <algorithm>
#include <cmath>

#include "elastimate/core/materials/elasticity.h"

namespace elastimate {
namespace {

// How far the ratio of the stiffness against volume to that against shear may
// change, in its logarithm, before the change is found again.
constexpr double kSameStiffness = 0.2;
constexpr double kLargestOfQuadratic = 0.495;

}  // namespace

std::optional<Eigen::VectorXd> ElementChange::Rows(
    const ObservedDisplacements& observed,
    const IsotropicElasticity& elasticity, const ModelAt& model_at) {
  const double nu =
      scene_.mesh.Order() == 2
          ? std::min(elasticity.poisson_ratio, kLargestOfQuadratic)
          : elasticity.poisson_ratio;
  auto known =
      std::find_if(found_.begin(), found_.end(), [nu](const Found& found) {
        return std::abs(LogStiffnessRatio(nu) -
                        LogStiffnessRatio(found.poisson_ratio)) <=
               kSameStiffness;
      });
  if (known == found_.end()) {
    found_.push_back({nu, Find(nu, model_at)});
    known = found_.end() - 1;
  }
  const std::optional<Eigen::MatrixXd>& of_responses = known->change;
  if (!of_responses) {
    return std::nullopt;
  }
  const IsotropicElasticity there = {elasticity.youngs_modulus,
                                     known->poisson_ratio};
  const auto num_cases = Eigen::Index(scene_.load_cases.size());
  Eigen::MatrixXd change = there.ComplianceScale(scene_.mesh.section.model) *
                           of_responses->leftCols(num_cases);
  if (of_responses->cols() > num_cases) {
    change.colwise() += of_responses->rightCols<1>();
  }
  return observed.Restrict(change);
}

std::optional<Eigen::MatrixXd> ElementChange::Find(double poisson_ratio,
                                                   const ModelAt& model_at) {
  const Model model = model_at(poisson_ratio);
  if (model.solver == nullptr) {
    return std::nullopt;
  }
  if (!hierarchical_) {
    hierarchical_ = std::make_unique<HierarchicalError>(scene_);
  }
  const int passes = hierarchical_->NumPasses();
  std::optional<Eigen::MatrixXd> change =
      hierarchical_->Find(poisson_ratio, model.responses, *model.solver);
  work_.element_passes += hierarchical_->NumPasses() - passes;
  return change;
}

}  // namespace elastimate
