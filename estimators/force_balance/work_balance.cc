#include "elastimate/estimators/force_balance/work_balance.h"

#include <algorithm>
#include <random>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/algebra/node_sums.h"
#include "elastimate/core/materials/isotropic_law.h"

namespace elastimate {
namespace {

// The work of loads that do none, relative to their norm, is rounding.
constexpr double kRoundingOfLoads = 1e-10;

// So many probes give the traces of k fields a relative standard error of about
// sqrt(2 / (16 k)).
constexpr Eigen::Index kFieldProbes = 16;

Eigen::MatrixXd RandomSigns(Eigen::Index num_rows, Eigen::Index num_columns) {
  std::mt19937_64 generator(20071107);
  Eigen::MatrixXd signs(num_rows, num_columns);
  for (double& sign : signs.reshaped()) {
    sign = (generator() >> 63U) != 0 ? 1 : -1;
  }
  return signs;
}

bool IsOneOfIsotropicLaw(const ForceScene& prepared) {
  if (prepared.LargeForces() != nullptr) {
    return false;
  }
  const MaterialParameters& parameters = prepared.Forces().Parameters();
  return parameters.NumMaterials() == 1 &&
         parameters.LawOf(0).Name() == IsotropicLaw::kName;
}

}  // namespace

WorkBalance::WorkBalance(const VirtualWork& work, const ForceResidual& forces)
    : work_(work),
      forces_(forces),
      has_triangle_(IsOneOfIsotropicLaw(forces.Prepared())),
      work_of_loads_(work.Of(forces.NodalLoads())),
      weights_(forces.Prepared().LargeForces() != nullptr
                   ? std::size_t(work_of_loads_.cols())
                   : 1) {
  if (!has_triangle_) {
    fields_ = work.Fields();
  }
  const std::vector<Eigen::MatrixXd>& products = forces.Products();
  std::vector<Eigen::MatrixXd> of_moduli;
  of_moduli.reserve(products.size());
  for (const Eigen::MatrixXd& product : products) {
    of_moduli.push_back(work.Of(product));
  }
  for (Eigen::Index i = 0; i < work_of_loads_.cols(); ++i) {
    Eigen::MatrixXd columns(work_of_loads_.rows(),
                            Eigen::Index(of_moduli.size()));
    for (Eigen::Index k = 0; k < columns.cols(); ++k) {
      columns.col(k) = of_moduli[k].col(i);
    }
    work_of_columns_.push_back(columns);
  }
}

bool WorkBalance::DoLoadsWork() const {
  return work_of_loads_.norm() > kRoundingOfLoads * Norm(forces_.NodalLoads());
}

Eigen::MatrixXd WorkBalance::Stiffened(const Eigen::VectorXd& moduli,
                                       std::size_t load_case) const {
  if (has_triangle_) {
    return moduli(0) * work_.H() + moduli(1) * work_.J();
  }
  const ForceScene& prepared = forces_.Prepared();
  const LargeStrainForces* const large = prepared.LargeForces();
  return prepared.Dofs().Restrict(
      large == nullptr
          ? prepared.Forces().Multiply(moduli, fields_)
          : large->TangentProducts(
                moduli,
                forces_.LargeDisplacements().col(Eigen::Index(load_case)),
                fields_));
}

std::vector<Eigen::MatrixXd> WorkBalance::Products(
    std::size_t load_case, const Eigen::MatrixXd& displacements) {
  const ForceScene& prepared = forces_.Prepared();
  const LargeStrainForces* const large = prepared.LargeForces();
  ++work_done_.element_passes;
  if (large == nullptr) {
    return prepared.Forces().Products(displacements);
  }
  const Eigen::Index num_moduli = large->Parameters().NumModuli();
  work_done_.element_passes += int(num_moduli) - 1;
  std::vector<Eigen::MatrixXd> products;
  for (Eigen::Index k = 0; k < num_moduli; ++k) {
    products.push_back(large->TangentProducts(
        Eigen::VectorXd::Unit(num_moduli, k),
        forces_.LargeDisplacements().col(Eigen::Index(load_case)),
        displacements));
  }
  return products;
}

Eigen::MatrixXd WorkBalance::WorkOfCorrection(
    std::size_t load_case, const Eigen::VectorXd& multipliers) {
  const Eigen::VectorXd correction =
      WeightOf(load_case).stiffened * multipliers;
  if (has_triangle_) {
    Eigen::MatrixXd work(multipliers.size(), 2);
    work << work_.H().transpose() * correction,
        work_.J().transpose() * correction;
    return work;
  }
  const std::vector<Eigen::MatrixXd> products =
      Products(load_case, forces_.Prepared().Dofs().Extend(correction));
  Eigen::MatrixXd work(multipliers.size(), Eigen::Index(products.size()));
  for (Eigen::Index k = 0; k < work.cols(); ++k) {
    work.col(k) = work_.Of(products[k]);
  }
  return work;
}

bool WorkBalance::SetWeights(const Eigen::VectorXd& moduli) {
  // A value and its derivatives are asked for one after the other.
  if (moduli_.size() == 0 || moduli != moduli_) {
    moduli_ = moduli;
    for (std::size_t i = 0; i < weights_.size(); ++i) {
      work_done_.element_passes += has_triangle_ ? 0 : 1;
      weights_[i].stiffened = Stiffened(moduli, i);
      weights_[i].factor = TriangularFactor(weights_[i].stiffened);
    }
  }
  return std::all_of(
      weights_.begin(), weights_.end(), [](const Weight& weight) {
        return weight.factor.diagonal().cwiseAbs().minCoeff() > 0 &&
               weight.factor.allFinite();
      });
}

bool WorkBalance::Evaluate(const Eigen::VectorXd& moduli,
                           const Eigen::MatrixXd& directions,
                           Eigen::VectorXd* residual,
                           Eigen::MatrixXd* jacobian) {
  if (!SetWeights(moduli)) {
    return false;
  }
  const Eigen::Index k = work_of_loads_.rows();
  residual->resize(NumEquations());
  if (jacobian != nullptr) {
    jacobian->resize(NumEquations(), directions.cols());
  }
  for (std::size_t i = 0; i < work_of_columns_.size(); ++i) {
    const Eigen::MatrixXd& factor = WeightOf(i).factor;
    const auto lower = factor.transpose().triangularView<Eigen::Lower>();
    const Eigen::Index first = k * Eigen::Index(i);
    const Eigen::VectorXd z = lower.solve(Eigen::VectorXd(
        work_of_columns_[i] * moduli - work_of_loads_.col(Eigen::Index(i))));
    residual->segment(first, k) = z;
    if (jacobian != nullptr) {
      const Eigen::VectorXd multipliers =
          factor.triangularView<Eigen::Upper>().solve(z);
      jacobian->middleRows(first, k) = lower.solve(Eigen::MatrixXd(
          (work_of_columns_[i] - WorkOfCorrection(i, multipliers)) *
          directions));
    }
  }
  return true;
}

Eigen::MatrixXd WorkBalance::NoiseOfInformation(
    const Eigen::MatrixXd& directions) {
  Eigen::MatrixXd information =
      Eigen::MatrixXd::Zero(directions.cols(), directions.cols());
  for (std::size_t i = 0; i < weights_.size(); ++i) {
    information += NoiseOfInformation(i, directions);
  }
  return double(work_of_columns_.size()) / double(weights_.size()) *
         information;
}

Eigen::MatrixXd WorkBalance::NoiseOfInformation(
    std::size_t load_case, const Eigen::MatrixXd& directions) {
  const Weight& weight = WeightOf(load_case);
  const auto upper = weight.factor.triangularView<Eigen::Upper>();
  const auto lower = weight.factor.transpose().triangularView<Eigen::Lower>();
  const Eigen::Index k = weight.factor.cols();
  // K_k V L^-T of all fields, or of probes of them.
  std::vector<Eigen::MatrixXd> of_moduli;
  double num_probes = 1;
  const Eigen::MatrixXd all = Eigen::MatrixXd::Identity(k, k);
  if (has_triangle_) {
    const Eigen::MatrixXd inverse = upper.solve(all);
    of_moduli = {work_.H() * inverse, work_.J() * inverse};
  } else {
    num_probes = kFieldProbes;
    const Eigen::MatrixXd probes = upper.solve(RandomSigns(k, kFieldProbes));
    of_moduli = Products(load_case, fields_ * probes);
    for (Eigen::MatrixXd& product : of_moduli) {
      product = forces_.Prepared().Dofs().Restrict(product);
    }
  }
  Eigen::MatrixXd columns(of_moduli[0].size(), directions.cols());
  Eigen::MatrixXd spanned(k * of_moduli[0].cols(), directions.cols());
  columns.setZero();
  spanned.setZero();
  for (Eigen::Index i = 0; i < directions.rows(); ++i) {
    const Eigen::MatrixXd within =
        lower.solve(InnerProducts(weight.stiffened, of_moduli[i]));
    columns += of_moduli[i].reshaped() * directions.row(i);
    spanned += within.reshaped() * directions.row(i);
  }
  return (InnerProducts(columns, columns) - spanned.transpose() * spanned) /
         num_probes;
}

double WorkBalance::BestScale(const Eigen::VectorXd& moduli) const {
  double product = 0;
  double square = 0;
  for (std::size_t i = 0; i < work_of_columns_.size(); ++i) {
    const Eigen::VectorXd internal = work_of_columns_[i] * moduli;
    product += internal.dot(work_of_loads_.col(Eigen::Index(i)));
    square += internal.squaredNorm();
  }
  return product / square;
}

Eigen::VectorXd WorkBalance::LeastSquares() const {
  const Eigen::Index k = work_of_loads_.rows();
  Eigen::MatrixXd columns(NumEquations(), work_of_columns_[0].cols());
  for (std::size_t i = 0; i < work_of_columns_.size(); ++i) {
    columns.middleRows(k * Eigen::Index(i), k) = work_of_columns_[i];
  }
  const Eigen::VectorXd scales = columns.colwise().norm();
  return SolveLeastSquares(columns * scales.cwiseInverse().asDiagonal(),
                           work_of_loads_.reshaped())
      .col(0)
      .cwiseQuotient(scales);
}

}  // namespace elastimate
