#include "elastimate/estimators/force_balance/force_residual.h"

#include "elastimate/core/algebra/large_pages.h"
#include "elastimate/core/algebra/node_sums.h"
#include "elastimate/core/algebra/row_block_qr.h"
#include "elastimate/core/materials/material.h"
#include "elastimate/core/mechanics/stiffness_traces.h"
#include "elastimate/core/scene/loads.h"

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

Eigen::VectorXd WeightsOf(const Scene& scene,
                          const MaterialParameters& parameters) {
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(parameters.NumModuli());
  if (parameters.NumMaterials() == 1) {
    weights(0) = 1;
    return weights;
  }
  const std::vector<int> material_of =
      MaterialOfElements(scene.materials, scene.mesh);
  const Eigen::VectorXd volumes = ElementVolumes(scene.mesh);
  for (Eigen::Index e = 0; e < volumes.size(); ++e) {
    weights(parameters.FirstModulus(std::size_t(material_of[e]))) += volumes(e);
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

}  // namespace

ForceScene::ForceScene(const Scene& scene)
    : forces_(scene.mesh, scene.materials),
      dofs_(scene.supports),
      loads_(WeightedLoads(scene)),
      traces_(double(scene.load_cases.size()) *
              TracesOf(scene, forces_, dofs_)),
      weights_(WeightsOf(scene, forces_.Parameters())) {
  SetHeldRowsToZero(dofs_, loads_);
}

ForceResidual::ForceResidual(const ForceScene& prepared, const Scene& scene)
    : prepared_(prepared),
      num_equations_(
          double(prepared.Dofs().NumFree() * prepared.Loads().cols())) {
  Eigen::MatrixXd q = WeightedDisplacements(scene);
  products_ = prepared.Forces().Products(q);
  SetHeldRowsToZero(prepared.Dofs(), q);
  displacement_norm_ = Norm(q);
  work_.element_passes = 2;
  const auto m = Eigen::Index(products_.size());
  RowBlockQr qr(m + 1);
  for (Eigen::Index k = 0; k < prepared.Loads().cols(); ++k) {
    for (const Eigen::Index dof : prepared.Dofs().free) {
      auto row = qr.NextRow();
      for (Eigen::Index i = 0; i < m; ++i) {
        row(i) = products_[i](dof, k);
      }
      row(m) = prepared.Loads()(dof, k);
    }
  }
  const Eigen::MatrixXd triangle = qr.Triangle();
  columns_ = triangle.leftCols(m);
  loads_ = triangle.col(m);
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
    of_combination = combinations(m, i) * prepared_.Loads();
    for (Eigen::Index k = 0; k < m; ++k) {
      if (combinations(k, i) != 0) {
        of_combination += combinations(k, i) * products_[k];
      }
    }
  }
  SetHeldRowsToZero(prepared_.Dofs(), x);
  Eigen::MatrixXd stiffened = prepared_.Forces().Multiply(moduli, x);
  ++work_.element_passes;
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
