#include "elastimate/core/materials/free_axis_law.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/materials/stiffness_factors.h"
#include "elastimate/core/materials/transversely_isotropic_law.h"

namespace elastimate {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

constexpr SectionModel kModel = SectionModel::kSolid;
constexpr double kPi = 3.14159265358979323846;
// So many parameters of the law of a known axis come before w_y and w_z.
constexpr Eigen::Index kNumOfKnownAxis = 5;

const TransverselyIsotropicLaw& OfKnownAxis() {
  static const TransverselyIsotropicLaw law;
  return law;
}

Eigen::Matrix3d CrossProductWith(const Eigen::Vector3d& w) {
  Eigen::Matrix3d matrix;
  matrix << 0, -w(2), w(1), w(2), 0, -w(0), -w(1), w(0), 0;
  return matrix;
}

Eigen::Vector3d RotationVector(const Eigen::VectorXd& parameters) {
  return {0, parameters(kNumOfKnownAxis), parameters(kNumOfKnownAxis + 1)};
}

Eigen::Matrix3d RotationBy(const Eigen::Vector3d& w) {
  const double angle = w.norm();
  return angle > 0 ? Eigen::AngleAxisd(angle, w / angle).toRotationMatrix()
                   : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
}

// Returns the J for which R(w + dw) = (1 + [J dw]_x) R(w), to first order.
Eigen::Matrix3d LeftJacobian(const Eigen::Vector3d& w) {
  constexpr double kSmall = 1e-4;
  const double angle = w.norm();
  const Eigen::Matrix3d cross = CrossProductWith(w);
  // These are (1 - cos t) / t^2 and (t - sin t) / t^3 for the angle t.
  const double first = angle < kSmall ? 0.5 - angle * angle / 24
                                      : (1 - std::cos(angle)) / (angle * angle);
  const double second = angle < kSmall
                            ? 1.0 / 6 - angle * angle / 120
                            : (angle - std::sin(angle)) / std::pow(angle, 3);
  return Eigen::Matrix3d::Identity() + first * cross + second * cross * cross;
}

// KelvinRotation is the matrix of E -> R E R^T in the notation of Kelvin, for
// strain tensors E.  KelvinSpin is that of E -> W E - E W, its derivative where
// the rotation begins.
Matrix6d KelvinRotation(const Eigen::Matrix3d& rotation) {
  const Eigen::MatrixXd to_strain = KelvinStrainOfGradient(3);
  Matrix6d turned;
  for (Eigen::Index j = 0; j < 6; ++j) {
    const Eigen::Matrix3d unit = to_strain.row(j).reshaped(3, 3);
    turned.col(j) =
        to_strain * (rotation * unit * rotation.transpose()).reshaped();
  }
  return turned;
}

Matrix6d KelvinSpin(const Eigen::Vector3d& w) {
  const Eigen::MatrixXd to_strain = KelvinStrainOfGradient(3);
  const Eigen::Matrix3d cross = CrossProductWith(w);
  Matrix6d spin;
  for (Eigen::Index j = 0; j < 6; ++j) {
    const Eigen::Matrix3d unit = to_strain.row(j).reshaped(3, 3);
    spin.col(j) = to_strain * (cross * unit - unit * cross).reshaped();
  }
  return spin;
}

Matrix6d KelvinStiffness(const Law& law, const Eigen::VectorXd& moduli) {
  const Eigen::MatrixXd to_strain = KelvinStrainOfGradient(3);
  return to_strain * law.Tangent(moduli, Eigen::MatrixXd::Zero(3, 3), kModel) *
         to_strain.transpose();
}

// Returns the stiffness for each unit modulus of the known axis, in the
// notation of Kelvin.
std::vector<Matrix6d> StiffnessesOfUnitModuli() {
  const int num_moduli = OfKnownAxis().NumModuli();
  std::vector<Matrix6d> stiffnesses;
  stiffnesses.reserve(num_moduli);
  for (int k = 0; k < num_moduli; ++k) {
    stiffnesses.push_back(
        KelvinStiffness(OfKnownAxis(), Eigen::VectorXd::Unit(num_moduli, k)));
  }
  return stiffnesses;
}

// Returns, as columns, the 21 stiffnesses for each unit modulus of the known
// axis, seen after this rotation.
Eigen::MatrixXd UnitModuli(const Eigen::Matrix3d& rotation,
                           const std::vector<BlockEntry>& entries) {
  static const std::vector<Matrix6d> stiffnesses = StiffnessesOfUnitModuli();
  const Matrix6d turned = KelvinRotation(rotation);
  Eigen::MatrixXd units(Eigen::Index(entries.size()),
                        Eigen::Index(stiffnesses.size()));
  for (std::size_t k = 0; k < stiffnesses.size(); ++k) {
    units.col(Eigen::Index(k)) =
        ModuliOfBlocks(entries, turned * stiffnesses[k] * turned.transpose());
  }
  return units;
}

// Returns d theta / dw, num_moduli x 3, of a stiffness seen after the rotation
// by w.
Eigen::MatrixXd RotationJacobian(const Matrix6d& stiffness,
                                 const Eigen::Vector3d& w,
                                 const std::vector<BlockEntry>& entries) {
  const Eigen::Matrix3d left = LeftJacobian(w);
  Eigen::MatrixXd jacobian(Eigen::Index(entries.size()), 3);
  for (Eigen::Index i = 0; i < 3; ++i) {
    const Matrix6d half = KelvinSpin(left.col(i)) * stiffness;
    jacobian.col(i) = ModuliOfBlocks(entries, half + half.transpose());
  }
  return jacobian;
}

// The best moduli for an axis that is turned by w.
struct FitOfAxis {
  Eigen::Vector3d w;
  Eigen::VectorXd moduli;
  double square_sum;
};

// Returns nothing where the best moduli have no positive definite stiffness.
std::optional<FitOfAxis> FitAxis(const Eigen::Vector3d& w,
                                 const Eigen::VectorXd& weighted_moduli,
                                 const Eigen::MatrixXd& weights,
                                 const std::vector<BlockEntry>& entries) {
  const Eigen::MatrixXd units = weights * UnitModuli(RotationBy(w), entries);
  const Eigen::VectorXd moduli = SolveLeastSquares(units, weighted_moduli);
  if (!FactorsOfModuli(OfKnownAxis().BlockEntries(), moduli).allFinite()) {
    return std::nullopt;
  }
  return FitOfAxis{w, moduli, (units * moduli - weighted_moduli).squaredNorm()};
}

// Takes a Gauss-Newton step of w, with the best moduli for it, which is halved
// until the sum of squares decreases.  Returns nothing where it never does.
std::optional<FitOfAxis> NextAxis(const FitOfAxis& fit,
                                  const Eigen::VectorXd& weighted_moduli,
                                  const Eigen::MatrixXd& weights,
                                  const std::vector<BlockEntry>& entries) {
  constexpr int kHalvings = 10;
  const Matrix6d turned = KelvinRotation(RotationBy(fit.w));
  const Matrix6d stiffness =
      turned * KelvinStiffness(OfKnownAxis(), fit.moduli) * turned.transpose();
  Eigen::MatrixXd jacobian(weights.rows(), kNumOfKnownAxis + 2);
  jacobian << weights * UnitModuli(RotationBy(fit.w), entries),
      weights * RotationJacobian(stiffness, fit.w, entries).rightCols(2);
  const Eigen::VectorXd residual =
      weighted_moduli - jacobian.leftCols(kNumOfKnownAxis) * fit.moduli;
  Eigen::Vector3d step = {0, 0, 0};
  step.tail(2) = SolveLeastSquares(jacobian, residual).bottomRows(2);
  // Where the axis makes hardly any difference, steps would be arbitrarily
  // long.
  constexpr double kLongest = 0.5;
  step *= std::min(1.0, kLongest / step.norm());
  for (int i = 0; i < kHalvings; ++i) {
    std::optional<FitOfAxis> next =
        FitAxis(fit.w + step, weighted_moduli, weights, entries);
    if (next && next->square_sum < fit.square_sum) {
      return next;
    }
    step /= 2;
  }
  return std::nullopt;
}

// Returns the fit to which the steps from an axis lead.  Returns nothing where
// the best moduli for that axis have no positive definite stiffness.
std::optional<FitOfAxis> DescendFromAxis(
    const Eigen::Vector3d& w, const Eigen::VectorXd& weighted_moduli,
    const Eigen::MatrixXd& weights, const std::vector<BlockEntry>& entries) {
  constexpr int kMostSteps = 50;
  constexpr double kSettled = 1 - 1e-10;
  std::optional<FitOfAxis> fit = FitAxis(w, weighted_moduli, weights, entries);
  for (int i = 0; fit && i < kMostSteps; ++i) {
    const std::optional<FitOfAxis> next =
        NextAxis(*fit, weighted_moduli, weights, entries);
    if (!next) {
      break;
    }
    const bool is_settled = next->square_sum > kSettled * fit->square_sum;
    fit = next;
    if (is_settled) {
      break;
    }
  }
  return fit;
}

LawParameter RotationComponent(std::string_view name, std::string_view symbol) {
  return {name, symbol, false, -kPi, kPi, 0};
}

// The typical values, where fits start, are anisotropic, so that the axis makes
// a difference there.
std::vector<LawParameter> ParametersOfFreeAxis() {
  std::vector<LawParameter> parameters = OfKnownAxis().Parameters();
  parameters[0].typical *= 2;
  parameters.push_back(RotationComponent("rotation_y", "w_y"));
  parameters.push_back(RotationComponent("rotation_z", "w_z"));
  return parameters;
}

}  // namespace

