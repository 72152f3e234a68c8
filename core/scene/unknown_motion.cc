#include "elastimate/core/scene/unknown_motion.h"

#include <cmath>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/mesh/axis_names.h"
#include "elastimate/core/mesh/middle_nodes.h"
#include "elastimate/core/scene/rigid_motion.h"

namespace elastimate {
namespace {

// A rigid motion of a face that moves its nodes by less than this share of the
// largest one is none: a rotation about a line on which all its nodes are, or a
// motion of components that the face leaves free.
constexpr double kNoMotion = 1e-6;

[[noreturn]] void Refuse(const std::string& message) {
  throw std::invalid_argument(message);
}

std::string NodeText(Eigen::Index node, int component) {
  return "node " + std::to_string(node) + " (" + kAxisNames[component] + ")";
}

// Returns the rigid motions of some points, with rotations about their middle,
// by their size: (dimension num_points) x 3 or 6.
Eigen::MatrixXd RigidMotionsAbout(const Eigen::MatrixXd& positions) {
  const Eigen::MatrixXd arms = positions.colwise() - positions.rowwise().mean();
  const double size = arms.cwiseAbs().maxCoeff();
  return RigidMotionsOf(arms / (size > 0 ? size : 1));
}

void ValidateRigidFace(const Mesh& mesh, const Supports& supports,
                       const RigidFace& face) {
  if (face.components.size() != mesh.Dimension() || !face.components.any()) {
    Refuse("a rigid face does not name its components; name some");
  }
  for (const int node : face.nodes) {
    if (node < 0 || node >= mesh.NumNodes()) {
      Refuse("node " + std::to_string(node) +
             " of a rigid face is outside 0.." +
             std::to_string(mesh.NumNodes() - 1));
    }
    for (int i = 0; i < mesh.Dimension(); ++i) {
      if (face.components(i) && supports.IsGiven(i, node)) {
        Refuse(NodeText(node, i) +
               " of a rigid face is also held at a given displacement; leave "
               "it out of one of the two");
      }
    }
  }
  if (face.nodes.empty()) {
    Refuse("a rigid face has no node; name some");
  }
}

void ValidateResultant(const Mesh& mesh, const Supports& supports,
                       const Resultant& resultant, const std::string& where) {
  if (resultant.force.size() != mesh.Dimension() ||
      resultant.noise_sd.size() != mesh.Dimension()) {
    Refuse("the force and the standard deviation of " + where +
           " do not have " + std::to_string(mesh.Dimension()) +
           " components; give one for each");
  }
  for (const int node : resultant.nodes) {
    if (node < 0 || node >= mesh.NumNodes()) {
      Refuse("node " + std::to_string(node) + " of " + where +
             " is outside 0.." + std::to_string(mesh.NumNodes() - 1));
    }
  }
  for (int i = 0; i < mesh.Dimension(); ++i) {
    if (std::isnan(resultant.force(i))) {
      continue;
    }
    if (!(std::isfinite(resultant.force(i)) && resultant.noise_sd(i) > 0 &&
          std::isfinite(resultant.noise_sd(i)))) {
      Refuse(std::string("component ") + kAxisNames[i] + " of " + where +
             " is not a finite force with a positive standard deviation; "
             "correct it");
    }
    bool is_held = false;
    for (const int node : resultant.nodes) {
      is_held = is_held || supports.held(i, node);
    }
    if (!is_held) {
      Refuse("no support holds component " + std::string(kAxisNames[i]) +
             " of a node of " + where +
             ", so that nothing exerts this force; give it as a load of type "
             "\"force\", or hold the nodes");
    }
  }
}

void RefuseTheSameResultant(const Resultant& before, const Resultant& resultant,
                            const std::string& where) {
  const bool is_known_twice =
      ((before.force + resultant.force).array().isFinite()).any();
  if (is_known_twice &&
      std::set<int>(before.nodes.begin(), before.nodes.end()) ==
          std::set<int>(resultant.nodes.begin(), resultant.nodes.end())) {
    Refuse(where +
           " measures a force on the same nodes as an earlier resultant; give "
           "the mean of both once");
  }
}

// The nodes of some supports that move as the mean of others, because they were
// measured in no load case of these supports.  They are nodes that a refinement
// put there, and the middle nodes of a mesh of order 2.
struct TiedNodes {
  TiedNodes(const Scene& scene, const Supports& supports)
      : is_tied(ComponentMask::Constant(supports.held.rows(),
                                        supports.held.cols(), false)) {
    const ComponentMask measured = AsMeasured(supports);
    if (measured.size() == 0) {
      return;
    }
    for (const MiddleNode& middle : supports.middles) {
      Tie(scene, supports, measured, middle);
    }
    if (scene.mesh.Order() == 1) {
      return;
    }
    const MiddleNodes nodes(scene.mesh);
    for (Eigen::Index i = 0; i < nodes.Vertices().Size(); ++i) {
      const auto vertices = nodes.Vertices()[i];
      Tie(scene, supports, measured,
          {static_cast<int>(nodes.NumVertices() + i),
           {vertices.begin(), vertices.end()}});
    }
  }

