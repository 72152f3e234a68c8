#include "elastimate/estimators/material_fit/certified_descent.h"

#include <cmath>

#include "elastimate/core/materials/isotropic_law.h"
#include "elastimate/core/scene/degrees_of_freedom.h"
#include "elastimate/core/scene/unknown_motion.h"

namespace elastimate {
namespace {

// The places of E and nu among the parameters of an isotropic material.
constexpr Eigen::Index kYoungsModulus = 0;
constexpr Eigen::Index kPoissonRatio = 1;

// The range of a parameter: its bounds, or the value that is known.
Bounds RangeOf(const FreeParameters& free, Eigen::Index place) {
  if (const std::optional<double>& known = free.All().All()[place].known) {
    return {known, known};
  }
  for (Eigen::Index i = 0; i < free.Size(); ++i) {
    if (free.All().Free()[i] == place) {
      Bounds bounds = free.VariableBounds()[i];
      if (place == kYoungsModulus) {
        for (std::optional<double>* const end :
             {&bounds.lower, &bounds.upper}) {
          *end = *end ? std::optional<double>(std::exp(**end)) : *end;
        }
      }
      return bounds;
    }
  }
  return {};
}

Side SideOf(const Bounds& bounds, double value) {
  constexpr double kOnBound = 1e-9;
  if (bounds.lower && value <= *bounds.lower + kOnBound) {
    return Side::kLower;
  }
  if (bounds.upper && value >= *bounds.upper - kOnBound) {
    return Side::kUpper;
  }
  return Side::kNone;
}

}  // namespace

bool CertifiedDescent::Takes(const Scene& scene) {
  return (scene.materials.empty() ||
          (scene.materials.size() == 1 &&
           scene.materials[0].law == IsotropicLaw::kName)) &&
         !HasUnknownMotion(scene) && !HasSupportsOfCases(scene);
}

CertifiedDescent::CertifiedDescent(const Scene& scene,
                                   const EstimatorOptions& options,
                                   DisplacementMisfit& misfit)
    : scene_(scene),
      misfit_(misfit),
      fit_(scene, RangeOf(misfit.Free(), kPoissonRatio),
           RangeOf(misfit.Free(), kYoungsModulus), options.solver,
           options.on_factorization) {
  misfit.SetSolution([this](const Eigen::VectorXd& x,
                            Eigen::MatrixXd* displacement,
                            Eigen::MatrixXd* sensitivities) {
    return Solve(x, displacement, sensitivities);
  });
}

CertifiedDescent::~CertifiedDescent() { misfit_.SetSolution({}); }

std::optional<BoundedMinimum> CertifiedDescent::Minimize() {
  const FreeParameters& free = misfit_.Free();
  BoundedMinimum minimum;
  const bool is_regular = fit_.Run(misfit_.Observed());
  const ReducedFit::Point& best = fit_.Best();
  if (is_regular && !(best.compliance_scale > 0)) {
    return std::nullopt;
  }
  const IsotropicElasticity elasticity =
      is_regular ? IsotropicElasticity::FromComplianceScale(
                       best.compliance_scale, best.poisson_ratio,
                       fit_.Model().Section())
                 : IsotropicElasticity{1, fit_.Model().Pole()};
  minimum.variables = free.VariablesOf(
      Eigen::Vector2d(elasticity.youngs_modulus, elasticity.poisson_ratio));
  minimum.cost = best.square_sum / 2;
  for (Eigen::Index i = 0; i < free.Size(); ++i) {
    minimum.on_bound.push_back(
        SideOf(free.VariableBounds()[i], minimum.variables(i)));
  }
  minimum.end = !is_regular           ? End::kSingularStiffness
                : fit_.HasConverged() ? End::kDone
                                      : End::kNotCertified;
  return minimum;
}

bool CertifiedDescent::Solve(const Eigen::VectorXd& x,
                             Eigen::MatrixXd* displacement,
                             Eigen::MatrixXd* sensitivities) const {
  const FreeParameters& free = misfit_.Free();
  const Eigen::VectorXd parameters = free.ParametersAt(x);
  const IsotropicElasticity elasticity = {parameters(kYoungsModulus),
                                          parameters(kPoissonRatio)};
  const ReducedModel& model = fit_.Model();
  if (!elasticity.IsPhysical() ||
      !fit_.IsAccurateAt({elasticity.poisson_ratio,
                          elasticity.ComplianceScale(model.Section()), 0},
                         misfit_.Observed())) {
    return false;
  }
  const ReducedSolution solution = SolveReduced(model, elasticity);
  *displacement =
      solution.displacement.colwise() + HeldDisplacement(scene_.supports);
  sensitivities->resize(displacement->rows(),
                        free.Size() * displacement->cols());
  for (Eigen::Index k = 0; k < displacement->cols(); ++k) {
    for (Eigen::Index i = 0; i < free.Size(); ++i) {
      sensitivities->col(free.Size() * k + i) =
          free.All().Free()[i] == kYoungsModulus
              ? solution.by_log_youngs_modulus.col(k)
              : solution.by_poisson_ratio.col(k);
    }
  }
  return true;
}

}  // namespace elastimate
