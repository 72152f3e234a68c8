#include "elastimate/estimators/material_fit/small_strain_start.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "elastimate/core/large_strain/charts.h"
#include "elastimate/core/large_strain/large_strain_law.h"
#include "elastimate/core/laws/elasticity.h"
#include "elastimate/core/materials/isotropic_law.h"
#include "elastimate/estimators/material_fit/material_descent.h"
#include "elastimate/estimators/misfit/descent.h"

namespace elastimate {
namespace {

// Returns E and nu of a law of large strains near the undeformed state.
IsotropicElasticity AtRest(const Law& law, const Eigen::VectorXd& parameters) {
  const Eigen::Vector2d elasticity = LameChart::ParametersOf(
      LameModuliAtRest(law, law.Moduli(parameters, SectionModel::kSolid)));
  return {elasticity(0), elasticity(1)};
}

// Multiplies the free moduli of material `i`.
void MultiplyModuli(const MaterialParameters& all, std::size_t i, double factor,
                    Eigen::VectorXd& parameters) {
  for (const Eigen::Index place : all.Free()) {
    const MaterialParameters::Parameter& parameter = all.All()[place];
    if (parameter.material == i && (parameter.law_parameter->is_modulus ||
                                    parameter.law_parameter->beside)) {
      parameters(place) *= factor;
    }
  }
}

bool HasFreeModulus(const MaterialParameters& all, std::size_t i) {
  return std::any_of(all.Free().begin(), all.Free().end(),
                     [&](Eigen::Index place) {
                       return all.All()[place].material == i &&
                              all.All()[place].law_parameter->is_modulus;
                     });
}

// Multiplies the free moduli of all materials.
void MultiplyModuli(const MaterialParameters& all, double factor,
                    Eigen::VectorXd& parameters) {
  for (std::size_t i = 0; i < all.NumMaterials(); ++i) {
    MultiplyModuli(all, i, factor, parameters);
  }
}

// Fits E of isotropic materials that have the Poisson's ratios of `at_rest`.  A
// material without free moduli keeps its E.
std::optional<Eigen::VectorXd> FitYoungsModuli(
    Scene scene, const std::vector<IsotropicElasticity>& at_rest,
    const MaterialParameters& all, const EstimatorOptions& options,
    Work& work) {
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    Material& material = scene.materials[i];
    material = {std::string(IsotropicLaw::kName), material.regions, {}, {}};
    material.known = {{"poisson_ratio", at_rest[i].poisson_ratio}};
    if (!HasFreeModulus(all, i)) {
      material.known.push_back({"youngs_modulus", at_rest[i].youngs_modulus});
    }
  }
  EstimatorOptions of_start = options;
  of_start.known_poisson_ratio.reset();
  of_start.poisson_ratio = {};
  of_start.youngs_modulus = {};
  DisplacementMisfit misfit(scene, of_start);
  std::optional<Eigen::VectorXd> variables = TypicalStart(misfit);
  if (variables && misfit.Free().Size() > 1) {
    variables =
        DescendFrom(of_start, *variables, Distance::kFar, misfit).variables;
  }
  work = work + misfit.Model().WorkDone();
  if (!variables) {
    return std::nullopt;
  }
  const Eigen::VectorXd parameters = misfit.Free().ParametersAt(*variables);
  return parameters(Eigen::seq(0, Eigen::last, 2));
}

}  // namespace

std::optional<Eigen::VectorXd> SmallStrainStart(const Scene& scene,
                                                const EstimatorOptions& options,
                                                DisplacementMisfit& misfit,
                                                Work& work) {
  const MaterialParameters& all = misfit.Free().All();
  Eigen::VectorXd parameters = all.Typical(all.KnownModulus().value_or(1));
  std::vector<IsotropicElasticity> at_rest;
  bool has_free_modulus = false;
  for (std::size_t i = 0; i < all.NumMaterials(); ++i) {
    const Law& law = all.LawOf(i);
    at_rest.push_back(
        AtRest(law, parameters.segment(all.FirstParameter(i),
                                       Eigen::Index(law.Parameters().size()))));
    has_free_modulus = has_free_modulus || HasFreeModulus(all, i);
  }
  if (has_free_modulus && misfit.NumResultants() > 0 &&
      misfit.Model().Load().isZero(0)) {
    // If only displaced supports load the specimen, its displacements do not
    // depend on the unit of the moduli.
    Eigen::VectorXd residual;
    std::optional<double> stiffness;
    if (misfit.Evaluate(misfit.Free().VariablesOf(parameters), &residual,
                        nullptr)) {
      stiffness = misfit.FitStiffness();
    }
    if (!stiffness) {
      return std::nullopt;
    }
    MultiplyModuli(all, *stiffness, parameters);
    // Where other moduli are known, these are far from the first ones.
    misfit.Model().BeginWith(misfit.Model().Displacement());
  } else if (has_free_modulus) {
    const std::optional<Eigen::VectorXd> youngs_moduli =
        FitYoungsModuli(scene, at_rest, all, options, work);
    if (!youngs_moduli) {
      return std::nullopt;
    }
    for (std::size_t i = 0; i < all.NumMaterials(); ++i) {
      MultiplyModuli(
          all, i, (*youngs_moduli)(Eigen::Index(i)) / at_rest[i].youngs_modulus,
          parameters);
    }
  }
  return StiffenedStart(misfit.Free().VariablesOf(parameters), misfit);
}

std::optional<Eigen::VectorXd> StiffenedStart(const Eigen::VectorXd& variables,
                                              DisplacementMisfit& misfit) {
  constexpr int kMostDoublings = 6;
  Eigen::VectorXd stiffened = variables;
  for (int doubling = 0; doubling <= kMostDoublings; ++doubling) {
    Eigen::VectorXd residual;
    if (misfit.Evaluate(stiffened, &residual, nullptr)) {
      return stiffened;
    }
    Eigen::VectorXd parameters = misfit.Free().ParametersAt(stiffened);
    MultiplyModuli(misfit.Free().All(), 2, parameters);
    stiffened = misfit.Free().VariablesOf(parameters);
  }
  return std::nullopt;
}

}  // namespace elastimate
