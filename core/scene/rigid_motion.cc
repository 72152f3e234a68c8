#include "elastimate/core/scene/rigid_motion.h"

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <array>
#include <boost/pending/disjoint_sets.hpp>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <utility>
#include <vector>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/mesh/axis_names.h"
#include "elastimate/core/mesh/elements_of_nodes.h"

namespace elastimate {
namespace {

using DisjointSets = boost::disjoint_sets_with_storage<>;

// The other vertices of a face whose smallest node is known, ascending; -1
// where there are fewer.
struct NodeFace {
  std::array<int, 3> others;
  int element;

  bool operator<(const NodeFace& other) const { return others < other.others; }
};

// Joins the elements that are connected through faces.
DisjointSets ElementsJoinedByFaces(const Mesh& mesh) {
  const ElementsOfNodes around(mesh);
  const auto& faces_of_element = mesh.Topology().faces;
  DisjointSets sets(mesh.NumElements());
  std::vector<NodeFace> faces;  // Whose smallest node is the same.
  for (Eigen::Index node = 0; node < mesh.NumNodes(); ++node) {
    faces.clear();
    for (Eigen::Index i = around.start[node]; i < around.start[node + 1]; ++i) {
      const int e = static_cast<int>(around.element[i]);
      const auto nodes = mesh.elements.col(e);
      for (const std::vector<int>& vertices : faces_of_element) {
        NodeFace face = {{-1, -1, -1}, e};
        std::size_t num_others = 0;
        bool has_node = false;
        bool is_smallest = true;
        for (const int vertex : vertices) {
          if (nodes(vertex) == node) {
            has_node = true;
          } else {
            is_smallest = is_smallest && nodes(vertex) > node;
            face.others[num_others % 3] = nodes(vertex);
            ++num_others;
          }
        }
        if (has_node && is_smallest) {
          std::sort(face.others.begin(), face.others.end());
          faces.push_back(face);
        }
      }
    }
    std::sort(faces.begin(), faces.end());
    for (std::size_t i = 1; i < faces.size(); ++i) {
      if (faces[i].others == faces[i - 1].others) {
        sets.union_set(faces[i].element, faces[i - 1].element);
      }
    }
  }
  return sets;
}

// A rigid body.
struct Body {
  std::vector<int> nodes;  // Ascending.
  Eigen::VectorXd centroid;
  double radius = 0;

  Body(const Mesh& mesh, std::vector<int> its_nodes)
      : nodes(std::move(its_nodes)),
        centroid(Eigen::VectorXd::Zero(mesh.Dimension())) {
    for (const int node : nodes) {
      centroid += mesh.nodes.col(node);
    }
    centroid /= static_cast<double>(nodes.size());
    for (const int node : nodes) {
      radius = std::max(radius, (mesh.nodes.col(node) - centroid).norm());
    }
  }
};

// Returns the bodies, ordered by their smallest nodes.
std::vector<Body> BodiesOf(const Mesh& mesh) {
  DisjointSets joined = ElementsJoinedByFaces(mesh);
  std::vector<std::pair<int, int>> nodes;  // Of the root of a body.
  nodes.reserve(mesh.NumNodes());
  std::vector<int> first(mesh.NumNodes(), -1);
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    const int root = static_cast<int>(joined.find_set(e));
    for (const int node : mesh.elements.col(e)) {
      if (first[node] < 0) {
        first[node] = root;
      }
      // Elements around a node nearly always belong to one body.
      if (first[node] != root) {
        nodes.emplace_back(root, node);
      }
    }
  }
  for (int node = 0; node < mesh.NumNodes(); ++node) {
    nodes.emplace_back(first[node], node);
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());

