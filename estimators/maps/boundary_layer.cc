#include "elastimate/estimators/maps/boundary_layer.h"

namespace elastimate {
namespace {

// The rest is what noise has put into a region that is otherwise thin.
constexpr double kLeastShare = 0.9;

}  // namespace

bool IsBoundaryLayer(const Mesh& mesh, const Eigen::VectorXd& volumes,
                     const std::vector<int>& region_of_element,
                     const Eigen::VectorXd& levels) {
  if (levels.size() != 3 || levels(1) <= levels(0) || levels(1) >= levels(2)) {
    return false;
  }
  using OfNodes = Eigen::Array<bool, Eigen::Dynamic, 3>;
  OfNodes is_in = OfNodes::Constant(mesh.NumNodes(), 3, false);
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    for (const int node : mesh.elements.col(e)) {
      is_in(node, region_of_element[e]) = true;
    }
  }
  double whole = 0;
  double between = 0;
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    if (region_of_element[e] == 1) {
      bool is_beside_first = false;
      bool is_beside_last = false;
      for (const int node : mesh.elements.col(e)) {
        is_beside_first = is_beside_first || is_in(node, 0);
        is_beside_last = is_beside_last || is_in(node, 2);
      }
      whole += volumes(e);
      between += is_beside_first && is_beside_last ? volumes(e) : 0;
    }
  }
  return between >= kLeastShare * whole;
}

}  // namespace elastimate
