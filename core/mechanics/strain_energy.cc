#include "elastimate/core/mechanics/strain_energy.h"

#include <array>
#include <vector>

#include "elastimate/core/mesh/shape_functions.h"

namespace elastimate {
namespace {

// The energy density is mu e:e + (lambda / 2) tr(e)^2.
class EnergyDensity {
 public:
  EnergyDensity(const IsotropicElasticity& elasticity, SectionModel model)
      : mu_(elasticity.ShearModulus()),
        // The stress is s (nu tr(e) I + (1 - c nu) e), so lambda = s nu and 2
        // mu = s (1 - c nu).
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

template <ElementKind kKind>
using Gradient = Eigen::Matrix<double, ElementSizes<kKind>::kDimension,
                               ElementSizes<kKind>::kDimension>;

// Calls visit(displacement gradient, volume, shape functions) at the points of
// a rule in an element.
template <ElementKind kKind, class Visitor>
void VisitGradients(const Mesh& mesh, Eigen::Index element,
                    const std::vector<ShapeFunctions<kKind>>& rule,
                    const double* displacement, const Visitor& visit) {
  const auto u = GatherNodes<kKind>(mesh, element, displacement);
  Gradient<kKind> gradient;
  bool is_known = false;
  VisitPoints<kKind>(
      mesh, element, rule,
      [&](const ElementPoint<kKind>& point, const auto& at) {
        // The gradient of a linear simplex is the same everywhere.
        if (!(kKind == ElementKind::kTet4 || kKind == ElementKind::kTri3) ||
            !is_known) {
          gradient.noalias() = u * point.gradient.transpose();
          is_known = true;
        }
        visit(gradient, point.volume, at);
      });
}

// Calls visit(displacement gradient, volume that it stands for) for each vertex
// of an element.
template <ElementKind kKind, class Visitor>
void VisitVertices(const Mesh& mesh, Eigen::Index element,
                   const double* displacement, const Visitor& visit) {
  if constexpr (!IsCurved(kKind)) {
    VisitGradients<kKind>(mesh, element, VertexRule<kKind>(), displacement,
                          [&](const Gradient<kKind>& gradient, double volume,
                              const auto&) { visit(gradient, volume); });
  } else {
    // This fits the linear function of the reference element that is nearest to
    // the gradient, since the map may be singular at a vertex itself.  The
    // inverse of the matrix of the means of lambda_a lambda_b is n (n + 1) (I -
    // 1 1^T / (n + 1)).
    constexpr int kVertices = ElementSizes<kKind>::kVertices;
    std::array<Gradient<kKind>, kVertices> moments;
    moments.fill(Gradient<kKind>::Zero());
    Gradient<kKind> sum = Gradient<kKind>::Zero();
    double volume = 0;
    double weights = 0;
    VisitGradients<kKind>(
        mesh, element, IntegrationRule<kKind>(), displacement,
        [&](const Gradient<kKind>& gradient, double volume_of_point,
            const ShapeFunctions<kKind>& at) {
          for (int a = 0; a < kVertices; ++a) {
            moments[a] += at.weight * at.vertex_value(a) * gradient;
          }
          sum += at.weight * gradient;
          weights += at.weight;
          volume += volume_of_point;
        });
    for (const Gradient<kKind>& moment : moments) {
      visit(kVertices / weights * ((kVertices + 1) * moment - sum),
            volume / kVertices);
    }
  }
}

// Returns, at each node that is a vertex, the mean of the gradient over the
// elements around it, weighted by the volumes that the vertices stand for.
template <ElementKind kKind>
std::vector<Gradient<kKind>> RecoveredGradient(const Mesh& mesh,
                                               const double* displacement) {
  std::vector<Gradient<kKind>> recovered(mesh.NumNodes(),
                                         Gradient<kKind>::Zero());
  std::vector<double> volumes(mesh.NumNodes(), 0.0);
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    const int* node = mesh.elements.col(e).data();
    VisitVertices<kKind>(mesh, e, displacement,
                         [&](const Gradient<kKind>& gradient, double volume) {
                           recovered[*node] += volume * gradient;
                           volumes[*node] += volume;
                           ++node;
                         });
  }
  for (Eigen::Index node = 0; node < mesh.NumNodes(); ++node) {
    if (volumes[node] > 0) {
      recovered[node] /= volumes[node];
    }
  }
  return recovered;
}

// The energy of the elements, and the energy that they miss.
struct Energies {
  double of_elements = 0;
  double missed = 0;
};

template <ElementKind kKind>
void AddEnergies(const Mesh& mesh, const EnergyDensity& density_of,
                 const double* displacement, Energies& energies) {
  constexpr int kVertices = ElementSizes<kKind>::kVertices;
  const auto recovered = RecoveredGradient<kKind>(mesh, displacement);
  const auto& rule = IntegrationRule<kKind>();
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    const int* const nodes = mesh.elements.col(e).data();
    VisitGradients<kKind>(
        mesh, e, rule, displacement,
        [&](const Gradient<kKind>& gradient, double volume,
            const ShapeFunctions<kKind>& at) {
          Gradient<kKind> difference = gradient;
          for (int k = 0; k < kVertices; ++k) {
            difference -= at.vertex_value(k) * recovered[nodes[k]];
          }
          energies.of_elements += volume * density_of(gradient);
          energies.missed += volume * density_of(difference);
        });
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
      double energy = 0;
      double volume = 0;
      VisitGradients<kind>(
          mesh, e, rule, displacement.data(),
          [&](const auto& gradient, double volume_of_point, const auto&) {
            energy += volume_of_point * density_of(gradient);
            volume += volume_of_point;
          });
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
