#include <limits>
#include <optional>
#include <random>
#include <stdexcept>

#include "apps/commands.h"
#include "apps/element_order.h"
#include "apps/estimator_flags.h"
#include "apps/flags.h"
#include "apps/outputs.h"
#include "apps/progress.h"
#include "apps/section_flags.h"
#include "elastimate/core/equilibrium/forward_model.h"
#include "elastimate/core/equilibrium/simulated_measurement.h"
#include "elastimate/core/mesh/representable.h"
#include "elastimate/core/scene/degrees_of_freedom.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/core/scene/rigid_motion.h"
#include "elastimate/io/scene/scene_reader.h"
#include "elastimate/io/text/printable.h"
#include "elastimate/io/vtk/vtu_writer.h"

namespace elastimate {
namespace {

IsotropicElasticity ElasticityFromFlags() {
  if (!IsGiven("youngs") || !IsGiven("nu")) {
    throw std::invalid_argument("simulate needs --youngs=E and --nu=NU");
  }
  if (!(FLAGS_youngs > 0)) {
    throw std::invalid_argument(AsGiven("youngs") + "; it must be positive");
  }
  CheckPoissonRatioFlag();
  return {FLAGS_youngs, FLAGS_nu};
}

void CheckNoiseFlags() {
  if (FLAGS_noise < 0) {
    throw std::invalid_argument(AsGiven("noise") + "; it must not be negative");
  }
  if (FLAGS_noise_law != "uniform" && FLAGS_noise_law != "gaussian") {
    throw std::invalid_argument(AsGiven("noise_law") +
                                "; it is uniform or gaussian");
  }
}

}  // namespace

int RunSimulate(const std::vector<std::string>& arguments) {
  if (arguments.size() != 1) {
    throw std::invalid_argument("simulate needs one scene file" +
                                ButGot(arguments));
  }
  if (FLAGS_out.empty()) {
    throw std::invalid_argument("simulate needs --out=FILE.vtu");
  }
  const IsotropicElasticity elasticity = ElasticityFromFlags();
  CheckNoiseFlags();
  const SolverKind solver = SolverFromFlag();
  ApplyComputingFlags();
  CheckOutputFlags(arguments);
  std::optional<Progress> progress("reading " + PrintablePath(arguments[0]));
  SceneReading reading =
      ReadScene({arguments[0]}, Measurement::kOptional, SectionFromFlags());
  Scene& scene = reading.scene;

  progress->Show("factorising");
  const std::string why_not_held = WhyNotHeld(scene.mesh, scene.supports);
  if (!why_not_held.empty()) {
    throw std::invalid_argument(PrintablePath(arguments[0]) + ": " +
                                why_not_held);
  }
  const std::optional<Scene> quadratic = QuadraticSceneIfAsked(
      PrintablePath(arguments[0]), scene, reading.notices);
  const Scene& modelled = quadratic ? *quadratic : scene;
  ForwardModel model(modelled.mesh, modelled.supports,
                     AssembleLoadCases(modelled), solver);
  if (!model.SetPoissonRatio(elasticity.poisson_ratio)) {
    throw std::invalid_argument(
        PrintablePath(arguments[0]) +
        ": the stiffness matrix is singular to working precision; check the "
        "mesh for slivers and --nu");
  }
  // At the nodes of the scene, which come first: what is measured and written.
  Eigen::MatrixXd displacement = model.Displacement(elasticity.youngs_modulus)
                                     .topRows(scene.mesh.NumDofs());
  const DegreesOfFreedom dofs(scene.supports);
  const NoiseLaw law =
      FLAGS_noise_law == "uniform" ? NoiseLaw::kUniform : NoiseLaw::kGaussian;
  std::mt19937_64 generator(FLAGS_seed);
  for (Eigen::Index k = 0; k < displacement.cols(); ++k) {
    LoadCase& load_case = scene.load_cases[k];
    if (FLAGS_noise > 0) {
      const double norm =
          FLAGS_noise * dofs.Restrict(displacement.col(k)).norm();
      displacement.col(k) +=
          dofs.Extend(DrawNoise(law, dofs.NumFree(), norm, generator));
    }
    load_case.displacement = displacement.col(k).reshaped(
        scene.mesh.Dimension(), scene.mesh.NumNodes());
  }
  try {
    RequireRepresentable(displacement.allFinite()
                             ? displacement.cwiseAbs().maxCoeff()
                             : std::numeric_limits<double>::infinity(),
                         "the simulated displacement");
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(PrintablePath(arguments[0]) + ": " +
                                error.what());
  }
  if (quadratic && !HasNodalForcesOnly(scene)) {
    reading.notices.push_back(
        PrintablePath(FLAGS_out) +
        " has the loads as nodal forces of linear elements; to estimate with "
        "--order=2, use a scene.json with the loads of " +
        PrintablePath(arguments[0]) + " and the displacement of " +
        PrintablePath(FLAGS_out));
  }
  progress->Show("writing " + PrintablePath(FLAGS_out));
  WriteVtu(FLAGS_out, scene.mesh, SceneFields(scene), reading.file_order);
  progress.reset();
  if (!model.Notice().empty()) {
    reading.notices.push_back(model.Notice());
  }
  PrintNotices(reading.notices);
  return 0;
}

}  // namespace elastimate
