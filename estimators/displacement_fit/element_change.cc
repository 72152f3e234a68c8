#include "elastimate/estimators/displacement_fit/element_change.h"

#include <cmath>

#include "elastimate/core/equilibrium/forward_model.h"
#include "elastimate/core/materials/elasticity.h"
#include "elastimate/core/mesh/mid_edges.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/core/scene/rigid_motion.h"
#include "elastimate/core/scene/simplicial_scene.h"

namespace elastimate {
namespace {

// How far the ratio of the stiffness against volume to that against shear may
// change, in its logarithm, before the change is found again.
constexpr double kSameStiffness = 0.2;

}  // namespace

std::optional<Eigen::VectorXd> ElementChange::Rows(
    const ObservedDisplacements& observed,
    const IsotropicElasticity& elasticity, const Eigen::MatrixXd& responses,
    const std::function<StiffnessSolver*(double poisson_ratio)>& solver_near) {
  const double nu = elasticity.poisson_ratio;
  const bool is_found =
      std::abs(LogStiffnessRatio(nu) - LogStiffnessRatio(poisson_ratio_)) <=
      kSameStiffness;
  if (!is_found) {
    poisson_ratio_ = nu;
    if (scene_.mesh.Order() == 2) {
      change_ = OfQuadraticElements(nu, responses);
    } else {
      change_ = OfLinearElements(nu, responses, solver_near(nu));
    }
  }
  if (!change_) {
    return std::nullopt;
  }
  const auto num_cases = Eigen::Index(scene_.load_cases.size());
  Eigen::MatrixXd change =
      elasticity.ComplianceScale(scene_.mesh.section.model) *
      change_->leftCols(num_cases);
  if (change_->cols() > num_cases) {
    change.colwise() += change_->rightCols<1>();
  }
  return observed.Restrict(change);
}

std::optional<Eigen::MatrixXd> ElementChange::OfLinearElements(
    double poisson_ratio, const Eigen::MatrixXd& responses,
    StiffnessSolver* solver) {
  if (solver == nullptr) {
    return std::nullopt;
  }
  if (!hierarchical_) {
    hierarchical_ =
        std::make_unique<HierarchicalError>(SimplicialScene(scene_));
  }
  const int passes = hierarchical_->NumPasses();
  std::optional<Eigen::MatrixXd> change =
      hierarchical_->Find(poisson_ratio, responses, *solver);
  work_.element_passes += hierarchical_->NumPasses() - passes;
  return change;
}

std::optional<Eigen::MatrixXd> ElementChange::OfQuadraticElements(
    double poisson_ratio, const Eigen::MatrixXd& responses) {
  const Mesh& mesh = scene_.mesh;
  const Eigen::Index num_vertices = mesh.NumVertices();
  Mesh linear;
  linear.kind = LinearKind(mesh.kind);
  linear.section = mesh.section;
  linear.nodes = mesh.nodes.leftCols(num_vertices);
  linear.elements = mesh.elements.topRows(mesh.Topology().num_vertices);
  const Supports supports = {
      scene_.supports.held.leftCols(num_vertices),
      scene_.supports.displacement.leftCols(num_vertices)};
  // Mid-edge nodes alone may hold the specimen.
  if (!WhyNotHeld(linear, supports).empty()) {
    return std::nullopt;
  }
  ForwardModel model(linear, supports,
                     MidEdges(mesh).Restrict(AssembleLoadCases(scene_)),
                     SolverKind::kCholesky);
  const bool is_regular = model.SetPoissonRatio(poisson_ratio);
  work_ = work_ + model.WorkDone();
  if (!is_regular) {
    return std::nullopt;
  }
  Eigen::MatrixXd of_linear = model.Responses();
  // Mid-edge nodes alone may be displaced.
  of_linear.conservativeResizeLike(
      Eigen::MatrixXd::Zero(of_linear.rows(), responses.cols()));
  return Eigen::MatrixXd(responses - MidEdges(mesh).Interpolate(of_linear));
}

}  // namespace elastimate
