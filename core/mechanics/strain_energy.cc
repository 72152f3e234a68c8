#include "elastimate/core/mechanics/strain_energy.h"

#include <vector>

#include "elastimate/core/mesh/tet10.h"
#include "elastimate/core/mesh/tet4.h"

namespace elastimate {
namespace {

// A displacement gradient, or a difference of two, that is linear in an
// element.
struct LinearGradient {
  std::array<Eigen::Matrix3d, 4> at_vertex;
  Eigen::Matrix3d mean;
};

// `displacement` holds 3 * node + component.
LinearGradient GradientIn(const Mesh& mesh, Eigen::Index e,
                          const TetrahedronGradients& element,
                          const double* displacement) {
  if (mesh.Order() == 2) {
    const QuadraticDisplacementGradient gradient(
        GatherQuadratic(mesh, e, displacement), element.gradient);
    return {gradient.at_vertex, gradient.mean};
  }
  Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 4; ++i) {
    gradient += Eigen::Map<const Eigen::Vector3d>(
                    displacement + 3 * Eigen::Index(mesh.elements(i, e))) *
                element.gradient.col(i).transpose();
  }
  return {{gradient, gradient, gradient, gradient}, gradient};
}

// The mean of the energy density: that of the product of two linear functions
// is a fifth of the mean of that at the vertices plus four fifths of the
// product of the means.
double MeanEnergyDensity(const IsotropicElasticity& elasticity,
                         const LinearGradient& gradient) {
  const double mu = elasticity.ShearModulus();
  const double lambda = elasticity.LameLambda();
  const auto density_of = [mu, lambda](const Eigen::Matrix3d& at) {
    const Eigen::Matrix3d strain = 0.5 * (at + at.transpose());
    const double trace = strain.trace();
    return mu * strain.squaredNorm() + lambda / 2 * trace * trace;
  };
  double density = 0.8 * density_of(gradient.mean);
  for (const Eigen::Matrix3d& at_vertex : gradient.at_vertex) {
    density += 0.05 * density_of(at_vertex);
  }
  return density;
}

// At each node that is a vertex, the mean over the elements around it, weighted
// by their volumes.
std::vector<Eigen::Matrix3d> RecoveredGradient(const Mesh& mesh,
                                               const double* displacement) {
  std::vector<Eigen::Matrix3d> recovered(mesh.NumNodes(),
                                         Eigen::Matrix3d::Zero());
  std::vector<double> volume(mesh.NumNodes(), 0.0);
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    const TetrahedronGradients element(GatherTetrahedron(mesh, e));
    const LinearGradient gradient = GradientIn(mesh, e, element, displacement);
    for (int i = 0; i < 4; ++i) {
      const int node = mesh.elements(i, e);
      recovered[node] += element.volume * gradient.at_vertex[i];
      volume[node] += element.volume;
    }
  }
  for (Eigen::Index node = 0; node < mesh.NumNodes(); ++node) {
    if (volume[node] > 0) {
      recovered[node] /= volume[node];
    }
  }
  return recovered;
}

}  // namespace

Eigen::VectorXd StrainEnergyDensity(const Mesh& mesh,
                                    const IsotropicElasticity& elasticity,
                                    const Eigen::Matrix3Xd& displacement) {
  Eigen::VectorXd density(mesh.NumElements());
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    const TetrahedronGradients element(GatherTetrahedron(mesh, e));
    density(e) = MeanEnergyDensity(
        elasticity, GradientIn(mesh, e, element, displacement.data()));
  }
  return density;
}

double DiscretizationError(const Mesh& mesh,
                           const IsotropicElasticity& elasticity,
                           const Eigen::MatrixXd& displacement) {
  double energy = 0;
  double missed = 0;
  for (Eigen::Index k = 0; k < displacement.cols(); ++k) {
    const double* values = displacement.col(k).data();
    const std::vector<Eigen::Matrix3d> recovered =
        RecoveredGradient(mesh, values);
    for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
      const TetrahedronGradients element(GatherTetrahedron(mesh, e));
      LinearGradient gradient = GradientIn(mesh, e, element, values);
      energy += element.volume * MeanEnergyDensity(elasticity, gradient);
      Eigen::Matrix3d mean = Eigen::Matrix3d::Zero();
      for (int i = 0; i < 4; ++i) {
        const Eigen::Matrix3d& at_vertex = recovered[mesh.elements(i, e)];
        gradient.at_vertex[i] -= at_vertex;
        mean += at_vertex / 4;
      }
      gradient.mean -= mean;
      missed += element.volume * MeanEnergyDensity(elasticity, gradient);
    }
  }
  return energy > 0 ? missed / energy : 0;
}

}  // namespace elastimate
