#include "elastimate/io/gmsh/gmsh_mesh.h"

#include <gmock/gmock.h>
#include <gmsh.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "elastimate/io/scene/file_scene.h"
#include "elastimate/io/scene/mesh_reader.h"
#include "elastimate/io/scene/scene_reader.h"
#include "tests/io/gmsh_files.h"
#include "tests/io/scene_files.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

using ::testing::ElementsAre;

class GmshMeshTest : public ::testing::Test {
 protected:
  MeshFile Read(const std::string& name, const std::string& content) const {
    return ReadMeshFile(folder_.Write(name, content));
  }
  MeshFile Read(const std::string& content) const {
    return Read("mesh.msh", content);
  }

  const TemporaryFolder folder_;
};

void ExpectTwoTetrahedra(const MeshFile& mesh) {
  EXPECT_THAT(mesh.node_numbers, ElementsAre(2, 3, 5, 7, 10));
  EXPECT_EQ(mesh.nodes.col(4), Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(mesh.nodes.col(3), Eigen::Vector3d(0, 0, -1));
  Eigen::MatrixXi tetrahedra(4, 2);
  tetrahedra.transpose() << 4, 0, 1, 2, 4, 0, 1, 3;
  EXPECT_EQ(mesh.elements, tetrahedra);
  EXPECT_TRUE(mesh.used.all());
}

TEST_F(GmshMeshTest, ReadsVersions1And2And4) {
  for (const std::string& content :
       {GmshVersion1Mesh(), GmshVersion2Mesh(), GmshVersion4Mesh()}) {
    ::testing::internal::CaptureStderr();
    ::testing::internal::CaptureStdout();
    const MeshFile mesh = Read(content);
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
    EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
    ExpectTwoTetrahedra(mesh);
    ASSERT_FALSE(mesh.groups.empty());
    EXPECT_EQ(mesh.groups[0].dimension, 2);
    EXPECT_EQ(mesh.groups[0].number, 70);
    EXPECT_THAT(mesh.groups[0].nodes, ElementsAre(0, 1, 2, 4));
    EXPECT_EQ(mesh.groups[0].facets.cols(), 2);
  }
}

// Gmsh reads options from a file beside the mesh, which may hold any of its
// commands.
TEST_F(GmshMeshTest, DoesNotRunWhatLiesBesideAFile) {
  const std::string run = (folder_.Path() / "run").string();
  const std::string options =
      "Printf(\"\") > \"" + run + "\";\nSystemCall \"touch " + run + "\";\n";
  for (const std::string name : {"mesh.msh", "mesh.mesh"}) {
    std::string content = GmshVersion2Mesh();
    if (name == "mesh.mesh") {
      gmsh::initialize(0, nullptr, false);
      gmsh::option::setNumber("General.Terminal", 0);
      gmsh::merge(folder_.Write("source.msh", content).string());
      gmsh::write((folder_.Path() / name).string());
      gmsh::finalize();
      content = ReadFile(folder_.Path() / name);
    }
    const MeshFile alone = Read(name, content);
    for (const std::string end : {".opt", ".pos", ".geo"}) {
      folder_.Write(name + end, options);
    }
    const MeshFile mesh = Read(name, content);
    EXPECT_FALSE(std::filesystem::exists(run)) << name;
    EXPECT_EQ(mesh.elements, alone.elements) << name;
    EXPECT_EQ(mesh.nodes, alone.nodes) << name;
  }
}

TEST_F(GmshMeshTest, ReadsWhatGmshWrites) {
  const auto source = folder_.Write("source.msh", GmshVersion2Mesh());
  gmsh::initialize(0, nullptr, false);
  gmsh::option::setNumber("General.Terminal", 0);
  gmsh::merge(source.string());
  gmsh::option::setNumber("Mesh.SaveAll", 1);
  std::vector<std::filesystem::path> paths;
  const auto write = [&](const std::string& name, double version, int binary) {
    paths.push_back(folder_.Path() / name);
    gmsh::option::setNumber("Mesh.MshFileVersion", version);
    gmsh::option::setNumber("Mesh.Binary", binary);
    gmsh::write(paths.back().string());
  };
  write("v1.msh", 1.0, 0);
  write("v2.msh", 2.2, 0);
  write("v2_binary.msh", 2.2, 1);
  write("v40.msh", 4.0, 0);
  write("v41.msh", 4.1, 0);
  write("v41_binary.msh", 4.1, 1);
  write("m.unv", 4.1, 0);
  write("m.bdf", 4.1, 0);
  write("m.mesh", 4.1, 0);
  gmsh::finalize();
  for (const auto& path : paths) {
    SCOPED_TRACE(path);
    const MeshFile mesh = ReadMeshFile(path);
    EXPECT_EQ(mesh.nodes.cols(), 5);
    EXPECT_EQ(mesh.elements.cols(), 2);
    EXPECT_EQ(mesh.nodes.rowwise().sum(), Eigen::Vector3d(1, 1, 0));
    // The other formats lose the groups when all elements are saved.
    const bool has_groups =
        path.stem().string().rfind("v4", 0) == 0 || path.extension() == ".unv";
    EXPECT_EQ(ReadRegions(mesh),
              Eigen::VectorXi::Ones(has_groups ? mesh.elements.cols() : 0));
    if (path.stem() == "v41" || path.stem() == "v41_binary") {
      ExpectTwoTetrahedra(mesh);  // The others give nodes new numbers.
    }
  }
}

TEST_F(GmshMeshTest, SaysThatSetsOfNastranAreNotRead) {
  const std::string mesh =
      "BEGIN BULK\n"
      "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,0.,1.,0.\n"
      "GRID,4,,0.,0.,1.\nCTETRA,1,1,1,2,3,4\nENDDATA\n";
  const std::string sets = "SET 3 = 1 THRU 3\n set 5 = 4\nSETTINGS\n";
  const auto notices = [&](const std::string& text) {
    return ReadMeshFile(folder_.Write("m.bdf", text)).notices;
  };
  EXPECT_TRUE(notices(mesh).empty());
  ASSERT_EQ(notices(sets + mesh).size(), 1);
  EXPECT_THAT(
      notices(sets + mesh)[0],
      ::testing::StartsWith("2 sets of this Nastran file are not read"));
}

TEST_F(GmshMeshTest, ReadsASceneFromNodeData) {
  for (const std::string& content :
       {GmshVersion1Scene(), GmshVersion2Scene(), GmshVersion4Scene()}) {
    const auto path = folder_.Write("scene.msh", content);
    const Scene scene = ReadScene({path}, Measurement::kRequired).scene;
    EXPECT_TRUE(scene.supports.held.col(4).all());
    EXPECT_FALSE(scene.supports.held.col(2).any());
    const LoadCase& load_case = scene.load_cases.at(0);
    EXPECT_EQ(load_case.displacement.col(2), Eigen::Vector3d(.001, .002, .003));
    EXPECT_EQ(std::get<NodalForces>(load_case.loads[0]).force.col(2),
              Eigen::Vector3d(1, 2, 3));
  }
}

TEST_F(GmshMeshTest, NamesNodesWithoutData) {
  const auto path = folder_.Write(
      "scene.msh", Replaced(GmshVersion2Scene(), "3\n5\n10 0 0 0\n", "3\n4\n"));
  EXPECT_THROWS_WITH(ReadScene({path}, Measurement::kRequired),
                     "scene.msh: the point array 'displacement' of node 4 "
                     "\\(number 10 in Gmsh\\) \\(x\\) is nan");
}

TEST_F(GmshMeshTest, ReadsRegionsFromElementData) {
  const auto path = folder_.Write(
      "scene.msh", GmshVersion2Scene() +
                       "$ElementData\n1\n\"region\"\n1\n0\n3\n0\n1\n2\n5 8\n"
                       "4 7\n$EndElementData\n");
  EXPECT_EQ(ReadScene({path}, Measurement::kRequired).scene.mesh.regions,
            Eigen::Vector2i(7, 8));
  EXPECT_FALSE(ReadMeshFile(path).are_regions_groups);
}

// Each volume is a group.  Elements are numbered without regard to groups.
TEST_F(GmshMeshTest, ReadsRegionsFromPhysicalGroups) {
  const std::string two = Replaced(
      Replaced(GmshVersion2Mesh(), "3 1 \"body\"", "3 9 \"body\""),
      "4 4 2 1 1 10 2 3 5\n5 4 2 1 1", "5 4 2 9 2 10 2 3 5\n4 4 2 7 1");
  std::vector<std::filesystem::path> paths = {folder_.Write("two.msh", two)};
  gmsh::initialize(0, nullptr, false);
  gmsh::option::setNumber("General.Terminal", 0);
  gmsh::merge(paths.front().string());
  for (const auto& [version, binary] :
       {std::pair(1.0, 0), std::pair(2.2, 0), std::pair(2.2, 1),
        std::pair(4.0, 0), std::pair(4.1, 0), std::pair(4.1, 1)}) {
    paths.push_back(folder_.Path() /
                    ("mesh" + std::to_string(paths.size()) + ".msh"));
    gmsh::option::setNumber("Mesh.MshFileVersion", version);
    gmsh::option::setNumber("Mesh.Binary", binary);
    gmsh::write(paths.back().string());
  }
  gmsh::finalize();
  for (const std::filesystem::path& path : paths) {
    SCOPED_TRACE(path.filename());
    const MeshFile mesh = ReadMeshFile(path);
    EXPECT_TRUE(mesh.are_regions_groups);
    const Eigen::VectorXi regions = ReadRegions(mesh);
    ASSERT_EQ(regions.size(), 2);
    for (Eigen::Index e = 0; e < 2; ++e) {
      const bool is_below =
          (mesh.nodes.row(2)(mesh.elements.col(e)).array() < 0).any();
      EXPECT_EQ(regions(e), is_below ? 7 : 9);
    }
  }
}

TEST_F(GmshMeshTest, ReadsElementsOfNoGroupAsRegionZero) {
  const MeshFile mesh = Read(
      Replaced(GmshVersion2Mesh(), "5 4 2 1 1 10 2 3 7", "5 4 2 0 2 10 2 3 7"));
  EXPECT_EQ(ReadRegions(mesh), Eigen::Vector2i(1, 0));
  const MeshFile none = Read(
      Replaced(GmshVersion2Mesh(), "4 4 2 1 1 10 2 3 5\n5 4 2 1 1 10 2 3 7",
               "4 4 2 0 1 10 2 3 5\n5 4 2 0 2 10 2 3 7"));
  EXPECT_EQ(ReadRegions(none).size(), 0);
  EXPECT_FALSE(none.are_regions_groups);
}

// A group of the whole mesh beside groups of its parts serves loads and
// supports, so the groups are no regions.
TEST_F(GmshMeshTest, HasNoRegionsWhereAnElementIsInTwoGroups) {
  const std::string content =
      Replaced(GmshVersion4Scene(), "1 0 0 -1 1 1 1 1 1 0\n",
               "1 0 0 -1 1 1 1 2 1 3 0\n");
  const auto path = folder_.Write("scene.msh", content);
  const SceneReading reading = ReadScene({path}, Measurement::kRequired);
  EXPECT_EQ(reading.scene.mesh.regions.size(), 0);
  EXPECT_THAT(reading.notices,
              ElementsAre(::testing::HasSubstr(
                  "its groups of elements overlap (tetrahedron 0 (number 3 in "
                  "Gmsh) is in the physical groups 1")));
  EXPECT_THROWS_WITH(
      ReadScene({path}, Measurement::kRequired,
                {{}, RegionChoice::kEach, {}, {}}),
      "scene.msh: there are no regions that could have their own materials: "
      "tetrahedron 0 .number 3 in Gmsh. "
      "is in the physical groups 1 \"body\" and 3; put it into one");
}

TEST_F(GmshMeshTest, SaysHowAMeshHasRegions) {
  const auto path = folder_.Write(
      "scene.msh",
      Replaced(GmshVersion2Scene(), "4 4 2 1 1 10 2 3 5\n5 4 2 1 1 10 2 3 7",
               "4 4 2 0 1 10 2 3 5\n5 4 2 0 1 10 2 3 7"));
  EXPECT_THROWS_WITH(
      ReadScene({path}, Measurement::kRequired,
                {{}, RegionChoice::kEach, {}, {}}),
      "scene.msh: there are no regions that could have their own materials; "
      "put the "
      "elements into physical groups, or add the element data \"region\"");
}

TEST_F(GmshMeshTest, NotesRegionsThatShareOneMaterial) {
  const auto path = folder_.Write(
      "scene.msh", Replaced(GmshVersion2Scene(), "5 4 2 1 1 10 2 3 7",
                            "5 4 2 2 2 10 2 3 7"));
  EXPECT_THAT(ReadScene({path}, Measurement::kRequired).notices,
              ElementsAre(::testing::HasSubstr(
                  "the mesh has 2 regions, but all regions share one")));
  EXPECT_THAT(ReadScene({path}, Measurement::kRequired,
                        {{}, RegionChoice::kEach, {}, {}})
                  .scene.materials,
              ::testing::SizeIs(2));
}

TEST_F(GmshMeshTest, SaysThatAMeshIsNoScene) {
  const auto path = folder_.Write("liver.msh", GmshVersion1Mesh());
  EXPECT_THROWS_WITH(
      ReadScene({path}, Measurement::kRequired),
      "liver.msh: a mesh alone is not a scene, as it has no supports, loads "
      "and displacements; write a scene.json with \"mesh\": \"liver.msh\"");
}

TEST_F(GmshMeshTest, KnowsOfNodesThatGmshLeavesOut) {
  const MeshFile mesh =
      Read(Replaced(GmshVersion2Mesh(), "$Nodes\n5\n", "$Nodes\n6\n1 7 7 7\n"));
  EXPECT_EQ(mesh.num_nodes_left_out, 1);
  EXPECT_EQ(mesh.nodes.cols(), 5);
}

TEST_F(GmshMeshTest, ErrsOnOtherVolumeElements) {
  EXPECT_THROWS_WITH(
      Read(Replaced(GmshVersion2Mesh(), "5 4 2 1 1 10 2 3 7",
                    "5 14 2 1 1 10 2 3 7 5 10 2 3 7 5 10 2 3 7")),
      "mesh.msh: element number . is a .*, but the "
      "elements of a scene are tetrahedra of 4 or 10 nodes");
}

TEST_F(GmshMeshTest, ErrsOnDamage) {
  const std::string whole = GmshVersion2Mesh();
  EXPECT_THROWS_WITH(
      Read(Replaced(whole, "5 4 2 1 1 10 2 3 7", "5 4 2 1 1 10 2 3 77")),
      "mesh.msh: .*Wrong node index 77");
  EXPECT_THROWS_WITH(Read(whole.substr(0, whole.size() - 20)),
                     "its last line does not begin with \\$END");
  EXPECT_THROWS_WITH(Read("Printf(\"a script\");\n$End\n"),
                     "it does not begin with \\$MeshFormat");
  EXPECT_THROWS_WITH(Read("mesh.mesh", "MeshVersionFormatted 2\nDimension 3\n"),
                     "mesh.mesh: .*its last line does not begin with END");
}

// Gmsh itself stops reading at a count that is too small, and loses what
// follows.
TEST_F(GmshMeshTest, ErrsOnCountsThatAreTooSmallOrTooLarge) {
  const auto expect = [this](const std::string& whole, const std::string& from,
                             const std::string& to,
                             const std::string& pattern) {
    EXPECT_THROWS_WITH(Read(Replaced(whole, from, to)),
                       "mesh.msh: the file is damaged .*" + pattern);
  };
  const std::string v1 = GmshVersion1Mesh();
  expect(v1, "$NOD\n5", "$NOD\n4", "section .NOD has 6 lines where 5 are due");
  expect(v1, "$ELM\n4", "$ELM\n3", "section .ELM has 5 lines where 4 are due");
  expect(v1, "$ELM\n4", "$ELM\n5", "section .ELM has 5 lines where 6 are due");
  expect(v1, "$ELM\n4", "$ELM\n-4", "section .ELM has 5 lines");
  const std::string v2 = GmshVersion2Mesh();
  expect(v2, "$Nodes\n5", "$Nodes\n4", "section .Nodes has 6 lines");
  expect(v2, "$Elements\n5", "$Elements\n4", "section .Elements has 6 lines");
  expect(v2, "$Nodes\n5", "$Nodes\n6", "section .Nodes has 6 lines");
  expect(v2, "$Nodes\n5\n", "$Nodes\n", "section .Nodes has 5 lines");
  const std::string v4 = GmshVersion4Mesh();
  expect(v4, "$Elements\n2", "$Elements\n1",
         "section .Elements has 7 lines where 6 are due");
  expect(v4, "$Elements\n2 4", "$Elements\n2 3",
         "section .Elements has 7 lines where 6 are due");
  expect(v4, "3 1 0 5\n", "3 1 0 4\n", "Unknown node");
  expect(v4, "3 1 4 2\n", "3 1 4\n", "");
  EXPECT_THROWS_WITH(Read(Replaced(v4, "3 1 4 2\n", "3 1 4 1\n")),
                     "mesh.msh: Gmsh can use only 3 of its 4 elements");
}

TEST_F(GmshMeshTest, ErrsOnNodeNumbersThatComeTwice) {
  EXPECT_THROWS_WITH(
      Read(Replaced(GmshVersion2Mesh(), "$Nodes\n5\n", "$Nodes\n6\n5 9 9 9\n")),
      "its section .Nodes has the number 5 twice");
  const std::string twin =
      Replaced(Replaced(GmshVersion4Mesh(), "$Nodes\n1 5 2 10\n3 1 0 5\n10\n",
                        "$Nodes\n1 6 2 10\n3 1 0 6\n5\n10\n"),
               "\n0 0 0\n", "\n9 9 9\n0 0 0\n");
  EXPECT_THROWS_WITH(Read(twin),
                     "mesh.msh: the file is damaged .*it has the node "
                     "number 5 twice");
  const MeshFile unused = Read(Replaced(twin, "\n5\n10\n", "\n6\n10\n"));
  EXPECT_EQ(unused.num_nodes_left_out, 0);
  EXPECT_EQ(unused.nodes.cols(), 6);
}

TEST_F(GmshMeshTest, ErrsOnElementsThatGmshLoses) {
  const auto expect = [this](const std::string& last) {
    EXPECT_THROWS_WITH(
        Read(Replaced(GmshVersion2Mesh(), "5 4 2 1 1 10 2 3 7", last)),
        "mesh.msh: Gmsh can use only 4 of its 5 elements");
  };
  expect("4 4 2 1 1 10 2 3 7");
  expect("5 11 2 1 1 10 2 3 7 10 2 3 5 7 2");
}

TEST_F(GmshMeshTest, ErrsOnTetrahedraThatComeTwice) {
  EXPECT_THROWS_WITH(Read(Replaced(GmshVersion2Mesh(), "5 4 2 1 1 10 2 3 7",
                                   "5 4 2 2 1 2 10 3 5")),
                     "mesh.msh: tetrahedra 0 and 1 .numbers 4 and 5 in Gmsh. "
                     "have the same nodes; save "
                     "the mesh as .msh of version 4");
}

TEST_F(GmshMeshTest, ErrsOnDataOfNodesThatAreNotThere) {
  const std::string data = GmshNodeData("u", "1 2 3");
  EXPECT_THROWS_WITH(
      Read(GmshVersion2Mesh() + Replaced(Replaced(data, "3\n5\n", "3\n6\n"),
                                         "$End", "99 1 1 1\n$End")),
      "mesh.msh: its data 'u' name node number 99, which the file does not");
}

TEST_F(GmshMeshTest, ErrsOnCountsOfMeditFiles) {
  const std::string whole =
      "MeshVersionFormatted 2\nDimension\n3\n"
      "Vertices\n5\n0 0 0 1\n1 0 0 1\n0 1 0 1\n0 0 1 1\n0 0 -1 1\n"
      "Tetrahedra\n2\n1 2 3 4 1\n1 2 3 5 1\nEnd\n";
  EXPECT_EQ(Read("a.mesh", whole).elements.cols(), 2);
  EXPECT_THROWS_WITH(
      Read("a.mesh", Replaced(whole, "Tetrahedra\n2", "Tetrahedra\n1")),
      "a.mesh: .*its section Tetrahedra has 3 lines where 2 are due");
  EXPECT_THROWS_WITH(
      Read("a.mesh", Replaced(whole, "Vertices\n5", "Vertices\n6")),
      "a.mesh: .*its section Vertices has 6 lines where 7 are due");
}

TEST_F(GmshMeshTest, ReadsOnAfterAnError) {
  EXPECT_THROWS_WITH(Read(Replaced(GmshVersion2Mesh(), "5 4 2 1 1 10 2 3 7",
                                   "5 4 2 1 1 10 2 3 77")),
                     "Wrong node index 77");
  ExpectTwoTetrahedra(Read(GmshVersion2Mesh()));
}

TEST_F(GmshMeshTest, ErrsOnAMeshOfLinesOnly) {
  EXPECT_THROWS_WITH(
      Read("$NOD\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$ENDNOD\n$ELM\n1\n"
           "1 1 1 1 2 1 2\n$ENDELM\n"),
      "mesh.msh: the mesh has no elements; give one of tetrahedra");
}

}  // namespace
}  // namespace elastimate
