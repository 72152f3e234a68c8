#include "elastimate/estimators/misfit/finer_elements.h"

#include "elastimate/core/mesh/simplicial_mesh.h"
#include "elastimate/core/scene/finer_scene.h"

namespace elastimate {

FinerElements::FinerElements(const Scene& scene,
                             const EstimatorOptions& options)
    : scene_(FinerScene(scene)), misfit_(scene_, options) {}

std::unique_ptr<FinerElements> FinerElements::Of(
    const Scene& scene, const EstimatorOptions& options) {
  const Eigen::Index most = scene.mesh.Dimension() == 3 ? 30000 : 120000;
  return SimplicialMesh(scene.mesh).Simplices().NumElements() > most
             ? nullptr
             : std::make_unique<FinerElements>(scene, options);
}

std::optional<Eigen::VectorXd> FinerElements::Rows(
    const Eigen::VectorXd& variables) {
  Eigen::VectorXd rows;
  return misfit_.NumResultants() == 0 &&
                 misfit_.Evaluate(variables, &rows, nullptr)
             ? std::optional<Eigen::VectorXd>(rows)
             : std::nullopt;
}

std::optional<Eigen::MatrixXd> FinerElements::Displacement(
    const Eigen::VectorXd& variables) {
  Eigen::VectorXd rows;
  return misfit_.Evaluate(variables, &rows, nullptr)
             ? std::optional<Eigen::MatrixXd>(misfit_.FittedDisplacement())
             : std::nullopt;
}

Eigen::MatrixXd FinerElements::DisplacementOfSpecimen(
    const Eigen::VectorXd& variables, double share,
    const Eigen::MatrixXd& displacement) {
  const std::optional<Eigen::MatrixXd> of_finer =
      share == 0 ? std::nullopt : Displacement(variables);
  return of_finer
             ? Eigen::MatrixXd((1 - share) * displacement +
                               share * of_finer->topRows(displacement.rows()))
             : displacement;
}

}  // namespace elastimate