  ComponentMask is_tied;            // dimension x num_nodes.
  std::vector<MiddleNode> middles;  // Each after its vertices.

 private:
  void Tie(const Scene& scene, const Supports& supports,
           const ComponentMask& measured, const MiddleNode& middle) {
    const auto& [node, vertices] = middle;
    bool is_any_new = false;
    for (int i = 0; i < measured.rows(); ++i) {
      if (is_tied(i, node) || !measured(i, node) ||
          !measured.row(i)(vertices).all()) {
        continue;
      }
      bool is_observed = false;
      for (std::size_t k = 0; k < scene.load_cases.size(); ++k) {
        is_observed =
            is_observed || (&SupportsOf(scene, Eigen::Index(k)) == &supports &&
                            IsObserved(scene.load_cases[k], i, node));
      }
      is_tied(i, node) = !is_observed;
      is_any_new = is_any_new || !is_observed;
    }
    if (is_any_new) {
      middles.push_back(middle);
    }
  }
};

// Throws where most nodes have no measurement, since the motion is ill-posed
// then.  A few nodes may have been lost: their motion follows from their
// neighbours'.
void ValidateMeasuredSupports(const Scene& scene, const Supports& supports) {
  ComponentMask measured = AsMeasured(supports);
  if (measured.size() != 0) {
    measured = measured && !TiedNodes(scene, supports).is_tied;
  }
  for (std::size_t k = 0; k < scene.load_cases.size(); ++k) {
    const LoadCase& load_case = scene.load_cases[k];
    if (&SupportsOf(scene, Eigen::Index(k)) != &supports) {
      continue;
    }
    for (int i = 0; i < measured.rows(); ++i) {
      Eigen::Index num_lost = 0;
      Eigen::Index first_lost = 0;
      for (Eigen::Index node = measured.cols() - 1; node >= 0; --node) {
        if (measured(i, node) && !IsObserved(load_case, i, node)) {
          first_lost = node;
          ++num_lost;
        }
      }
      const Eigen::Index num_nodes = measured.row(i).count();
      if (2 * num_lost > num_nodes) {
        Refuse(std::to_string(num_lost) + " of " + std::to_string(num_nodes) +
               " nodes of supports that moved as measured, " +
               NodeText(first_lost, i) + " the first, have no measurement in " +
               "load case " + std::to_string(k + 1) +
               "; leave them out of the support, or give it \"displacement\": "
               "\"rigid\"");
      }
    }
  }
}

void ValidateUnknownDisplacements(const Scene& scene,
                                  const Supports& supports) {
  const ComponentMask& unknown = supports.unknown;
  if (unknown.size() != 0 && (unknown.rows() != supports.held.rows() ||
                              unknown.cols() != supports.held.cols())) {
    Refuse(
        "the mask of unknown displacements of supports has not the shape of "
        "the mask of held components; correct it");
  }
  if (unknown.size() == 0 && !supports.rigid_faces.empty()) {
    Refuse(
        "the displacements of rigid faces are not marked as unknown; mark "
        "them");
  }
  if (unknown.size() != 0 && (unknown && !supports.held).any()) {
    Refuse(
        "a displacement that no support holds is marked as unknown; hold it");
  }
  for (const RigidFace& face : supports.rigid_faces) {
    ValidateRigidFace(scene.mesh, supports, face);
  }
  ValidateMeasuredSupports(scene, supports);
}

}  // namespace

bool HasUnknownMotion(const Scene& scene) {
  bool has_some =
      scene.is_rigid_motion_free || scene.supports.unknown.size() != 0;
  for (const LoadCase& load_case : scene.load_cases) {
    has_some = has_some || !load_case.resultants.empty() ||
               (load_case.supports && load_case.supports->unknown.size() != 0);
  }
  return has_some;
}

void ValidateUnknownMotion(const Scene& scene) {
  ValidateUnknownDisplacements(scene, scene.supports);
  for (std::size_t k = 0; k < scene.load_cases.size(); ++k) {
    const LoadCase& load_case = scene.load_cases[k];
    if (load_case.supports) {
      ValidateUnknownDisplacements(scene, *load_case.supports);
    }
    for (std::size_t i = 0; i < load_case.resultants.size(); ++i) {
      const std::string where = "resultant " + std::to_string(i + 1) +
                                " of load case " + std::to_string(k + 1);
      ValidateResultant(scene.mesh, SupportsOf(scene, Eigen::Index(k)),
                        load_case.resultants[i], where);
      for (std::size_t j = 0; j < i; ++j) {
        RefuseTheSameResultant(load_case.resultants[j], load_case.resultants[i],
                               where);
      }
    }
  }
}

ComponentMask AsMeasured(const Supports& supports) {
  ComponentMask mask = supports.unknown;
  for (const RigidFace& face : supports.rigid_faces) {
    for (const int node : face.nodes) {
      mask.col(node) = mask.col(node) && !face.components;
    }
  }
  return mask;
}

UnknownMotion::UnknownMotion(const Scene& scene, const Supports& supports)
    : UnknownMotion(scene, supports, {scene.mesh.nodes, scene.mesh.nodes}) {}

UnknownMotion::UnknownMotion(const Scene& scene, const Supports& supports,
                             const Positions& positions)
    : of_all(scene.mesh.NumDofs(), 0) {
  const Mesh& mesh = scene.mesh;
  const int dimension = mesh.Dimension();
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::Index num_columns = 0;
  const ComponentMask measured = AsMeasured(supports);
  const TiedNodes tied(scene, supports);
  // These are the columns of each degree of freedom, with their shares.
  std::vector<std::map<Eigen::Index, double>> shares(mesh.NumDofs());
  for (Eigen::Index dof = 0; dof < measured.size(); ++dof) {
    if (measured.reshaped()(dof) && !tied.is_tied.reshaped()(dof)) {
      shares[dof][num_columns++] = 1;
    }
  }
  for (const auto& [node, vertices] : tied.middles) {
    for (int i = 0; i < dimension; ++i) {
      if (!tied.is_tied(i, node)) {
        continue;
      }
      for (const int vertex : vertices) {
        for (const auto& [column, share] :
             shares[dimension * Eigen::Index(vertex) + i]) {
          shares[dimension * Eigen::Index(node) + i][column] +=
              share / double(vertices.size());
        }
      }
    }
  }
  for (Eigen::Index dof = 0; dof < mesh.NumDofs(); ++dof) {
    for (const auto& [column, share] : shares[dof]) {
      entries.emplace_back(dof, column, share);
    }
  }
  for (const RigidFace& face : supports.rigid_faces) {
    const Eigen::MatrixXd& at =
        face.components.all() ? positions.of_faces : mesh.nodes;
    Eigen::MatrixXd motions = RigidMotionsAbout(at(Eigen::all, face.nodes));
    for (Eigen::Index row = 0; row < motions.rows(); ++row) {
      motions.row(row) *= face.components(row % dimension) ? 1 : 0;
    }
    const Eigen::MatrixXd span = OrthonormalBasis(motions, kNoMotion);
    for (Eigen::Index column = 0; column < span.cols(); ++column) {
      for (Eigen::Index row = 0; row < span.rows(); ++row) {
        if (span(row, column) != 0) {
          entries.emplace_back(
              dimension * Eigen::Index(face.nodes[row / dimension]) +
                  row % dimension,
              num_columns, span(row, column));
        }
      }
      ++num_columns;
    }
  }
  of_supports.resize(mesh.NumDofs(), num_columns);
  of_supports.setFromTriplets(entries.begin(), entries.end());
  if (scene.is_rigid_motion_free) {
    of_all = OrthonormalBasis(RigidMotionsAbout(positions.of_all), kNoMotion);
  }
}

Eigen::VectorXd FiniteIncrement(const Mesh& mesh, const Supports& supports,
                                const Eigen::VectorXd& displacement,
                                const Eigen::VectorXd& increment) {
  const auto of_nodes = [&](const Eigen::VectorXd& values) {
    return values.reshaped(mesh.Dimension(), mesh.NumNodes());
  };
  Eigen::MatrixXd finite = of_nodes(increment);
  for (const RigidFace& face : supports.rigid_faces) {
    if (face.components.all()) {
      const Eigen::MatrixXd from =
          (mesh.nodes + of_nodes(displacement))(Eigen::all, face.nodes);
      finite(Eigen::all, face.nodes) =
          MovedRigidly(from,
                       RigidMotionNearest(
                           from, of_nodes(increment)(Eigen::all, face.nodes))) -
          from;
    }
  }
  return finite.reshaped();
}

Eigen::VectorXd MeasuredSupports(const Scene& scene, Eigen::Index k) {
  const ComponentMask measured = AsMeasured(SupportsOf(scene, k));
  const LoadCase& load_case = scene.load_cases[k];
  if (measured.size() == 0 || load_case.displacement.size() == 0) {
    return Eigen::VectorXd::Zero(scene.mesh.NumDofs());
  }
  const ComponentMask known = load_case.observed.size() == 0
                                  ? measured
                                  : measured && load_case.observed;
  return known.select(load_case.displacement.array(), 0.0).reshaped();
}

}  // namespace elastimate
