#include "elastimate/estimators/misfit/element_change.h"

#include <algorithm>
#include <cmath>

#include "elastimate/core/materials/elasticity.h"

namespace elastimate {
namespace {

// How far the ratio of the stiffness against volume to that against shear may
// change, in its logarithm, before the change is found again.
constexpr double kSameStiffness = 0.2;
// How far, where the change is about linear in nu.
constexpr double kAlike = 0.5;
constexpr double kLargestOfQuadratic = 0.495;

}  // namespace

std::optional<Eigen::VectorXd> ElementChange::Rows(
    const ObservedDisplacements& observed,
    const IsotropicElasticity& elasticity, const ModelAt& model_at) {
  const double nu =
      scene_.mesh.Order() == 2
          ? std::min(elasticity.poisson_ratio, kLargestOfQuadratic)
          : elasticity.poisson_ratio;
  const Found* nearest = Nearest(nu, kSameStiffness, nullptr);
  if (nearest == nullptr) {
    found_.push_back({nu, Find(nu, model_at)});
    nearest = &found_.back();
  }
  if (!nearest->change) {
    return std::nullopt;
  }
  Eigen::MatrixXd change = ChangeOf(*nearest, elasticity.youngs_modulus);
  const Found* other = Nearest(nu, kAlike, nearest);
  if (other != nullptr && other->change) {
    change += (nu - nearest->poisson_ratio) /
              (other->poisson_ratio - nearest->poisson_ratio) *
              (ChangeOf(*other, elasticity.youngs_modulus) - change);
  }
  return observed.Restrict(change);
}

const ElementChange::Found* ElementChange::Nearest(double nu, double within,
                                                   const Found* but) const {
  const Found* nearest = nullptr;
  for (const Found& found : found_) {
    const double distance = std::abs(LogStiffnessRatio(nu) -
                                     LogStiffnessRatio(found.poisson_ratio));
    if (&found != but && distance <= within) {
      nearest = &found;
      within = distance;
    }
  }
  return nearest;
}

Eigen::MatrixXd ElementChange::ChangeOf(const Found& found,
                                        double youngs_modulus) const {
  const IsotropicElasticity there = {youngs_modulus, found.poisson_ratio};
  const auto num_cases = Eigen::Index(scene_.load_cases.size());
  Eigen::MatrixXd change = there.ComplianceScale(scene_.mesh.section.model) *
                           found.change->leftCols(num_cases);
  if (found.change->cols() > num_cases) {
    change.colwise() += found.change->rightCols<1>();
  }
  return change;
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