  std::vector<Body> bodies;
  for (auto begin = nodes.begin(); begin != nodes.end();) {
    const auto end = std::find_if(begin, nodes.end(), [&](const auto& node) {
      return node.first != begin->first;
    });
    std::vector<int> of_body;
    for (; begin != end; ++begin) {
      of_body.push_back(begin->second);
    }
    bodies.emplace_back(mesh, std::move(of_body));
  }
  std::sort(bodies.begin(), bodies.end(), [](const Body& a, const Body& b) {
    return a.nodes.front() < b.nodes.front();
  });
  return bodies;
}

// Returns the direction closest to an axis among those that the orthonormal
// columns of `span` span: "x", or "(0.6, 0.8, 0)".
std::string DescribeDirection(const Eigen::MatrixXd& span) {
  const Eigen::MatrixXd projection = span * span.transpose();
  Eigen::Index axis = 0;
  projection.diagonal().maxCoeff(&axis);
  const Eigen::VectorXd direction = projection.col(axis).normalized();
  if (direction(axis) > 0.9999) {
    return kAxisNames[axis];
  }
  std::ostringstream text;
  text << std::setprecision(2);
  for (Eigen::Index i = 0; i < direction.size(); ++i) {
    text << (i == 0 ? "(" : ", ")
         << (std::abs(direction(i)) < 0.005 ? 0.0 : direction(i));
  }
  text << ")";
  return text.str();
}

// Describes one of the rigid motions that the columns span.  It takes a
// translation if there is one, since any rotation about an axis off the
// centroid moves the centroid too.
std::string DescribeRigidMotion(const Eigen::MatrixXd& columns) {
  // The columns are dependent where they are rows of a part of all bodies.
  constexpr double kSmall = 1e-5;
  const SingularValueDecomposition span = DecomposeSingularValues(columns);
  const Eigen::MatrixXd motions =
      span.u.leftCols((span.values.array() > kSmall * span.values(0)).count());
  const int dimension = columns.rows() == NumRigidMotions(3) ? 3 : 2;
  const SingularValueDecomposition rotations =
      DecomposeSingularValues(motions.bottomRows(motions.rows() - dimension));
  const Eigen::Index rank = (rotations.values.array() > kSmall).count();
  if (rank < motions.cols()) {
    return "move along " +
           DescribeDirection(motions.topRows(dimension) *
                             rotations.v.rightCols(motions.cols() - rank));
  }
  return dimension == 2
             ? "rotate"
             : "rotate about " + DescribeDirection(rotations.u.leftCols(rank));
}

// Returns the coefficients of the rigid motions of a body (translations, then
// rotations about axes through its centroid, by radii) in the displacement of a
// node: dimension rows.
Eigen::MatrixXd RigidMotionRows(const Mesh& mesh, const Body& body, int node) {
  return RigidMotionsAt((mesh.nodes.col(node) - body.centroid) / body.radius);
}

// Returns a quadratic form of the rigid motions of all bodies that is zero
// where nothing resists them.  It adds up the squared motions of held
// components, and the squared distances by which bodies that share a node move
// apart there.
Eigen::SparseMatrix<double> HoldingForm(
    const Mesh& mesh, const Supports& supports,
    const std::vector<const Body*>& bodies) {
  const int num_motions = NumRigidMotions(mesh.Dimension());
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](Eigen::Index a, Eigen::Index b,
                       const Eigen::MatrixXd& block) {
    for (Eigen::Index i = 0; i < num_motions; ++i) {
      for (Eigen::Index j = 0; j < num_motions; ++j) {
        entries.emplace_back(num_motions * a + i, num_motions * b + j,
                             block(i, j));
      }
    }
  };
  std::vector<std::pair<int, Eigen::Index>> nodes;
  for (Eigen::Index b = 0; b < Eigen::Index(bodies.size()); ++b) {
    Eigen::MatrixXd held = Eigen::MatrixXd::Zero(num_motions, num_motions);
    for (const int node : bodies[b]->nodes) {
      nodes.emplace_back(node, b);
      if (!supports.held.col(node).any()) {
        continue;
      }
      const Eigen::MatrixXd rows = RigidMotionRows(mesh, *bodies[b], node);
      for (int i = 0; i < mesh.Dimension(); ++i) {
        if (supports.held(i, node)) {
          held += rows.row(i).transpose() * rows.row(i);
        }
      }
    }
    add(b, b, held);
  }
  std::sort(nodes.begin(), nodes.end());
  for (std::size_t k = 1; k < nodes.size(); ++k) {
    const auto [node, b] = nodes[k];
    const auto [previous, a] = nodes[k - 1];
    if (node != previous) {
      continue;
    }
    const Eigen::MatrixXd rows_a = RigidMotionRows(mesh, *bodies[a], node);
    const Eigen::MatrixXd rows_b = RigidMotionRows(mesh, *bodies[b], node);
    add(a, a, rows_a.transpose() * rows_a);
    add(b, b, rows_b.transpose() * rows_b);
    add(a, b, -rows_a.transpose() * rows_b);
    add(b, a, -rows_b.transpose() * rows_a);
  }
  const Eigen::Index size = num_motions * Eigen::Index(bodies.size());
  Eigen::SparseMatrix<double> form(size, size);
  form.setFromTriplets(entries.begin(), entries.end());
  return form;
}

