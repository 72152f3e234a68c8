#include "elastimate/estimators/force_balance/force_residual.h"

#include <stdexcept>
#include <string>
#include <utility>

#include "elastimate/core/algebra/large_pages.h"
#include "elastimate/core/algebra/node_sums.h"
#include "elastimate/core/algebra/row_block_qr.h"
#include "elastimate/core/large_strain/large_strain_law.h"
#include "elastimate/core/materials/material.h"
#include "elastimate/core/materials/material_parameters.h"
#include "elastimate/core/mechanics/follower_pressure.h"
#include "elastimate/core/mechanics/stiffness_traces.h"
#include "elastimate/core/mesh/node_graph.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/core/text/numbers.h"

namespace elastimate {
namespace {

// Up to here the exact traces take milliseconds; beyond, estimated ones are
// good to better than 1 %, and standard errors to half of that.
constexpr Eigen::Index kMostElementsForExactTraces = 10000;
constexpr Eigen::Index kNumTraceProbes = 2;

void SetHeldRowsToZero(const DegreesOfFreedom& dofs,
                       Eigen::Ref<Eigen::MatrixXd> columns) {
  for (auto column : columns.colwise()) {
    for (Eigen::Index dof = 0; dof < dofs.NumAll(); ++dof) {
      if (dofs.place[dof] < 0) {
        column(dof) = 0;
      }
    }
  }
}

// T of one load case.
Eigen::MatrixXd TracesOf(const Scene& scene, const InternalForces& forces,
                         const DegreesOfFreedom& dofs) {
  if (scene.mesh.NumElements() <= kMostElementsForExactTraces) {
    return StiffnessTraces(scene.mesh, forces, dofs);
  }
  Eigen::MatrixXd probes;
  ResizeInLargePages(dofs.NumAll(), kNumTraceProbes, probes);
  SetTraceProbes(scene.supports.held, probes);
  return EstimateStiffnessTraces(dofs, forces.Products(probes));
}

// Calls add(dA / dtheta_k) for each modulus, where A(theta) is a matrix that
// grows as a factor on all moduli: linear, or else by central differences.
template <class Function, class Adder>
void VisitDerivatives(const Eigen::VectorXd& moduli, bool is_linear,
                      const Function& matrix_at, const Adder& add) {
  constexpr double kStep = 1e-4;
  const double step = kStep * moduli.norm();
  for (Eigen::Index k = 0; k < moduli.size(); ++k) {
    const Eigen::VectorXd unit = Eigen::VectorXd::Unit(moduli.size(), k);
    add(is_linear ? matrix_at(unit)
                  : Eigen::MatrixXd((matrix_at(moduli + step * unit) -
                                     matrix_at(moduli - step * unit)) /
                                    (2 * step)));
  }
}

// T of one load case at its displacement.
Eigen::MatrixXd LargeTracesOf(const Scene& scene, const ForceScene& prepared,
                              const Eigen::VectorXd& moduli,
                              const Eigen::VectorXd& displacement) {
  const LargeStrainForces& forces = *prepared.LargeForces();
  const bool is_linear = !prepared.AreNonlinearInModuli();
  std::vector<Eigen::MatrixXd> of_moduli;
  const auto add = [&](const Eigen::MatrixXd& of_modulus) {
    of_moduli.push_back(of_modulus);
  };
  if (scene.mesh.NumElements() <= kMostElementsForExactTraces) {
    const NodeGraph graph(scene.mesh);
    const auto blocks_at = [&](const Eigen::VectorXd& theta) {
      return forces.TangentBlocks(theta, displacement, graph);
    };
    VisitDerivatives(moduli, is_linear, blocks_at, add);
    return StiffnessTraces(graph, prepared.Dofs(), std::move(of_moduli));
  }
  Eigen::MatrixXd probes(prepared.Dofs().NumAll(), kNumTraceProbes);
  SetTraceProbes(scene.supports.held, probes);
  const auto products_at = [&](const Eigen::VectorXd& theta) {
    return forces.TangentProducts(theta, displacement, probes);
  };
  VisitDerivatives(moduli, is_linear, products_at, add);
  return EstimateStiffnessTraces(prepared.Dofs(), of_moduli);
}

// What each modulus of a law adds to its stiffness: the first one for small
// strains, and the shear modulus at rest for large ones.
Eigen::VectorXd StiffnessWeightsOf(const Law& law) {
  const Eigen::Index m = law.NumModuli();
  Eigen::VectorXd weights = Eigen::VectorXd::Unit(m, 0);
  if (law.ForLargeStrains() != nullptr) {
    for (Eigen::Index k = 0; k < m; ++k) {
      weights(k) = LameModuliAtRest(law, Eigen::VectorXd::Unit(m, k))(0);
    }
  }
  return weights;
}

Eigen::VectorXd WeightsOf(const Scene& scene,
                          const MaterialParameters& parameters) {
  if (parameters.NumMaterials() == 1) {
    return StiffnessWeightsOf(parameters.LawOf(0));
  }
  const std::vector<int> material_of =
      MaterialOfElements(scene.materials, scene.mesh);
  const Eigen::VectorXd volumes = ElementVolumes(scene.mesh);
  Eigen::VectorXd volume_of =
      Eigen::VectorXd::Zero(Eigen::Index(parameters.NumMaterials()));
  for (Eigen::Index e = 0; e < volumes.size(); ++e) {
    volume_of(material_of[e]) += volumes(e);
  }
  Eigen::VectorXd weights(parameters.NumModuli());
  for (std::size_t i = 0; i < parameters.NumMaterials(); ++i) {
    const Law& law = parameters.LawOf(i);
    weights.segment(parameters.FirstModulus(i), law.NumModuli()) =
        volume_of(Eigen::Index(i)) * StiffnessWeightsOf(law);
  }
  return weights / volumes.sum();
}

// All load cases are taken at once, each divided by its noise_sd where that is
// given, so that the noise of the weighted displacements has standard deviation
// 1: measured displacements where the supports leave the nodes free, given ones
// where they hold them, and the loads, num_dofs x num_load_cases each.

Eigen::MatrixXd WeightedDisplacements(const Scene& scene) {
  const Supports& supports = scene.supports;
  Eigen::MatrixXd q;
  ResizeInLargePages(scene.mesh.NumDofs(),
                     Eigen::Index(scene.load_cases.size()), q);
  for (Eigen::Index k = 0; k < q.cols(); ++k) {
    const LoadCase& load_case = scene.load_cases[k];
    q.col(k).reshaped(supports.held.rows(), scene.mesh.NumNodes()) =
        1 / load_case.noise_sd.value_or(1) *
        supports.held.select(supports.displacement, load_case.displacement);
  }
  return q;
}

Eigen::MatrixXd WeightedLoads(const Scene& scene) {
  Eigen::MatrixXd f;
  ResizeInLargePages(scene.mesh.NumDofs(),
                     Eigen::Index(scene.load_cases.size()), f);
  AssembleLoadCases(scene, f);
  for (Eigen::Index k = 0; k < f.cols(); ++k) {
    f.col(k) *= 1 / scene.load_cases[k].noise_sd.value_or(1);
  }
  return f;
}

void RequireNoInvertedElement(const LargeStrainForces& forces,
                              const Eigen::VectorXd& displacement,
                              std::size_t load_case) {
  const VolumeRatio smallest = forces.SmallestVolumeRatio(displacement);
  if (!(smallest.value > 0)) {
    throw std::invalid_argument(
        "the measured displacements of load case " +
        std::to_string(load_case + 1) + " turn element " +
        std::to_string(smallest.element) +
        " inside out (its volume ratio falls to " + TwoDigits(smallest.value) +
        "), where laws of large strains have no forces; correct the "
        "displacements of its nodes, measure them with less noise, or make the "
        "mesh coarser");
  }
}

}  // namespace

ForceScene::ForceScene(const Scene& scene)
    : dofs_(scene.supports), loads_(WeightedLoads(scene)) {
  SetHeldRowsToZero(dofs_, loads_);
  if (HasLargeStrainLaw(scene.materials)) {
    large_forces_ =
        std::make_unique<LargeStrainForces>(scene.mesh, scene.materials);
    weights_ = WeightsOf(scene, large_forces_->Parameters());
    return;
  }
  forces_ = std::make_unique<InternalForces>(scene.mesh, scene.materials);
  traces_ = double(scene.load_cases.size()) * TracesOf(scene, *forces_, dofs_);
  weights_ = WeightsOf(scene, forces_->Parameters());
}

ForceResidual::ForceResidual(const ForceScene& prepared, const Scene& scene,
                             const Eigen::VectorXd& moduli)
    : prepared_(prepared),
      num_equations_(
          double(prepared.Dofs().NumFree() * prepared.Loads().cols())) {
  Eigen::MatrixXd q = WeightedDisplacements(scene);
  work_.element_passes = 2;
  if (prepared.LargeForces() != nullptr) {
    SetLargeStrains(scene, q, moduli);
  } else {
    products_ = prepared.Forces().Products(q);
  }
  SetHeldRowsToZero(prepared.Dofs(), q);
  displacement_norm_ = Norm(q);
  const auto m = Eigen::Index(products_.size());
  RowBlockQr qr(m + 1);
  for (Eigen::Index k = 0; k < prepared.Loads().cols(); ++k) {
    for (const Eigen::Index dof : prepared.Dofs().free) {
      auto row = qr.NextRow();
      for (Eigen::Index i = 0; i < m; ++i) {
        row(i) = products_[i](dof, k);
      }
      row(m) = NodalLoads()(dof, k);
    }
  }
  const Eigen::MatrixXd triangle = qr.Triangle();
  columns_ = triangle.leftCols(m);
  loads_ = triangle.col(m);
}

void ForceResidual::SetLargeStrains(const Scene& scene,
                                    const Eigen::MatrixXd& q,
                                    const Eigen::VectorXd& moduli) {
  const LargeStrainForces& forces = *prepared_.LargeForces();
  const Eigen::Index m = forces.Parameters().NumModuli();
  const Eigen::VectorXd at =
      moduli.size() > 0 ? moduli : Eigen::VectorXd::Ones(m);
  large_displacements_ = q;
  products_.assign(m, Eigen::MatrixXd(q.rows(), q.cols()));
  traces_ = Eigen::MatrixXd::Zero(m, m);
  nodal_loads_ = prepared_.Loads();
  for (Eigen::Index k = 0; k < q.cols(); ++k) {
    const double noise_sd = scene.load_cases[k].noise_sd.value_or(1);
    large_displacements_.col(k) *= noise_sd;
    RequireNoInvertedElement(forces, large_displacements_.col(k), k);
    const Eigen::MatrixXd columns =
        forces.ModuliDerivatives(at, large_displacements_.col(k)) / noise_sd;
    for (Eigen::Index i = 0; i < m; ++i) {
      products_[i].col(k) = columns.col(i);
    }
    traces_ += LargeTracesOf(scene, prepared_, at, large_displacements_.col(k));
    // The loads of the scene have the pressures on the undeformed surface.
    const FollowerPressure pressure(scene.mesh, scene.load_cases[k].loads);
    nodal_loads_.col(k) += (pressure.Forces(large_displacements_.col(k)) -
                            pressure.Forces(Eigen::VectorXd::Zero(q.rows()))) /
                           noise_sd;
  }
  SetHeldRowsToZero(prepared_.Dofs(), nodal_loads_);
  work_.element_passes = int(q.cols() * (1 + m));
}

Eigen::MatrixXd ForceResidual::Stiffen(const Eigen::VectorXd& moduli,
                                       const Eigen::MatrixXd& x) const {
  if (prepared_.LargeForces() == nullptr) {
    return prepared_.Forces().Multiply(moduli, x);
  }
  const Eigen::Index num_cases = large_displacements_.cols();
  Eigen::MatrixXd stiffened(x.rows(), x.cols());
  for (Eigen::Index k = 0; k < num_cases; ++k) {
    const auto of_case = Eigen::seqN(k, x.cols() / num_cases, num_cases);
    stiffened(Eigen::all, of_case) = prepared_.LargeForces()->TangentProducts(
        moduli, large_displacements_.col(k), x(Eigen::all, of_case));
  }
  return stiffened;
}

Eigen::MatrixXd ForceResidual::StiffenedGram(
    const Eigen::VectorXd& moduli, const Eigen::MatrixXd& combinations) {
  const auto m = Eigen::Index(products_.size());
  const Eigen::Index num_cases = prepared_.Loads().cols();
  const Eigen::Index n = combinations.cols();
  Eigen::MatrixXd x;
  ResizeInLargePages(prepared_.Dofs().NumAll(), n * num_cases, x);
  for (Eigen::Index i = 0; i < n; ++i) {
    auto of_combination = x.middleCols(i * num_cases, num_cases);
    of_combination = combinations(m, i) * NodalLoads();
    for (Eigen::Index k = 0; k < m; ++k) {
      if (combinations(k, i) != 0) {
        of_combination += combinations(k, i) * products_[k];
      }
    }
  }
  SetHeldRowsToZero(prepared_.Dofs(), x);
  Eigen::MatrixXd stiffened = Stiffen(moduli, x);
  work_.element_passes +=
      prepared_.LargeForces() != nullptr ? int(num_cases) : 1;
  SetHeldRowsToZero(prepared_.Dofs(), stiffened);
  Eigen::MatrixXd gram(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) {
      gram(i, j) = InnerProduct(
          stiffened.middleCols(i * num_cases, num_cases).reshaped(),
          stiffened.middleCols(j * num_cases, num_cases).reshaped());
      gram(j, i) = gram(i, j);
    }
  }
  return gram;
}

}  // namespace elastimate
