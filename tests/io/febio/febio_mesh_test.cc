#include "elastimate/io/febio/febio_mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "elastimate/core/mesh/facets.h"
#include "elastimate/io/scene/mesh_reader.h"
#include "elastimate/io/scene/scene_reader.h"
#include "tests/io/febio_files.h"
#include "tests/io/mesh_text.h"
#include "tests/io/scene_files.h"

namespace elastimate {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class FebioMeshTest : public MeshTextTest {
 protected:
  FebioMeshTest() : MeshTextTest("mesh.feb") {}
};

const PhysicalGroup& FebioGroup(const MeshFile& mesh, const std::string& name) {
  return *std::find_if(
      mesh.groups.begin(), mesh.groups.end(),
      [&](const PhysicalGroup& group) { return group.name == name; });
}

TEST_F(FebioMeshTest, ReadsVersions3And4) {
  for (const bool is_version_4 : {false, true}) {
    const MeshFile mesh = Read(FebioText(is_version_4));
    EXPECT_EQ(mesh.kind, ElementKind::kTet4);
    EXPECT_THAT(mesh.node_numbers, ElementsAre(2, 3, 5, 7, 10));
    EXPECT_EQ(mesh.nodes.col(2), Eigen::Vector3d(0, 0, 1.5));
    Eigen::MatrixXi elements(4, 2);
    elements.transpose() << 4, 0, 1, 2, 4, 1, 0, 3;
    EXPECT_EQ(mesh.elements, elements);
    EXPECT_THAT(FebioGroup(mesh, "held").nodes, ElementsAre(0, 1, 4));
    EXPECT_THAT(FebioGroup(mesh, "one").nodes, ElementsAre(0, 1, 2, 4));
    EXPECT_EQ(FebioGroup(mesh, "top").facets, Eigen::Vector3i(0, 1, 2));
    ASSERT_TRUE(mesh.are_regions_groups);
    EXPECT_EQ(*FindArray(mesh.element_arrays, "region"),
              Eigen::RowVector2d(1, 2));
    ASSERT_EQ(mesh.notices.size(), 1U);
    EXPECT_THAT(mesh.notices[0], HasSubstr("1 element of type tri3 is left"));
  }
}

TEST_F(FebioMeshTest, MakesAScene) {
  folder_.Write("mesh.feb", FebioText(true));
  const Scene scene =
      ReadScene({folder_.Write("scene.json", R"({"mesh": "mesh.feb",
    "supports": [{"nodes": {"set": "held"}}],
    "materials": [{"region": "Upper"}, {"region": "Lower"}],
    "cases": [{"loads": [{"type": "force", "value": [0, 0, 1],
                          "surface": {"set": "top"}}]}]})")},
                Measurement::kOptional)
          .scene;
  EXPECT_EQ(scene.supports.held.count(), 9);
  EXPECT_EQ(std::get<SurfaceForce>(scene.load_cases[0].loads[0]).facets.cols(),
            1);
}

TEST_F(FebioMeshTest, NamesWhatIsWrong) {
  const std::string text = FebioText(true);
  EXPECT_THAT(WhyNot(text.substr(0, text.size() / 2)),
              HasSubstr("mesh.feb: the file is damaged"));
  EXPECT_THAT(WhyNot("<other/>"), HasSubstr("febio_spec"));
  EXPECT_THAT(WhyNot(Replaced(text, "version=\"4.0\"", "version=\"2.5\"")),
              HasSubstr("FEBio's format 2.5"));
  EXPECT_THAT(WhyNot(Replaced(text, "0,0,1.5", "0,0")),
              HasSubstr("has node 5 with 2 coordinates where 3 are due"));
  EXPECT_THAT(WhyNot(Replaced(text, "0,0,1.5", "0,0,z")),
              HasSubstr("Nodes \"all\" has 'z' where a number is due"));
  EXPECT_THAT(WhyNot(Replaced(text, "10,2,3,5<", "10,2,3<")),
              HasSubstr("has element 11 of type tet4 with 3 nodes"));
  EXPECT_THAT(WhyNot(Replaced(text, "10,2,3,5<", "10,2,3,6<")),
              HasSubstr("element 11 names node 6"));
  EXPECT_THAT(WhyNot(Replaced(text, "\"tet4\"", "\"penta6\"")),
              HasSubstr("has element 11 of type penta6 with 4 nodes where 6"));
  EXPECT_THAT(WhyNot(Replaced(text, "\"tet4\"", "\"hex27\"")),
              HasSubstr("element 11 is of type hex27"));
  EXPECT_THAT(WhyNot(Replaced(text, "id=\"22\"", "id=\"11\"")),
              HasSubstr("it has the element number 11 twice"));
}

}  // namespace
}  // namespace elastimate
