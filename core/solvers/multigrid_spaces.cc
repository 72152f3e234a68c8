#include "elastimate/core/solvers/multigrid_spaces.h"

#include "elastimate/core/mesh/node_order.h"

namespace elastimate {

void OrderFinest(const Mesh& mesh, const DegreesOfFreedom& degrees_of_freedom,
                 MultigridSpaces& spaces) {
  if (HasLocality(mesh)) {
    return;
  }
  const int dimension = degrees_of_freedom.dimension;
  std::vector<int> row_of_node(mesh.NumNodes(), -1);
  for (std::size_t i = 0; i < spaces.row_of_free.size(); ++i) {
    row_of_node[degrees_of_freedom.free[i] / dimension] =
        spaces.row_of_free[i] / dimension;
  }
  std::vector<int> rows;
  std::vector<int> new_rows(spaces.matrices.back().NumBlockRows());
  for (const int node : OrderForLocality(mesh).places) {
    if (row_of_node[node] >= 0) {
      new_rows[row_of_node[node]] = static_cast<int>(rows.size());
      rows.push_back(row_of_node[node]);
    }
  }
  spaces.matrices.back() = Ordered(spaces.matrices.back(), rows, new_rows);
  if (!spaces.interpolations.empty()) {
    spaces.interpolations.back() =
        Ordered(spaces.interpolations.back(), rows, {});
  }
  for (int& row : spaces.row_of_free) {
    row = dimension * new_rows[row / dimension] + row % dimension;
  }
}

}  // namespace elastimate
