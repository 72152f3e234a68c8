#include "elastimate/estimators/interface/statistics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <sstream>

namespace elastimate {
namespace {

// A modulus is called determined when its relative standard error is below
// this.
constexpr double kDetermined = 0.1;

// The sine of the angle between a modulus' gradient and the direction that the
// data leave free, below which the modulus is called determined by them.
constexpr double kUnchanged = 1e-3;

const char* const kAdvice =
    "; give Poisson's ratio, or add a load case that strains the specimen "
    "otherwise";

struct Modulus {
  std::string name;
  double value;
  Eigen::RowVector2d gradient;  // d ln value / d (ln E, nu).
};

std::array<Modulus, 3> Moduli(const IsotropicElasticity& elasticity) {
  const double nu = elasticity.poisson_ratio;
  return {
      Modulus{"Young's modulus", elasticity.youngs_modulus, {1, 0}},
      Modulus{
          "the shear modulus", elasticity.ShearModulus(), {1, -1 / (1 + nu)}},
      Modulus{
          "the bulk modulus", elasticity.BulkModulus(), {1, 2 / (1 - 2 * nu)}}};
}

}  // namespace

double Median(std::vector<double> values) {
  const auto middle =
      values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) {
    return *middle;
  }
  return (*middle + *std::max_element(values.begin(), middle)) / 2;
}

double LeastAbsoluteDeviations(const Eigen::VectorXd& x,
                               const Eigen::VectorXd& y) {
  std::vector<std::pair<double, double>> ratios;  // y / x and its weight.
  double all_weights = 0;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    if (x(i) != 0) {
      ratios.emplace_back(y(i) / x(i), std::abs(x(i)));
      all_weights += std::abs(x(i));
    }
  }
  std::sort(ratios.begin(), ratios.end());
  double weights = 0;
  std::size_t middle = 0;
  while (middle + 1 < ratios.size() &&
         (weights += ratios[middle].second) < all_weights / 2) {
    ++middle;
  }
  return ratios[middle].first;
}

std::string TwoDigits(double value) {
  std::ostringstream text;
  if (value == 0 || !std::isfinite(value)) {
    text << value;
    return text.str();
  }
  // By precision(2), 100 is 1e+02.
  const double unit = std::pow(10, std::floor(std::log10(std::abs(value))) - 1);
  text << std::round(value / unit) * unit;
  return text.str();
}

std::string DescribeWhatIsDetermined(const Estimate& estimate) {
  const Eigen::Vector2d to_logarithm(1 / estimate.elasticity.youngs_modulus, 1);
  const Eigen::Matrix2d covariance = to_logarithm.asDiagonal() *
                                     estimate.covariance *
                                     to_logarithm.asDiagonal();
  std::ostringstream text;
  text << "the data do not determine Poisson's ratio (standard error "
       << std::sqrt(covariance(1, 1)) << "); ";
  std::optional<Modulus> best;
  double best_error = kDetermined;
  for (const Modulus& modulus : Moduli(estimate.elasticity)) {
    const double error =
        std::sqrt(modulus.gradient * covariance * modulus.gradient.transpose());
    if (error < best_error) {
      best = modulus;
      best_error = error;
    }
  }
  if (best) {
    text << "they determine " << best->name << " = " << best->value << " +- "
         << best->value * best_error;
  } else {
    text << "nor do they determine E, the shear or the bulk modulus to 10 %";
  }
  text << kAdvice;
  return text.str();
}

std::string DescribeCollinear(const IsotropicElasticity& elasticity,
                              const Eigen::Vector2d& direction) {
  std::ostringstream text;
  text << "the data determine one combination of Young's modulus and "
          "Poisson's ratio only";
  for (const Modulus& modulus : Moduli(elasticity)) {
    if (std::abs(modulus.gradient.normalized().dot(direction.normalized())) <
        kUnchanged) {
      text << ", " << modulus.name << " = " << modulus.value;
    }
  }
  text << kAdvice;
  return text.str();
}

}  // namespace elastimate
