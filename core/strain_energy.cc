#include "elastimate/core/strain_energy.h"

#include "elastimate/core/tetrahedron.h"

namespace elastimate {

Eigen::VectorXd StrainEnergyDensity(const Mesh& mesh,
                                    const IsotropicElasticity& elasticity,
                                    const Eigen::Matrix3Xd& displacement) {
  const double mu = elasticity.ShearModulus();
  const double lambda = elasticity.LameLambda();
  Eigen::VectorXd density(mesh.NumElements());
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    const TetrahedronGradients element(GatherTetrahedron(mesh, e));
    Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
    for (int i = 0; i < 4; ++i) {
      gradient += displacement.col(mesh.elements(i, e)) *
                  element.gradient.col(i).transpose();
    }
    const Eigen::Matrix3d strain = 0.5 * (gradient + gradient.transpose());
    const double trace = strain.trace();
    density(e) = mu * strain.squaredNorm() + lambda / 2 * trace * trace;
  }
  return density;
}

}  // namespace elastimate
