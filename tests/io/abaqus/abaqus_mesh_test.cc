#include "elastimate/io/abaqus/abaqus_mesh.h"

#include <gmock/gmock.h>
#include <gmsh.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "elastimate/core/mesh/facets.h"
#include "elastimate/io/scene/mesh_reader.h"
#include "elastimate/io/scene/scene_reader.h"
#include "tests/io/abaqus_files.h"
#include "tests/io/mesh_text.h"
#include "tests/io/scene_files.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class AbaqusMeshTest : public MeshTextTest {
 protected:
  AbaqusMeshTest() : MeshTextTest("mesh.inp") {}
  SceneReading ReadWith(const std::string& content,
                        const std::string& rest) const {
    folder_.Write("mesh.inp", content);
    return ReadScene(
        {folder_.Write("scene.json", "{\"mesh\": \"mesh.inp\", " + rest + "}")},
        Measurement::kOptional);
  }
};

const PhysicalGroup& GroupOf(const MeshFile& mesh, const std::string& name,
                             int dimension) {
  const auto found = std::find_if(
      mesh.groups.begin(), mesh.groups.end(), [&](const PhysicalGroup& group) {
        return group.name == name && group.dimension == dimension;
      });
  if (found == mesh.groups.end()) {
    throw std::runtime_error("no group " + name);
  }
  return *found;
}

std::string TwoFlatTetrahedra() {
  return R"(** no heading
*NODE, NSET=NALL
1, 0, 0, 0
2, 1.D0, 0, 0
3, 0, +1e0, 0
4, 0, 0, 1
5, 0, 0, -1.
*ELEMENT, TYPE=C3D4,
 ELSET=EALL
1, 1, 2,
3, 4
2, 1, 3, 2, 5
*NSET, NSET=BOTTOM
5
*nset, nset=bottom, generate
1, 3
*ELSET, ELSET=ONE
1
*ELSET, ELSET=BOTH
ONE, 2
*NSET, NSET=OFONE, ELSET=ONE
*SURFACE, NAME=TOP
ONE, S3
1, S2
)";
}

TEST_F(AbaqusMeshTest, ReadsTheInstanceThatHasABody) {
  const MeshFile mesh = Read(AbaqusDeckText());
  EXPECT_EQ(mesh.kind, ElementKind::kTet4);
  EXPECT_THAT(mesh.node_numbers, ElementsAre(2, 3, 5, 7, 9, 10));
  // Shifted down by 5 and then turned: x becomes y, and y becomes -x.
  Eigen::Matrix3Xd nodes(3, 6);
  nodes.transpose() << 0, 1, 0, -1, 0, 0, 0, 0, 1, 0, 0, -1, -8, 8, 3, 0, 0, 0;
  EXPECT_LT((mesh.nodes - nodes).cwiseAbs().maxCoeff(), 1e-14);
  Eigen::MatrixXi elements(4, 2);
  elements.transpose() << 5, 0, 1, 2, 5, 1, 0, 3;
  EXPECT_EQ(mesh.elements, elements);
}

