#include <limits>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "apps/commands.h"
#include "apps/element_order.h"
#include "apps/estimator_flags.h"
#include "apps/flags.h"
#include "apps/outputs.h"
#include "apps/progress.h"
#include "apps/section_flags.h"
#include "elastimate/core/equilibrium/equilibrium.h"
#include "elastimate/core/equilibrium/simulated_measurement.h"
#include "elastimate/core/mesh/representable.h"
#include "elastimate/core/scene/degrees_of_freedom.h"
#include "elastimate/core/scene/rigid_motion.h"
#include "elastimate/core/scene/unknown_motion.h"
#include "elastimate/io/report/parameters_file.h"
#include "elastimate/io/scene/scene_reader.h"
#include "elastimate/io/text/printable.h"
#include "elastimate/io/vtk/vtu_writer.h"

namespace elastimate {
namespace {

void CheckParameterFlags() {
  if (IsGiven("parameters")) {
    if (IsGiven("youngs") || IsGiven("nu")) {
      throw std::invalid_argument(AsGiven("parameters") + " is given beside " +
                                  AsGiven(IsGiven("youngs") ? "youngs" : "nu") +
                                  "; give one or the other");
    }
    return;
  }
  if (!IsGiven("youngs") || !IsGiven("nu")) {
    throw std::invalid_argument(
        "simulate needs --youngs=E and --nu=NU, or --parameters=FILE.json");
  }
  if (!(FLAGS_youngs > 0)) {
    throw std::invalid_argument(AsGiven("youngs") + "; it must be positive");
  }
  CheckPoissonRatioFlag();
}

// Of all materials of the scene: those of --parameters, or E and nu alike.
Eigen::VectorXd ParametersFromFlags(const Scene& scene) {
  if (IsGiven("parameters")) {
    return ReadParameters(FLAGS_parameters, scene);
  }
  const MaterialParameters parameters(scene.materials,
                                      scene.mesh.section.model);
  Eigen::VectorXd values(parameters.NumParameters());
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    values(i) =
        parameters.All()[i].law_parameter->is_modulus ? FLAGS_youngs : FLAGS_nu;
  }
  return values;
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

// At the nodes of the scene, which come first of those that are modelled:
// num_dofs x num_load_cases.
Eigen::MatrixXd Simulate(const std::string& source, const Scene& scene,
                         const Scene& modelled, SolverKind solver,
                         std::vector<std::string>& notices) {
  const Eigen::VectorXd values = ParametersFromFlags(modelled);
  Equilibrium model(modelled, solver);
  if (!model.Solve(model.Forces().Parameters().Moduli(values))) {
    throw std::invalid_argument(
        source +
        ": the stiffness matrix is singular to working precision; check the "
        "mesh for slivers and Poisson's ratio");
  }
  if (!model.Notice().empty()) {
    notices.push_back(model.Notice());
  }
  return model.Displacement().topRows(scene.mesh.NumDofs());
}

// Enters displacements with noise as the measurement.
void EnterMeasurement(const std::string& source, Eigen::MatrixXd displacement,
                      Scene& scene) {
  const DegreesOfFreedom dofs(scene.supports);
  const NoiseLaw law =
      FLAGS_noise_law == "uniform" ? NoiseLaw::kUniform : NoiseLaw::kGaussian;
  std::mt19937_64 generator(FLAGS_seed);
  for (Eigen::Index k = 0; k < displacement.cols(); ++k) {
    if (FLAGS_noise > 0) {
      const double norm =
          FLAGS_noise * dofs.Restrict(displacement.col(k)).norm();
      displacement.col(k) +=
          dofs.Extend(DrawNoise(law, dofs.NumFree(), norm, generator));
    }
    scene.load_cases[k].displacement = displacement.col(k).reshaped(
        scene.mesh.Dimension(), scene.mesh.NumNodes());
  }
  try {
    RequireRepresentable(displacement.allFinite()
                             ? displacement.cwiseAbs().maxCoeff()
                             : std::numeric_limits<double>::infinity(),
                         "the simulated displacement");
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(source + ": " + error.what());
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
  CheckParameterFlags();
  CheckNoiseFlags();
  const SolverKind solver = SolverFromFlag();
  ApplyComputingFlags();
  CheckOutputFlags(arguments);
  const std::string source = PrintablePath(arguments[0]);
  std::optional<Progress> progress("reading " + source);
  SceneReading reading = ReadScene({arguments[0]}, Measurement::kOptional,
                                   SectionFromFlags(), RegionsFromFlag());
  Scene& scene = reading.scene;

  progress->Show("factorising");
  const std::string why_not_held = WhyNotHeld(scene.mesh, scene.supports);
  if (!why_not_held.empty()) {
    throw std::invalid_argument(source + ": " + why_not_held);
  }
  if (HasUnknownMotion(scene)) {
    throw std::invalid_argument(
        source +
        ": simulate has to know how supports moved; give their "
        "\"displacement\" "
        "as a vector, and leave out resultants and \"rigid_motion\"");
  }
  const std::optional<Scene> quadratic =
      QuadraticSceneIfAsked(source, scene, reading.notices);
  EnterMeasurement(source,
                   Simulate(source, scene, quadratic ? *quadratic : scene,
                            solver, reading.notices),
                   scene);
  if (quadratic && !HasNodalForcesOnly(scene)) {
    reading.notices.push_back(
        PrintablePath(FLAGS_out) +
        " has the loads as nodal forces of linear elements; to estimate with "
        "--order=2, use a scene.json with the loads of " +
        source + " and the displacement of " + PrintablePath(FLAGS_out));
  }
  progress->Show("writing " + PrintablePath(FLAGS_out));
  WriteVtu(FLAGS_out, scene.mesh, SceneFields(scene), reading.file_order);
  progress.reset();
  PrintNotices(reading.notices);
  return 0;
}

}  // namespace elastimate
