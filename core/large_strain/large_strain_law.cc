#include "elastimate/core/large_strain/large_strain_law.h"

#include <Eigen/LU>
#include <vector>

namespace elastimate {
namespace {

Eigen::Matrix3d MatrixAt(const PointMatrices& matrices, int point) {
  Eigen::Matrix3d matrix;
  for (int i = 0; i < 9; ++i) {
    matrix(i) = matrices.row[i][point];
  }
  return matrix;
}

// The gradient at one point, with a gradient of zero at the others, since
// vectors of points are evaluated as a whole.
PointMatrices AtOnePoint(const Eigen::MatrixXd& gradient) {
  PointMatrices matrices = {};
  for (int i = 0; i < 9; ++i) {
    matrices.row[i][0] = gradient(i);
  }
  return matrices;
}

}  // namespace

Eigen::MatrixXd LargeStrainLaw::Stresses(const Eigen::MatrixXd& gradient,
                                         SectionModel /*model*/) const {
  std::vector<PointMatrices> columns(NumModuli());
  StressesAtPoints(AtOnePoint(gradient), GradientEntries::kAll, 1,
                   columns.data());
  Eigen::MatrixXd stresses(9, NumModuli());
  for (int k = 0; k < NumModuli(); ++k) {
    stresses.col(k) = MatrixAt(columns[k], 0).reshaped();
  }
  return stresses;
}

Eigen::MatrixXd LargeStrainLaw::Tangent(const Eigen::VectorXd& moduli,
                                        const Eigen::MatrixXd& gradient,
                                        SectionModel /*model*/) const {
  PointTangents tangents;
  TangentsAtPoints(moduli, AtOnePoint(gradient), GradientEntries::kAll, 1,
                   tangents, nullptr);
  Eigen::MatrixXd tangent(9, 9);
  for (int a = 0; a < 9; ++a) {
    for (int b = 0; b < 9; ++b) {
      tangent(a, b) = tangents.row[TangentRow(a, b)][0];
    }
  }
  return tangent;
}

Eigen::Vector2d LameModuliAtRest(const Law& law,
                                 const Eigen::VectorXd& moduli) {
  const Eigen::MatrixXd tangent =
      law.Tangent(moduli, Eigen::Matrix3d::Zero(), SectionModel::kSolid);
  // dP_21 / dH_21 is mu, and dP_11 / dH_11 is lambda + 2 mu.
  return {tangent(1, 1), tangent(0, 0) - 2 * tangent(1, 1)};
}

double VolumeChange(const Eigen::Matrix3d& gradient) {
  const double trace = gradient.trace();
  const double squares = gradient.cwiseProduct(gradient.transpose()).sum();
  return trace + (trace * trace - squares) / 2 + gradient.determinant();
}

}  // namespace elastimate
