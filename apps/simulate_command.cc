#include <algorithm>
#include <iomanip>
#include <limits>
#include <optional>
#include <random>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "apps/commands.h"
#include "apps/element_order.h"
#include "apps/error_flags.h"
#include "apps/estimator_flags.h"
#include "apps/flags.h"
#include "apps/material_flags.h"
#include "apps/number_list.h"
#include "apps/outputs.h"
#include "apps/parameter_flags.h"
#include "apps/progress.h"
#include "apps/section_flags.h"
#include "elastimate/core/equilibrium/equilibrium.h"
#include "elastimate/core/equilibrium/large_strain_equilibrium.h"
#include "elastimate/core/equilibrium/simulated_measurement.h"
#include "elastimate/core/materials/material_parameters.h"
#include "elastimate/core/mesh/mesh_points.h"
#include "elastimate/core/mesh/representable.h"
#include "elastimate/core/scene/degrees_of_freedom.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/core/scene/rigid_motion.h"
#include "elastimate/core/scene/unknown_motion.h"
#include "elastimate/io/points/points_file.h"
#include "elastimate/io/scene/scene_reader.h"
#include "elastimate/io/text/file_output.h"
#include "elastimate/io/text/printable.h"
#include "elastimate/io/vtk/vtu_writer.h"

