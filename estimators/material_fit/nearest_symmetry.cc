#include "elastimate/estimators/material_fit/nearest_symmetry.h"

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/materials/anisotropic_law.h"
#include "elastimate/core/materials/free_axis_law.h"

namespace elastimate {

Scene WithoutFreeAxes(const Scene& scene) {
  Scene without = scene;
  for (Material& material : without.materials) {
    if (material.law == FreeAxisLaw::kName) {
      material.law = AnisotropicLaw::kName;
      material.known.clear();
      material.bounds.clear();
    }
  }
  return without;
}

Eigen::MatrixXd WeightsOf(const Eigen::MatrixXd& covariance) {
  constexpr double kRounding = 1e-12;
  const SymmetricEigenDecomposition modes = DecomposeSymmetric(covariance);
  const Eigen::VectorXd variances =
      modes.values.cwiseMax(kRounding * modes.values.maxCoeff());
  return variances.cwiseSqrt().cwiseInverse().asDiagonal() *
         modes.vectors.transpose();
}

std::optional<Eigen::VectorXd> NearestVariables(
    const FreeParameters& free, const FreeParameters& without_axes,
    const Eigen::VectorXd& variables, const Eigen::MatrixXd& covariance) {
  const MaterialParameters& all = free.All();
  const Eigen::VectorXd moduli = without_axes.ModuliAt(variables);
  const Eigen::MatrixXd jacobian = without_axes.ModuliJacobian(variables);
  const Eigen::MatrixXd of_moduli =
      jacobian * covariance * jacobian.transpose();
  Eigen::VectorXd parameters = all.Typical(1);
  for (std::size_t i = 0; i < all.NumMaterials(); ++i) {
    const Law& law = all.LawOf(i);
    const Eigen::Index first = all.FirstModulus(i);
    const Eigen::Index count = law.NumModuli();
    const Eigen::VectorXd of_material = moduli.segment(first, count);
    const Eigen::MatrixXd block = of_moduli.block(first, first, count, count);
    // Exact displacements leave no errors to weigh by.
    const bool has_errors =
        block.allFinite() && block.diagonal().minCoeff() > 0;
    parameters.segment(all.FirstParameter(i),
                       Eigen::Index(law.Parameters().size())) =
        law.Name() == FreeAxisLaw::kName && has_errors
            ? FreeAxisLaw().NearestParameters(of_material, WeightsOf(block))
            : law.ParametersOf(of_material, all.Model());
  }
  const Eigen::VectorXd nearest = free.VariablesOf(parameters);
  return nearest.allFinite() ? std::optional<Eigen::VectorXd>(nearest)
                             : std::nullopt;
}

}  // namespace elastimate
