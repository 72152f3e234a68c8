#include "elastimate/estimators/maps/sharpen_map.h"

#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/solvers/conjugate_gradients.h"
#include "elastimate/estimators/maps/element_factor.h"

namespace elastimate {
namespace {

constexpr double kSharpBeta = 0.02;
constexpr int kMostSharpSteps = 20;
constexpr int kMostSharpHalvings = 6;
constexpr double kSettledSharp = 3e-3;
constexpr double kAccurateSharp = 1e-3;
constexpr int kMostSharpIterations = 300;
// Modes of the smooth map that the preconditioner takes: their cost grows with
// the square of the number.
constexpr Eigen::Index kMostModes = 256;
// What the preconditioner adds to alpha R, relative to its diagonal, so that it
// has an inverse.
constexpr double kSharpShift = 1e-4;

// The penalty on jumps, divided by alpha.
class JumpPenalty {
 public:
  explicit JumpPenalty(const ElementFacets& facets) : facets_(facets) {}

  double Of(const Eigen::VectorXd& field) const {
    double penalty = 0;
    Visit(field, [&](int, int, double area, double root) {
      penalty += area * (root - kSharpBeta);
    });
    return penalty;
  }
  // Returns R.
  Eigen::SparseMatrix<double> Curvature(const Eigen::VectorXd& field) const {
    std::vector<Eigen::Triplet<double>> entries;
    Visit(field, [&](int a, int b, double area, double root) {
      const double weight = area / root;
      entries.emplace_back(a, a, weight);
      entries.emplace_back(b, b, weight);
      entries.emplace_back(a, b, -weight);
      entries.emplace_back(b, a, -weight);
    });
    Eigen::SparseMatrix<double> curvature(field.size(), field.size());
    curvature.setFromTriplets(entries.begin(), entries.end());
    return curvature;
  }

 private:
  template <class Function>
  void Visit(const Eigen::VectorXd& field, const Function& function) const {
    for (Eigen::Index i = 0; i < facets_.area.size(); ++i) {
      const int a = facets_.elements(0, i);
      const int b = facets_.elements(1, i);
      if (b >= 0) {
        function(a, b, facets_.area(i),
                 std::hypot(field(a) - field(b), kSharpBeta));
      }
    }
  }

  const ElementFacets& facets_;
};

// (alpha R + shift + B B^T)^-1, where B B^T is the leading part of
// S^T Pi S / sigma^2.
class SharpPreconditioner {
 public:
  explicit SharpPreconditioner(const Eigen::MatrixXd& modes) : modes_(modes) {}

  // Factorises the preconditioner for this alpha R.
  void SetPenalty(Eigen::SparseMatrix<double> penalty) {
    const Eigen::VectorXd diagonal = penalty.diagonal();
    const double shift = kSharpShift * diagonal.mean();
    for (Eigen::Index e = 0; e < penalty.rows(); ++e) {
      penalty.coeffRef(e, e) += shift;
    }
    if (penalty_) {
      penalty_->Factorize(penalty);
    } else {
      penalty_.emplace(penalty);
    }
    const Eigen::MatrixXd by_penalty = penalty_->Solve(modes_);
    Eigen::MatrixXd inner = ProductOfTransposed(modes_, by_penalty);
    inner.diagonal().array() += 1;
    const SymmetricEigenDecomposition of_inner = DecomposeSymmetric(inner);
    solved_ =
        Product(by_penalty,
                of_inner.vectors *
                    of_inner.values.cwiseSqrt().cwiseInverse().asDiagonal());
  }

  Eigen::MatrixXd operator()(const Eigen::MatrixXd& x) const {
    return penalty_->Solve(x) - solved_ * (solved_.transpose() * x);
  }

 private:
  const Eigen::MatrixXd& modes_;
  std::optional<ElementFactor> penalty_;
  Eigen::MatrixXd solved_;  // (alpha R + shift)^-1 B inner^(-1/2).
};

// Returns the Gauss-Newton step of ln E without that of its level.  The model
// is at the state.
Eigen::VectorXd SharpStep(const MapProblem& problem,
                          const FlatUnknowns& unknowns, const MapState& state,
                          double variance,
                          const Eigen::SparseMatrix<double>& curvature,
                          const SharpPreconditioner& preconditioner) {
  FieldSensitivity& model = problem.model;
  const Eigen::VectorXd slope =
      model.MultiplyTransposed(unknowns.Project(model.Residual())) / variance -
      curvature * state.log_moduli;
  ConjugateGradientOptions options;
  options.tolerance = kAccurateSharp;
  options.most_iterations = kMostSharpIterations;
  return SolveByConjugateGradients(
             [&](const Eigen::MatrixXd& x) {
               return Eigen::MatrixXd(model.MultiplyTransposed(
                                          unknowns.Project(model.Multiply(x))) /
                                          variance +
                                      curvature * x);
             },
             [&](const Eigen::MatrixXd& x) { return preconditioner(x); }, slope,
             {}, options)
      .solution;
}

}  // namespace

MapState SharpenMap(const MapProblem& problem, const FieldPrior& prior,
                    const SmoothMap& smooth) {
  FieldSensitivity& model = problem.model;
  const JumpPenalty penalty(prior.Facets());
  const Eigen::MatrixXd ones = Eigen::MatrixXd::Ones(prior.NumElements(), 1);
  const double variance = smooth.variance;
  const double noise = std::sqrt(variance);
  const Eigen::Index num_modes =
      std::min(kMostModes, smooth.modes.Values().size());
  const Eigen::MatrixXd modes =
      prior.ApplyInverseTransposed(smooth.modes.Vectors().leftCols(num_modes)) *
      (smooth.modes.Values().head(num_modes) / variance)
          .cwiseSqrt()
          .asDiagonal();
  SharpPreconditioner preconditioner(modes);
  MapState state = smooth.state;
  double alpha = 0;
  for (int i = 0; i < kMostSharpSteps; ++i) {
    const double jumps = penalty.Of(state.log_moduli);
    if (!(jumps > 0)) {
      break;
    }
    const double next_alpha = smooth.effective_number / jumps;
    const double change_of_alpha =
        i == 0 ? 1 : std::abs(std::log(next_alpha / alpha));
    alpha = i == 0 ? next_alpha : std::sqrt(alpha * next_alpha);
    const FlatUnknowns unknowns(problem, state, ones);
    const Eigen::VectorXd residual = model.Residual();
    const Eigen::SparseMatrix<double> curvature =
        alpha * penalty.Curvature(state.log_moduli);
    preconditioner.SetPenalty(curvature);
    const Eigen::VectorXd field = SharpStep(problem, unknowns, state, variance,
                                            curvature, preconditioner);
    const Eigen::VectorXd flat =
        unknowns.Solve(residual - model.Multiply(field));
    const Eigen::VectorXd step = field + flat(0) * ones;
    const double before =
        residual.squaredNorm() / (2 * variance) + alpha * jumps;
    const bool is_better =
        TakeStep(
            problem, step, flat(1), noise, kMostSharpHalvings,
            [&](double, const MapState& next) {
              return model.Residual().squaredNorm() / (2 * variance) +
                         alpha * penalty.Of(next.log_moduli) <
                     before;
            },
            state) > 0;
    const double change = step.norm() / std::sqrt(double(step.size()));
    if ((!is_better || change < kSettledSharp) && change_of_alpha < 0.02) {
      break;
    }
  }
  return state;
}

}  // namespace elastimate