TEST_F(AbaqusMeshTest, ReadsSetsOfPartsAndOfTheAssembly) {
  const MeshFile mesh = Read(AbaqusDeckText());
  EXPECT_THAT(GroupOf(mesh, "Set-1", 0).nodes, ElementsAre(0, 1, 5));
  EXPECT_THAT(GroupOf(mesh, "Body-1.Set-1", 0).nodes, ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(GroupOf(mesh, "Tips", 0).nodes, ElementsAre(2, 3));
  EXPECT_THAT(GroupOf(mesh, "Dots", 0).nodes, ElementsAre(2, 3));
  EXPECT_THAT(GroupOf(mesh, "Upper", 3).nodes, ElementsAre(0, 1, 2, 5));
  // S2 and S3 of 10 2 3 5 are 10 5 2 and 2 5 3.
  const PhysicalGroup& top = GroupOf(mesh, "Top", 2);
  EXPECT_THAT(top.nodes, ElementsAre(0, 1, 2, 5));
  Eigen::MatrixXi facets(3, 2);
  facets.transpose() << 5, 2, 0, 0, 2, 1;
  EXPECT_EQ(top.facets, facets);
  EXPECT_EQ(GroupOf(mesh, "Skin", 2).facets.cols(), 6);
  EXPECT_TRUE(GroupOf(mesh, "RP", 0).nodes.empty());
  EXPECT_TRUE(std::none_of(
      mesh.groups.begin(), mesh.groups.end(),
      [](const PhysicalGroup& group) { return group.name[0] == '_'; }));
}

TEST_F(AbaqusMeshTest, MakesRegionsOfWhatHasMaterials) {
  const MeshFile mesh = Read(AbaqusDeckText());
  ASSERT_TRUE(mesh.are_regions_groups) << mesh.why_no_regions;
  const Eigen::MatrixXd& regions = *FindArray(mesh.element_arrays, "region");
  EXPECT_EQ(regions(0), GroupOf(mesh, "Upper", 3).number);
  EXPECT_EQ(regions(1), GroupOf(mesh, "Lower", 3).number);
  EXPECT_NE(regions(0), regions(1));
  EXPECT_EQ(GroupOf(mesh, "All", 3).number, 0);
}

TEST_F(AbaqusMeshTest, ReadsFlatFiles) {
  const MeshFile mesh = Read(TwoFlatTetrahedra());
  Eigen::MatrixXi elements(4, 2);
  elements.transpose() << 0, 1, 2, 3, 0, 2, 1, 4;
  EXPECT_EQ(mesh.elements, elements);
  EXPECT_EQ(mesh.nodes.col(1), Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(mesh.nodes.col(2), Eigen::Vector3d(0, 1, 0));
  EXPECT_THAT(GroupOf(mesh, "BOTTOM", 0).nodes, ElementsAre(0, 1, 2, 4));
  EXPECT_THAT(GroupOf(mesh, "OFONE", 0).nodes, ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(GroupOf(mesh, "BOTH", 3).nodes, ElementsAre(0, 1, 2, 3, 4));
  EXPECT_EQ(GroupOf(mesh, "TOP", 2).facets.cols(), 2);
  EXPECT_TRUE(mesh.are_regions_groups);  // ONE and the others.
}

TEST_F(AbaqusMeshTest, HasNoRegionsWhereSetsOverlap) {
  const std::string text = TwoFlatTetrahedra() + "*ELSET, ELSET=FIRST\n1\n";
  const MeshFile mesh = Read(text);
  EXPECT_FALSE(mesh.are_regions_groups);
  EXPECT_EQ(mesh.why_no_regions,
            "tetrahedron 0 (number 1 in Abaqus) is in the sets \"FIRST\" and "
            "\"ONE\"");
  // Sections say which of them have materials.
  const std::string section =
      text +
      "*SOLID SECTION, ELSET=one, MATERIAL=M\n*SOLID SECTION, "
      "ELSET=TWO, MATERIAL=M2\n*ELSET, ELSET=TWO\n2\n";
  EXPECT_TRUE(Read(section).are_regions_groups);
}

TEST_F(AbaqusMeshTest, ReadsWhatIsIncluded) {
  const std::string text = TwoFlatTetrahedra();
  const std::size_t place = text.find("*ELEMENT");
  folder_.Write("nodes.inc", text.substr(0, place));
  EXPECT_EQ(Read("*Include, input=nodes.inc\n" + text.substr(place)).elements,
            Read(text).elements);
  // As Windows writes it, and as a parameter of a keyword.
  const std::size_t data = text.find("1, 0, 0, 0");
  std::filesystem::create_directory(folder_.Path() / "sub");
  folder_.Write("sub/nodes.txt", text.substr(data, place - data));
  EXPECT_EQ(Read("*NODE, INPUT=sub\\nodes.txt\n" + text.substr(place)).nodes,
            Read(text).nodes);
  EXPECT_THAT(WhyNot("*Include, input=none.inc\n"), HasSubstr("no such file"));
  EXPECT_THAT(WhyNot("*Include, input=mesh.inp\n"),
              HasSubstr("line 1: the file includes itself"));
}

// Names of sets serve as supports, loads and regions, in letters of any case.
TEST_F(AbaqusMeshTest, MakesAScene) {
  const SceneReading reading = ReadWith(AbaqusDeckText(), R"(
    "supports": [{"nodes": {"set": "SET-1"}}],
    "materials": [{"region": "upper"}, {"region": "lower"}],
    "cases": [{"loads": [{"type": "pressure", "value": 2,
                          "surface": {"set": "top"}},
                         {"type": "nodal_force", "value": [0, 0, 1],
                          "nodes": {"physical": "Tips"}}]}])");
  const Scene& scene = reading.scene;
  EXPECT_EQ(scene.supports.held.count(), 9);
  EXPECT_EQ(scene.materials.size(), 2U);
  const Eigen::MatrixXi& facets =
      std::get<Pressure>(scene.load_cases[0].loads[0]).facets;
  EXPECT_EQ(facets.cols(), 2);
  EXPECT_NEAR(FacetArea(scene.mesh, facets), 0.5 + std::sqrt(3.0) / 2, 1e-14);
}

TEST_F(AbaqusMeshTest, TakesTheNodesOfASetBeforeItsElements) {
  // Abaqus/CAE makes both of a face.
  const std::string text = TwoFlatTetrahedra() +
                           "*NSET, NSET=FACE\n1, 2, 4\n*ELSET, ELSET=FACE\n1\n";
  const SceneReading reading = ReadWith(text, R"(
    "supports": [{"nodes": {"set": "FACE"}}],
    "cases": [{"loads": [{"type": "force", "value": [0, 0, 1],
                          "surface": {"set": "Face"}}]}])");
  EXPECT_EQ(reading.scene.supports.held.count(), 9);
  EXPECT_EQ(std::get<SurfaceForce>(reading.scene.load_cases[0].loads[0])
                .facets.cols(),
            1);
}

TEST_F(AbaqusMeshTest, ReadsReducedIntegrationWithANotice) {
  const std::string text = Replaced(TwoFlatTetrahedra(), "C3D4", "C3D4H");
  const MeshFile mesh = Read(text);
  EXPECT_EQ(mesh.elements, Read(TwoFlatTetrahedra()).elements);
  ASSERT_EQ(mesh.notices.size(), 1U);
  EXPECT_THAT(mesh.notices[0], HasSubstr("C3D4H are read as C3D4"));
}

TEST_F(AbaqusMeshTest, SaysWhatDoesNotConnectParts) {
  const std::string surfaces =
      "*SURFACE, NAME=ALL, COMBINE=UNION\nTOP, OTHER\n";
  EXPECT_TRUE(Read(TwoFlatTetrahedra() + surfaces).notices.empty());
  const MeshFile tied =
      Read(TwoFlatTetrahedra() + surfaces + "*TIE, NAME=T\nTOP, ALL\n");
  ASSERT_EQ(tied.notices.size(), 1);
  EXPECT_THAT(tied.notices[0], HasSubstr("*TIE is not read"));
}

TEST_F(AbaqusMeshTest, ReadsPlanarElementsWithTheirSection) {
  const std::string text =
      "*NODE\n1, 0, 0\n2, 1, 0\n3, 1, 1\n4, 0, 1\n"
      "*ELEMENT, TYPE=CPS4R, ELSET=SHEET\n1, 1, 2, 3, 4\n"
      "*SOLID SECTION, ELSET=SHEET, MATERIAL=M\n0.25\n"
      "*SURFACE, NAME=RIGHT\n1, S2\n*NSET, NSET=LEFT\n1, 4\n";
  const Scene scene =
      ReadWith(text, R"("supports": [{"nodes": {"set": "LEFT"}}],
    "cases": [{"loads": [{"type": "force", "value": [1, 0],
                          "surface": {"set": "RIGHT"}}]}])")
          .scene;
  EXPECT_EQ(scene.mesh.kind, ElementKind::kQuad4);
  EXPECT_EQ(scene.mesh.section.model, SectionModel::kPlaneStress);
  EXPECT_EQ(scene.mesh.section.thickness, 0.25);
  EXPECT_EQ(std::get<SurfaceForce>(scene.load_cases[0].loads[0]).facets,
            Eigen::Vector2i(1, 2));
  EXPECT_EQ(*Read(Replaced(text, "CPS4R", "CPE4")).model, 2);
  EXPECT_THROWS_WITH(
      ReadWith(Replaced(text, "*ELEMENT",
                        "5, 2, 0\n*ELEMENT, TYPE=CPE3\n2, 2, 5, 3\n*ELEMENT"),
               R"("supports": [], "cases": [{"loads": []}])"),
      "mesh.inp: some of its elements are in plane stress .CPS. and others in "
      "plane strain .CPE., but a scene has one model; give --model=");
}

// Abaqus' manual: the faces of hexahedra are 1234, 5876, 1562, 2673, 3784 and
// 4851.
TEST_F(AbaqusMeshTest, KnowsTheFacesOfHexahedra) {
  std::string text =
      "*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 1, 1, 0\n4, 0, 1, 0\n"
      "5, 0, 0, 1\n6, 1, 0, 1\n7, 1, 1, 1\n8, 0, 1, 1\n"
      "*ELEMENT, TYPE=C3D8I\n1, 1, 2, 3, 4, 5, 6, 7, 8\n";
  for (int face = 1; face <= 6; ++face) {
    text += "*SURFACE, NAME=F" + std::to_string(face) + "\n1, S" +
            std::to_string(face) + "\n";
  }
  const MeshFile mesh = Read(text);
  EXPECT_EQ(mesh.kind, ElementKind::kHex8);
  const std::vector<std::pair<int, double>> kPlanes = {{2, 0}, {2, 1}, {1, 0},
                                                       {0, 1}, {1, 1}, {0, 0}};
  for (int face = 0; face < 6; ++face) {
    const std::vector<int>& nodes =
        GroupOf(mesh, "F" + std::to_string(face + 1), 2).nodes;
    EXPECT_EQ(nodes.size(), 4U);
    for (const int node : nodes) {
      EXPECT_EQ(mesh.nodes(kPlanes[face].first, node), kPlanes[face].second);
    }
  }
}

// Gmsh writes the elements of surfaces and lines as planar elements and bars.
TEST_F(AbaqusMeshTest, ReadsWhatGmshWrites) {
  for (const int order : {1, 2}) {
    gmsh::initialize(0, nullptr, false);
    gmsh::option::setNumber("General.Terminal", 0);
    gmsh::model::occ::addBox(0, 0, 0, 1, 1, 1);
    gmsh::model::occ::synchronize();
    gmsh::vectorpair surfaces;
    gmsh::model::getEntities(surfaces, 2);
    gmsh::model::addPhysicalGroup(2, {surfaces[0].second}, 7);
    gmsh::model::setPhysicalName(2, 7, "left");
    gmsh::model::addPhysicalGroup(3, {1}, 8);
    gmsh::model::setPhysicalName(3, 8, "body");
    gmsh::option::setNumber("Mesh.MeshSizeMin", 0.5);
    gmsh::option::setNumber("Mesh.ElementOrder", order);
    gmsh::model::mesh::generate(3);
    gmsh::option::setNumber("Mesh.SaveAll", 0);
    const auto path = folder_.Path() / "gmsh.inp";
    gmsh::write(path.string());
    gmsh::write((folder_.Path() / "gmsh.msh").string());
    gmsh::finalize();
    const MeshFile mesh = ReadMeshFile(path);
    const MeshFile same = ReadMeshFile(folder_.Path() / "gmsh.msh");
    EXPECT_EQ(mesh.kind, order == 1 ? ElementKind::kTet4 : ElementKind::kTet10);
    EXPECT_EQ(mesh.elements, same.elements);
    EXPECT_LT((mesh.nodes - same.nodes).cwiseAbs().maxCoeff(), 1e-12);
    const auto left = std::find_if(
        mesh.groups.begin(), mesh.groups.end(), [](const PhysicalGroup& group) {
          return group.name == "left" && group.dimension == 2;
        });
    ASSERT_NE(left, mesh.groups.end());
    EXPECT_EQ(left->nodes, same.groups[0].nodes);
    EXPECT_EQ(left->facets.cols(), same.groups[0].facets.cols());
  }
}

TEST_F(AbaqusMeshTest, RefusesWhatIsNotForScenes) {
  const std::string text = TwoFlatTetrahedra();
  EXPECT_THAT(WhyNot(Replaced(text, "*NSET",
                              "*ELEMENT, TYPE=C3D27\n7, 1,2,3,4\n*NSET")),
              HasSubstr("element 7 is of type C3D27, but the solid "
                        "elements that are read are C3D4, C3D5, C3D6, C3D8, "
                        "C3D10, C3D15 and C3D20;"));
  EXPECT_THAT(
      WhyNot(text + "*ELEMENT, TYPE=C3D4\n3, 1, 2, 3, 4\n"),
      HasSubstr("tetrahedra 0 and 2 (numbers 1 and 3 in Abaqus) have the same "
                "nodes"));
  EXPECT_THAT(WhyNot(Replaced(text, "*NSET",
                              "*ELEMENT, TYPE=C3D10\n"
                              "9, 1, 2, 3, 4, 5, 1, 2, 3, 4, 5\n*NSET")),
              HasSubstr("element 9 is of type C3D10, which is quadratic, but "
                        "others are linear"));
  EXPECT_THAT(WhyNot(Replaced(text, "*NSET",
                              "*ELEMENT, TYPE=C3D8\n"
                              "9, 1, 2, 3, 4, 5, 1, 2, 3\n*NSET")),
              HasSubstr("element 9 of type C3D8 is folded or flat"));
  EXPECT_THAT(WhyNot("*NODE\n1, 0, 0\n*ELEMENT, TYPE=CAX4\n1, 1, 1, 1, 1\n"),
              HasSubstr("axisymmetric"));
  EXPECT_THAT(WhyNot(text + "*NGEN\n1, 5\n"), HasSubstr("*NGEN is not read"));
  EXPECT_THAT(WhyNot(Replaced(text, "*NODE", "*NODE, SYSTEM=C")),
              HasSubstr("cylindrical"));
  const std::string deck = AbaqusDeckText();
  EXPECT_THAT(WhyNot(Replaced(deck, "part=Plate", "part=Body")),
              HasSubstr("it has 2 bodies"));
}

TEST_F(AbaqusMeshTest, NamesWhatIsWrong) {
  const std::string text = TwoFlatTetrahedra();
  EXPECT_THAT(WhyNot("1, 2, 3\n"), HasSubstr("line 1: there are data without"));
  EXPECT_THAT(WhyNot(Replaced(text, "2, 1.D0", "2, 1.x")),
              HasSubstr("mesh.inp: line 4: '1.x' is not a number"));
  EXPECT_THAT(WhyNot(Replaced(text, "4, 0, 0, 1", "3, 0, 0, 1")),
              HasSubstr("it has the node number 3 twice"));
  EXPECT_THAT(WhyNot(text + "*ELEMENT, TYPE=C3D4\n1, 1, 3, 2, 5\n"),
              HasSubstr("it has the element number 1 twice"));
  EXPECT_THAT(WhyNot(Replaced(text, "2, 1, 3, 2, 5", "2, 1, 3, 2, 6")),
              HasSubstr("element 2 names node 6"));
  EXPECT_THAT(WhyNot(Replaced(text, "2, 1, 3, 2, 5", "2, 1, 3, 2")),
              HasSubstr("element 2 of type C3D4 has 3 nodes where 4 are due"));
  EXPECT_THAT(WhyNot(text + "*NSET, NSET=X\n77\n"),
              HasSubstr("the set \"X\" names node 77"));
  EXPECT_THAT(WhyNot(text + "*ELSET, ELSET=X\nNONE\n"),
              HasSubstr("the set \"X\" names \"NONE\""));
  EXPECT_THAT(WhyNot(text + "*SURFACE, NAME=X\n1, S5\n"),
              HasSubstr("'S5' is no face of an element of type C3D4"));
  EXPECT_THAT(WhyNot(text + "*NSET, NSET=X, GENERATE\n1, 2000000000, 0\n"),
              HasSubstr("GENERATE has a step of 0"));
  EXPECT_THAT(WhyNot(Replaced(AbaqusDeckText(), "*End Step", "**")),
              HasSubstr("this *STEP has no *END STEP"));
  EXPECT_THAT(WhyNot(Replaced(AbaqusDeckText(), "*End Assembly", "**")),
              HasSubstr("this *ASSEMBLY has no *END ASSEMBLY"));
  EXPECT_THROWS_WITH(
      ReadWith(text, R"("supports": [{"nodes": {"set": "TOPS"}}],
        "cases": [{"loads": []}])"),
      "names no set of .*mesh.inp'; its sets are: \"BOTTOM\", \"NALL\"");
}

}  // namespace
}  // namespace elastimate
