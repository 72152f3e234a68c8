// An estimator that the library does not have, which is registered beside those
// that it has.

#include <elastimate/core/equilibrium/simulated_measurement.h>
#include <elastimate/core/mechanics/internal_forces.h>
#include <elastimate/core/scene/loads.h>
#include <elastimate/core/scene/scene_builder.h>
#include <elastimate/estimators/registry.h>

#include <iostream>
#include <memory>

namespace {

using elastimate::Capabilities;
using elastimate::Estimate;
using elastimate::EstimatorOptions;
using elastimate::Scene;

// 1. The estimator: E by the theorem of Clapeyron, for a known nu.  Loads f
// that grow from zero do the work f.u / 2, which the strain energy E U(u; nu)
// keeps:
//
//   E = sum f.u / (2 sum U(u; nu))   over the load cases.
//
// Supports do no work where they are held at zero.  Noise makes U too large and
// E too small.  Cost: one element pass for each load case.
class Clapeyron : public elastimate::Estimator {
 public:
  std::string_view Name() const override { return "clapeyron"; }
  std::string_view Description() const override {
    return "E by the theorem of Clapeyron, for a known Poisson's ratio";
  }
  // What the scene may have: see Capabilities.  Run refuses all else.
  Capabilities WhatItTakes() const override {
    Capabilities capabilities;
    capabilities.needs_all_displacements = true;
    return capabilities;
  }
  std::string WhyUnsupported(const Scene& scene,
                             const EstimatorOptions& options) const override {
    if (!options.known_poisson_ratio) {
      return "it needs a known Poisson's ratio; give known_poisson_ratio";
    }
    if (!scene.supports.held.select(scene.supports.displacement.array(), 0.0)
             .isZero(0)) {
      return "it takes supports that are held at zero; use reduced-fe";
    }
    return Estimator::WhyUnsupported(scene, options);
  }

 protected:
  Estimate DoRun(const Scene& scene,
                 const EstimatorOptions& options) const override {
    const double nu = *options.known_poisson_ratio;
    const Eigen::MatrixXd force = elastimate::AssembleLoadCases(scene);
    const elastimate::InternalForces internal(scene.mesh, scene.materials);
    const Eigen::VectorXd moduli =
        internal.Parameters().Moduli(Eigen::Vector2d(1, nu));
    double work = 0;
    double unit_energy = 0;
    for (Eigen::Index k = 0; k < force.cols(); ++k) {
      // Displacements of held components need not have been measured.
      const Eigen::MatrixXd displacement = scene.supports.held.select(
          0.0, scene.load_cases[k].displacement.array());
      work += force.col(k).dot(displacement.reshaped()) / 2;
      unit_energy +=
          displacement.reshaped().dot(
              internal.Multiply(moduli, displacement.reshaped()).reshaped()) /
          2;
    }
    Estimate estimate;
    estimate.elasticity = {work / unit_energy, nu};
    estimate.why_no_standard_error = "clapeyron does not look at the noise";
    estimate.Accept();  // Run looks whether it is finite and physical.
    return estimate;
  }
};

Scene MakeScene() {
  const double coordinates[] = {0, 0, 1, 0, 2, 0, 0, 1, 1, 1, 2, 1};
  const int connectivity[] = {0, 1, 4, 3, 1, 2, 5, 4};
  Scene scene = elastimate::UnsupportedScene(elastimate::MakeMesh(
      elastimate::ElementKind::kQuad4, coordinates, 6, connectivity, 2));
  elastimate::HoldInBox(Eigen::Vector2d(0, 0), Eigen::Vector2d(0, 1), scene);
  elastimate::LoadCase load_case;
  load_case.loads = {
      elastimate::TractionInBox(scene.mesh, Eigen::Vector2d(2, 0),
                                Eigen::Vector2d(2, 1), Eigen::Vector2d(1, 0))};
  scene.load_cases = {load_case};
  return scene;
}

}  // namespace

int main() {
  // 2. From here on the name of the estimator is known.
  elastimate::RegisterEstimator(std::make_shared<Clapeyron>());

  // 3. A plate of E = 500 and nu = 0.2, measured by the library's own model.
  Scene scene = MakeScene();
  elastimate::Measure({500, 0.2}, scene);

  // 4. The estimate.
  EstimatorOptions options;
  options.known_poisson_ratio = 0.2;
  const Estimate estimate =
      elastimate::MakeEstimator("clapeyron")->Run(scene, options);
  if (!estimate.IsUsable()) {
    std::cerr << estimate.message << "\n";
    return 1;
  }
  std::cout << "E = " << estimate.elasticity.youngs_modulus
            << ", without a standard error: " << estimate.why_no_standard_error
            << "\n";
  return 0;
}