FreeAxisLaw::FreeAxisLaw() : parameters_(ParametersOfFreeAxis()) {}

std::string_view FreeAxisLaw::Description() const {
  return "transversely_isotropic with an unknown axis L, which is x turned by "
         "a rotation vector w";
}

const std::vector<BlockEntry>& FreeAxisLaw::BlockEntries() const {
  static const std::vector<BlockEntry> none;
  return none;
}

Eigen::VectorXd FreeAxisLaw::Moduli(const Eigen::VectorXd& parameters,
                                    SectionModel model) const {
  return UnitModuli(RotationBy(RotationVector(parameters)),
                    AnisotropicLaw::BlockEntries()) *
         OfKnownAxis().Moduli(parameters.head(kNumOfKnownAxis), model);
}

Eigen::MatrixXd FreeAxisLaw::ModuliJacobian(const Eigen::VectorXd& parameters,
                                            SectionModel model) const {
  const std::vector<BlockEntry>& entries = AnisotropicLaw::BlockEntries();
  const Eigen::Vector3d w = RotationVector(parameters);
  const Eigen::VectorXd of_known = parameters.head(kNumOfKnownAxis);
  const Matrix6d turned = KelvinRotation(RotationBy(w));
  const Matrix6d stiffness =
      turned *
      KelvinStiffness(OfKnownAxis(), OfKnownAxis().Moduli(of_known, model)) *
      turned.transpose();
  Eigen::MatrixXd jacobian(NumModuli(), parameters.size());
  jacobian << UnitModuli(RotationBy(w), entries) *
                  OfKnownAxis().ModuliJacobian(of_known, model),
      RotationJacobian(stiffness, w, entries).rightCols(2);
  return jacobian;
}

