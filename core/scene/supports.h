#ifndef ELASTIMATE_CORE_SCENE_SUPPORTS_H_
#define ELASTIMATE_CORE_SCENE_SUPPORTS_H_

#include <Eigen/Core>
#include <vector>

#include "elastimate/core/algebra/eigen_abi.h"

namespace elastimate {

/// One flag per displacement component: dimension x num_nodes.
using ComponentMask = Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic>;

/// A part of space in which a specimen is held, bounds included.
struct HeldBox {
  Eigen::VectorXd lower;  ///< The lower corner, `dimension` x 1 [length].
  Eigen::VectorXd upper;
  Eigen::Array<bool, Eigen::Dynamic, 1>
      components;                ///< Which components it holds.
  Eigen::VectorXd displacement;  ///< `dimension` components [length].

  bool Contains(const Eigen::Ref<const Eigen::VectorXd>& point) const {
    return (point.array() >= lower.array()).all() &&
           (point.array() <= upper.array()).all();
  }
};

/// A degree of freedom, and the displacement at which it may be held [length].
struct HeldComponent {
  Eigen::Index component;
  Eigen::Index node;
  double displacement;
};

/// A part of the specimen that a grip or a platen moves as a rigid body, by a
/// motion that is not known: some components of u = a + w x (x - x0).
struct RigidFace {
  std::vector<int> nodes;
  Eigen::Array<bool, Eigen::Dynamic, 1> components;  ///< One for each axis.
};

/// A node that a refinement put in the middle of some others.
struct MiddleNode {
  int node;
  std::vector<int> vertices;
};

/// The held degrees of freedom, and the displacement they are held at.
struct Supports {
  ComponentMask held;            ///< dimension x num_nodes.
  Eigen::MatrixXd displacement;  ///< dimension x num_nodes [length]; used where
                                 ///< `held`, ignored elsewhere.
  /// The boxes from which `held` comes, as far as it was told by place.  They
  /// decide about the nodes that QuadraticScene adds.
  std::vector<HeldBox> boxes = {};
  /// Held components whose displacement is not known and differs between load
  /// cases: those of rigid faces, and others that moved as they were measured,
  /// with the error of a measurement.  dimension x num_nodes; empty when there
  /// are none.
  ComponentMask unknown = {};
  std::vector<RigidFace> rigid_faces = {};
  /// Held components of supports that end with their nodes, as a part of the
  /// mesh does.  dimension x num_nodes; empty when there are none.
  ComponentMask delimited = {};
  /// The components of nodes where a support ends, of which QuadraticScene
  /// cannot tell whether it holds them (FindSupportEnds).  None is held.
  std::vector<HeldComponent> in_doubt = {};
  /// The nodes that QuadraticScene put between held nodes of unknown
  /// displacement, each after its vertices.  Such a node moves as their mean
  /// where it was not measured itself.
  std::vector<MiddleNode> middles = {};

  /// Tells whether component `i` of `node` is held at a displacement that is
  /// known.
  bool IsGiven(int i, Eigen::Index node) const {
    return held(i, node) && (unknown.size() == 0 || !unknown(i, node));
  }
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SCENE_SUPPORTS_H_
