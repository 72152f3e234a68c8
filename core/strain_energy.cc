#include "elastimate/core/strain_energy.h"

#include "elastimate/core/quadratic_tetrahedron.h"
#include "elastimate/core/tetrahedron.h"

namespace elastimate {
namespace {

Eigen::Matrix3d LinearDisplacementGradient(
    const Mesh& mesh, Eigen::Index e, const TetrahedronGradients& element,
    const Eigen::Matrix3Xd& displacement) {
  Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 4; ++i) {
    gradient += displacement.col(mesh.elements(i, e)) *
                element.gradient.col(i).transpose();
  }
  return gradient;
}

}  // namespace

Eigen::VectorXd StrainEnergyDensity(const Mesh& mesh,
                                    const IsotropicElasticity& elasticity,
                                    const Eigen::Matrix3Xd& displacement) {
  const double mu = elasticity.ShearModulus();
  const double lambda = elasticity.LameLambda();
  const auto density_of = [mu, lambda](const Eigen::Matrix3d& gradient) {
    const Eigen::Matrix3d strain = 0.5 * (gradient + gradient.transpose());
    const double trace = strain.trace();
    return mu * strain.squaredNorm() + lambda / 2 * trace * trace;
  };
  Eigen::VectorXd density(mesh.NumElements());
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    const TetrahedronGradients element(GatherTetrahedron(mesh, e));
    if (mesh.Order() == 1) {
      density(e) = density_of(
          LinearDisplacementGradient(mesh, e, element, displacement));
      continue;
    }
    // The mean of the product of two linear functions is a fifth of the mean
    // of that at the vertices plus four fifths of the product of the means.
    const QuadraticDisplacementGradient gradient(
        GatherQuadratic(mesh, e, displacement.data()), element.gradient);
    density(e) = 0.8 * density_of(gradient.mean);
    for (const Eigen::Matrix3d& at_vertex : gradient.at_vertex) {
      density(e) += 0.05 * density_of(at_vertex);
    }
  }
  return density;
}

}  // namespace elastimate
