#include "elastimate/estimators/interface/axis_estimate.h"

#include <algorithm>
#include <cmath>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/materials/free_axis_law.h"
#include "elastimate/core/materials/material_parameters.h"
#include "elastimate/estimators/interface/limits.h"

namespace elastimate {
namespace {

// The components of w are at the end of the parameters of the law.
constexpr std::size_t kNumRotations = 2;

double ChiSquareOfAnisotropy(const Eigen::VectorXd& parameters,
                             const Eigen::MatrixXd& covariance) {
  // Exact displacements, and parameters that are given, leave no more than
  // this.
  constexpr double kRounding = 1e-8;
  const Eigen::Vector3d anisotropy = FreeAxisLaw::Anisotropy(parameters);
  const Eigen::MatrixXd jacobian = FreeAxisLaw::AnisotropyJacobian(parameters);
  Eigen::MatrixXd of_anisotropy = jacobian * covariance * jacobian.transpose();
  of_anisotropy.diagonal().array() += kRounding * kRounding;
  const double chi_square =
      (anisotropy.transpose() * Inverse(of_anisotropy) * anisotropy).value();
  return std::isfinite(chi_square) ? chi_square : 0;
}

}  // namespace

bool HasFreeAxis(const std::vector<Material>& materials) {
  return std::any_of(materials.begin(), materials.end(),
                     [](const Material& material) {
                       return material.law == FreeAxisLaw::kName;
                     });
}

std::vector<FreeAxisPlace> FreeAxisParameters(const MaterialParameters& all) {
  std::vector<FreeAxisPlace> places;
  for (std::size_t i = 0; i < all.NumMaterials(); ++i) {
    if (all.LawOf(i).Name() == FreeAxisLaw::kName) {
      places.push_back({all.FirstParameter(i),
                        Eigen::Index(all.LawOf(i).Parameters().size())});
    }
  }
  return places;
}

bool AreAxesApart(const MaterialParameters& all, const Eigen::VectorXd& a,
                  const Eigen::VectorXd& b) {
  const double near = std::cos(3 * kLimits.largest_axis_error);
  for (const auto& [first, count] : FreeAxisParameters(all)) {
    if (std::abs(FreeAxisLaw::Axis(a.segment(first, count))
                     .dot(FreeAxisLaw::Axis(b.segment(first, count)))) < near) {
      return true;
    }
  }
  return false;
}

std::vector<AxisEstimate> AxesOf(const Scene& scene, const Estimate& estimate) {
  std::vector<AxisEstimate> axes;
  if (estimate.parameters.empty() || !HasFreeAxis(scene.materials)) {
    return axes;
  }
  const Eigen::VectorXd values = estimate.ParameterValues();
  const Eigen::MatrixXd of_all = estimate.CovarianceWithGiven();
  const MaterialParameters all(scene.materials, scene.mesh.section.model);
  for (const auto& [first, count] : FreeAxisParameters(all)) {
    const Eigen::VectorXd parameters = values.segment(first, count);
    AxisEstimate axis;
    axis.regions = estimate.parameters[first].regions;
    axis.first_rotation = std::size_t(first + count) - kNumRotations;
    const Eigen::Vector3d direction = FreeAxisLaw::Axis(parameters);
    if (direction.allFinite()) {
      axis.direction = direction;
    }
    const Eigen::MatrixXd jacobian =
        FreeAxisLaw::AxisJacobian(parameters).rightCols(kNumRotations);
    const Eigen::MatrixXd own = of_all.block(first, first, count, count);
    const Eigen::MatrixXd covariance =
        jacobian * own.bottomRightCorner(kNumRotations, kNumRotations) *
        jacobian.transpose();
    if (covariance.allFinite()) {
      axis.standard_error =
          std::sqrt(std::max(DecomposeSymmetric(covariance).values(2), 0.0));
      axis.anisotropy = ChiSquareOfAnisotropy(parameters, own);
      if (!(*axis.standard_error <= kLimits.largest_axis_error &&
            axis.anisotropy >= kLimits.least_anisotropy)) {
        axis.direction.reset();
      }
    }
    axes.push_back(axis);
  }
  return axes;
}

const AxisEstimate* AxisOfParameter(const Estimate& estimate,
                                    std::size_t place) {
  for (const AxisEstimate& axis : estimate.axes) {
    if (place >= axis.first_rotation &&
        place < axis.first_rotation + kNumRotations) {
      return &axis;
    }
  }
  return nullptr;
}

}  // namespace elastimate
