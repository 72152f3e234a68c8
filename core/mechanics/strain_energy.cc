#include "elastimate/core/mechanics/strain_energy.h"

#include <array>
#include <vector>

#include "elastimate/core/mesh/shape_functions.h"

namespace elastimate {
namespace {

// mu e:e + (lambda / 2) tr(e)^2.
class EnergyDensity {
 public:
  EnergyDensity(const IsotropicElasticity& elasticity, SectionModel model)
      : mu_(elasticity.ShearModulus()),
        // That of s (nu tr(e) + (1 - c nu) e), 2 mu = s (1 - c nu).
        lambda_(elasticity.StiffnessScale(model) * elasticity.poisson_ratio) {}

  template <class Gradient>
  double operator()(const Gradient& gradient) const {
    const double trace = gradient.trace();
    return mu_ / 4 * (gradient + gradient.transpose()).squaredNorm() +
           lambda_ / 2 * trace * trace;
  }

 private:
  double mu_;
  double lambda_;
};

// The displacement gradients and volumes at the points of a rule.
template <ElementKind kKind>
class ElementGradients {
 public:
  static constexpr int kDimension = ElementSizes<kKind>::kDimension;
  using Gradient = Eigen::Matrix<double, kDimension, kDimension>;

  ElementGradients(const std::vector<ShapeFunctions<kKind>>& rule,
                   const Mesh& mesh, Eigen::Index element,
                   const double* displacement) {
    const auto vertices = GatherVertices<kKind>(mesh, element);
    const auto u = GatherNodes<kKind>(mesh, element, displacement);
    for (std::size_t i = 0; i < rule.size(); ++i) {
      const ElementPoint<kKind> point(vertices, rule[i],
                                      mesh.section.thickness);
      at[i] = u * point.gradient.transpose();
      volume[i] = point.volume;
    }
  }

  static constexpr int kMostPoints = 8;
  std::array<Gradient, kMostPoints> at;
  std::array<double, kMostPoints> volume;
};

// At each node that is a vertex, the mean over the elements around it, weighted
// by the volumes that the vertices stand for.
template <ElementKind kKind>
std::vector<typename ElementGradients<kKind>::Gradient> RecoveredGradient(
    const Mesh& mesh, const double* displacement) {
  using Gradient = typename ElementGradients<kKind>::Gradient;
  std::vector<Gradient> recovered(mesh.NumNodes(), Gradient::Zero());
  std::vector<double> volume(mesh.NumNodes(), 0.0);
  const auto& vertices = VertexRule<kKind>();
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    const ElementGradients<kKind> gradients(vertices, mesh, e, displacement);
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const int node = mesh.elements(Eigen::Index(i), e);
      recovered[node] += gradients.volume[i] * gradients.at[i];
      volume[node] += gradients.volume[i];
    }
  }
  for (Eigen::Index node = 0; node < mesh.NumNodes(); ++node) {
    if (volume[node] > 0) {
      recovered[node] /= volume[node];
    }
  }
  return recovered;
}

// Of the elements, and of what they miss.
struct Energies {
  double of_elements = 0;
  double missed = 0;
};

template <ElementKind kKind>
void AddEnergies(const Mesh& mesh, const EnergyDensity& density_of,
                 const double* displacement, Energies& energies) {
  const auto recovered = RecoveredGradient<kKind>(mesh, displacement);
  const auto& rule = IntegrationRule<kKind>();
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    const ElementGradients<kKind> gradients(rule, mesh, e, displacement);
    for (std::size_t i = 0; i < rule.size(); ++i) {
      typename ElementGradients<kKind>::Gradient difference = gradients.at[i];
      for (int k = 0; k < ElementSizes<kKind>::kVertices; ++k) {
        difference -= rule[i].vertex_value(k) * recovered[mesh.elements(k, e)];
      }
      energies.of_elements += gradients.volume[i] * density_of(gradients.at[i]);
      energies.missed += gradients.volume[i] * density_of(difference);
    }
  }
}

}  // namespace

Eigen::VectorXd StrainEnergyDensity(const Mesh& mesh,
                                    const IsotropicElasticity& elasticity,
                                    const Eigen::MatrixXd& displacement) {
  const EnergyDensity density_of(elasticity, mesh.section.model);
  Eigen::VectorXd density(mesh.NumElements());
  VisitElementKind(mesh.kind, [&](auto kind) {
    const auto& rule = IntegrationRule<kind>();
    for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
      const ElementGradients<kind> gradients(rule, mesh, e,
                                             displacement.data());
      double energy = 0;
      double volume = 0;
      for (std::size_t i = 0; i < rule.size(); ++i) {
        energy += gradients.volume[i] * density_of(gradients.at[i]);
        volume += gradients.volume[i];
      }
      density(e) = energy / volume;
    }
  });
  return density;
}

double DiscretizationError(const Mesh& mesh,
                           const IsotropicElasticity& elasticity,
                           const Eigen::MatrixXd& displacement) {
  const EnergyDensity density_of(elasticity, mesh.section.model);
  Energies energies;
  for (Eigen::Index k = 0; k < displacement.cols(); ++k) {
    VisitElementKind(mesh.kind, [&](auto kind) {
      AddEnergies<kind>(mesh, density_of, displacement.col(k).data(), energies);
    });
  }
  return energies.of_elements > 0 ? energies.missed / energies.of_elements : 0;
}

}  // namespace elastimate
