#include "elastimate/core/mesh/mesh_parts.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/core/random_values.h"
#include "tests/element_kinds.h"

namespace elastimate {
namespace {

using testing::KindOfSection;

class MeshPartsOfKinds : public ::testing::TestWithParam<KindOfSection> {};

TEST_P(MeshPartsOfKinds, ShareNoNodesAndAreTheSameElements) {
  const Mesh mesh = testing::MeshOfKind(GetParam());
  std::vector<int> part_of_element(mesh.NumElements());
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    part_of_element[e] = static_cast<int>(e % 3);
  }
  const MeshParts parts = SplitMesh(mesh, part_of_element);
  ValidateMesh(parts.mesh);
  std::set<std::pair<int, int>> copies;
  for (std::size_t copy = 0; copy < parts.node.size(); ++copy) {
    EXPECT_TRUE(copies.emplace(parts.node[copy], parts.part[copy]).second);
  }
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    for (Eigen::Index i = 0; i < mesh.elements.rows(); ++i) {
      const int copy = parts.mesh.elements(i, e);
      EXPECT_EQ(parts.node[copy], mesh.elements(i, e));
      EXPECT_EQ(parts.part[copy], part_of_element[e]);
      EXPECT_EQ(parts.mesh.nodes.col(copy),
                mesh.nodes.col(mesh.elements(i, e)));
    }
  }
  const Eigen::MatrixXd values = testing::RandomMatrix(mesh.NumDofs(), 2, 1);
  const Eigen::MatrixXd gathered = parts.Gather(values);
  for (std::size_t copy = 0; copy < parts.node.size(); ++copy) {
    EXPECT_EQ(gathered.middleRows(mesh.Dimension() * Eigen::Index(copy),
                                  mesh.Dimension()),
              values.middleRows(mesh.Dimension() * parts.node[copy],
                                mesh.Dimension()));
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, MeshPartsOfKinds,
                         ::testing::ValuesIn(testing::AllKindsOfSections()),
                         testing::KindTestName);

}  // namespace
}  // namespace elastimate
