#include "elastimate/core/scene/camera.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/scene/rigid_motion.h"

namespace elastimate {
namespace {

// Positions that were observed, and where they were seen: dimension x n each.
// NaN stands for components that were not observed.
struct SeenPoints {
  Eigen::MatrixXd positions;
  Eigen::MatrixXd seen;
};

SeenPoints PointsSeen(const Scene& scene, const LoadCase& load_case) {
  const Mesh& mesh = scene.mesh;
  const int dimension = mesh.Dimension();
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  Eigen::MatrixXd of_nodes = load_case.displacement;
  if (of_nodes.size() != 0 && load_case.observed.size() != 0) {
    of_nodes = load_case.observed.select(of_nodes.array(), kNone).matrix();
  }
  const Eigen::Index num_points = load_case.points.points.Size();
  Eigen::MatrixXd positions(dimension, of_nodes.cols() + num_points);
  Eigen::MatrixXd displacement = positions;
  if (of_nodes.size() != 0) {
    positions.leftCols(of_nodes.cols()) = mesh.nodes;
    displacement.leftCols(of_nodes.cols()) = of_nodes;
  }
  if (num_points > 0) {
    positions.rightCols(num_points) =
        Interpolate(mesh, load_case.points.points, mesh.nodes);
    displacement.rightCols(num_points) = load_case.points.displacement;
  }
  std::vector<Eigen::Index> any;
  for (Eigen::Index i = 0; i < displacement.cols(); ++i) {
    if (!displacement.col(i).array().isNaN().all()) {
      any.push_back(i);
    }
  }
  return {positions(Eigen::all, any),
          (positions + displacement)(Eigen::all, any)};
}

// Returns the gradient of the affine map from `arms` (dimension x n) to values
// that is nearest by least squares, without a part along directions in which
// the arms have no extent.
Eigen::VectorXd AffineGradient(const Eigen::MatrixXd& arms,
                               const Eigen::VectorXd& values) {
  constexpr double kNoExtent = 1e-6;
  const Eigen::MatrixXd centred = arms.colwise() - arms.rowwise().mean();
  const SymmetricEigenDecomposition squares =
      DecomposeSymmetric(centred * centred.transpose());
  const double least =
      kNoExtent * kNoExtent * std::max(squares.values.maxCoeff(), 0.0);
  return squares.vectors *
         (squares.values.array() > least)
             .select(squares.values.cwiseInverse().array(), 0.0)
             .matrix()
             .asDiagonal() *
         squares.vectors.transpose() * (centred * values);
}

// Returns the rotation nearest to a matrix of few rows, or of a low rank, among
// those the one that turns least.
Eigen::MatrixXd RotationNearest(const Eigen::MatrixXd& matrix) {
  // This decides only where the matrix leaves several rotations.
  constexpr double kTurnsLess = 1e-6;
  const Eigen::Index dimension = matrix.rows();
  const SingularValueDecomposition svd = DecomposeSingularValues(
      matrix + kTurnsLess * std::max(matrix.norm(), 1.0) *
                   Eigen::MatrixXd::Identity(dimension, dimension));
  Eigen::VectorXd signs = Eigen::VectorXd::Ones(dimension);
  signs(dimension - 1) = (svd.u * svd.v.transpose()).determinant() < 0 ? -1 : 1;
  return svd.u * signs.asDiagonal() * svd.v.transpose();
}

Eigen::MatrixXd AffineTurn(const Eigen::MatrixXd& arms,
                           const Eigen::MatrixXd& seen) {
  Eigen::MatrixXd gradient = Eigen::MatrixXd::Zero(arms.rows(), arms.rows());
  for (Eigen::Index i = 0; i < arms.rows(); ++i) {
    std::vector<Eigen::Index> observed;
    for (Eigen::Index point = 0; point < arms.cols(); ++point) {
      if (!std::isnan(seen(i, point))) {
        observed.push_back(point);
      }
    }
    if (!observed.empty()) {
      const Eigen::VectorXd values = seen.row(i)(observed).transpose();
      gradient.row(i) = AffineGradient(arms(Eigen::all, observed), values);
    }
  }
  return RotationNearest(gradient);
}

// What a rotation about the origin and a translation leave of the observed
// components, in units of length.
class RigidFit {
 public:
  RigidFit(const Eigen::MatrixXd& arms, const Eigen::MatrixXd& seen)
      : arms_(arms), seen_(seen), rotation_(AffineTurn(arms, seen)) {
    for (Eigen::Index i = 0; i < seen.size(); ++i) {
      if (!std::isnan(seen.reshaped()(i))) {
        rows_.push_back(i);
      }
    }
    translation_.setZero(arms.rows());
  }

