#include "elastimate/io/report/scene_results.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <vector>

#include "elastimate/core/equilibrium/equilibrium.h"
#include "elastimate/core/equilibrium/large_strain_equilibrium.h"
#include "elastimate/core/materials/material_parameters.h"
#include "elastimate/core/mesh/mesh_points.h"
#include "elastimate/core/mesh/middle_nodes.h"
#include "elastimate/core/scene/camera.h"
#include "elastimate/core/scene/degrees_of_freedom.h"
#include "elastimate/core/scene/finer_scene.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/core/scene/quadratic_scene.h"
#include "elastimate/core/scene/rigid_motion.h"
#include "elastimate/estimators/interface/estimator.h"
#include "elastimate/estimators/maps/field_sensitivity.h"

namespace elastimate {
namespace {

// Returns p of the fit, without the correction for what its elements miss;
// empty where some parameters are not physical.
std::optional<Eigen::VectorXd> FittedParameters(const Estimate& estimate) {
  Eigen::VectorXd values(Eigen::Index(estimate.parameters.size()));
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    const ParameterEstimate& parameter = estimate.parameters[i];
    values(i) = parameter.value;
    if (!parameter.IsPhysical() || !std::isfinite(parameter.value)) {
      return std::nullopt;
    }
  }
  if (estimate.uncorrected_parameters.size() == values.size()) {
    values = estimate.uncorrected_parameters;
  }
  return values.size() == 0 ? std::nullopt
                            : std::optional<Eigen::VectorXd>(values);
}

class FieldCollector {
 public:
  // Shows the first nodes, which are the nodes of `shown`.
  FieldCollector(const Mesh& shown, Fields& fields)
      : shown_(shown), fields_(fields) {}

  void AddPoint(const std::string& name, Eigen::Index load_case,
                const Eigen::MatrixXd& all) {
    fields_.point.push_back(
        {name + CaseSuffix(load_case),
         all.col(load_case)
             .head(shown_.NumDofs())
             .reshaped(shown_.Dimension(), shown_.NumNodes())});
  }

  // Adds the mean over the elements of `mesh` that each element was cut into.
  void AddStrainEnergy(const Mesh& mesh, const InternalForces& forces,
                       const Eigen::VectorXd& moduli, Eigen::Index load_case,
                       const Eigen::MatrixXd& all) {
    const Eigen::VectorXd volumes = ElementVolumes(mesh);
    const Eigen::VectorXd energies =
        volumes.cwiseProduct(forces.EnergyDensity(moduli, all.col(load_case)));
    const Eigen::Index num_elements = shown_.NumElements();
    const Eigen::Index num_parts = mesh.NumElements() / num_elements;
    fields_.cell.push_back(
        {"strain_energy_density" + CaseSuffix(load_case),
         energies.reshaped(num_parts, num_elements)
             .colwise()
             .sum()
             .cwiseQuotient(
                 volumes.reshaped(num_parts, num_elements).colwise().sum())});
  }

  // Adds a field that is 1 at the nodes whose measurement was left out.
  void AddOutliers(const std::vector<Outlier>& outliers) {
    for (const Outlier& outlier : outliers) {
      const std::string name = "outlier" + CaseSuffix(outlier.load_case);
      if (outlier.is_point) {
        continue;
      }
      if (fields_.point.back().name != name) {
        fields_.point.push_back(
            {name, Eigen::RowVectorXd::Zero(shown_.NumNodes())});
      }
      fields_.point.back().values(0, outlier.index) = 1;
    }
  }

  // Adds cell arrays of what is left of the measurement in the material of each
  // element.
  void AddResiduals(const Scene& scene, const Estimate& estimate) {
    const std::vector<int> material_of =
        MaterialOfElements(scene.materials, scene.mesh);
    const std::size_t num_materials = scene.materials.size();
    if (estimate.materials.size() != num_materials) {
      return;
    }
    Eigen::VectorXd chi_square(num_materials);
    Eigen::VectorXd correlation(num_materials);
    for (std::size_t i = 0; i < num_materials; ++i) {
      const MaterialEstimate& material = estimate.materials[i];
      chi_square(Eigen::Index(i)) =
          material.residual_chi_square.value_or(Estimate::kUnknown);
      correlation(Eigen::Index(i)) =
          material.residual_correlation.value_or(Estimate::kUnknown);
    }
    if (chi_square.array().isNaN().all()) {
      return;
    }
    fields_.cell.push_back(
        {"residual_chi_square", chi_square(material_of).transpose()});
    fields_.cell.push_back(
        {"residual_correlation", correlation(material_of).transpose()});
  }

