#include "elastimate/estimators/reduced_model/reduced_model.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/algebra/node_sums.h"
#include "elastimate/core/laws/elasticity.h"
#include "elastimate/core/mechanics/stiffness_product.h"
#include "elastimate/core/scene/degrees_of_freedom.h"
#include "elastimate/core/scene/loads.h"

namespace elastimate {
namespace {

// A vector whose energy falls by this factor when it is made orthogonal to
// others was rounding.
constexpr double kDependent = 1e-24;

// Vectors whose inner products are below this part of their norms count as
// orthogonal.
constexpr double kOrthogonal = 1e-10;

// Makes a symmetric matrix one larger.
void AppendSymmetric(const Eigen::VectorXd& column, Eigen::MatrixXd& matrix) {
  const Eigen::Index m = column.size();
  matrix.conservativeResize(m, m);
  matrix.col(m - 1) = column;
  matrix.row(m - 1) = column.transpose();
}

}  // namespace

Eigen::VectorXd ReducedModes::At(double poisson_ratio) const {
  return (g0 + poisson_ratio * g1).array() /
         (1 + (poisson_ratio - pole) * theta.array());
}

Eigen::VectorXd ReducedModes::DerivativeAt(double poisson_ratio) const {
  return (g1.array() - theta.array() * At(poisson_ratio).array()) /
         (1 + (poisson_ratio - pole) * theta.array());
}

double ReducedModes::EnergyNorm(double poisson_ratio) const {
  return std::sqrt(
      std::max(0.0, At(poisson_ratio).dot(g0 + poisson_ratio * g1)));
}

ReducedModel::ReducedModel(const Scene& scene, SolverKind solver)
    : section_model_(scene.mesh.section.model),
      stiffness_(scene.mesh),
      solver_(scene.mesh, scene.supports, solver),
      num_load_cases_(Eigen::Index(scene.load_cases.size())) {
  const Eigen::MatrixXd force = FreeRows(AssembleLoadCases(scene));
  for (Eigen::Index k = 0; k < num_load_cases_; ++k) {
    Response response;
    response.g0 = force.col(k);
    response.g1 = Eigen::VectorXd::Zero(force.rows());
    response.basis.resize(force.rows(), 0);
    responses_.push_back(response);
  }
  const Eigen::VectorXd held = HeldDisplacement(scene.supports);
  if (!held.isZero(0)) {
    const StiffnessProducts products = Multiply(held);
    Response response;
    response.g0 = -products.h;
    response.g1 = -products.j;
    response.basis.resize(force.rows(), 0);
    responses_.push_back(response);
  }
}

Eigen::MatrixXd ReducedModel::FreeRows(const Eigen::MatrixXd& all) const {
  return solver_.Dofs().Extend(solver_.Dofs().Restrict(all));
}

StiffnessProducts ReducedModel::Multiply(const Eigen::MatrixXd& x) {
  StiffnessProducts products;
  stiffness_.Multiply(x, products);
  ++element_passes_;
  return {FreeRows(products.h), FreeRows(products.j)};
}

bool ReducedModel::SetPole(double poisson_ratio) {
  if (!solver_.Factorize(poisson_ratio)) {
    return false;
  }
  uses_multigrid_ = UsesMultigrid();
  const double tolerance =
      solver_.UsesMultigrid() ? StiffnessSolver::kAccurate : 0;
  Eigen::MatrixXd loads(responses_[0].g0.size(), NumResponses());
  for (Eigen::Index k = 0; k < NumResponses(); ++k) {
    loads.col(k) = responses_[k].g0 + poisson_ratio * responses_[k].g1;
  }
  const Eigen::MatrixXd x = solver_.Solve(loads);
  if (!x.allFinite()) {
    return false;
  }
  const StiffnessProducts of_x = Multiply(x);
  for (Eigen::Index k = 0; k < NumResponses(); ++k) {
    loads.col(k) = responses_[k].g1 - of_x.j.col(k);
  }
  const Eigen::MatrixXd direction = solver_.Solve(loads);
  if (!direction.allFinite()) {
    return false;
  }
  const StiffnessProducts of_direction = Multiply(direction);
  const auto norm = [poisson_ratio](const auto& vector, const auto& h,
                                    const auto& j) {
    return std::sqrt(
        std::max(0.0, InnerProduct(vector, h + poisson_ratio * j)));
  };
  for (Eigen::Index k = 0; k < NumResponses(); ++k) {
    Response& response = responses_[k];
    const double x_norm = norm(x.col(k), of_x.h.col(k), of_x.j.col(k));
    const double start_norm =
        norm(direction.col(k), of_direction.h.col(k), of_direction.j.col(k));
    response.bounds.emplace_back(section_model_, poisson_ratio, start_norm,
                                 tolerance * x_norm, tolerance * start_norm);
    Append(x.col(k), of_x.h.col(k), of_x.j.col(k), response);
    response.krylov.resize(x.rows(), 0);
    if (start_norm > 0) {
      response.krylov = direction.col(k) / start_norm;
      response.next_product = of_direction.j.col(k) / start_norm;
      Append(direction.col(k), of_direction.h.col(k), of_direction.j.col(k),
             response);
    }
    FindModes(response);
  }
  ++version_;
  return true;
}

// The next vectors of the Krylov spaces that still grow, one for each.
struct ReducedModel::KrylovStep {
  std::vector<Response*> responses;
  /// What A^-1 J v has beside the vectors that there are.
  Eigen::MatrixXd z;
  StiffnessProducts of_z;
  /// What it has along them.
  std::vector<Eigen::VectorXd> columns;
  /// What an inexact solve has left along them: of the size of its error.
  std::vector<double> errors;