  // Takes Gauss-Newton steps until they are small, or lead no farther.
  void Minimize() {
    constexpr int kMostSteps = 50;
    constexpr double kSettled = 1e-12;
    constexpr double kRounding = 1e-9;
    // A turn that moves no component more than this share is not observed.
    constexpr double kNoMotion = 1e-6;
    const double size = arms_.cwiseAbs().maxCoeff();
    const double unit = size > 0 ? size : 1;
    double left = Residual().norm();
    for (int i = 0; i < kMostSteps; ++i) {
      const RigidFit before = *this;
      const Eigen::MatrixXd turned = rotation_ * arms_ / unit;
      Eigen::VectorXd motion =
          SolveLeastSquares(RigidMotionsOf(turned)(rows_, Eigen::all),
                            Residual() / unit, kNoMotion);
      const Eigen::Index dimension = arms_.rows();
      translation_ += unit * motion.head(dimension);
      motion.head(dimension).setZero();
      rotation_ = MovedRigidly(rotation_, motion);
      const double now = Residual().norm();
      // The first steps find the translation, and rounding is no increase.
      if (i > 1 && !(now < (1 + kRounding) * left)) {
        *this = before;
        return;
      }
      left = now;
      if (motion.norm() < kSettled) {
        return;
      }
    }
  }

  const Eigen::MatrixXd& Rotation() const { return rotation_; }

 private:
  Eigen::VectorXd Residual() const {
    const Eigen::MatrixXd difference =
        seen_ - ((rotation_ * arms_).colwise() + translation_);
    return difference.reshaped()(rows_);
  }

  Eigen::MatrixXd arms_;
  Eigen::MatrixXd seen_;
  std::vector<Eigen::Index> rows_;  ///< The observed components.
  Eigen::MatrixXd rotation_;
  Eigen::VectorXd translation_;
};

}  // namespace

Eigen::VectorXd Camera::SeenDisplacement(
    const Mesh& mesh, const Eigen::VectorXd& displacement) const {
  const Eigen::MatrixXd positions =
      mesh.nodes + displacement.reshaped(mesh.Dimension(), mesh.NumNodes());
  return (Seen(positions) - mesh.nodes).reshaped();
}

double Camera::Angle() const {
  // The skew part tells small angles, of which the trace has half of the
  // digits.
  const bool is_planar = rotation.rows() == 2;
  const double cosine =
      is_planar ? rotation.trace() / 2 : (rotation.trace() - 1) / 2;
  const double sine = (rotation - rotation.transpose()).norm() / std::sqrt(8.0);
  return std::atan2(sine, cosine);
}

Eigen::MatrixXd SeenDisplacements(const Mesh& mesh,
                                  Eigen::MatrixXd displacements,
                                  const std::vector<Camera>& cameras) {
  for (std::size_t k = 0; k < cameras.size(); ++k) {
    auto of_case = displacements.col(Eigen::Index(k));
    of_case = cameras[k].SeenDisplacement(mesh, of_case);
  }
  return displacements;
}

Camera TurnOfCamera(const Scene& scene, const LoadCase& load_case) {
  const SeenPoints observed = PointsSeen(scene, load_case);
  if (observed.positions.size() == 0) {
    return Camera::AtRest(scene.mesh.Dimension());
  }
  const Eigen::VectorXd middle = observed.positions.rowwise().mean();
  RigidFit fit(observed.positions.colwise() - middle,
               observed.seen.colwise() - middle);
  fit.Minimize();
  return {fit.Rotation(), middle - fit.Rotation() * middle};
}

}  // namespace elastimate