// Squares of lever arms below 1e-6 of a radius count as zero.
constexpr double kHoldsNothing = 1e-12;

// Returns an orthonormal basis of the motions that nothing holds.
Eigen::MatrixXd FreeMotions(const Eigen::SparseMatrix<double>& form) {
  const SymmetricEigenDecomposition eigen =
      DecomposeSymmetric(Eigen::MatrixXd(form));
  return eigen.vectors.leftCols((eigen.values.array() < kHoldsNothing).count());
}

// Returns one of these motions, by inverse iteration; no column where there is
// none.
Eigen::MatrixXd AFreeMotion(const Eigen::SparseMatrix<double>& form) {
  constexpr int kIterations = 5;
  Eigen::SparseMatrix<double> identity(form.rows(), form.cols());
  identity.setIdentity();
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> inverse(
      form + 0.1 * kHoldsNothing * identity);
  // The iteration may start from any vector that has a part along each motion.
  Eigen::VectorXd motion = Eigen::VectorXd::NullaryExpr(
      form.rows(),
      [](Eigen::Index i) { return std::cos(static_cast<double>(i * i)); });
  for (int i = 0; i < kIterations; ++i) {
    motion = inverse.solve(motion).normalized();
  }
  if (motion.dot(form * motion) < kHoldsNothing) {
    return motion;
  }
  return Eigen::MatrixXd(form.rows(), 0);
}

// Returns the smallest node of body `b` that no other body has, if there is
// one.
int NodeOfItsOwn(Eigen::Index b, const std::vector<const Body*>& bodies) {
  const std::vector<int>& nodes = bodies[b]->nodes;
  const auto is_shared = [&](int node) {
    return std::any_of(bodies.begin(), bodies.end(), [&](const Body* other) {
      return other != bodies[b] &&
             std::binary_search(other->nodes.begin(), other->nodes.end(), node);
    });
  };
  const auto own = std::find_if_not(nodes.begin(), nodes.end(), is_shared);
  return own == nodes.end() ? nodes.front() : *own;
}

Body Union(const Mesh& mesh, const std::vector<const Body*>& bodies) {
  std::vector<int> nodes;
  for (const Body* const body : bodies) {
    nodes.insert(nodes.end(), body->nodes.begin(), body->nodes.end());
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return Body(mesh, std::move(nodes));
}

// Returns a sentence about the first of the bodies that moves; empty when none
// does.
std::string WhyNotHeld(const Mesh& mesh, const Supports& supports,
                       const std::vector<const Body*>& bodies) {
  // The time for all motions grows with the third power of the number of
  // bodies.
  constexpr std::size_t kMostBodies = 64;
  const Eigen::SparseMatrix<double> form = HoldingForm(mesh, supports, bodies);
  const Eigen::MatrixXd motions =
      bodies.size() <= kMostBodies ? FreeMotions(form) : AFreeMotion(form);
  if (motions.cols() == 0) {
    return "";
  }
  constexpr double kMoves = 1e-3;
  const int num_motions = NumRigidMotions(mesh.Dimension());
  Eigen::Index b = 0;
  while (motions.middleRows(num_motions * b, num_motions).norm() <
         kMoves / std::sqrt(static_cast<double>(bodies.size()))) {
    ++b;
  }
  const bool is_hinged = bodies.size() > 1;
  return "the supports let the part of the mesh around node " +
         std::to_string(NodeOfItsOwn(b, bodies)) + " " +
         DescribeRigidMotion(motions.middleRows(num_motions * b, num_motions)) +
         " without strain; hold more components" +
         (is_hinged ? ", or mend the mesh, in which this part shares only "
                      "edges or nodes with the rest"
                    : "");
}

}  // namespace