  // Adds the map of a modulus, with its error and its resolution.
  void AddMap(const MapEstimate& map) {
    fields_.cell.push_back({"youngs_modulus", map.youngs_modulus.transpose()});
    if (map.verdict == MapVerdict::kElements) {
      return;
    }
    fields_.cell.push_back({"youngs_modulus_standard_error",
                            map.youngs_modulus_standard_error.transpose()});
    fields_.cell.push_back(
        {"resolution_length", map.resolution_length.transpose()});
  }

  // Adds a cell array of each parameter, with the value of each element's
  // material.
  void AddParameters(const Scene& scene, const Estimate& estimate) {
    const std::vector<int> material_of =
        MaterialOfElements(scene.materials, scene.mesh);
    const MaterialParameters parameters(scene.materials,
                                        scene.mesh.section.model);
    for (Eigen::Index i = 0; i < parameters.NumParameters(); ++i) {
      const ParameterEstimate& parameter = estimate.parameters[i];
      auto field = std::find_if(
          fields_.cell.begin(), fields_.cell.end(),
          [&](const Field& other) { return other.name == parameter.name; });
      if (field == fields_.cell.end()) {
        fields_.cell.push_back({parameter.name, Eigen::RowVectorXd::Constant(
                                                    scene.mesh.NumElements(),
                                                    Estimate::kUnknown)});
        field = std::prev(fields_.cell.end());
      }
      for (Eigen::Index e = 0; e < scene.mesh.NumElements(); ++e) {
        if (material_of[e] == int(parameters.All()[i].material)) {
          field->values(0, e) = parameter.value;
        }
      }
    }
  }

 private:
  const Mesh& shown_;
  Fields& fields_;
};

// Subtracts the displacement from the measured one.
Eigen::MatrixXd MeasuredMinus(const Scene& scene,
                              const Eigen::MatrixXd& displacement) {
  Eigen::MatrixXd difference =
      Eigen::MatrixXd::Zero(displacement.rows(), displacement.cols());
  const int dimension = scene.mesh.Dimension();
  for (Eigen::Index k = 0; k < displacement.cols(); ++k) {
    const LoadCase& load_case = scene.load_cases[k];
    for (Eigen::Index dof = 0; dof < displacement.rows(); ++dof) {
      const Eigen::Index node = dof / dimension;
      if (IsObserved(load_case, dof % dimension, node)) {
        difference(dof, k) = load_case.displacement(dof % dimension, node) -
                             displacement(dof, k);
      }
    }
  }
  return difference;
}

// Does what MeasuredMinus does at the points of each load case: dimension x
// num_points.
std::vector<Eigen::MatrixXd> MeasuredMinusAtPoints(
    const Scene& scene, const Eigen::MatrixXd& displacement) {
  const Mesh& mesh = scene.mesh;
  std::vector<Eigen::MatrixXd> differences;
  for (std::size_t k = 0; k < scene.load_cases.size(); ++k) {
    const PointDisplacements& points = scene.load_cases[k].points;
    differences.emplace_back(points.displacement);
    if (points.points.Size() != 0) {
      differences.back() -=
          Interpolate(mesh, points.points,
                      displacement.col(Eigen::Index(k))
                          .reshaped(mesh.Dimension(), mesh.NumNodes()));
    }
  }
  return differences;
}

// Returns the scene with supports where a fit of unknown motion found them, as
// displacements that begin with those of its nodes tell.
Scene WithFittedSupports(Scene scene, const Eigen::MatrixXd& fitted) {
  for (std::size_t k = 0; k < scene.load_cases.size(); ++k) {
    Supports supports = SupportsOf(scene, Eigen::Index(k));
    supports.displacement = supports.held.select(
        fitted.col(Eigen::Index(k))
            .head(scene.mesh.NumDofs())
            .reshaped(scene.mesh.Dimension(), scene.mesh.NumNodes()),
        supports.displacement);
    supports.unknown.resize(0, 0);
    supports.rigid_faces.clear();
    // Boxes say where nodes would be if nothing had moved.
    supports.boxes.clear();
    scene.load_cases[k].supports = supports;
  }
  return scene;
}

// The scenes that a fit solved for.
struct SolvedScenes {
  Scene undivided;
  std::optional<Scene> divided;

