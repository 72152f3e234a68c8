#include "elastimate/estimators/material_fit/large_strain_choice.h"

#include <algorithm>
#include <cmath>
#include <iterator>
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
#include "elastimate/estimators/material_fit/refined_fit.h"

namespace elastimate {
namespace {

constexpr const char* kRotated = "corotated";
constexpr const char* kStretched[] = {"neo_hookean", "st_venant_kirchhoff"};
// Laws whose chi^2 differ by less explain the data about as well.
constexpr double kAlike = 9;

// Copies known values and bounds of isotropic materials from the options to a
// material.
void MoveOptions(const EstimatorOptions& options, Material& material) {
  if (options.known_poisson_ratio) {
    material.known.push_back({"poisson_ratio", *options.known_poisson_ratio});
  }
  for (const BoundsOfParameter& given :
       {BoundsOfParameter{"youngs_modulus", options.youngs_modulus},
        BoundsOfParameter{"poisson_ratio", options.poisson_ratio}}) {
    const auto is_of_it = [&](const auto& other) {
      return other.name == given.name;
    };
    if (given.bounds.AreGiven() &&
        std::none_of(material.known.begin(), material.known.end(), is_of_it) &&
        std::none_of(material.bounds.begin(), material.bounds.end(),
                     is_of_it)) {
      material.bounds.push_back(given);
    }
  }
}

struct LawFit {
  std::string law;
  MaterialFit fit;
  double square_sum = 0;

  Eigen::VectorXd Values() const { return fit.estimate.ParameterValues(); }
};

// Returns the difference of chi^2 between two fits of one measurement.
double Difference(const LawFit& fit, const LawFit& best) {
  const auto n = static_cast<double>(best.fit.errors.residual.size());
  constexpr double kExact = kLimits.exact_residual * kLimits.exact_residual;
  return n * std::log(std::max(fit.square_sum, kExact) /
                      std::max(best.square_sum, kExact));
}

// Returns, for each parameter, half of the distance between its value for the
// best law and the nearest value for another law, because the specimen may
// follow a law that was not fitted.
Eigen::VectorXd LeastErrors(const std::vector<LawFit>& fits,
                            const LawFit& best) {
  const Eigen::VectorXd of_best = best.Values();
  Eigen::VectorXd least = Eigen::VectorXd::Constant(
      of_best.size(), std::numeric_limits<double>::infinity());
  for (const LawFit& fit : fits) {
    if (fit.law != best.law && fit.fit.minimum && fit.Values().allFinite()) {
      least = least.cwiseMin((fit.Values() - of_best).cwiseAbs() / 2);
    }
  }
  return least.allFinite() ? least : Eigen::VectorXd::Zero(of_best.size());
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
    const Eigen::VectorXd distance = fits[i].Values() - fits[0].Values();
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

// Returns the compared laws, the best first.
std::vector<LawComparison> Compare(const std::vector<LawFit>& fits,
                                   Eigen::Index num_parameters) {
  std::vector<LawComparison> laws;
  for (const LawFit& fit : fits) {
    const double difference = Difference(fit, fits[0]);
    laws.push_back({fit.law, num_parameters, difference, difference});
  }
  return laws;
}

// Returns the usable fits, the best first; where there are none, the first fit.
std::vector<LawFit> UsableFits(const std::vector<LawFit>& fits) {
  std::vector<LawFit> candidates;
  std::copy_if(fits.begin(), fits.end(), std::back_inserter(candidates),
               [](const LawFit& fit) {
                 return fit.fit.estimate.IsUsable() &&
                        fit.fit.errors.residual.size() > 0;
               });
  if (candidates.empty()) {
    return {fits[0]};
  }
  std::sort(candidates.begin(), candidates.end(),
            [](const LawFit& a, const LawFit& b) {
              return a.square_sum < b.square_sum;
            });
  return candidates;
}

// The fits of laws of large strains in place of isotropic ones.
class LargeStrainFits {
 public:
  LargeStrainFits(const Scene& scene, const EstimatorOptions& options)
      : scene_(scene), options_(options) {
    scene_.materials = MaterialsOfLargeStrains(scene.materials, kRotated);
    for (Material& material : scene_.materials) {
      MoveOptions(options, material);
    }
    options_.kinematics = Kinematics::kAutomatic;
    options_.known_poisson_ratio.reset();
    options_.youngs_modulus = {};
    options_.poisson_ratio = {};
  }

  LawFit Fit(const std::string& law,
             const std::optional<Eigen::VectorXd>& start) {
    scene_.materials = MaterialsOfLargeStrains(scene_.materials, law);
    return Enter(law,
                 FitMaterialsFrom(start, scene_, options_, Descent::kFull));
  }
  // Fits to compare with other laws, without what they have in common.
  LawFit FitToCompare(const std::string& law,
                      const std::optional<Eigen::VectorXd>& start) {
    scene_.materials = MaterialsOfLargeStrains(scene_.materials, law);
    EstimatorOptions options = options_;
    options.refinement = Refine::kNever;
    return Enter(law, FitRefined(scene_, options, Descent::kFull, start,
                                 MisfitCurvature::kIgnored));
  }
  const Work& WorkDone() const { return work_; }

 private:
  LawFit Enter(const std::string& law, MaterialFit fit) {
    work_ = work_ + fit.estimate.work;
    const double square_sum = SquaredNorm(fit.errors.residual);
    return {law, std::move(fit), square_sum};
  }

  Scene scene_;
  EstimatorOptions options_;
  Work work_;
};

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
      scene.origin != Origin::kMeasured || !AreIsotropic(scene.materials)) {
    return options.kinematics == Kinematics::kLarge;
  }
  const DeformationSize size = MeasureDeformation(scene);
  return IsMentioned(size) && IsPossible(size);
}

Estimate FitLargeStrainLaws(const Scene& scene,
                            const EstimatorOptions& options) {
  LargeStrainFits all(scene, options);
  const DeformationSize size = MeasureDeformation(scene);
  const bool are_compared = size.strain > kLimits.mentioned_strain / 2;
  // Finer elements change the fits of all laws by about as much, so only the
  // best law is fitted on them.
  const bool is_refined_last =
      are_compared && scene.origin == Origin::kMeasured;
  const auto fit = [&](const char* law,
                       const std::optional<Eigen::VectorXd>& start) {
    return is_refined_last ? all.FitToCompare(law, start) : all.Fit(law, start);
  };
  std::vector<LawFit> fits;
  fits.push_back(fit(kRotated, std::nullopt));
  const std::optional<Eigen::VectorXd> start = fits[0].fit.Variables();
  if (start && are_compared) {
    for (const char* const law : kStretched) {
      fits.push_back(fit(law, start));
    }
  }
  const std::vector<LawFit> candidates = UsableFits(fits);
  const LawFit& best = candidates[0];
  Estimate estimate = is_refined_last
                          ? all.Fit(best.law, best.fit.Variables()).fit.estimate
                          : best.fit.estimate;
  estimate.large_strain_law = best.law;
  if (are_compared && start && estimate.IsUsable()) {
    AddSpread(candidates,
              scene.origin == Origin::kMeasured
                  ? LeastErrors(fits, best)
                  : Eigen::VectorXd::Zero(best.Values().size()),
              estimate);
  }
  if (candidates.size() > 1) {
    estimate.laws = Compare(candidates, start->size());
  }
  estimate.work = all.WorkDone();
  if (best.fit.minimum) {
    estimate.Add(LargeStrainsFitted(size, best.law));
  }
  return estimate;
}

}  // namespace elastimate
