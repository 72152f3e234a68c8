#include "elastimate/estimators/material_fit/reduced_descent.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/algebra/node_sums.h"
#include "elastimate/core/algebra/tall_columns.h"
#include "elastimate/core/materials/free_axis_law.h"
#include "elastimate/estimators/interface/axis_estimate.h"
#include "elastimate/estimators/material_fit/material_descent.h"
#include "elastimate/estimators/reduced_model/nearby_solve.h"
#include "elastimate/estimators/reduced_model/reduced_equilibrium.h"

namespace elastimate {
namespace {

// The step, in standard errors, below which a minimum is accepted, and the
// error that each of the two solves (u, adjoint) may add to it.
constexpr double kLargestStep = 0.05;
constexpr double kStepAccuracy = 0.01;
// The standard deviation of a row that counts as noise at least, where the norm
// of all rows is 1: exact displacements are fitted to a part of it.
constexpr double kNoiseOfExactData = 1e-8;
// What is less certain than by a factor of e^3 is not determined, whatever the
// gradient is.
constexpr double kUndetermined = 3;
constexpr double kSensitivityAccuracy = 1e-4;
// A solve that takes more iterations ends, and a new pole is set.  With cycles
// over coarser spaces, thin bodies and nu near 1/2 take more than a hundred
// even at the pole itself, so that a new pole would not help.
constexpr int kMostIterationsByFactor = 8;
constexpr int kMostIterationsByCycle = 200;
constexpr int kMostPoles = 10;

class ReducedDescent {
 public:
  explicit ReducedDescent(DisplacementMisfit& misfit)
      : misfit_(misfit),
        reduced_(misfit.SmallStrainModel(), misfit.Observed()) {}

  /// False where the stiffness is singular.
  bool SetPole(const Eigen::VectorXd& x);
  /// Sets the pole at typical values, where the model is solved but for the
  /// scale; empty where displacements oppose the loads.
  std::optional<Eigen::VectorXd> SetTypicalPole();
  /// Sets the pole at x, with the derivatives by all moduli.  False where the
  /// stiffness is singular.
  bool SetPoleOfAllModuli(const Eigen::VectorXd& x);
  int NumPoles() const { return num_poles_; }
  /// Whether the last minimum is farther from the pole than the reduced model
  /// is trusted.
  bool LeadsAway() const { return leads_away_; }

  BoundedMinimum MinimumFrom(const Eigen::VectorXd& x);

  /// Solves the full model next to the reduced one; false where that is too
  /// far from the pole.
  bool Check(const BoundedMinimum& minimum);
  /// The largest step that is left at the last minimum that was checked, in
  /// standard errors.
  double Step() const { return step_; }
  /// Makes the misfit and its gradient exact there.
  void Refine();
  /// Leaves the misfit there.
  void Finish(const Eigen::VectorXd& x);

  int ElementPasses() const {
    return element_passes_ + reduced_.ElementPasses();
  }

 private:
  /// Returns the bounds of the variables, narrowed to where the model is
  /// trusted.
  std::vector<Bounds> TrustBounds() const;
  Eigen::MatrixXd WithoutHeld(const Eigen::MatrixXd& displacement) const {
    return displacement - misfit_.SmallStrainModel().HeldDisplacement();
  }
  void AddPole(const Eigen::VectorXd& x, const Eigen::MatrixXd& displacement,
               Eigen::MatrixXd sensitivities);
  /// Iterations over finer spaces take as long for each variable alone, and
  /// need less memory.
  Eigen::Index NumVariablesAtATime() const {
    return misfit_.SmallStrainModel().IsRefined() ? 1 : misfit_.Free().Size();
  }
  /// df(u)/dp of each load case side by side, at the u of the check, for
  /// directions d theta / dp.
  Eigen::MatrixXd ForcesOf(const Eigen::MatrixXd& directions);
  bool SolveForAdjoint(const Eigen::VectorXd& residual, double tolerance);
  /// The gradient at the check, by the adjoint, without what a bound holds.
  Eigen::VectorXd GradientWithin(const std::vector<Side>& on_bound);
  bool SolveNear(Eigen::MatrixXd forces, const Eigen::VectorXd& tolerances,
                 Eigen::MatrixXd& x);

  DisplacementMisfit& misfit_;
  ReducedEquilibrium reduced_;
  int num_poles_ = 0;
  Eigen::VectorXd pole_;
  bool leads_away_ = false;
  int element_passes_ = 0;

