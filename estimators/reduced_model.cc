#include "elastimate/estimators/reduced_model.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "elastimate/core/degrees_of_freedom.h"
#include "elastimate/core/loads.h"
#include "elastimate/core/stiffness_product.h"

namespace elastimate {
namespace {

// A vector whose energy falls by this factor when it is made orthogonal to a
// basis was rounding.
constexpr double kDependent = 1e-20;

// Of iterative solves: a vector of the basis serves as well when it is only
// near to where the exact one is, for the next one mends that.
constexpr double kSolveTolerance = 1e-3;

// Makes a symmetric matrix one larger.
void AppendSymmetric(const Eigen::VectorXd& column, Eigen::MatrixXd& matrix) {
  const Eigen::Index m = column.size();
  matrix.conservativeResize(m, m);
  matrix.col(m - 1) = column;
  matrix.row(m - 1) = column.transpose();
}

// With J z = theta A_pole z, z^T A_pole z = 1, for the reduced matrices.
ReducedModes FindModes(const Eigen::MatrixXd& h, const Eigen::MatrixXd& j,
                       double pole, const Eigen::VectorXd& g0,
                       const Eigen::VectorXd& g1) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(
      j, h + pole * j);
  const Eigen::MatrixXd& vectors = solver.eigenvectors();
  return {pole, vectors, solver.eigenvalues(), vectors.transpose() * g0,
          vectors.transpose() * g1};
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

ReducedModel::ReducedModel(const Scene& scene, SolverKind solver)
    : stiffness_(scene.mesh),
      solver_(scene.mesh, scene.supports, solver),
      num_load_cases_(Eigen::Index(scene.load_cases.size())) {
  const DegreesOfFreedom& dofs = solver_.Dofs();
  const auto free_rows = [&dofs](const Eigen::MatrixXd& all) {
    return dofs.Extend(dofs.Restrict(all));
  };
  const Eigen::MatrixXd force = free_rows(AssembleLoadCases(scene));
  for (Eigen::Index k = 0; k < num_load_cases_; ++k) {
    Response response;
    response.g0 = force.col(k);
    response.g1 = Eigen::VectorXd::Zero(force.rows());
    response.basis.resize(force.rows(), 0);
    responses_.push_back(response);
  }
  const Eigen::VectorXd held = HeldDisplacement(scene.supports);
  if (!held.isZero(0)) {
    StiffnessProducts products;
    stiffness_.Multiply(held, products);
    ++element_passes_;
    Response response;
    response.g0 = -free_rows(products.h);
    response.g1 = -free_rows(products.j);
    response.basis.resize(force.rows(), 0);
    responses_.push_back(response);
  }
}

bool ReducedModel::SetPole(double poisson_ratio) {
  return solver_.Factorize(poisson_ratio);
}

double ReducedModel::Refine(double poisson_ratio, double tolerance) {
  const DegreesOfFreedom& dofs = solver_.Dofs();
  const double pole = solver_.PoissonRatio();
  const double smallest_ratio =
      std::min((1 - 2 * poisson_ratio) / (1 - 2 * pole),
               (1 + poisson_ratio) / (1 + pole));
  const Eigen::Index num_responses = Eigen::Index(responses_.size());
  Eigen::MatrixXd solution =
      Eigen::MatrixXd::Zero(dofs.NumAll(), num_responses);
  Eigen::MatrixXd residual(dofs.NumAll(), num_responses);
  for (Eigen::Index k = 0; k < num_responses; ++k) {
    const Response& response = responses_[k];
    residual.col(k) = response.g0 + poisson_ratio * response.g1;
    if (response.basis.cols() > 0) {
      solution.col(k) = response.basis * (response.modes.vectors *
                                          response.modes.At(poisson_ratio));
    }
  }
  StiffnessProducts products;
  stiffness_.Multiply(solution, products);
  ++element_passes_;
  const Eigen::MatrixXd reaction = products.h + poisson_ratio * products.j;
  residual -= dofs.Extend(dofs.Restrict(reaction));
  const Eigen::MatrixXd correction = solver_.Solve(residual, kSolveTolerance);
  if (!correction.allFinite()) {
    return std::numeric_limits<double>::infinity();
  }
  double largest = 0;
  for (Eigen::Index k = 0; k < num_responses; ++k) {
    const double square =
        std::max(0.0, residual.col(k).dot(correction.col(k))) / smallest_ratio;
    const double energy = solution.col(k).dot(reaction.col(k));
    if (square > 0) {
      largest = std::max(largest, std::sqrt(square / energy));
    }
  }
  if (!(largest <= tolerance)) {
    Append(residual, correction);
  }
  return largest;
}

void ReducedModel::Append(const Eigen::MatrixXd& residual,
                          Eigen::MatrixXd correction) {
  const double pole = solver_.PoissonRatio();
  const Eigen::VectorXd energy_before =
      correction.cwiseProduct(residual).colwise().sum();
  for (Eigen::Index k = 0; k < correction.cols(); ++k) {
    const Response& response = responses_[k];
    if (response.basis.cols() > 0) {
      // The solution of a Galerkin residual is orthogonal to a basis of the
      // same pole already, but for rounding.
      const Eigen::LLT<Eigen::MatrixXd> gram(response.reduced_h +
                                             pole * response.reduced_j);
      correction.col(k) -=
          response.basis *
          gram.solve(response.basis.transpose() * residual.col(k));
    }
  }
  StiffnessProducts products;
  stiffness_.Multiply(correction, products);
  ++element_passes_;
  for (Eigen::Index k = 0; k < correction.cols(); ++k) {
    Response& response = responses_[k];
    const Eigen::VectorXd h = products.h.col(k);
    const Eigen::VectorXd j = products.j.col(k);
    const double energy = correction.col(k).dot(h + pole * j);
    if (!(energy > kDependent * energy_before(k)) || !(energy > 0)) {
      continue;
    }
    const double scale = 1 / std::sqrt(energy);
    const Eigen::Index m = response.basis.cols() + 1;
    response.basis.conservativeResize(Eigen::NoChange, m);
    response.basis.col(m - 1) = scale * correction.col(k);
    AppendSymmetric(scale * (response.basis.transpose() * h),
                    response.reduced_h);
    AppendSymmetric(scale * (response.basis.transpose() * j),
                    response.reduced_j);
    response.modes = FindModes(response.reduced_h, response.reduced_j, pole,
                               response.basis.transpose() * response.g0,
                               response.basis.transpose() * response.g1);
  }
  ++version_;
}

Work ReducedModel::WorkDone() const {
  Work work = solver_.WorkDone();
  work.element_passes += element_passes_;
  return work;
}

}  // namespace elastimate
