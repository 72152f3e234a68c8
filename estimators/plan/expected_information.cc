#include "elastimate/estimators/plan/expected_information.h"

#include <cmath>
#include <optional>
#include <stdexcept>

#include "elastimate/core/equilibrium/equilibrium.h"
#include "elastimate/core/scene/observed_displacements.h"
#include "elastimate/core/scene/unknown_motion.h"
#include "elastimate/estimators/misfit/motion_elimination.h"
#include "elastimate/estimators/plan/expected_errors.h"

namespace elastimate {
namespace {

// Displacements of the model where a load case has none, and from
// `first_planned` on.
void MeasureByModel(const Eigen::MatrixXd& displacement,
                    std::size_t first_planned, Scene& scene) {
  const Mesh& mesh = scene.mesh;
  for (std::size_t k = 0; k < scene.load_cases.size(); ++k) {
    LoadCase& load_case = scene.load_cases[k];
    if (k < first_planned && IsMeasured(load_case)) {
      continue;
    }
    const Eigen::MatrixXd of_model =
        displacement.col(Eigen::Index(k))
            .reshaped(mesh.Dimension(), mesh.NumNodes());
    PointDisplacements& points = load_case.points;
    if (load_case.displacement.size() != 0 || points.points.Size() == 0) {
      load_case.displacement = of_model;
    }
    if (points.points.Size() > 0) {
      points.displacement = points.displacement.array().isNaN().select(
          points.displacement, Interpolate(mesh, points.points, of_model));
    }
  }
}

Scene WithoutNoise(Scene scene) {
  for (LoadCase& load_case : scene.load_cases) {
    load_case.noise_sd.reset();
    load_case.points.noise_sd.resize(0, 0);
  }
  return scene;
}

// The root mean square of the rows of load case `k` [length]; `rows` are those
// of `plain`, which has no weights.
double RootMeanSquare(const ObservedDisplacements& plain,
                      const Eigen::VectorXd& rows, Eigen::Index k) {
  const Eigen::Index count = plain.CaseStart(k + 1) - plain.CaseStart(k);
  return count == 0
             ? 0
             : plain.Norm() *
                   std::sqrt(
                       rows.segment(plain.CaseStart(k), count).squaredNorm() /
                       double(count));
}

// dtheta / dp of the free parameters p, these in the units of their errors.
Eigen::MatrixXd Directions(const MaterialParameters& of_materials,
                           const Eigen::VectorXd& parameters) {
  Eigen::MatrixXd directions =
      of_materials.ModuliJacobian(parameters)(Eigen::all, of_materials.Free());
  const Eigen::VectorXd units = of_materials.UnitsOfErrors(parameters);
  directions *= units(of_materials.Free()).asDiagonal();
  return directions;
}

Eigen::Index NumMeasuredForces(const LoadCase& load_case) {
  Eigen::Index count = 0;
  for (const Resultant& resultant : load_case.resultants) {
    count += (!resultant.force.array().isNaN()).count();
  }
  return count;
}

// The rows of the sensitivities along some directions of the moduli.
Eigen::MatrixXd SensitivityRows(const Eigen::MatrixXd& directions,
                                const ObservedDisplacements& observed,
                                Equilibrium& model,
                                std::optional<MotionElimination>& motion) {
  const Eigen::Index n = directions.cols();
  const Eigen::MatrixXd of_cases = model.Sensitivities(directions);
  const Eigen::MatrixXd forces =
      motion ? model.SupportForceSensitivities(directions, of_cases)
             : Eigen::MatrixXd();
  Eigen::MatrixXd rows(motion ? motion->NumRows() : observed.Size(), n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto own = Eigen::seq(i, Eigen::last, n);
    rows.col(i) = motion ? motion->Eliminate(of_cases(Eigen::all, own),
                                             forces(Eigen::all, own))
                         : observed.Restrict(of_cases(Eigen::all, own));
  }
  return rows;
}

// S^T S over the rows of each load case.
std::vector<Eigen::MatrixXd> InformationOfCases(
    const Scene& scene, const ObservedDisplacements& observed,
    const Eigen::MatrixXd& rows) {
  std::vector<Eigen::MatrixXd> information;
  Eigen::Index first_force = observed.Size();
  for (Eigen::Index k = 0; k < observed.NumLoadCases(); ++k) {
    const auto of_points =
        rows.middleRows(observed.CaseStart(k),
                        observed.CaseStart(k + 1) - observed.CaseStart(k));
    const Eigen::Index num_forces = NumMeasuredForces(scene.load_cases[k]);
    const auto of_forces = rows.middleRows(first_force, num_forces);
    first_force += num_forces;
    information.emplace_back(of_points.transpose() * of_points +
                             of_forces.transpose() * of_forces);
  }
  return information;
}

// Takes the motion of supports that fits best.
std::optional<MotionElimination> FitMotion(
    const Scene& scene, const ObservedDisplacements& observed,
    Equilibrium& model) {
  std::optional<MotionElimination> motion;
  if (HasUnknownMotion(scene)) {
    motion.emplace(scene, observed, model);
    motion->SetNoise(1 / observed.Norm());
    motion->Fit();
  }
  return motion;
}

// Gives each load case without noise that of its displacement.
void SetRelativeNoise(double relative_noise, const ObservedDisplacements& plain,
                      Scene& scene) {
  for (std::size_t k = 0; k < scene.load_cases.size(); ++k) {
    LoadCase& load_case = scene.load_cases[k];
    if (!load_case.noise_sd) {
      const double noise =
          relative_noise *
          RootMeanSquare(plain, plain.Measured(), Eigen::Index(k));
      // Where nothing moves, there is no information under any noise.
      load_case.noise_sd = noise > 0 ? noise : 1;
    }
  }
}

}  // namespace

std::vector<CaseInformation> ExpectedInformation(
    const Scene& scene, std::size_t first_planned,
    const Eigen::VectorXd& parameters, double relative_noise,
    SolverKind solver) {
  Equilibrium model(scene, solver);
  const MaterialParameters& of_materials = model.Forces().Parameters();
  if (!model.Solve(of_materials.Moduli(parameters))) {
    throw std::runtime_error(
        "the stiffness matrix is singular to working precision; check the mesh "
        "for flat elements, and the parameters");
  }
  Scene measured = scene;
  MeasureByModel(model.Displacement(), first_planned, measured);
  const ObservedDisplacements plain(WithoutNoise(measured));
  if (!(plain.Norm() > 0)) {
    throw std::invalid_argument(
        "the loads move nothing that is observed; give loads that deform the "
        "observed part of the specimen");
  }
  SetRelativeNoise(relative_noise, plain, measured);
  const ObservedDisplacements observed(measured);
  std::optional<MotionElimination> motion =
      FitMotion(measured, observed, model);
  const Eigen::VectorXd rows = plain.Restrict(model.Displacement());
  const std::vector<Eigen::MatrixXd> of_cases =
      InformationOfCases(measured, observed,
                         SensitivityRows(Directions(of_materials, parameters),
                                         observed, model, motion));
  std::vector<CaseInformation> information;
  for (Eigen::Index k = 0; k < Eigen::Index(of_cases.size()); ++k) {
    information.push_back({observed.Norm() * observed.Norm() * of_cases[k],
                           RootMeanSquare(plain, rows, k)});
  }
  return information;
}

Eigen::MatrixXd CramerRaoBound(Scene scene, const Eigen::VectorXd& parameters,
                               const Eigen::VectorXd& noise_sd) {
  for (std::size_t k = 0; k < scene.load_cases.size(); ++k) {
    scene.load_cases[k].noise_sd = noise_sd(Eigen::Index(k));
    scene.load_cases[k].points.noise_sd.resize(0, 0);
  }
  const MaterialParameters chart(scene.materials, scene.mesh.section.model);
  const Eigen::VectorXd units = chart.UnitsOfErrors(parameters)(chart.Free());
  Eigen::MatrixXd information =
      Eigen::MatrixXd::Zero(units.size(), units.size());
  for (const CaseInformation& of_case :
       ExpectedInformation(scene, 0, parameters, 1, SolverKind::kAutomatic)) {
    information += of_case.information;
  }
  const ExpectedErrors errors = ExpectedErrors::Of(information);
  if (errors.NumUndetermined() > 0) {
    return Eigen::MatrixXd::Constant(units.size(), units.size(),
                                     errors.standard_errors(0));
  }
  const Eigen::MatrixXd root = units.asDiagonal() * errors.directions *
                               errors.standard_errors.asDiagonal();
  return root * root.transpose();
}

}  // namespace elastimate
