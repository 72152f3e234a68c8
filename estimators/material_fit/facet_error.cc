#include "elastimate/estimators/material_fit/facet_error.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "elastimate/core/materials/material_parameters.h"
#include "elastimate/core/mechanics/internal_forces.h"
#include "elastimate/core/mesh/facet_bulge.h"
#include "elastimate/core/mesh/facets.h"
#include "elastimate/estimators/interface/finding_sentences.h"
#include "elastimate/estimators/interface/limits.h"

namespace elastimate {

std::optional<double> ErrorByFacets(const Scene& scene,
                                    const Estimate& estimate,
                                    const Eigen::MatrixXd& displacement) {
  const Mesh& mesh = scene.mesh;
  if (IsCurved(mesh.kind) || HasLargeStrainLaw(scene.materials) ||
      displacement.rows() != mesh.NumDofs()) {
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
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < estimate.parameters.size(); ++i) {
    const ParameterEstimate& parameter = estimate.parameters[i];
    const double variance =
        estimate.parameter_covariance(Eigen::Index(i), Eigen::Index(i));
    if (parameter.is_modulus && variance >= 0) {
      least = std::min(least, std::sqrt(variance) / parameter.value);
    }
  }
  const std::optional<double> error =
      ErrorByFacets(scene, estimate, displacement);
  if (error && std::abs(*error) >
                   std::max(kLimits.notable_youngs_modulus_error, least)) {
    estimate.Add(FacetsOfRoundBody(*error));
  }
}

}  // namespace elastimate
