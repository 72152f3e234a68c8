#include "elastimate/estimators/material_fit/facet_error.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <variant>

#include "elastimate/core/materials/material_parameters.h"
#include "elastimate/core/mechanics/internal_forces.h"
#include "elastimate/core/mesh/facet_bulge.h"
#include "elastimate/core/mesh/facets.h"
#include "elastimate/estimators/interface/finding_sentences.h"
#include "elastimate/estimators/interface/limits.h"

namespace elastimate {
namespace {

bool AreForcesGiven(const Scene& scene) {
  const auto is_force = [](const Load& load) {
    return std::holds_alternative<NodalForces>(load) ||
           std::holds_alternative<SurfaceForce>(load);
  };
  return std::all_of(scene.load_cases.begin(), scene.load_cases.end(),
                     [&](const LoadCase& load_case) {
                       return std::all_of(load_case.loads.begin(),
                                          load_case.loads.end(), is_force);
                     });
}

// Returns the relative standard error of the best known modulus.
double LeastError(const Estimate& estimate) {
  double least = estimate.shear_modulus
                     ? estimate.shear_modulus->RelativeError()
                     : std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < estimate.parameters.size(); ++i) {
    const ParameterEstimate& parameter = estimate.parameters[i];
    const double variance =
        estimate.parameter_covariance(Eigen::Index(i), Eigen::Index(i));
    if (parameter.is_modulus && variance >= 0) {
      least = std::min(least, std::sqrt(variance) / parameter.value);
    }
  }
  return least;
}

}  // namespace

std::optional<double> ErrorByFacets(const Scene& scene,
                                    const Estimate& estimate,
                                    const Eigen::MatrixXd& displacement) {
  const Mesh& mesh = scene.mesh;
  if (IsCurved(mesh.kind) || HasLargeStrainLaw(scene.materials) ||
      !AreForcesGiven(scene) || displacement.rows() != mesh.NumDofs()) {
    return std::nullopt;
  }
  const InternalForces forces(mesh, scene.materials);
  const Eigen::VectorXd moduli =
      forces.Parameters().Moduli(estimate.ParameterValues());
  Eigen::VectorXd density = Eigen::VectorXd::Zero(mesh.NumElements());
  for (const auto& u : displacement.colwise()) {
    density += forces.EnergyDensity(moduli, u);
  }
  const double energy = density.dot(ElementVolumes(mesh));
  if (!(energy > 0)) {
    return std::nullopt;
  }
  const Eigen::MatrixXi facets = BoundaryFacets(mesh);
  const Eigen::VectorXi elements = ElementsOfFacets(mesh, facets);
  const Eigen::VectorXd bulge = BulgeOfFacets(mesh, facets);
  double missed = 0;
  for (Eigen::Index i = 0; i < facets.cols(); ++i) {
    missed += bulge(i) * WeightsOfFacet(mesh, facets.col(i)).area.sum() *
              density(elements(i));
  }
  return missed / energy;
}

void WarnOfFlatFacets(const Scene& scene, const Eigen::MatrixXd& displacement,
                      Estimate& estimate) {
  if (scene.origin != Origin::kMeasured || !estimate.IsUsable()) {
    return;
  }
  const std::optional<double> error =
      ErrorByFacets(scene, estimate, displacement);
  if (error && std::abs(*error) > std::max(kLimits.notable_youngs_modulus_error,
                                           LeastError(estimate))) {
    estimate.Add(FacetsOfRoundBody(*error));
  }
}

}  // namespace elastimate