Eigen::VectorXd FreeAxisLaw::ParametersOf(const Eigen::VectorXd& moduli,
                                          SectionModel /*model*/) const {
  const std::vector<BlockEntry>& entries = AnisotropicLaw::BlockEntries();
  Eigen::VectorXd weights(moduli.size());
  for (Eigen::Index k = 0; k < weights.size(); ++k) {
    weights(k) = entries[k].factor *
                 (entries[k].row == entries[k].column ? 1 : std::sqrt(2.0));
  }
  return NearestParameters(moduli, weights.asDiagonal());
}

Eigen::VectorXd FreeAxisLaw::NearestParameters(
    const Eigen::VectorXd& moduli, const Eigen::MatrixXd& weights) const {
  const std::vector<BlockEntry>& entries = AnisotropicLaw::BlockEntries();
  const Eigen::VectorXd weighted = weights * moduli;
  constexpr int kNumAxes = 48;
  std::optional<FitOfAxis> best;
  for (const Eigen::Vector3d& w : RotationsOfHalfSphere(kNumAxes)) {
    const std::optional<FitOfAxis> fit =
        DescendFromAxis(w, weighted, weights, entries);
    if (fit && !(best && best->square_sum <= fit->square_sum)) {
      best = fit;
    }
  }
  Eigen::VectorXd parameters = Eigen::VectorXd::Constant(
      kNumOfKnownAxis + 2, std::numeric_limits<double>::quiet_NaN());
  if (!best) {
    return parameters;
  }
  parameters << OfKnownAxis().ParametersOf(best->moduli, kModel),
      best->w.tail(2);
  return WithNearerEnd(parameters);
}

