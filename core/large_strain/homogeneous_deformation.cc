#include "elastimate/core/large_strain/homogeneous_deformation.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace elastimate {
namespace {

// The place of H(i, i) in the order of the columns of H.
int Diagonal(int axis) { return 4 * axis; }

std::vector<int> FreeAxes(DeformationMode mode) {
  switch (mode) {
    case DeformationMode::kUniaxial:
      return {1, 2};
    case DeformationMode::kEquibiaxial:
    case DeformationMode::kPureShear:
      return {2};
    case DeformationMode::kSimpleShear:
    case DeformationMode::kVolumetric:
      break;
  }
  return {};
}

// Sets the entries of H that a mode prescribes.
void Prescribe(DeformationMode mode, double stretch,
               Eigen::Matrix3d& gradient) {
  const double strain = stretch - 1;
  if (mode == DeformationMode::kSimpleShear) {
    gradient(0, 1) = strain;
    return;
  }
  gradient(0, 0) = strain;
  if (mode == DeformationMode::kEquibiaxial ||
      mode == DeformationMode::kVolumetric) {
    gradient(1, 1) = strain;
  }
  if (mode == DeformationMode::kVolumetric) {
    gradient(2, 2) = strain;
  }
}

// Returns the states at stretches that go away from rest.
std::vector<std::optional<HomogeneousState>> Follow(
    const Law& law, const Eigen::VectorXd& moduli, DeformationMode mode,
    const std::vector<double>& stretches) {
  constexpr double kLargestStep = 0.02;
  const std::vector<int> free = FreeAxes(mode);
  std::vector<std::optional<HomogeneousState>> states(stretches.size());
  Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
  double reached = 1;
  for (std::size_t i = 0; i < stretches.size(); ++i) {
    const double ratio = stretches[i] / reached;
    const int num_steps =
        std::max(1, int(std::ceil(std::abs(std::log(ratio)) / kLargestStep)));
    for (int step = 1; step <= num_steps; ++step) {
      Prescribe(mode,
                step == num_steps
                    ? stretches[i]
                    : reached * std::pow(ratio, double(step) / num_steps),
                gradient);
      if (!ReleaseAxes(law, moduli, free, gradient)) {
        return states;
      }
    }
    reached = stretches[i];
    const Eigen::VectorXd stress =
        law.Stresses(gradient, SectionModel::kSolid) * moduli;
    states[i] = {gradient,
                 stress(mode == DeformationMode::kSimpleShear ? 3 : 0)};
  }
  return states;
}

}  // namespace

std::string_view DeformationModeName(DeformationMode mode) {
  switch (mode) {
    case DeformationMode::kUniaxial:
      return "uniaxial";
    case DeformationMode::kEquibiaxial:
      return "equibiaxial";
    case DeformationMode::kPureShear:
      return "pure_shear";
    case DeformationMode::kSimpleShear:
      return "simple_shear";
    case DeformationMode::kVolumetric:
      break;
  }
  return "volumetric";
}

bool ReleaseAxes(const Law& law, const Eigen::VectorXd& moduli,
                 const std::vector<int>& axes, Eigen::Matrix3d& gradient) {
  constexpr int kMostSteps = 60;
  constexpr double kTolerance = 1e-13;
  // A law may have no energy left that resists being pressed flat.
  constexpr double kSmallestStretch = 1e-3;
  if (axes.empty()) {
    return true;
  }
  std::vector<int> places(axes.size());
  std::transform(axes.begin(), axes.end(), places.begin(), Diagonal);
  const auto tractions = [&](const Eigen::Matrix3d& h) {
    return Eigen::VectorXd(
        (law.Stresses(h, SectionModel::kSolid) * moduli)(places));
  };
  Eigen::VectorXd residual = tractions(gradient);
  for (int step = 0; step < kMostSteps; ++step) {
    // The tangent need not be positive definite before the end is reached: a
    // nearly incompressible material is far from it at any wrong volume.
    const Eigen::MatrixXd tangent =
        law.Tangent(moduli, gradient, SectionModel::kSolid)(places, places);
    const Eigen::VectorXd change = -tangent.partialPivLu().solve(residual);
    if (!change.allFinite()) {
      return false;
    }
    const double relative_change =
        change.cwiseAbs().maxCoeff() / gradient.cwiseAbs().maxCoeff();
    const auto is_stable = [&] {
      return Eigen::LLT<Eigen::MatrixXd>(tangent).info() == Eigen::Success &&
             1 + gradient.diagonal().minCoeff() > kSmallestStretch;
    };
    if (residual.isZero(0) || relative_change <= kTolerance) {
      return is_stable();
    }
    // A stretch may become half of what it is at most, and the residual has to
    // decrease.
    double factor = 1;
    for (std::size_t i = 0; i < axes.size(); ++i) {
      const double stretch = 1 + gradient(axes[i], axes[i]);
      factor =
          std::min(factor, stretch / 2 /
                               std::max(stretch / 2, -change(Eigen::Index(i))));
    }
    constexpr double kSmallestFactor = 1e-3;
    Eigen::Matrix3d next;
    Eigen::VectorXd next_residual;
    for (;; factor /= 2) {
      next = gradient;
      next.reshaped()(places) += factor * change;
      next_residual = tractions(next);
      if (next_residual.norm() < residual.norm()) {
        break;
      }
      if (!(factor > kSmallestFactor)) {
        // Rounding is all that is left, or nothing was found.
        constexpr double kRounding = 1e-9;
        return relative_change <= kRounding && is_stable();
      }
    }
    gradient = next;
    residual = next_residual;
  }
  return false;
}

std::vector<std::optional<HomogeneousState>> DeformHomogeneously(
    const Law& law, const Eigen::VectorXd& moduli, DeformationMode mode,
    const std::vector<double>& stretches) {
  // Stretches above 1 are followed upwards, those below downwards.
  std::vector<std::size_t> order(stretches.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    order[i] = i;
  }
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::abs(std::log(stretches[a])) < std::abs(std::log(stretches[b]));
  });
  std::vector<std::optional<HomogeneousState>> states(stretches.size());
  for (const bool is_longer : {true, false}) {
    std::vector<std::size_t> places;
    std::vector<double> followed;
    for (const std::size_t i : order) {
      if ((stretches[i] >= 1) == is_longer) {
        places.push_back(i);
        followed.push_back(stretches[i]);
      }
    }
    const auto found = Follow(law, moduli, mode, followed);
    for (std::size_t i = 0; i < places.size(); ++i) {
      states[places[i]] = found[i];
    }
  }
  return states;
}

}  // namespace elastimate