  // Where the last check was.
  Eigen::VectorXd moduli_;
  Eigen::MatrixXd directions_;  ///< d theta / dx.
  Eigen::MatrixXd displacement_;
  Eigen::MatrixXd adjoint_;
  double step_ = 0;
};

bool ReducedDescent::SetPole(const Eigen::VectorXd& x) {
  // The first pole may be where an earlier descent ended, with the factor of
  // that.  A further one is set where that factor is too far away.
  Equilibrium& model = misfit_.SmallStrainModel();
  // Columns of large meshes need much memory.
  displacement_.resize(0, 0);
  adjoint_.resize(0, 0);
  if (num_poles_ > 0) {
    const FreeParameters& free = misfit_.Free();
    if (reduced_.Solve(free.ModuliAt(x))) {
      model.BeginWith(
          reduced_.Displacement(),
          reduced_.DisplacementSensitivities(free.ModuliJacobian(x)));
    }
    // The new pole is nearer to the minimum, so the old vectors are worth less
    // than the memory that they need on a large mesh.
    if (model.IsRefined()) {
      reduced_.ForgetBases();
    }
    if (!misfit_.Factorize(x)) {
      return false;
    }
  }
  Eigen::MatrixXd displacement;
  Eigen::MatrixXd sensitivities;
  if (!misfit_.SolutionAt(x, &displacement, &sensitivities)) {
    return false;
  }
  misfit_.ForgetSolution();
  AddPole(x, displacement, std::move(sensitivities));
  return true;
}

bool ReducedDescent::SetPoleOfAllModuli(const Eigen::VectorXd& x) {
  if (!misfit_.SolveAt(x)) {
    return false;
  }
  const Eigen::Index num_moduli = misfit_.Free().All().NumModuli();
  AddPole(x, misfit_.SmallStrainModel().Displacement(),
          misfit_.SmallStrainModel().Sensitivities(
              Eigen::MatrixXd::Identity(num_moduli, num_moduli)));
  return true;
}

std::optional<Eigen::VectorXd> ReducedDescent::SetTypicalPole() {
  std::optional<Eigen::VectorXd> x = TypicalStart(misfit_);
  if (!x) {
    return std::nullopt;
  }
  const FreeParameters& free = misfit_.Free();
  const Eigen::VectorXd moduli = free.ModuliAt(*x);
  const Eigen::VectorXd unit = free.All().Moduli(free.All().Typical(1));
  const double scale = moduli.norm() / unit.norm();
  constexpr double kRounding = 1e-12;
  if (free.All().KnownModulus() ||
      (moduli - scale * unit).norm() > kRounding * moduli.norm()) {
    return SetPole(*x) ? x : std::nullopt;
  }
  // The factor at hand is that of the pole but for the scale.
  Equilibrium& model = misfit_.SmallStrainModel();
  const Eigen::MatrixXd& held = model.SupportResponse();
  displacement_ = held + (model.Displacement() - held) / scale;
  directions_ = free.ModuliJacobian(*x);
  AddPole(*x, displacement_, model.SolveFor(-ForcesOf(directions_)) / scale);
  return x;
}

void ReducedDescent::AddPole(const Eigen::VectorXd& x,
                             const Eigen::MatrixXd& displacement,
                             Eigen::MatrixXd sensitivities) {
  const Eigen::Index n = sensitivities.cols() / displacement.cols();
  Eigen::MatrixXd vectors(displacement.rows(), (n + 1) * displacement.cols());
  for (Eigen::Index k = 0; k < displacement.cols(); ++k) {
    vectors.middleCols((n + 1) * k + 1, n) = sensitivities.middleCols(n * k, n);
  }
  sensitivities.resize(0, 0);
  vectors(Eigen::all, Eigen::seq(0, Eigen::last, n + 1)) =
      WithoutHeld(displacement);
  reduced_.Extend(misfit_.Free().ModuliAt(x), std::move(vectors));
  pole_ = x;
  ++num_poles_;
}

std::vector<Bounds> ReducedDescent::TrustBounds() const {
  // A modulus may change by a factor of ten, a ratio may go nine tenths of the
  // way to an end of its range, or all of it from nearby.
  constexpr double kLargestChange = 2.3;
  constexpr double kLargestPart = 0.9;
  constexpr double kNearby = 0.02;
  const auto towards = [](double from, double end, double range) {
    const double way = end - from;
    return std::abs(way) < kNearby * range ? end : from + kLargestPart * way;
  };
  const FreeParameters& free = misfit_.Free();
  std::vector<Bounds> bounds = free.VariableBounds();
  for (Eigen::Index i = 0; i < free.Size(); ++i) {
    const LawParameter& parameter = *free.Free(i).law_parameter;
    Bounds& own = bounds[i];
    double lower = pole_(i) - kLargestChange;
    double upper = pole_(i) + kLargestChange;
    // Logarithms and factors of a stiffness have no range.
    if (own.lower && own.upper && !parameter.is_modulus) {
      const double range = *own.upper - *own.lower;
      lower = towards(pole_(i), *own.lower, range);
      upper = towards(pole_(i), *own.upper, range);
    }
    own.lower = std::max(own.lower.value_or(lower), lower);
    own.upper = std::min(own.upper.value_or(upper), upper);
  }
  return bounds;
}

BoundedMinimum ReducedDescent::MinimumFrom(const Eigen::VectorXd& x) {
  // Steps of a model that costs nothing may be short.
  constexpr double kRadius = 1;
  constexpr double kSmallestStepOfErrors = 1e-3;
  constexpr int kIterations = 200;
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = kIterations;
  options.initial_trust_region_radius = kRadius;
  options.function_tolerance = kSmallestStepOfErrors * kSmallestStepOfErrors /
                               static_cast<double>(misfit_.NumRows());
  options.gradient_tolerance = 1e-20;
  options.parameter_tolerance = 1e-12;
  options.logging_type = ceres::SILENT;
  const FreeParameters& free = misfit_.Free();
  const std::vector<Bounds> bounds = TrustBounds();
  BoundedMinimum minimum = MinimizeOverVariables(
      [&](const Eigen::VectorXd& variables, Eigen::VectorXd* residual,
          Eigen::MatrixXd* jacobian) {
        const Eigen::VectorXd moduli = free.ModuliAt(variables);
        if (!moduli.allFinite() || !reduced_.Solve(moduli)) {
          return false;
        }
        *residual = reduced_.Residual();
        if (jacobian != nullptr) {
          *jacobian = reduced_.Sensitivities(free.ModuliJacobian(variables));
        }
        return residual->allFinite();
      },
      reduced_.NumRows(), bounds, x, options);
  leads_away_ = false;
  for (Eigen::Index i = 0; i < free.Size(); ++i) {
    const Bounds& own = free.VariableBounds()[i];
    Side& side = minimum.on_bound[i];
    if ((side == Side::kLower && bounds[i].lower != own.lower) ||
        (side == Side::kUpper && bounds[i].upper != own.upper)) {
      side = Side::kNone;
      leads_away_ = true;
    }
  }
  return minimum;
}

Eigen::MatrixXd ReducedDescent::ForcesOf(const Eigen::MatrixXd& directions) {
  const Eigen::Index n = directions.cols();
  Eigen::MatrixXd forces(displacement_.rows(), n * displacement_.cols());
  for (Eigen::Index k = 0; k < displacement_.cols(); ++k) {
    ++element_passes_;
    forces.middleCols(n * k, n) = misfit_.SmallStrainModel().Forces().Along(
        directions, displacement_.col(k));
  }
  return forces;
}

bool ReducedDescent::SolveNear(Eigen::MatrixXd forces,
                               const Eigen::VectorXd& tolerances,
                               Eigen::MatrixXd& x) {
  Equilibrium& model = misfit_.SmallStrainModel();
  const int most_iterations =
      model.IsRefined() ? kMostIterationsByCycle : kMostIterationsByFactor;
  const std::optional<int> iterations = SolveNearby(
      moduli_, std::move(forces), tolerances, most_iterations, model, x);
  element_passes_ += 1 + iterations.value_or(most_iterations);
  return iterations.has_value();
}

bool ReducedDescent::Check(const BoundedMinimum& minimum) {
  const Eigen::VectorXd& x = minimum.variables;
  const FreeParameters& free = misfit_.Free();
  moduli_ = free.ModuliAt(x);
  directions_ = free.ModuliJacobian(x);
  if (!moduli_.allFinite() || !reduced_.Solve(moduli_)) {
    return false;
  }
  const Eigen::Index num_cases = misfit_.Observed().NumLoadCases();
  const double noise =
      std::max(std::sqrt(misfit_.Variance(SquaredNorm(reduced_.Residual()))),
               kNoiseOfExactData);
  const Eigen::MatrixXd sensitivities = reduced_.Sensitivities(directions_);
  const SymmetricEigenDecomposition modes =
      DecomposeSymmetric(InnerProducts(sensitivities, sensitivities));
  // The variables of a standard error of 1 where the noise is 1, as columns.
  const double least = std::max(std::pow(noise / kUndetermined, 2),
                                1e-14 * modes.values.cwiseAbs().maxCoeff());
  const Eigen::Index kept = (modes.values.array() > least).count();
  const Eigen::MatrixXd whitened =
      modes.vectors.rightCols(kept) *
      modes.values.tail(kept).cwiseSqrt().cwiseInverse().asDiagonal();
  const double tolerance = kStepAccuracy * noise;
  displacement_ = reduced_.Displacement();
  if (!SolveNear(misfit_.SmallStrainModel().Load(),
                 Eigen::VectorXd::Constant(
                     num_cases, tolerance / reduced_.ComplianceNorm()),
                 displacement_)) {
    return false;
  }
  const Eigen::MatrixXd energy = whitened.transpose() *
                                 reduced_.EnergyOfSensitivities(directions_) *
                                 whitened;
  const double largest =
      kept == 0 ? 1 : DecomposeSymmetric(energy).values.maxCoeff();
  const Eigen::VectorXd residual = misfit_.Observed().Restrict(displacement_) -
                                   misfit_.Observed().Measured();
  if (!SolveForAdjoint(residual, tolerance / std::sqrt(largest))) {
    return false;
  }
  const Eigen::VectorXd gradient = GradientWithin(minimum.on_bound);
  step_ = Norm(InnerProducts(whitened, gradient)) / noise;
  return std::isfinite(step_);
}

Eigen::VectorXd ReducedDescent::GradientWithin(
    const std::vector<Side>& on_bound) {
  const Eigen::Index n = directions_.cols();
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(n);
  const Eigen::Index at_a_time = NumVariablesAtATime();
  for (Eigen::Index i = 0; i < n; i += at_a_time) {
    const Eigen::MatrixXd forces =
        ForcesOf(directions_.middleCols(i, at_a_time));
    for (Eigen::Index k = 0; k < adjoint_.cols(); ++k) {
      gradient.segment(i, at_a_time) -= InnerProducts(
          forces.middleCols(at_a_time * k, at_a_time), adjoint_.col(k));
    }
  }
  // A bound holds what the gradient drives against it.
  for (Eigen::Index i = 0; i < n; ++i) {
    const Side side = on_bound[i];
    if ((side == Side::kLower && gradient(i) > 0) ||
        (side == Side::kUpper && gradient(i) < 0)) {
      gradient(i) = 0;
    }
  }
  return gradient;
}

bool ReducedDescent::SolveForAdjoint(const Eigen::VectorXd& residual,
                                     double tolerance) {
  adjoint_ = reduced_.Adjoint();
  return SolveNear(misfit_.Observed().RestrictTransposed(residual),
                   Eigen::VectorXd::Constant(adjoint_.cols(), tolerance),
                   adjoint_);
}

void ReducedDescent::Refine() {
  const Eigen::MatrixXd u = WithoutHeld(displacement_);
  Eigen::MatrixXd vectors(u.rows(), 2 * u.cols());
  for (Eigen::Index k = 0; k < u.cols(); ++k) {
    vectors.col(2 * k) = u.col(k);
    vectors.col(2 * k + 1) = adjoint_.col(k);
  }
  reduced_.Extend(moduli_, std::move(vectors));
}

void ReducedDescent::Finish(const Eigen::VectorXd& x) {
  adjoint_.resize(0, 0);
  const Eigen::Index n = directions_.cols();
  Eigen::MatrixXd sensitivities =
      reduced_.DisplacementSensitivities(directions_);
  reduced_.ForgetBases();
  const Eigen::Index at_a_time = NumVariablesAtATime();
  for (Eigen::Index i = 0; i < n; i += at_a_time) {
    const auto own = Eigen::seq(i, Eigen::last, n / at_a_time);
    Eigen::MatrixXd columns = sensitivities(Eigen::all, own);
    Eigen::MatrixXd forces = ForcesOf(-directions_.middleCols(i, at_a_time));
    const Eigen::VectorXd energies =
        ColumnProducts(columns, forces).cwiseMax(0).cwiseSqrt().transpose();
    // Where that takes too many iterations, the misfit solves when it is next
    // evaluated there.
    if (!SolveNear(std::move(forces), kSensitivityAccuracy * energies,
                   columns)) {
      return;
    }
    sensitivities(Eigen::all, own) = columns;
  }
  misfit_.Place(x, std::move(displacement_), std::move(sensitivities));
}

// From a pole on.
BoundedMinimum DescendFromPole(const Eigen::VectorXd& pole, int most_poles,
                               ReducedDescent& descent) {
  constexpr double kLeastProgress = 0.5;
  BoundedMinimum minimum = descent.MinimumFrom(pole);
  double last_step = std::numeric_limits<double>::infinity();
  while (true) {
    const bool is_solved = !descent.LeadsAway() && descent.Check(minimum);
    if (is_solved && descent.Step() <= kLargestStep) {
      descent.Finish(minimum.variables);
      minimum.end = End::kDone;
      return minimum;
    }
    if (is_solved && descent.Step() <= kLeastProgress * last_step) {
      last_step = descent.Step();
      descent.Refine();
    } else if (descent.NumPoles() >= most_poles) {
      minimum.end = End::kNotCertified;
      return minimum;
    } else if (descent.SetPole(minimum.variables)) {
      last_step = std::numeric_limits<double>::infinity();
    } else {
      minimum.end = End::kSingularStiffness;
      return minimum;
    }
    minimum = descent.MinimumFrom(minimum.variables);
  }
}

// Returns the parameters with those of each material whose axis is to be found
// replaced by what `change` makes of them.
template <class Function>
Eigen::VectorXd WithFreeAxes(const MaterialParameters& all,
                             Eigen::VectorXd parameters,
                             const Function& change) {
  for (const auto& [first, count] : FreeAxisParameters(all)) {
    const Eigen::VectorXd own = parameters.segment(first, count);
    parameters.segment(first, count) = change(own);
  }
  return parameters;
}

}  // namespace

std::vector<Eigen::VectorXd> StartsOverAxes(const Scene& scene,
                                            DisplacementMisfit& misfit) {
  constexpr int kNumAxes = 13;
  // A minimum whose log likelihood is so much less than that of the least one
  // is no start.  The reduced model is exact to that near its pole only.
  constexpr double kOutOfReach = 25;
  const std::optional<Eigen::VectorXd> typical = TypicalStart(misfit);
  if (!typical) {
    return {};
  }
  const FreeParameters& free = misfit.Free();
  const auto changed = [&](const Eigen::VectorXd& x, const auto& change) {
    return free.VariablesOf(
        WithFreeAxes(free.All(), free.ParametersAt(x), change));
  };
  std::vector<Eigen::VectorXd> along_axes;
  for (const Eigen::Vector3d& w :
       FreeAxisLaw::RotationsOfHalfSphere(kNumAxes)) {
    along_axes.push_back(changed(*typical, [&](Eigen::VectorXd own) {
      own.tail(2) = w.tail(2);
      return own;
    }));
  }
  // With E_T for E_L, typical values are nearly alike in all directions.
  const Eigen::VectorXd pole = changed(*typical, [](Eigen::VectorXd own) {
    own(0) = own(1);
    return own;
  });
  ReducedDescent descent(misfit);
  if (HasUnknownMotion(scene) || !descent.SetPoleOfAllModuli(pole)) {
    return along_axes;
  }
  std::vector<BoundedMinimum> minima;
  minima.reserve(along_axes.size());
  for (const Eigen::VectorXd& start : along_axes) {
    minima.push_back(descent.MinimumFrom(start));
  }
  std::sort(minima.begin(), minima.end(),
            [](const BoundedMinimum& a, const BoundedMinimum& b) {
              return a.cost < b.cost;
            });
  const double least = minima[0].cost;
  std::vector<Eigen::VectorXd> starts;
  for (const BoundedMinimum& minimum : minima) {
    const bool is_another = std::all_of(
        starts.begin(), starts.end(), [&](const Eigen::VectorXd& other) {
          return AreAxesApart(free.All(), free.ParametersAt(minimum.variables),
                              free.ParametersAt(other));
        });
    if (is_another &&
        minimum.cost <= least + kOutOfReach * misfit.Variance(2 * least)) {
      starts.push_back(changed(minimum.variables, FreeAxisLaw::WithNearerEnd));
    }
  }
  return starts;
}

std::optional<BoundedMinimum> ReducedMinimum(
    const std::optional<Eigen::VectorXd>& start,
    const EstimatorOptions& options, DisplacementMisfit& misfit,
    Estimate& estimate) {
  ReducedDescent descent(misfit);
  std::optional<Eigen::VectorXd> pole = start;
  if (!pole || !descent.SetPole(*pole)) {
    pole = descent.SetTypicalPole();
  }
  if (!pole) {
    return std::nullopt;
  }
  const BoundedMinimum minimum = DescendFromPole(
      *pole, std::min(kMostPoles, options.max_iterations), descent);
  estimate.work.element_passes += descent.ElementPasses();
  return minimum;
}

}  // namespace elastimate
