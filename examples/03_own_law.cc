// A law of elasticity that the library does not have: cork, which does not get
// thicker where it is pressed.  Checks it, registers it, and finds its modulus
// from displacements.
//
//            z
//         |  |  |  |  a pressure of 100 Pa on the top, z = 0.2 m
//        +v--v--v--v+
//       /          /|
//      +----------+ |  a block of one hexahedron
//      |          | +
//      |          |/
//   ///+----------+///  the bottom, z = 0, is glued to the table

#include <elastimate/core/equilibrium/simulated_measurement.h>
#include <elastimate/core/materials/law_check.h>
#include <elastimate/core/materials/laws.h>
#include <elastimate/core/scene/scene_builder.h>
#include <elastimate/estimators/registry.h>

#include <iostream>
#include <memory>

namespace {

using elastimate::ElementKind;
using elastimate::Scene;
using elastimate::SectionModel;

// 1. The law: isotropic elasticity with nu = 0, the stress of which is
//
//   P = E e,   e = sym(H),   W = E e:e / 2,
//
// so that there is one modulus, theta = (E), and one parameter, E.
class Cork : public elastimate::Law {
 public:
  std::string_view Name() const override { return "cork"; }
  std::string_view Description() const override {
    return "an isotropic material with Poisson's ratio 0";
  }
  const std::vector<elastimate::LawParameter>& Parameters() const override {
    static const std::vector<elastimate::LawParameter> parameters = {
        {"youngs_modulus", "E", true, 1e-300, 1e300, 1}};
    return parameters;
  }
  int NumModuli() const override { return 1; }
  bool Takes(SectionModel /*model*/) const override { return true; }

  Eigen::VectorXd Energies(const Eigen::MatrixXd& gradient,
                           SectionModel /*model*/) const override {
    return Eigen::VectorXd::Constant(1, Strain(gradient).squaredNorm() / 2);
  }
  Eigen::MatrixXd Stresses(const Eigen::MatrixXd& gradient,
                           SectionModel /*model*/) const override {
    return Strain(gradient).reshaped();
  }
  Eigen::MatrixXd Tangent(const Eigen::VectorXd& moduli,
                          const Eigen::MatrixXd& gradient,
                          SectionModel /*model*/) const override {
    Eigen::MatrixXd tangent(gradient.size(), gradient.size());
    Eigen::MatrixXd unit = 0 * gradient;
    for (Eigen::Index i = 0; i < gradient.size(); ++i) {
      unit(i) = 1;
      tangent.col(i) = moduli(0) * Strain(unit).reshaped();
      unit(i) = 0;
    }
    return tangent;
  }

  Eigen::VectorXd Moduli(const Eigen::VectorXd& parameters,
                         SectionModel /*model*/) const override {
    return parameters;
  }
  Eigen::MatrixXd ModuliJacobian(const Eigen::VectorXd& /*parameters*/,
                                 SectionModel /*model*/) const override {
    return Eigen::MatrixXd::Ones(1, 1);
  }
  Eigen::VectorXd ParametersOf(const Eigen::VectorXd& moduli,
                               SectionModel /*model*/) const override {
    return moduli;
  }

 private:
  static Eigen::MatrixXd Strain(const Eigen::MatrixXd& gradient) {
    return (gradient + gradient.transpose()) / 2;
  }
};

Scene MakeScene() {
  const double coordinates[] = {0, 0,   0,   0.1, 0,   0, 0.1, 0.1,
                                0, 0,   0.1, 0,   0,   0, 0.2, 0.1,
                                0, 0.2, 0.1, 0.1, 0.2, 0, 0.1, 0.2};
  const int connectivity[] = {0, 1, 2, 3, 4, 5, 6, 7};
  Scene scene = elastimate::UnsupportedScene(elastimate::MakeMesh(
      ElementKind::kHex8, coordinates, 8, connectivity, 1));
  elastimate::HoldInBox(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0.1, 0.1, 0),
                        scene);
  elastimate::LoadCase load_case;
  load_case.loads = {elastimate::TractionInBox(
      scene.mesh, Eigen::Vector3d(0, 0, 0.2), Eigen::Vector3d(0.1, 0.1, 0.2),
      Eigen::Vector3d(0, 0, -100))};
  scene.load_cases = {load_case};
  return scene;
}

}  // namespace

int main() {
  // 2. The check, which names each thing that is wrong.
  for (const std::string& sentence : elastimate::CheckLaw(Cork())) {
    std::cerr << sentence << "\n";
  }
  // 3. From here on the name of the law is known.
  elastimate::RegisterLaw(std::make_shared<Cork>());

  // 4. A scene of that material, and a measurement of it by the library's own
  // model, with an error of a micrometre.
  Scene scene = MakeScene();
  elastimate::Material cork;
  cork.law = "cork";
  scene.materials = {cork};
  elastimate::MeasureMaterials(Eigen::VectorXd::Constant(1, 20e3), scene);
  scene.load_cases[0].noise_sd = 1e-6;
  scene.origin = elastimate::Origin::kComputed;

  // 5. The estimate.
  const elastimate::Estimate estimate =
      elastimate::MakeEstimator("iterative-fe")->Run(scene, {});
  if (!estimate.IsUsable()) {
    std::cerr << estimate.message << "\n";
    return 1;
  }
  const elastimate::ParameterEstimate& modulus = estimate.parameters[0];
  std::cout << modulus.Label() << " = " << modulus.value << " +- "
            << modulus.standard_error.value_or(0) << " Pa\n";
  return 0;
}
