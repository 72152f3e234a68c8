#include "elastimate/core/mechanics/strain_energy.h"

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

// Calls visit(displacement gradient, volume) at the points of a rule in an
// element.
template <ElementKind kKind, class Visitor>
void VisitGradients(const Mesh& mesh, Eigen::Index element,
                    const std::vector<ShapeFunctions<kKind>>& rule,
                    const double* displacement, const Visitor& visit) {
  const auto u = GatherNodes<kKind>(mesh, element, displacement);
  Gradient<kKind> gradient;
  bool is_known = false;
  VisitPoints<kKind>(
      mesh, element, rule, [&](const ElementPoint<kKind>& point, const auto&) {
        // The gradient of a linear simplex is the same everywhere.
        if (!(kKind == ElementKind::kTet4 || kKind == ElementKind::kTri3) ||
            !is_known) {
          gradient.noalias() = u * point.gradient.transpose();
          is_known = true;
        }
        visit(gradient, point.volume);
      });
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
      VisitGradients<kind>(mesh, e, rule, displacement.data(),
                           [&](const auto& gradient, double volume_of_point) {
                             energy += volume_of_point * density_of(gradient);
                             volume += volume_of_point;
                           });
      density(e) = energy / volume;
    }
  });
  return density;
}

}  // namespace elastimate