Eigen::MatrixXd MovedRigidly(const Eigen::MatrixXd& points,
                             const Eigen::VectorXd& motion) {
  const Eigen::Index dimension = points.rows();
  Eigen::MatrixXd rotation;
  if (dimension == 2) {
    rotation = Eigen::Rotation2Dd(motion(2)).toRotationMatrix();
  } else {
    const Eigen::Vector3d turn = motion.tail(3);
    rotation = Eigen::AngleAxisd(turn.norm(), turn.stableNormalized())
                   .toRotationMatrix();
  }
  return (rotation * points).colwise() + motion.head(dimension);
}

Eigen::VectorXd RigidMotionNearest(const Eigen::MatrixXd& points,
                                   const Eigen::MatrixXd& change) {
  // A rotation that moves points on a line by less than this share is one about
  // the line.
  constexpr double kNoMotion = 1e-6;
  const Eigen::Index dimension = points.rows();
  const Eigen::VectorXd middle = points.rowwise().mean();
  const Eigen::MatrixXd arms = points.colwise() - middle;
  const double size = arms.cwiseAbs().maxCoeff();
  const double unit = size > 0 ? size : 1;
  Eigen::VectorXd motion = SolveLeastSquares(RigidMotionsOf(arms / unit),
                                             change.reshaped(), kNoMotion);
  const Eigen::VectorXd translation = motion.head(dimension);
  motion /= unit;
  motion.head(dimension).setZero();
  motion.head(dimension) = middle + translation - MovedRigidly(middle, motion);
  return motion;
}

std::string WhyNotHeld(const Mesh& mesh, const Supports& supports) {
  const std::vector<Body> bodies = BodiesOf(mesh);
  std::vector<int> first(mesh.NumNodes(), -1);
  DisjointSets hinged(bodies.size());
  for (int b = 0; b < static_cast<int>(bodies.size()); ++b) {
    for (const int node : bodies[b].nodes) {
      if (first[node] < 0) {
        first[node] = b;
      }
      hinged.union_set(first[node], b);
    }
  }
  std::vector<std::vector<const Body*>> groups;
  std::vector<int> group_of(bodies.size(), -1);
  for (int b = 0; b < static_cast<int>(bodies.size()); ++b) {
    int& group = group_of[hinged.find_set(b)];
    if (group < 0) {
      group = static_cast<int>(groups.size());
      groups.emplace_back();
    }
    groups[group].push_back(&bodies[b]);
  }
  for (const std::vector<const Body*>& group : groups) {
    // The group is tried as a whole first, and then part by part.
    std::string why;
    if (group.size() > 1) {
      const Body whole = Union(mesh, group);
      why = WhyNotHeld(mesh, supports, {&whole});
    }
    if (why.empty()) {
      why = WhyNotHeld(mesh, supports, group);
    }
    if (!why.empty() && groups.size() > 1) {
      why +=
          " (it shares no node with the rest of the mesh, even if nodes of "
          "both lie at the same place)";
    }
    if (!why.empty()) {
      return why;
    }
  }
  return "";
}

std::string WhyNotHeld(const Scene& scene) {
  std::string why = WhyNotHeld(scene.mesh, scene.supports);
  for (std::size_t k = 0; k < scene.load_cases.size() && why.empty(); ++k) {
    if (scene.load_cases[k].supports) {
      why = WhyNotHeld(scene.mesh, *scene.load_cases[k].supports);
      why.insert(
          0, why.empty() ? "" : "in load case " + std::to_string(k + 1) + ", ");
    }
  }
  return why;
}

}  // namespace elastimate