  const Scene& Finest() const { return divided ? *divided : undivided; }
  /// Returns the spaces of Equilibrium.  `scene` comes first where the fit had
  /// finer elements.
  std::vector<const Scene*> FromCoarseToFine(const Scene& scene) const {
    std::vector<const Scene*> spaces;
    if (scene.mesh.NumNodes() < undivided.mesh.NumNodes()) {
      spaces.push_back(&scene);
    }
    spaces.push_back(&undivided);
    if (divided) {
      spaces.push_back(&*divided);
    }
    return spaces;
  }
};

// Returns the scenes of the fit, of whose elements `modelled` has the order.
// A fit of unknown motion tells the displacements at the nodes of `scene` alone
// where it has finer elements.
SolvedScenes ScenesOfFit(const Scene& scene, const Scene& modelled,
                         const Estimate& estimate) {
  const Eigen::MatrixXd& fitted = estimate.fitted_displacement;
  SolvedScenes solved;
  if (fitted.size() == 0) {
    solved.undivided = modelled;
  } else if (fitted.rows() == modelled.mesh.NumDofs()) {
    solved.undivided = WithFittedSupports(modelled, fitted);
  } else {
    solved.undivided = FinerScene(WithFittedSupports(scene, fitted));
  }
  if (estimate.mesh_divisions > 0 && !estimate.map) {
    solved.divided = FinerScene(solved.undivided);
  }
  return solved;
}

// Returns the parameters of WithMaterialOfEachElement.
Eigen::VectorXd ValuesOfMap(const MapEstimate& map) {
  Eigen::VectorXd values(2 * map.youngs_modulus.size());
  values(Eigen::seq(0, Eigen::last, 2)) = map.youngs_modulus;
  values(Eigen::seq(1, Eigen::last, 2)).setConstant(map.poisson_ratio);
  return values;
}

// Returns the forces of the held nodes of `scene`.
Eigen::MatrixXd ReactionOf(const Scene& scene, const SolvedScenes& solved,
                           const Eigen::MatrixXd& imbalance) {
  Eigen::MatrixXd reaction = OfHeld(solved.Finest(), imbalance);
  if (solved.divided) {
    reaction = MiddleNodes(solved.divided->mesh).Restrict(reaction);
  }
  return scene.mesh.Order() == 2
             ? reaction
             : MiddleNodes(solved.undivided.mesh).Restrict(reaction);
}

// Adds the displacements of a model as the cameras see them, and what they
// leave of the measured ones and, by `imbalance` of internal forces and loads,
// of the supports.
void AddFitted(const Scene& scene, const SolvedScenes& solved,
               const Eigen::MatrixXd& of_specimen,
               const Eigen::MatrixXd& imbalance, const Estimate& estimate,
               SceneResults& results) {
  FieldCollector collector(scene.mesh, results.fields);
  const Eigen::MatrixXd fitted =
      SeenDisplacements(solved.Finest().mesh, of_specimen, estimate.cameras);
  const Eigen::MatrixXd difference = MeasuredMinus(solved.Finest(), fitted);
  const Eigen::MatrixXd reaction = ReactionOf(scene, solved, imbalance);
  collector.AddOutliers(estimate.outliers);
  for (Eigen::Index k = 0; k < fitted.cols(); ++k) {
    collector.AddPoint("fitted_displacement", k, fitted);
    collector.AddPoint("displacement_residual", k, difference);
    collector.AddPoint("reaction_force", k, reaction);
  }
  results.point_residuals = MeasuredMinusAtPoints(solved.Finest(), fitted);
}

// Adds by how much the displacement of finer elements differs from that of the
// elements of the scene, of the same supports.
void AddMeshError(const Eigen::MatrixXd& finer, const Eigen::MatrixXd& own,
                  FieldCollector& collector) {
  const Eigen::MatrixXd error = finer.topRows(own.rows()) - own;
  for (Eigen::Index k = 0; k < error.cols(); ++k) {
    collector.AddPoint("mesh_error", k, error);
  }
}

// Returns the scene, with the supports of the fit, whose own elements are less
// fine than those of the fit; empty where they are not.
std::optional<Scene> CoarserScene(const Scene& scene,
                                  const SolvedScenes& solved,
                                  const Estimate& estimate) {
  if (solved.Finest().mesh.NumNodes() == scene.mesh.NumNodes()) {
    return std::nullopt;
  }
  const Eigen::MatrixXd& fitted = estimate.fitted_displacement;
  return fitted.size() == 0 ? scene : WithFittedSupports(scene, fitted);
}

// Adds what the model says at these parameters of its materials, which have
// laws of small strains.
void AddModel(const Scene& scene, const Scene& modelled,
              const Eigen::VectorXd& values, const Estimate& estimate,
              SolverKind solver, SceneResults& results) {
  FieldCollector collector(scene.mesh, results.fields);
  const Eigen::Index num_cases = Eigen::Index(scene.load_cases.size());
  if (!WhyNotHeld(scene).empty()) {
    const Eigen::MatrixXd force = AssembleLoadCases(scene);
    const Eigen::MatrixXd measured =
        MeasuredMinus(scene, Eigen::MatrixXd::Zero(force.rows(), num_cases));
    const InternalForces forces(scene.mesh, scene.materials);
    const Eigen::VectorXd moduli = forces.Parameters().Moduli(values);
    const Eigen::MatrixXd residual = forces.Multiply(moduli, measured) - force;
    for (Eigen::Index k = 0; k < num_cases; ++k) {
      collector.AddPoint("force_residual", k, residual);
      collector.AddStrainEnergy(scene.mesh, forces, moduli, k, measured);
    }
    return;
  }
  const SolvedScenes solved = ScenesOfFit(scene, modelled, estimate);
  Equilibrium model(solved.FromCoarseToFine(scene), solver);
  const Eigen::VectorXd moduli = model.Forces().Parameters().Moduli(values);
  if (!model.Solve(moduli)) {
    return;
  }
  const Eigen::MatrixXd& fitted = model.Displacement();
  AddFitted(scene, solved, fitted,
            model.Forces().Multiply(moduli, fitted) -
                AssembleLoadCases(solved.Finest()),
            estimate, results);
  for (Eigen::Index k = 0; k < num_cases; ++k) {
    collector.AddStrainEnergy(solved.Finest().mesh, model.Forces(), moduli, k,
                              fitted);
  }
  if (const auto coarser = CoarserScene(scene, solved, estimate)) {
    Equilibrium own({&*coarser}, solver, StiffnessSolver::kAccurate,
                    model.SolverOfCoarsest());
    if (own.Solve(own.Forces().Parameters().Moduli(values))) {
      AddMeshError(fitted, own.Displacement(), collector);
    }
  }
}

// Adds what the model says at these parameters of its laws of large strains;
// nothing where supports do not hold the specimen, or where there is no
// equilibrium.
void AddLargeStrainModel(const Scene& scene, const Scene& modelled,
                         const Eigen::VectorXd& values,
                         const Estimate& estimate, SceneResults& results) {
  if (!WhyNotHeld(scene).empty()) {
    return;
  }
  const auto solve = [&values](const Scene& of) {
    LargeStrainEquilibrium model(of);
    return SolveLoadCases(model.Forces().Parameters().Moduli(values), model);
  };
  const SolvedScenes solved = ScenesOfFit(scene, modelled, estimate);
  const LargeStrainSolution fit = solve(solved.Finest());
  if (!fit.why_not.empty()) {
    return;
  }
  AddFitted(scene, solved, fit.displacement, fit.imbalance, estimate, results);
  if (const auto coarser = CoarserScene(scene, solved, estimate)) {
    const LargeStrainSolution own = solve(*coarser);
    if (own.why_not.empty()) {
      FieldCollector collector(scene.mesh, results.fields);
      AddMeshError(fit.displacement, own.displacement, collector);
    }
  }
}

}  // namespace

SceneResults ResultsOf(const Scene& scene, const Scene& modelled,
                       const Estimate& estimate, SolverKind solver) {
  SceneResults results = {SceneFields(scene), {}};
  const std::optional<Eigen::VectorXd> values = FittedParameters(estimate);
  if (!values) {
    return results;
  }
  FieldCollector collector(scene.mesh, results.fields);
  if (estimate.map) {
    collector.AddMap(*estimate.map);
    AddModel(WithMaterialOfEachElement(scene),
             WithMaterialOfEachElement(modelled), ValuesOfMap(*estimate.map),
             estimate, solver, results);
    return results;
  }
  if (!IsOneIsotropicMaterial(scene.materials)) {
    collector.AddParameters(scene, estimate);
    collector.AddResiduals(scene, estimate);
  }
  if (HasLargeStrainLaw(scene.materials)) {
    AddLargeStrainModel(scene, modelled, *values, estimate, results);
  } else {
    AddModel(scene, modelled, *values, estimate, solver, results);
  }
  return results;
}

}  // namespace elastimate
