#include "elastimate/estimators/material_fit/large_strain_choice.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "elastimate/core/algebra/node_sums.h"
#include "elastimate/core/materials/isotropic_law.h"
#include "elastimate/core/scene/deformation_size.h"
#include "elastimate/estimators/interface/finding_sentences.h"
#include "elastimate/estimators/interface/kinematic_error.h"
#include "elastimate/estimators/interface/limits.h"
#include "elastimate/estimators/material_fit/material_fit.h"

namespace elastimate {
namespace {

constexpr const char* kRotated = "corotated";
constexpr const char* kStretched[] = {"neo_hookean", "st_venant_kirchhoff"};
// Laws whose chi^2 differ by less explain the data about as well.
constexpr double kAlike = 9;

// Options for one isotropic material, as a property of that.
void MoveOptions(EstimatorOptions& options, Material& material) {
  if (options.known_poisson_ratio) {
    material.known.push_back({"poisson_ratio", *options.known_poisson_ratio});
  }
  options.known_poisson_ratio.reset();
  for (auto [name, bounds] :
       {std::pair{"youngs_modulus", &options.youngs_modulus},
        std::pair{"poisson_ratio", &options.poisson_ratio}}) {
    const auto is_of_it = [name = name](const auto& given) {
      return given.name == name;
    };
    if (bounds->AreGiven() &&
        std::none_of(material.known.begin(), material.known.end(), is_of_it) &&
        std::none_of(material.bounds.begin(), material.bounds.end(),
                     is_of_it)) {
      material.bounds.push_back({name, *bounds});
    }
  }
}

struct LawFit {
  std::string law;
  MaterialFit fit;
  double square_sum = 0;
};

// What two fits of one measurement differ by, in chi^2.
double Difference(const LawFit& fit, const LawFit& best) {
  const auto n = static_cast<double>(best.fit.errors.residual.size());
  constexpr double kExact = kLimits.exact_residual * kLimits.exact_residual;
  return n * std::log(std::max(fit.square_sum, kExact) /
                      std::max(best.square_sum, kExact));
}

Eigen::VectorXd ValuesOf(const Estimate& estimate) {
  Eigen::VectorXd values(Eigen::Index(estimate.parameters.size()));
  std::transform(
      estimate.parameters.begin(), estimate.parameters.end(), values.begin(),
      [](const ParameterEstimate& parameter) { return parameter.value; });
  return values;
}

// Returns half of the distance of each parameter from that of the nearest of
// other laws: a specimen may be of a law that was not fitted.
Eigen::VectorXd LeastErrors(const std::vector<Eigen::VectorXd>& of_others,
                            const Eigen::VectorXd& best) {
  Eigen::VectorXd least = Eigen::VectorXd::Constant(
      best.size(), std::numeric_limits<double>::infinity());
  for (const Eigen::VectorXd& values : of_others) {
    if (values.allFinite()) {
      least = least.cwiseMin((values - best).cwiseAbs() / 2);
    }
  }
  return least.allFinite() ? least : Eigen::VectorXd::Zero(best.size());
}

// Adds the spread of the laws to the errors of the best, which is the first,
// `least` of each parameter at least.
void AddSpread(const std::vector<LawFit>& fits, const Eigen::VectorXd& least,
               Estimate& estimate) {
  double sum_of_weights = 1;
  Eigen::MatrixXd spread =
      Eigen::MatrixXd::Zero(Eigen::Index(estimate.parameters.size()),
                            Eigen::Index(estimate.parameters.size()));
  std::vector<std::string> alike;
  for (std::size_t i = 1; i < fits.size(); ++i) {
    const double difference = Difference(fits[i], fits[0]);
    if (difference >= kAlike) {
      continue;
    }
    alike.push_back(fits[i].law);
    const double weight = std::exp(-difference / 2);
    sum_of_weights += weight;
    const Eigen::VectorXd distance =
        ValuesOf(fits[i].fit.estimate) - ValuesOf(fits[0].fit.estimate);
    spread += weight * distance * distance.transpose();
  }
  spread /= sum_of_weights;
  for (Eigen::Index p = 0; p < spread.rows(); ++p) {
    spread(p, p) = std::max(spread(p, p), least(p) * least(p));
  }
  estimate.error_budget.law.resize(spread.rows());
  for (Eigen::Index p = 0; p < spread.rows(); ++p) {
    const ParameterEstimate& parameter = estimate.parameters[p];
    estimate.error_budget.law(p) =
        parameter.is_known ? Estimate::kUnknown
                           : std::sqrt(spread(p, p)) / parameter.ErrorUnit();
  }
  estimate.parameter_covariance += spread;
  if (!alike.empty()) {
    estimate.Add(LargeStrainLawsFitAlike(fits[0].law, alike));
  }
}

// The laws, the best first.
std::vector<LawComparison> Compare(const std::vector<LawFit>& fits,
                                   Eigen::Index num_parameters) {
  std::vector<LawComparison> laws;
  for (const LawFit& fit : fits) {
    const double difference = Difference(fit, fits[0]);
    laws.push_back({fit.law, num_parameters, difference, difference});
  }
  return laws;
}

}  // namespace

std::vector<Material> MaterialsOfLargeStrains(std::vector<Material> materials,
                                              const std::string& law) {
  if (materials.empty()) {
    materials.emplace_back();
  }
  for (Material& material : materials) {
    material.law = law;
  }
  return materials;
}

bool AsksForLargeStrains(const Scene& scene, const EstimatorOptions& options) {
  if (options.kinematics != Kinematics::kAutomatic ||
      scene.origin != Origin::kMeasured || scene.is_rigid_motion_free ||
      !AreIsotropic(scene.materials)) {
    return options.kinematics == Kinematics::kLarge;
  }
  const DeformationSize size = MeasureDeformation(scene);
  return IsMentioned(size) && size.strain < kLimits.impossible_strain;
}

Estimate FitLargeStrainLaws(const Scene& scene,
                            const EstimatorOptions& options) {
  Scene large = scene;
  large.materials = MaterialsOfLargeStrains(scene.materials, kRotated);
  EstimatorOptions of_fit = options;
  of_fit.kinematics = Kinematics::kAutomatic;
  for (Material& material : large.materials) {
    EstimatorOptions of_material = options;
    MoveOptions(of_material, material);
  }
  of_fit.known_poisson_ratio.reset();
  of_fit.youngs_modulus = {};
  of_fit.poisson_ratio = {};
  Work work;
  const auto fit_law = [&](const std::string& law,
                           const std::optional<Eigen::VectorXd>& start,
                           Refine refinement) {
    large.materials = MaterialsOfLargeStrains(large.materials, law);
    of_fit.refinement = refinement;
    MaterialFit fit = FitMaterialsFrom(start, large, of_fit, Descent::kFull);
    work = work + fit.estimate.work;
    const double square_sum = SquaredNorm(fit.errors.residual);
    return LawFit{law, std::move(fit), square_sum};
  };
  const DeformationSize size = MeasureDeformation(scene);
  const bool are_laws_compared = size.strain > kLimits.mentioned_strain / 2;
  // Finer elements change laws alike, so that only the best is fitted on them.
  const bool is_divided_last = are_laws_compared &&
                               scene.origin == Origin::kMeasured &&
                               options.refinement != Refine::kNever;
  const Refine first = is_divided_last ? Refine::kNever : options.refinement;
  std::vector<LawFit> fits;
  fits.push_back(fit_law(kRotated, std::nullopt, first));
  const std::optional<Eigen::VectorXd> start = fits[0].fit.Variables();
  if (start && are_laws_compared) {
    for (const char* const law : kStretched) {
      fits.push_back(fit_law(law, start, first));
    }
  }
  std::vector<std::pair<std::string, Eigen::VectorXd>> of_laws;
  for (const LawFit& fit : fits) {
    if (fit.fit.minimum) {
      of_laws.emplace_back(fit.law, ValuesOf(fit.fit.estimate));
    }
  }
  // A law that has no fit is not compared.
  fits.erase(std::remove_if(fits.begin() + 1, fits.end(),
                            [](const LawFit& fit) {
                              return !fit.fit.estimate.IsUsable() ||
                                     fit.fit.errors.residual.size() == 0;
                            }),
             fits.end());
  if (fits.size() > 1 && !fits[0].fit.estimate.IsUsable()) {
    fits.erase(fits.begin());
  }
  std::sort(fits.begin(), fits.end(), [](const LawFit& a, const LawFit& b) {
    return a.square_sum < b.square_sum;
  });
  Estimate estimate =
      is_divided_last
          ? fit_law(fits[0].law, fits[0].fit.Variables(), options.refinement)
                .fit.estimate
          : fits[0].fit.estimate;
  estimate.large_strain_law = fits[0].law;
  if (are_laws_compared && start && estimate.IsUsable()) {
    std::vector<Eigen::VectorXd> of_others;
    for (const auto& [law, values] : of_laws) {
      if (law != fits[0].law && scene.origin == Origin::kMeasured) {
        of_others.push_back(values);
      }
    }
    AddSpread(fits, LeastErrors(of_others, ValuesOf(fits[0].fit.estimate)),
              estimate);
  }
  if (fits.size() > 1) {
    estimate.laws = Compare(fits, Eigen::Index(start->size()));
  }
  estimate.work = work;
  estimate.Add(LargeStrainsFitted(size, fits[0].law));
  return estimate;
}

}  // namespace elastimate
