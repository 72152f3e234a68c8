#ifndef ELASTIMATE_CORE_MECHANICS_FOLLOWER_PRESSURE_H_
#define ELASTIMATE_CORE_MECHANICS_FOLLOWER_PRESSURE_H_

#include <Eigen/Core>
#include <vector>

#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/mesh/node_graph.h"
#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// The nodal forces of pressures that follow the deformed surface,
///
///   F_i(u) = -p integral of N_i cof(F) N dA = -p integral of N_i n da,
///
/// over the deformed facets of normal n, whose area vector n da is the cross
/// product of their tangents [Bonet & Wood, Nonlinear Continuum Mechanics for
/// Finite Element Analysis, 2008, section 8.5].  In two dimensions the surface
/// has the thickness of the undeformed section.
class FollowerPressure {
 public:
  /// Keeps the pressures among `loads` that follow the surface (Follows).
  FollowerPressure(const Mesh& mesh, const std::vector<Load>& loads);

  /// Returns F(u), num_dofs.
  Eigen::VectorXd Forces(const Eigen::VectorXd& displacement) const;

  /// Adds `factor` times the symmetric part of dF / du to the blocks of the
  /// pairs of the graph of the mesh, dimension x (dimension num_pairs).
  /// dF/du itself is symmetric if the edge of the surface is held, or if the
  /// surface is closed.
  void AddSymmetricBlocks(const Eigen::VectorXd& displacement, double factor,
                          const NodeGraph& graph,
                          Eigen::MatrixXd& blocks) const;

 private:
  struct FacetPoint {
    Eigen::VectorXd value;     ///< N_i.
    Eigen::MatrixXd gradient;  ///< dN_i / dxi, (dimension - 1) x num_nodes.
    double weight;
  };

  static std::vector<FacetPoint> PointsOfFacets(const Mesh& mesh);
  /// Returns the deformed positions of the nodes of a facet.
  Eigen::MatrixXd Positions(const Eigen::Ref<const Eigen::VectorXi>& facet,
                            const Eigen::VectorXd& displacement) const;
  /// Returns dF / du of one facet for p = -1, rows dimension * node + component
  /// with nodes in the order of the facet.
  Eigen::MatrixXd FacetTangent(const Eigen::MatrixXd& positions) const;

  const Mesh& mesh_;
  std::vector<Pressure> pressures_;
  std::vector<FacetPoint> points_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MECHANICS_FOLLOWER_PRESSURE_H_