namespace elastimate {
namespace {

// Tells whether the measurement is written as a table of points rather than a
// scene.
bool WritesTable() { return HasExtension(FLAGS_out, ".csv"); }

// Returns the value of --points, which is given.
int NumPointsFromFlag() {
  return NumberList<Eigen::Matrix<int, 1, 1>>("points", FLAGS_points,
                                              "integer from 1 to 10000000")(0);
}

void CheckPointsFlag() {
  constexpr int kMostPoints = 10000000;
  if (!IsGiven("points")) {
    return;
  }
  if (const int count = NumPointsFromFlag(); count < 1 || count > kMostPoints) {
    throw std::invalid_argument(AsGiven("points") + "; it must be from 1 to " +
                                std::to_string(kMostPoints));
  }
  if (!WritesTable()) {
    throw std::invalid_argument(
        AsGiven("points") +
        "; points are written as a table, so give --out=FILE.csv");
  }
}

/// The equilibrium of each load case: num_dofs of the modelled scene x
/// num_load_cases.
struct Solution {
  Eigen::MatrixXd displacement;
  /// These are zero where nothing is held, and empty where nothing is held away
  /// from zero.
  Eigen::MatrixXd support_forces;
};

ComponentMask Displaced(const Supports& supports) {
  return supports.held && supports.displacement.array() != 0.0;
}

bool IsAnyDisplaced(const Scene& scene) {
  bool is_any_displaced = false;
  for (Eigen::Index k = 0; k < Eigen::Index(scene.load_cases.size()); ++k) {
    is_any_displaced =
        is_any_displaced || Displaced(SupportsOf(scene, k)).any();
  }
  return is_any_displaced;
}

Solution SolveLargeStrains(const std::string& source, const Scene& modelled,
                           SolverKind solver, Progress& progress) {
  if (solver == SolverKind::kMultigrid) {
    throw std::invalid_argument(
        "--solver=multigrid cannot tell whether an equilibrium of large "
        "strains is stable; give --solver=cholesky, or leave it out");
  }
  const Eigen::VectorXd values = ParametersFromFlags(modelled);
  LargeStrainEquilibrium model(modelled);
  const Eigen::VectorXd moduli = model.Forces().Parameters().Moduli(values);
  const LargeStrainSolution solution =
      SolveLoadCases(moduli, model, [&progress](const std::string& load_case) {
        progress.Show("searching the equilibrium of " + load_case);
      });
  if (!solution.why_not.empty()) {
    throw std::invalid_argument(source + ": " + solution.why_not);
  }
  return {solution.displacement, IsAnyDisplaced(modelled)
                                     ? OfHeld(modelled, solution.imbalance)
                                     : Eigen::MatrixXd()};
}

/// Solves in the last of some spaces, which go from coarse to fine.
Solution Solve(const std::string& source,
               const std::vector<const Scene*>& spaces, SolverKind solver,
               Progress& progress, std::vector<std::string>& notices) {
  const Scene& modelled = *spaces.back();
  progress.Show("factorising");
  if (HasLargeStrainLaw(modelled.materials)) {
    return SolveLargeStrains(source, modelled, solver, progress);
  }
  const Eigen::VectorXd values = ParametersFromFlags(modelled);
  Equilibrium model(spaces, solver);
  const Eigen::VectorXd moduli = model.Forces().Parameters().Moduli(values);
  if (!model.Solve(moduli)) {
    throw std::invalid_argument(
        source +
        ": the stiffness matrix is singular to working precision; check the "
        "mesh for flat elements, and Poisson's ratio");
  }
  if (!model.Notice().empty()) {
    notices.push_back(model.Notice());
  }
  if (!IsAnyDisplaced(modelled)) {
    return {model.Displacement(), {}};
  }
  const Eigen::MatrixXd residual =
      model.Forces().Multiply(moduli, model.Displacement()) -
      AssembleLoadCases(modelled);
  return {model.Displacement(), OfHeld(modelled, residual)};
}

/// Returns what a load cell would show, with a line for each load case where
/// supports are held away from zero.
std::string ForcesOfDisplacedSupports(const Scene& modelled,
                                      const Solution& solution) {
  std::ostringstream text;
  text << std::setprecision(10);
  for (Eigen::Index k = 0; k < solution.support_forces.cols(); ++k) {
    const ComponentMask displaced = Displaced(SupportsOf(modelled, k));
    if (!displaced.any()) {
      continue;
    }
    const Eigen::MatrixXd forces = solution.support_forces.col(k).reshaped(
        displaced.rows(), displaced.cols());
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(forces.rows());
    for (Eigen::Index node = 0; node < forces.cols(); ++node) {
      if (displaced.col(node).any()) {
        sum += forces.col(node);
      }
    }
    text << "load case " << k + 1 << ": force of the displaced supports ";
    for (Eigen::Index i = 0; i < sum.size(); ++i) {
      text << (i == 0 ? "(" : ", ") << sum(i);
    }
    text << ")\n";
  }
  return text.str();
}

/// Adds errors to what is measured at some positions.
void Disturb(const std::string& source, const MeasurementErrors& errors,
             const Eigen::MatrixXd& positions, const ComponentMask& held,
             std::mt19937_64& generator, Eigen::MatrixXd& displacement) {
  try {
    AddErrors(errors, positions, held, generator, displacement);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(std::string("--") + error.what());
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

/// Returns the scene with the displacement of its nodes as the measurement.
/// The nodes come first among those that are modelled.
std::string MeasuredScene(const std::string& source,
                          const MeasurementErrors& errors,
                          const Solution& solution, SceneReading& reading) {
  Scene& scene = reading.scene;
  const Mesh& mesh = scene.mesh;
  std::mt19937_64 generator(FLAGS_seed);
  for (std::size_t k = 0; k < scene.load_cases.size(); ++k) {
    Eigen::MatrixXd displacement =
        solution.displacement.col(Eigen::Index(k))
            .head(mesh.NumDofs())
            .reshaped(mesh.Dimension(), mesh.NumNodes());
    Disturb(source, errors, mesh.nodes, SupportsOf(scene, Eigen::Index(k)).held,
            generator, displacement);
    scene.load_cases[k].displacement = displacement;
  }
  // A finite rotation has to be treated as that of a camera.
  const bool is_of_this_mesh =
      std::max<int>(FLAGS_order, mesh.Order()) == mesh.Order() &&
      errors.rigid_motion.size() == 0;
  scene.origin = !is_of_this_mesh ? Origin::kMeasured
                 : HasLargeStrainLaw(scene.materials)
                     ? Origin::kComputedAtLargeStrains
                     : Origin::kComputed;
  Fields fields = SceneFields(scene);
  for (const auto& [name, axes] : reading.axis_arrays) {
    fields.cell.push_back({name, axes});
  }
  return VtuContent(FLAGS_out, mesh, fields, reading.file_order);
}

/// Returns the table of --points random points, or of all nodes of the scene in
/// the order of the file.  To a camera, points on supports are like others.
std::string MeasuredPoints(const std::string& source,
                           const MeasurementErrors& errors,
                           const Solution& solution,
                           const std::vector<int>& file_order,
                           const Scene& scene, const Scene& modelled) {
  if (scene.load_cases.size() != 1) {
    throw std::invalid_argument(
        "--out=" + PrintablePath(FLAGS_out) + ": " + source + " has " +
        std::to_string(scene.load_cases.size()) +
        " load cases, and a table holds only one; give --out=FILE.vtu, or make "
        "a scene of each load case");
  }
  const Mesh& mesh = modelled.mesh;
  std::mt19937_64 generator(FLAGS_seed);
  Eigen::MatrixXd positions = scene.mesh.nodes;
  Eigen::MatrixXd displacement =
      solution.displacement.reshaped(mesh.Dimension(), mesh.NumNodes())
          .leftCols(scene.mesh.NumNodes());
  if (IsGiven("points")) {
    const MeshPoints points = DrawPoints(mesh, NumPointsFromFlag(), generator);
    positions = Interpolate(mesh, points, mesh.nodes);
    displacement = Interpolate(
        mesh, points,
        solution.displacement.reshaped(mesh.Dimension(), mesh.NumNodes()));
  } else if (!file_order.empty()) {
    positions = positions(Eigen::all, file_order).eval();
    displacement = displacement(Eigen::all, file_order).eval();
  }
  const ComponentMask held =
      ComponentMask::Constant(positions.rows(), positions.cols(), false);
  Disturb(source, errors, positions, held, generator, displacement);
  return PointsContent(positions, displacement);
}

void RequireKnownSupports(const std::string& source, const Scene& scene) {
  const std::string why_not_held = WhyNotHeld(scene);
  if (!why_not_held.empty()) {
    throw std::invalid_argument(source + ": " + why_not_held);
  }
  if (HasUnknownMotion(scene)) {
    throw std::invalid_argument(
        source +
        ": simulate needs supports whose displacement is known; give their "
        "\"displacement\" as a vector, and leave out loads of type "
        "\"resultant\" and the key \"rigid_motion\"");
  }
}

// Checks what can be checked before any work is done.
MeasurementErrors ErrorsFromCheckedFlags(
    const std::vector<std::string>& arguments) {
  if (arguments.size() != 1) {
    throw std::invalid_argument("simulate needs one scene file" +
                                ButGot(arguments));
  }
  if (FLAGS_out.empty()) {
    throw std::invalid_argument(
        "simulate needs a file to write; give --out=FILE.vtu, or "
        "--out=FILE.csv for a table of points");
  }
  if (!AreParametersGiven()) {
    throw std::invalid_argument(
        "simulate needs the parameters of the material; give --youngs=E and "
        "--nu=NU, or --parameters=FILE.json");
  }
  CheckParameterFlags();
  CheckNoMerging();
  MeasurementErrors errors = ErrorsFromFlags();
  CheckPointsFlag();
  return errors;
}

}  // namespace

int RunSimulate(const std::vector<std::string>& arguments) {
  MeasurementErrors errors = ErrorsFromCheckedFlags(arguments);
  const SolverKind solver = SolverFromFlag();
  ApplyComputingFlags();
  CheckOutputFlags(arguments, OutFormats::kVtuOrTable);
  const std::string source = PrintablePath(arguments[0]);
  std::optional<Progress> progress("reading " + source);
  SceneReading reading =
      ReadScene({arguments[0]}, Measurement::kOptional,
                {SectionFromFlags(), RegionsFromFlag(), LawFromFlags()});
  Scene& scene = reading.scene;
  errors.rigid_motion = RigidMotionFromFlag(scene.mesh.Dimension());

  RequireKnownSupports(source, scene);
  const std::optional<Scene> quadratic =
      QuadraticSceneIfAsked(source, scene, reading.notices);
  std::vector<const Scene*> spaces = {&scene};
  if (quadratic) {
    spaces.push_back(&*quadratic);
  }
  const Scene& modelled = *spaces.back();
  const Solution solution =
      Solve(source, spaces, solver, *progress, reading.notices);
  const std::string forces = ForcesOfDisplacedSupports(modelled, solution);
  if (quadratic && !HasNodalForcesOnly(scene) && !WritesTable()) {
    reading.notices.push_back(
        PrintablePath(FLAGS_out) +
        " holds the loads as nodal forces of linear elements; for an estimate "
        "with --order=2, write a scene.json with the loads of " +
        source + " and the displacement of " + PrintablePath(FLAGS_out));
  }
  progress->Show("writing " + PrintablePath(FLAGS_out));
  StagedFiles files;
  files.Add(FLAGS_out, WritesTable()
                           ? MeasuredPoints(source, errors, solution,
                                            reading.file_order, scene, modelled)
                           : MeasuredScene(source, errors, solution, reading));
  progress.reset();
  WriteStandardOutput(forces);
  files.Commit();
  PrintNotices(reading.notices);
  return 0;
}

}  // namespace elastimate