Eigen::VectorXd FreeAxisLaw::WithNearerEnd(Eigen::VectorXd parameters) {
  const double angle = parameters.tail(2).norm();
  if (angle > 0) {
    parameters.tail(2) *= std::remainder(angle, kPi) / angle;
  }
  return parameters;
}

std::vector<Eigen::Vector3d> FreeAxisLaw::RotationsOfHalfSphere(int num_axes) {
  const double golden_angle = kPi * (3 - std::sqrt(5.0));
  std::vector<Eigen::Vector3d> rotations;
  for (int i = 0; i < num_axes; ++i) {
    const double angle = std::acos((i + 0.5) / num_axes);
    rotations.emplace_back(0, angle * std::cos(golden_angle * i),
                           angle * std::sin(golden_angle * i));
  }
  return rotations;
}

Eigen::Vector3d FreeAxisLaw::Axis(const Eigen::VectorXd& parameters) {
  const Eigen::Vector3d axis = RotationBy(RotationVector(parameters)).col(0);
  return axis(0) < 0 ? Eigen::Vector3d(-axis) : axis;
}

Eigen::MatrixXd FreeAxisLaw::AxisJacobian(const Eigen::VectorXd& parameters) {
  const Eigen::Vector3d w = RotationVector(parameters);
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(3, parameters.size());
  // The axis changes by d (R x) = (J dw) x (R x).
  jacobian.rightCols(2) =
      (-CrossProductWith(Axis(parameters)) * LeftJacobian(w)).rightCols(2);
  return jacobian;
}

Eigen::Vector3d FreeAxisLaw::Anisotropy(const Eigen::VectorXd& p) {
  return {std::log(p(0) / p(1)), p(2) - p(3),
          std::log(2 * p(4) * (1 + p(3)) / p(1))};
}

Eigen::MatrixXd FreeAxisLaw::AnisotropyJacobian(const Eigen::VectorXd& p) {
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(3, p.size());
  jacobian(0, 0) = 1 / p(0);
  jacobian(0, 1) = -1 / p(1);
  jacobian(1, 2) = 1;
  jacobian(1, 3) = -1;
  jacobian(2, 1) = -1 / p(1);
  jacobian(2, 3) = 1 / (1 + p(3));
  jacobian(2, 4) = 1 / p(4);
  return jacobian;
}

}  // namespace elastimate