  Eigen::Index Count() const { return Eigen::Index(responses.size()); }
};

bool ReducedModel::Enlarge(double tolerance) {
  KrylovStep step;
  for (Response& response : responses_) {
    if (response.krylov.cols() > 0) {
      step.responses.push_back(&response);
    }
  }
  if (step.responses.empty()) {
    return false;
  }
  Eigen::MatrixXd loads(responses_[0].g0.size(), step.Count());
  for (Eigen::Index k = 0; k < step.Count(); ++k) {
    loads.col(k) = step.responses[k]->next_product;
  }
  step.z = solver_.Solve(loads, tolerance);
  if (!step.z.allFinite()) {
    return false;
  }
  Orthogonalize(step);
  const double inexactness = solver_.UsesMultigrid() ? tolerance : 0;
  for (Eigen::Index k = 0; k < step.Count(); ++k) {
    ExtendKrylov(k, inexactness, step);
  }
  ++version_;
  return true;
}

void ReducedModel::Orthogonalize(KrylovStep& step) {
  for (Eigen::Index k = 0; k < step.Count(); ++k) {
    const Response& response = *step.responses[k];
    step.columns.emplace_back(
        InnerProducts(response.krylov, response.next_product));
    step.z.col(k) -= response.krylov * step.columns.back();
  }
  step.of_z = Multiply(step.z);
  bool is_orthogonal = true;
  for (Eigen::Index k = 0; k < step.Count(); ++k) {
    const Eigen::MatrixXd& krylov = step.responses[k]->krylov;
    const Eigen::VectorXd rest =
        InnerProducts(krylov, step.of_z.h.col(k) + Pole() * step.of_z.j.col(k));
    step.z.col(k) -= krylov * rest;
    step.errors.push_back(rest.norm());
    is_orthogonal =
        is_orthogonal && rest.norm() <= kOrthogonal * step.columns[k].norm();
  }
  if (!is_orthogonal) {
    step.of_z = Multiply(step.z);
  }
}

void ReducedModel::ExtendKrylov(Eigen::Index k, double inexactness,
                                const KrylovStep& step) {
  Response& response = *step.responses[k];
  const Eigen::VectorXd h = step.of_z.h.col(k);
  const Eigen::VectorXd j = step.of_z.j.col(k);
  const double energy = InnerProduct(step.z.col(k), h + Pole() * j);
  const double energy_before = energy + step.columns[k].squaredNorm();
  const bool is_new = energy > kDependent * energy_before;
  const double error =
      std::max(step.errors[k], inexactness * std::sqrt(energy_before));
  const double remainder = is_new ? std::sqrt(energy) : 0;
  response.bounds.back().Extend(step.columns[k], error, remainder);
  if (!is_new) {
    response.krylov.resize(step.z.rows(), 0);
    return;
  }
  Append(step.z.col(k), h, j, response);
  FindModes(response);
  response.krylov.conservativeResize(Eigen::NoChange,
                                     response.krylov.cols() + 1);
  response.krylov.rightCols<1>() = step.z.col(k) / remainder;
  response.next_product = j / remainder;
}

void ReducedModel::KeepResponses() {
  solver_.KeepPreconditioner();
  for (Response& response : responses_) {
    response.krylov.resize(response.krylov.rows(), 0);
    response.next_product.resize(0);
  }
}

void ReducedModel::Append(const Eigen::VectorXd& x, const Eigen::VectorXd& h,
                          const Eigen::VectorXd& j, Response& response) {
  // Below this share of the energy, rounding decides on what is left.
  constexpr double kMostlyDependent = 1e-4;
  const double pole = Pole();
  const double energy_before = InnerProduct(x, h + pole * j);
  Eigen::VectorXd rest = x;
  Eigen::VectorXd rest_h = h;
  Eigen::VectorXd rest_j = j;
  double energy = energy_before;
  const Eigen::Index m = response.basis.cols();
  if (m > 0) {
    const Eigen::LLT<Eigen::MatrixXd> gram(response.reduced_h +
                                           pole * response.reduced_j);
    for (int i = 0; i < 2; ++i) {
      rest -= response.basis *
              gram.solve(InnerProducts(response.basis, rest_h + pole * rest_j));
      const StiffnessProducts products = Multiply(rest);
      rest_h = products.h;
      rest_j = products.j;
      energy = InnerProduct(rest, rest_h + pole * rest_j);
      if (energy > kMostlyDependent * energy_before) {
        break;
      }
    }
  }
  if (!(energy > kDependent * energy_before) || !(energy > 0)) {
    return;
  }
  const double scale = 1 / std::sqrt(energy);
  response.basis.conservativeResize(Eigen::NoChange, m + 1);
  response.basis.col(m) = scale * rest;
  AppendSymmetric(scale * InnerProducts(response.basis, rest_h),
                  response.reduced_h);
  AppendSymmetric(scale * InnerProducts(response.basis, rest_j),
                  response.reduced_j);
}

// With J z = theta A_pole z, z^T A_pole z = 1, for the reduced matrices.
void ReducedModel::FindModes(Response& response) const {
  const double pole = Pole();
  const auto [values, vectors] = DecomposeSymmetric(
      response.reduced_j, response.reduced_h + pole * response.reduced_j);
  response.modes = {
      pole, vectors, values,
      vectors.transpose() * InnerProducts(response.basis, response.g0),
      vectors.transpose() * InnerProducts(response.basis, response.g1)};
}

Eigen::MatrixXd ReducedModel::Responses(double poisson_ratio) const {
  Eigen::MatrixXd all(responses_[0].g0.size(), NumResponses());
  for (Eigen::Index k = 0; k < NumResponses(); ++k) {
    const Response& response = responses_[k];
    all.col(k) = response.basis *
                 (response.modes.vectors * response.modes.At(poisson_ratio));
  }
  return all;
}

double ReducedModel::ErrorBound(Eigen::Index k, double poisson_ratio) const {
  double least = std::numeric_limits<double>::infinity();
  for (const KrylovBound& bound : responses_[k].bounds) {
    least = std::min(least, bound.At(poisson_ratio));
  }
  return least;
}

double ReducedModel::RelativeErrorBound(double poisson_ratio) const {
  double largest = 0;
  for (Eigen::Index k = 0; k < NumResponses(); ++k) {
    const double error = ErrorBound(k, poisson_ratio);
    if (error > 0) {
      largest = std::max(largest,
                         error / responses_[k].modes.EnergyNorm(poisson_ratio));
    }
  }
  return largest;
}

Work ReducedModel::WorkDone() const {
  Work work = solver_.WorkDone();
  work.element_passes += element_passes_;
  return work;
}

ReducedSolution SolveReduced(const ReducedModel& model,
                             const IsotropicElasticity& elasticity) {
  const Eigen::Index num_cases = model.NumLoadCases();
  const double nu = elasticity.poisson_ratio;
  const double t = elasticity.ComplianceScale(model.Section());
  const double dt_dnu = t * LogYoungsModulusSlope(nu, model.Section());
  const auto value_and_slope = [&model, nu](Eigen::Index k) {
    const ReducedModes& modes = model.Modes(k);
    Eigen::MatrixXd coefficients(modes.theta.size(), 2);
    coefficients << modes.At(nu), modes.DerivativeAt(nu);
    return Eigen::MatrixXd(model.Basis(k) * (modes.vectors * coefficients));
  };
  const Eigen::Index num_rows = model.Basis(0).rows();
  const Eigen::MatrixXd support = model.HasSupportResponse()
                                      ? value_and_slope(num_cases)
                                      : Eigen::MatrixXd::Zero(num_rows, 2);
  ReducedSolution solution;
  solution.displacement.resize(num_rows, num_cases);
  solution.by_log_youngs_modulus.resize(num_rows, num_cases);
  solution.by_poisson_ratio.resize(num_rows, num_cases);
  for (Eigen::Index k = 0; k < num_cases; ++k) {
    const Eigen::MatrixXd load = value_and_slope(k);
    solution.displacement.col(k) = t * load.col(0) + support.col(0);
    solution.by_log_youngs_modulus.col(k) = -t * load.col(0);
    solution.by_poisson_ratio.col(k) =
        dt_dnu * load.col(0) + t * load.col(1) + support.col(1);
  }
  return solution;
}

}  // namespace elastimate
