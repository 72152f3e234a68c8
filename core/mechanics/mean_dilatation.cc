#include "elastimate/core/mechanics/mean_dilatation.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

#include "elastimate/core/large_strain/large_strain_law.h"

namespace elastimate {
namespace {

using Matrix9 = Eigen::Matrix<double, 9, 9>;
using Vector9 = Eigen::Matrix<double, 9, 1>;

Eigen::Map<const Vector9> AsVector(const Eigen::Matrix3d& matrix) {
  return Eigen::Map<const Vector9>(matrix.data());
}

// Returns T with dF : T : dF = tr(F^-1 dF F^-1 dF), for G = F^-T.
Matrix9 TraceOfSquares(const Eigen::Matrix3d& g) {
  Matrix9 t;
  for (int row = 0; row < 9; ++row) {
    for (int column = 0; column < 9; ++column) {
      t(row, column) = g(row % 3, column / 3) * g(column % 3, row / 3);
    }
  }
  return t;
}

// Returns polynomials that are orthonormal over the points of these volumes.
Eigen::MatrixXd Orthonormal(const Eigen::MatrixXd& polynomials,
                            const Eigen::VectorXd& volumes) {
  const Eigen::MatrixXd products =
      polynomials.transpose() * volumes.asDiagonal() * polynomials;
  return products.llt().matrixL().solve(polynomials.transpose()).transpose();
}

}  // namespace

MeanDilatation::MeanDilatation(const std::vector<Eigen::Matrix3d>& gradients,
                               const Eigen::VectorXd& volumes,
                               const Eigen::MatrixXd& polynomials)
    : volumes_(volumes), polynomials_(Orthonormal(polynomials, volumes)) {
  Eigen::VectorXd changes(volumes.size());
  for (std::size_t i = 0; i < gradients.size(); ++i) {
    const double change = VolumeChange(gradients[i]);
    changes(Eigen::Index(i)) = change;
    jacobian_.push_back(1 + change);
    f_.emplace_back(Eigen::Matrix3d::Identity() + gradients[i]);
    cofactors_.emplace_back(jacobian_[i] * f_[i].inverse().transpose());
  }
  const Eigen::VectorXd smoothed = Fit(changes);
  theta_ = smoothed.array() + 1;
  for (std::size_t i = 0; i < gradients.size(); ++i) {
    const Eigen::Index point = Eigen::Index(i);
    const double scale_change = std::expm1(
        (std::log1p(smoothed(point)) - std::log1p(changes(point))) / 3);
    scale_.push_back(1 + scale_change);
    Eigen::Matrix3d scaled = scale_[i] * gradients[i];
    scaled.diagonal().array() += scale_change;
    gradients_.push_back(scaled);
  }
}

double MeanDilatation::Work(std::size_t point,
                            const Eigen::Matrix3d& stress) const {
  return scale_[point] * stress.cwiseProduct(f_[point]).sum();
}

Eigen::VectorXd MeanDilatation::Fit(const Eigen::VectorXd& values) const {
  return polynomials_ *
         (polynomials_.transpose() * volumes_.cwiseProduct(values));
}

Eigen::VectorXd MeanDilatation::Pressures(
    const std::vector<Eigen::Matrix3d>& stresses) const {
  Eigen::VectorXd values(volumes_.size());
  for (std::size_t i = 0; i < stresses.size(); ++i) {
    const Eigen::Index point = Eigen::Index(i);
    values(point) = Work(i, stresses[i]) / (3 * theta_(point));
  }
  return Fit(values);
}

std::vector<Eigen::Matrix3d> MeanDilatation::Stresses(
    const std::vector<Eigen::Matrix3d>& stresses) const {
  const Eigen::VectorXd pressures = Pressures(stresses);
  std::vector<Eigen::Matrix3d> acting;
  for (std::size_t i = 0; i < stresses.size(); ++i) {
    const double own = Work(i, stresses[i]) / (3 * jacobian_[i]);
    acting.emplace_back(scale_[i] * stresses[i] +
                        (pressures(Eigen::Index(i)) - own) * cofactors_[i]);
  }
  return acting;
}

MeanDilatation::Curvature MeanDilatation::CurvatureOf(
    const std::vector<Eigen::Matrix3d>& stresses,
    const std::vector<Matrix9>& tangents) const {
  // With sigma = dTheta / (3 Theta) - F^-T : dF / 3,
  //
  //   dFbar = s (dF + sigma F),
  //   Pbar : d2Fbar = pi (sigma^2 + dsigma) + 2 s sigma Pbar : dF,
  //   dsigma = (d2Theta / Theta - (dTheta / Theta)^2
  //             + tr(F^-1 dF F^-1 dF)) / 3,
  //
  // and the sum of v pi d2Theta / (3 Theta) over the points is that of v p d2J.
  const Eigen::VectorXd pressures = Pressures(stresses);
  Curvature curvature;
  curvature.dilatation.resize(volumes_.size());
  for (std::size_t i = 0; i < stresses.size(); ++i) {
    const double s = scale_[i];
    const double work = Work(i, stresses[i]);
    const Eigen::Matrix3d g = cofactors_[i] / jacobian_[i];
    const auto f9 = AsVector(f_[i]);
    const auto g9 = AsVector(g);
    const auto p9 = AsVector(stresses[i]);
    const double theta = theta_(Eigen::Index(i));
    const double of_volume = pressures(Eigen::Index(i)) * jacobian_[i];
    // The tangent T acts on dF - F (F^-T : dF) / 3, which adds outer products
    // of F^-T and T F.
    const Vector9 stretched = s * s * tangents[i] * f9;
    const double of_stretch = f9.dot(stretched);
    const Vector9 beside_g = ((of_stretch + work) / 9 + of_volume) / 2 * g9 -
                             (stretched + s * p9) / 3;
    Matrix9 local = s * s * tangents[i];
    local += beside_g * g9.transpose() + g9 * beside_g.transpose();
    local += (work / 3 - of_volume) * TraceOfSquares(g);
    curvature.local.push_back(local);
    const Vector9 coupling =
        (stretched + s * p9 - (of_stretch + work) / 3 * g9) / (3 * theta);
    curvature.coupling.emplace_back(
        Eigen::Map<const Eigen::Matrix3d>(coupling.data()));
    curvature.dilatation(Eigen::Index(i)) =
        ((of_stretch + work) / 9 - work / 3) / (theta * theta);
  }
  return curvature;
}

}  // namespace elastimate
