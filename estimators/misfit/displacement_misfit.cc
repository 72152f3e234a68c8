#include "elastimate/estimators/misfit/displacement_misfit.h"

#include <cmath>

#include "elastimate/core/algebra/node_sums.h"
#include "elastimate/core/equilibrium/large_strain_model.h"
#include "elastimate/estimators/interface/statistics.h"

namespace elastimate {
namespace {

// Column i of those of each load case.
Eigen::MatrixXd OfVariable(const Eigen::MatrixXd& of_cases, Eigen::Index i,
                           Eigen::Index num_variables) {
  return of_cases(Eigen::all, Eigen::seq(i, Eigen::last, num_variables));
}

std::optional<DisplacementMisfit::ScaleFit> IfPositive(
    const DisplacementMisfit::ScaleFit& fit) {
  return fit.compliance > 0 && std::isfinite(fit.compliance)
             ? std::optional<DisplacementMisfit::ScaleFit>(fit)
             : std::nullopt;
}

// Returns the error that iterative solutions may have, relative in the energy
// norm.  What finer elements change of measured displacements is a thousandth
// of these at least where it matters.  Computed ones may be exact, and the
// elimination of motions asks for more.
double ToleranceFor(const Scene& scene) {
  constexpr double kOfDisplacements = 1e-5;
  return HasUnknownMotion(scene) || scene.origin != Origin::kMeasured
             ? StiffnessSolver::kAccurate
             : kOfDisplacements;
}

std::unique_ptr<ForwardModel> MakeModel(const std::vector<const Scene*>& spaces,
                                        SolverKind solver,
                                        const StiffnessSolver* shared) {
  const Scene& scene = *spaces.back();
  if (HasLargeStrainLaw(scene.materials)) {
    return std::make_unique<LargeStrainModel>(scene);
  }
  return std::make_unique<Equilibrium>(spaces, solver, ToleranceFor(scene),
                                       shared);
}

}  // namespace

DisplacementMisfit::DisplacementMisfit(const std::vector<const Scene*>& spaces,
                                       const EstimatorOptions& options,
                                       const StiffnessSolver* shared)
    : free_(*spaces.back(), options),
      model_(MakeModel(spaces, options.solver, shared)),
      small_strain_model_(dynamic_cast<Equilibrium*>(model_.get())),
      observed_(*spaces.back()),
      on_factorization_(options.on_factorization) {
  if (HasUnknownMotion(*spaces.back())) {
    motion_.emplace(*spaces.back(), observed_, *model_);
  }
}

void DisplacementMisfit::Remeasure(const Scene& scene) {
  observed_.Remeasure(scene);
  CompareAnew();
}

void DisplacementMisfit::ObserveAnew(const Scene& scene) {
  observed_ = ObservedDisplacements(scene);
  CompareAnew();
}

void DisplacementMisfit::SetDilatation(Dilatation dilatation) {
  static_cast<LargeStrainModel&>(*model_).SetDilatation(dilatation);
  x_.resize(0);
}

void DisplacementMisfit::SetRotations(MotionElimination::Rotations rotations) {
  motion_->SetRotations(rotations);
  x_.resize(0);
}

void DisplacementMisfit::CompareAnew() {
  if (x_.size() != 0) {
    residual_ = observed_.Restrict(Displacement()) - observed_.Measured();
  }
}

bool DisplacementMisfit::SolutionAt(const Eigen::VectorXd& x,
                                    Eigen::MatrixXd* displacement,
                                    Eigen::MatrixXd* sensitivities) {
  if (!MoveTo(x)) {
    return false;
  }
  // The solves of sensitivities need much memory.
  *sensitivities = placed_ ? placed_->sensitivities
                           : model_->Sensitivities(free_.ModuliJacobian(x));
  *displacement = Displacement();
  return true;
}

Eigen::Index DisplacementMisfit::NumRows() const {
  return motion_ ? motion_->NumRows() : observed_.Size();
}

Eigen::Index DisplacementMisfit::NumAmounts() const {
  return motion_ ? motion_->NumAmounts() : 0;
}

Eigen::Index DisplacementMisfit::NumResultants() const {
  return motion_ ? motion_->NumResultants() : 0;
}

void DisplacementMisfit::SetNoise(double standard_deviation) {
  if (!motion_) {
    return;
  }
  motion_->SetNoise(standard_deviation);
  if (x_.size() != 0) {
    const std::optional<Eigen::VectorXd> rows = motion_->Refit();
    if (rows) {
      residual_ = *rows;
    } else {
      x_.resize(0);
    }
  }
}

double DisplacementMisfit::Variance(double square_sum) const {
  const Eigen::Index redundancy =
      observed_.Size() - NumAmounts() - free_.Size();
  const double variance =
      observed_.GivenNoise()
          ? 1 / (observed_.Norm() * observed_.Norm())
          : square_sum /
                static_cast<double>(std::max<Eigen::Index>(redundancy, 1));
  return std::max(variance, kLeastNoise * kLeastNoise);
}

bool DisplacementMisfit::Evaluate(const Eigen::VectorXd& x,
                                  Eigen::VectorXd* residual,
                                  Eigen::MatrixXd* jacobian) {
  if (!MoveTo(x)) {
    return false;
  }
  *residual = residual_;
  if (jacobian != nullptr) {
    *jacobian = Sensitivities(x);
    // A solver that does not converge leaves none.
    if (!jacobian->allFinite()) {
      return false;
    }
  }
  const Eigen::VectorXd& factors = weights_.factors;
  if (factors.size() != 0) {
    residual->array() *= factors.array();
    if (jacobian != nullptr) {
      *jacobian = (factors.asDiagonal() * *jacobian).eval();
    }
  }
  return residual->allFinite();
}

std::optional<DisplacementMisfit::ScaleFit> DisplacementMisfit::FitScale(
    const Eigen::VectorXd& unit_moduli, Loss loss) {
  x_.resize(0);
  placed_.reset();
  if (motion_ ? !model_->Solve(unit_moduli)
              : !small_strain_model_->SolveRoughly(unit_moduli)) {
    return std::nullopt;
  }
  const Eigen::MatrixXd& held = small_strain_model_->SupportResponse();
  const Eigen::MatrixXd loaded = model_->Displacement() - held;
  if (motion_) {
    motion_->SetNoise(0);
  }
  const Eigen::VectorXd by_loads = WithoutMotion(loaded);
  if (SquaredNorm(by_loads) > 0) {
    Eigen::VectorXd rest = -WithoutMotion(held);
    rest.head(observed_.Size()) += observed_.Measured();
    if (motion_) {
      rest.head(observed_.Size()) -= observed_.Restrict(motion_->SeenAtRest());
    }
    const double compliance =
        loss == Loss::kNone
            ? InnerProduct(by_loads, rest) / SquaredNorm(by_loads)
            : LeastAbsoluteDeviations(by_loads, rest);
    const Eigen::VectorXd left = rest - compliance * by_loads;
    return IfPositive({compliance, loss == Loss::kNone ? SquaredNorm(left)
                                                       : left.lpNorm<1>()});
  }
  if (!motion_) {
    return std::nullopt;
  }
  static_cast<void>(model_->MoveSupports(motion_->HeldMotion()) &&
                    motion_->Fit());
  const std::optional<double> stiffness = FitStiffness();
  return stiffness ? IfPositive({1 / *stiffness, 0}) : std::nullopt;
}

std::optional<double> DisplacementMisfit::FitStiffness() {
  if (!motion_) {
    return std::nullopt;
  }
  const Eigen::VectorXd of_model = motion_->Resultants(model_->SupportForces());
  const double stiffness =
      of_model.dot(motion_->MeasuredResultants()) / of_model.squaredNorm();
  return stiffness > 0 ? std::optional<double>(stiffness) : std::nullopt;
}

bool DisplacementMisfit::SolveAt(const Eigen::VectorXd& x) {
  x_.resize(0);
  placed_.reset();
  if (on_factorization_) {
    on_factorization_(++num_factorizations_);
  }
  const Eigen::VectorXd moduli = free_.ModuliAt(x);
  return moduli.allFinite() &&
         (motion_ ? model_->SolveMoved(moduli, motion_->HeldMotion())
                  : model_->Solve(moduli)) &&
         model_->Displacement().allFinite();
}

bool DisplacementMisfit::Factorize(const Eigen::VectorXd& x) {
  return (!placed_ && IsAt(x)) || MoveModelTo(x);
}

void DisplacementMisfit::ForgetSolution() {
  small_strain_model_->ForgetSolution();
  if (!placed_) {
    x_.resize(0);
  }
}

void DisplacementMisfit::ForgetPlaced() {
  if (placed_) {
    placed_.reset();
    x_.resize(0);
  }
}

void DisplacementMisfit::Place(const Eigen::VectorXd& x,
                               Eigen::MatrixXd displacement,
                               Eigen::MatrixXd sensitivities) {
  placed_ = Placed{std::move(displacement), std::move(sensitivities)};
  residual_ = observed_.Restrict(placed_->displacement) - observed_.Measured();
  x_ = x;
}

bool DisplacementMisfit::MoveTo(const Eigen::VectorXd& x) {
  if (IsAt(x)) {
    return true;
  }
  Placed placed;
  if (solution_ && solution_(x, &placed.displacement, &placed.sensitivities)) {
    Place(x, std::move(placed.displacement), std::move(placed.sensitivities));
    return true;
  }
  return MoveModelTo(x);
}

bool DisplacementMisfit::MoveModelTo(const Eigen::VectorXd& x) {
  if (!SolveAt(x)) {
    return false;
  }
  if (motion_) {
    const std::optional<Eigen::VectorXd> rows = motion_->Fit();
    if (!rows) {
      return false;
    }
    residual_ = *rows;
  } else {
    residual_ =
        observed_.Restrict(model_->Displacement()) - observed_.Measured();
  }
  x_ = x;
  return true;
}

Eigen::MatrixXd DisplacementMisfit::Sensitivities(const Eigen::VectorXd& x) {
  const Eigen::Index n = free_.Size();
  const Eigen::MatrixXd directions = free_.ModuliJacobian(x);
  const Eigen::MatrixXd of_cases =
      placed_ ? placed_->sensitivities : model_->Sensitivities(directions);
  const Eigen::MatrixXd forces =
      motion_ ? model_->SupportForceSensitivities(directions, of_cases)
              : Eigen::MatrixXd();
  Eigen::MatrixXd sensitivities(NumRows(), n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::MatrixXd of_variable = OfVariable(of_cases, i, n);
    sensitivities.col(i) =
        motion_ ? motion_->Eliminate(of_variable, OfVariable(forces, i, n))
                : observed_.Restrict(of_variable);
  }
  return sensitivities;
}

Eigen::VectorXd DisplacementMisfit::WithoutMotion(
    const Eigen::MatrixXd& displacements) {
  return motion_ ? motion_->Eliminate(displacements, Eigen::MatrixXd::Zero(
                                                         displacements.rows(),
                                                         displacements.cols()))
                 : observed_.Restrict(displacements);
}

}  // namespace elastimate
