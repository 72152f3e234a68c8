#include "elastimate/estimators/displacement_fit/element_change.h"

#include <cmath>

#include "elastimate/core/equilibrium/forward_model.h"
#include "elastimate/core/materials/elasticity.h"
#include "elastimate/core/mesh/mid_edges.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/core/scene/rigid_motion.h"

namespace elastimate {
namespace {

// How far the ratio of the stiffness against volume to that against shear may
// change, in its logarithm, before the change is found again.
constexpr double kSameStiffness = 0.2;

}  // namespace

const std::optional<Eigen::MatrixXd>& ElementChange::Find(
    double poisson_ratio, const Eigen::MatrixXd& responses,
    StiffnessSolver& solver) {
  if (std::abs(LogStiffnessRatio(poisson_ratio) -
               LogStiffnessRatio(poisson_ratio_)) <= kSameStiffness) {
    return change_;
  }
  poisson_ratio_ = poisson_ratio;
  change_ = IsOfFinerElements()
                ? OfLinearElements(poisson_ratio, responses, solver)
                : OfQuadraticElements(poisson_ratio, responses);
  return change_;
}

std::optional<Eigen::MatrixXd> ElementChange::OfLinearElements(
    double poisson_ratio, const Eigen::MatrixXd& responses,
    StiffnessSolver& solver) {
  if (!HasQuadraticKind(scene_.mesh.kind)) {
    return std::nullopt;
  }
  if (!hierarchical_) {
    hierarchical_ = std::make_unique<HierarchicalError>(scene_);
  }
  const int passes = hierarchical_->NumPasses();
  std::optional<Eigen::MatrixXd> change =
      hierarchical_->Find(poisson_ratio, responses, solver);
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
  Eigen::MatrixXd of_linear(linear.NumDofs(), responses.cols());
  of_linear.leftCols(model.UnitLoadResponse().cols()) =
      model.UnitLoadResponse();
  if (of_linear.cols() > model.UnitLoadResponse().cols()) {
    of_linear.rightCols<1>() = model.SupportResponse();
  }
  return Eigen::MatrixXd(responses - MidEdges(mesh).Interpolate(of_linear));
}

std::optional<Eigen::VectorXd> RowsOfChange(
    const ObservedDisplacements& observed,
    const std::optional<Eigen::MatrixXd>& of_responses, double compliance_scale,
    Eigen::Index num_load_cases) {
  if (!of_responses) {
    return std::nullopt;
  }
  Eigen::MatrixXd change =
      compliance_scale * of_responses->leftCols(num_load_cases);
  if (of_responses->cols() > num_load_cases) {
    change.colwise() += of_responses->rightCols<1>();
  }
  return observed.Restrict(change);
}

}  // namespace elastimate
