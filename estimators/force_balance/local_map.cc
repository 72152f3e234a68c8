#include "elastimate/estimators/force_balance/local_map.h"

#include <Eigen/SparseCore>
#include <Eigen/SparseQR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "elastimate/core/laws/elasticity.h"
#include "elastimate/core/mechanics/stiffness_product.h"
#include "elastimate/core/mesh/mesh_parts.h"
#include "elastimate/core/scene/degrees_of_freedom.h"
#include "elastimate/core/scene/loads.h"

namespace elastimate {
namespace {

constexpr int kMostLocalSteps = 20;
constexpr double kSettledLocally = 1e-13;

// The equations of the free degrees of freedom of all load cases.
class LocalEquations {
 public:
  explicit LocalEquations(const Scene& scene)
      : model_(scene.mesh.section.model),
        num_elements_(scene.mesh.NumElements()) {
    const MeshParts parts = SplitIntoElements(scene.mesh);
    const Eigen::MatrixXd load = AssembleLoadCases(scene);
    const int dimension = scene.mesh.Dimension();
    for (Eigen::Index k = 0; k < load.cols(); ++k) {
      const Supports& supports = SupportsOf(scene, k);
      const DegreesOfFreedom dofs(supports);
      const Eigen::MatrixXd displacement = supports.held.select(
          supports.displacement, scene.load_cases[k].displacement);
      const StiffnessProducts products = MultiplyStiffnessBasis(
          parts.mesh, parts.Gather(displacement.reshaped()));
      for (std::size_t copy = 0; copy < parts.node.size(); ++copy) {
        for (int i = 0; i < dimension; ++i) {
          const Eigen::Index place =
              dofs.place[dimension * parts.node[copy] + i];
          const Eigen::Index row = dimension * Eigen::Index(copy) + i;
          if (place >= 0) {
            entries_.push_back({forces_.size() + place, parts.part[copy],
                                products.h(row, 0), products.j(row, 0)});
          }
        }
      }
      const Eigen::VectorXd of_case = dofs.Restrict(load.col(k));
      forces_.conservativeResize(forces_.size() + of_case.size());
      forces_.tail(of_case.size()) = of_case;
    }
  }

  const Eigen::VectorXd& Forces() const { return forces_; }

  // Returns the forces of elements of E = 1 as columns, and behind them, for
  // some E, the derivative of the forces of all by nu.
  Eigen::SparseMatrix<double> Columns(double nu,
                                      const Eigen::VectorXd& moduli) const {
    const double factor = ComplianceFactor(nu, model_);
    const double slope = ComplianceFactorSlope(nu, model_) / factor;
    std::vector<Eigen::Triplet<double>> triplets;
    for (const Entry& entry : entries_) {
      const double force = (entry.h + nu * entry.j) / factor;
      triplets.emplace_back(entry.row, entry.element, force);
      if (moduli.size() > 0) {
        triplets.emplace_back(
            entry.row, num_elements_,
            moduli(entry.element) * (entry.j / factor - slope * force));
      }
    }
    Eigen::SparseMatrix<double> columns(
        forces_.size(), num_elements_ + (moduli.size() > 0 ? 1 : 0));
    columns.setFromTriplets(triplets.begin(), triplets.end());
    return columns;
  }

 private:
  struct Entry {
    Eigen::Index row;
    int element;
    double h;
    double j;
  };

  SectionModel model_;
  Eigen::Index num_elements_;
  std::vector<Entry> entries_;
  Eigen::VectorXd forces_;
};

struct LocalSolution {
  Eigen::VectorXd values;
  bool is_determined;
};

LocalSolution SolveSparse(Eigen::SparseMatrix<double> columns,
                          const Eigen::VectorXd& rows) {
  columns.makeCompressed();
  const Eigen::SparseQR<Eigen::SparseMatrix<double>, Eigen::COLAMDOrdering<int>>
      qr(columns);
  return {qr.solve(rows), qr.rank() == columns.cols()};
}

// Returns E at this nu.
LocalSolution LocalModuliAt(const LocalEquations& equations, double nu) {
  return SolveSparse(equations.Columns(nu, {}), equations.Forces());
}

double LocalResidualAt(const LocalEquations& equations, double nu,
                       const Eigen::VectorXd& moduli) {
  return (equations.Columns(nu, {}) * moduli - equations.Forces()).norm();
}

}  // namespace

LocalMap EstimateLocalMap(const Scene& scene, const EstimatorOptions& options) {
  const LocalEquations equations(scene);
  LocalMap map;
  if (options.known_poisson_ratio) {
    map.poisson_ratio = *options.known_poisson_ratio;
    const LocalSolution solution = LocalModuliAt(equations, map.poisson_ratio);
    map.youngs_modulus = solution.values;
    map.is_determined = solution.is_determined;
  } else {
    double least = std::numeric_limits<double>::infinity();
    for (const double nu : {-0.4, 0.0, 0.2, 0.3, 0.4, 0.45, 0.49}) {
      const Eigen::VectorXd moduli = LocalModuliAt(equations, nu).values;
      const double residual = LocalResidualAt(equations, nu, moduli);
      if (residual < least) {
        least = residual;
        map.poisson_ratio = nu;
        map.youngs_modulus = moduli;
      }
    }
    for (int i = 0; i < kMostLocalSteps; ++i) {
      const LocalSolution solution =
          SolveSparse(equations.Columns(map.poisson_ratio, map.youngs_modulus),
                      equations.Forces());
      // The columns of E give F at the moduli themselves, so the solution is
      // E, and the last value a change of nu.
      const double last = map.poisson_ratio;
      map.poisson_ratio =
          std::clamp(last + solution.values(solution.values.size() - 1),
                     kSmallestPoissonRatio, kLargestPoissonRatio);
      map.youngs_modulus = LocalModuliAt(equations, map.poisson_ratio).values;
      map.is_determined = solution.is_determined;
      if (std::abs(map.poisson_ratio - last) <= kSettledLocally) {
        break;
      }
    }
  }
  map.force_residual =
      LocalResidualAt(equations, map.poisson_ratio, map.youngs_modulus) /
      equations.Forces().norm();
  return map;
}

}  // namespace elastimate
