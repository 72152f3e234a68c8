#include "elastimate/estimators/interface/stiffness_estimate.h"

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/materials/isotropic_law.h"
#include "elastimate/core/materials/kelvin_law.h"
#include "elastimate/core/materials/material_parameters.h"

namespace elastimate {
namespace {

// Its entries as columns, for unit moduli.
Eigen::MatrixXd UnitStiffnesses(const Law& law, const Mesh& mesh) {
  const Eigen::MatrixXd rest =
      Eigen::MatrixXd::Zero(mesh.Dimension(), mesh.Dimension());
  const int size = mesh.Dimension() == 3 ? 6 : 3;
  Eigen::MatrixXd units(size * size, law.NumModuli());
  for (int k = 0; k < law.NumModuli(); ++k) {
    units.col(k) =
        VoigtStiffness(law.Tangent(Eigen::VectorXd::Unit(law.NumModuli(), k),
                                   rest, mesh.section.model))
            .reshaped();
  }
  return units;
}

}  // namespace

std::vector<StiffnessEstimate> StiffnessesOf(const Scene& scene,
                                             const Estimate& estimate) {
  std::vector<StiffnessEstimate> stiffnesses;
  if (estimate.parameters.empty()) {
    return stiffnesses;
  }
  const SectionModel model = scene.mesh.section.model;
  const MaterialParameters all(scene.materials, model);
  const Eigen::VectorXd values = estimate.ParameterValues();
  const Eigen::MatrixXd covariance = estimate.CovarianceWithGiven();
  for (std::size_t i = 0; i < all.NumMaterials(); ++i) {
    const Law& law = all.LawOf(i);
    if (law.Name() == IsotropicLaw::kName || law.ForLargeStrains() != nullptr) {
      continue;
    }
    const Eigen::Index first = all.FirstParameter(i);
    const Eigen::Index count = Eigen::Index(law.Parameters().size());
    const Eigen::VectorXd parameters = values.segment(first, count);
    const Eigen::MatrixXd units = UnitStiffnesses(law, scene.mesh);
    const Eigen::MatrixXd jacobian =
        units * law.ModuliJacobian(parameters, model);
    const Eigen::VectorXd variances =
        (jacobian * covariance.block(first, first, count, count))
            .cwiseProduct(jacobian)
            .rowwise()
            .sum();
    const Eigen::Index size = scene.mesh.Dimension() == 3 ? 6 : 3;
    stiffnesses.push_back(
        {estimate.parameters[first].regions,
         (units * law.Moduli(parameters, model)).reshaped(size, size),
         variances.cwiseSqrt().reshaped(size, size)});
  }
  return stiffnesses;
}

bool IsPositiveDefinite(const StiffnessEstimate& stiffness) {
  return stiffness.value.allFinite() &&
         DecomposeSymmetric(stiffness.value).values.minCoeff() > 0;
}

}  // namespace elastimate
