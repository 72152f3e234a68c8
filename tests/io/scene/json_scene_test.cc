#include "elastimate/io/scene/json_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "elastimate/core/scene/loads.h"
#include "elastimate/io/vtk/vtu_writer.h"
#include "tests/io/gmsh_files.h"
#include "tests/io/scene_files.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

/// The document is a scene over two tetrahedra.
const std::string kDocument = R"({
  "mesh": "mesh.vtu",
  "supports": [ {"nodes": {"ids": [0, 1, 4]}, "components": "xyz"} ],
  "cases": [
    { "displacement": {"file": "u.csv"},
      "loads": [ {"type": "body_force", "value": [0, 0, -9810]} ],
      "noise_sd": 1e-5 } ]
})";

const std::string kField =
    "ux,uy,uz\n0,0,0\n0,0,0\n0.1,0.2,0.3\n0.4,0.5,0.6\n0,0,0\n";

/// Returns the mesh of GmshVersion2Mesh, without its groups.
Mesh MeshOfDocument() {
  Mesh mesh;
  mesh.nodes.resize(3, 5);
  mesh.nodes << 1, 0, 0, 0, 0,  //
      0, 1, 0, 0, 0,            //
      0, 0, 1, -1, 0;
  mesh.elements.resize(4, 2);
  mesh.elements << 4, 4,  //
      0, 1,               //
      1, 0,               //
      2, 3;
  return mesh;
}

class JsonSceneTest : public ::testing::Test {
 protected:
  JsonSceneTest() {
    WriteVtu(folder_.Path() / "mesh.vtu", MeshOfDocument(), {});
    folder_.Write("u.csv", kField);
  }

  /// Uses a mesh of Gmsh, for what only such files have.  Each is read in a
  /// process of its own, which takes most of the time of a test.
  void UseGmshMesh(const std::string& content) {
    mesh_ = folder_.Write("mesh.msh", content).filename();
  }

  SceneReading Read(const std::string& document,
                    Measurement measurement = Measurement::kRequired) const {
    return ReadScene({folder_.Write("scene.json", OverMesh(document))},
                     measurement);
  }
  std::string OverMesh(const std::string& document) const {
    return mesh_.empty() ? document : Replaced(document, "mesh.vtu", mesh_);
  }

  static std::string WithLoad(const std::string& load) {
    return Replaced(kDocument,
                    R"({"type": "body_force", "value": [0, 0, -9810]})", load);
  }
  Load ReadLoad(const std::string& load) const {
    return Read(WithLoad(load)).scene.load_cases.at(0).loads.at(0);
  }
  static std::string WithSupports(const std::string& supports) {
    return Replaced(kDocument,
                    R"([ {"nodes": {"ids": [0, 1, 4]}, "components": "xyz"} ])",
                    supports);
  }
  static std::string WithNodes(const std::string& selection) {
    return WithSupports("[ {\"nodes\": " + selection + "} ]");
  }
  /// Returns the nodes that a support's selection holds.
  std::vector<int> Held(const std::string& document) const {
    const Scene scene = Read(document).scene;
    std::vector<int> nodes;
    for (int node = 0; node < scene.mesh.NumNodes(); ++node) {
      if (scene.supports.held.col(node).all()) {
        nodes.push_back(node);
      }
    }
    return nodes;
  }

  const TemporaryFolder folder_;

 private:
  std::string mesh_;
};

using ::testing::ElementsAre;

TEST_F(JsonSceneTest, ReadsTheDocument) {
  const Scene scene = Read(kDocument).scene;
  EXPECT_EQ(scene.mesh.NumNodes(), 5);
  EXPECT_EQ(scene.mesh.NumElements(), 2);
  ASSERT_EQ(scene.load_cases.size(), 1);
  const LoadCase& load_case = scene.load_cases[0];
  EXPECT_EQ(load_case.noise_sd, 1e-5);
  EXPECT_EQ(load_case.displacement.col(2), Eigen::Vector3d(.1, .2, .3));
  EXPECT_EQ(load_case.observed.size(), 0);
  EXPECT_EQ(std::get<BodyForce>(load_case.loads.at(0)).force_density,
            Eigen::Vector3d(0, 0, -9810));
}

TEST_F(JsonSceneTest, ReadsSupportsOfALoadCase) {
  const std::string of_case = R"("supports": [
      {"nodes": {"ids": [0, 1, 2]}, "displacement": [0, 0, 0.5]} ],
      "noise_sd": 1e-5 }, )";
  const std::string two = Replaced(kDocument, R"({ "displacement")",
                                   R"({ "displacement": {"file": "u.csv"},
           "loads": [ {"type": "body_force", "value": [9810, 0, 0]} ], )" +
                                       of_case + R"({ "displacement")");
  const Scene scene = Read(two).scene;
  ASSERT_EQ(scene.load_cases.size(), 2);
  ASSERT_TRUE(scene.load_cases[0].supports);
  EXPECT_TRUE(scene.load_cases[0].supports->held.col(2).all());
  EXPECT_EQ(scene.load_cases[0].supports->displacement(2, 2), 0.5);
  EXPECT_FALSE(scene.load_cases[1].supports);
  EXPECT_FALSE(scene.supports.held.col(2).any());
  // If every load case has supports of its own, the scene needs none.
  const std::string alone = Replaced(
      Replaced(kDocument, R"("noise_sd": 1e-5)",
               R"("supports": [ {"nodes": {"ids": [0, 1, 4]}} ])"),
      R"("supports": [ {"nodes": {"ids": [0, 1, 4]}, "components": "xyz"} ],)",
      "");
  EXPECT_THAT(Held(alone), ElementsAre(0, 1, 4));
  EXPECT_FALSE(HasSupportsOfCases(Read(alone).scene));
  EXPECT_THROWS_WITH(
      Read(Replaced(
          two,
          R"("supports": [ {"nodes": {"ids": [0, 1, 4]}, "components": "xyz"} ],
)",
          "")),
      "cases\\[1\\] has no \"supports\" of its own");
}

TEST_F(JsonSceneTest, SelectsNodes) {
  EXPECT_THAT(Held(kDocument), ElementsAre(0, 1, 4));
  EXPECT_THAT(Held(WithNodes(R"({"box": [[-1, -1, 0], [1, 1, 0]]})")),
              ElementsAre(0, 1, 4));
  UseGmshMesh(GmshVersion2Mesh());
  EXPECT_THAT(Held(WithNodes(R"({"physical": "top"})")),
              ElementsAre(0, 1, 2, 4));
  EXPECT_THAT(Held(WithNodes(R"({"physical": 71})")), ElementsAre(0, 1, 4));
  EXPECT_THAT(Held(WithNodes(R"({"physical": "71"})")), ElementsAre(0, 1, 4));
  EXPECT_EQ(
      Read(WithNodes(R"({"ids": [0, 1, 4]})")).scene.supports.delimited.size(),
      0);
  const Supports of_group =
      Read(WithNodes(R"({"physical": 71})")).scene.supports;
  EXPECT_TRUE((of_group.delimited == of_group.held).all());
  EXPECT_THROWS_WITH(Read(WithNodes(R"("all")")),
                     "scene.json: every degree of freedom is held");
}

TEST_F(JsonSceneTest, SelectsNodesByArray) {
  folder_.Write("mesh.vtk", LegacySceneText());
  const std::string document = Replaced(
      Replaced(WithNodes(R"({"array": "fixed"})"), "mesh.vtu", "mesh.vtk"),
      R"({"file": "u.csv"})", R"({"array": "displacement"})");
  const SceneReading reading = Read(document);
  // The numbers count the points of the file, of which the third is dropped.
  EXPECT_THAT(Held(document), ElementsAre(0, 1, 2));
  EXPECT_EQ(reading.scene.load_cases[0].displacement.col(3),
            Eigen::Vector3d(.1, .2, .3));
  EXPECT_THAT(reading.notices,
              ElementsAre(::testing::HasSubstr("1 point that no"),
                          ::testing::HasSubstr("regions share one material")));
  EXPECT_THROWS_WITH(Read(Replaced(document, "\"fixed\"", "\"none\"")),
                     "supports\\[0\\].nodes.array names the array 'none', "
                     "which '.*mesh.vtk' does not have");
  EXPECT_THROWS_WITH(Read(Replaced(document, "\"fixed\"", "\"force\"")),
                     "'force', which has 3 components where 1 are due");
}

TEST_F(JsonSceneTest, CountsRowsAndIdsOverUnusedPointsToo) {
  folder_.Write("mesh.vtk", LegacySceneText());
  folder_.Write("u.csv",
                "x,y,z\n0,0,0\n0,0,0\n9,9,9\n0,0,0\n.1,.2,.3\n.4,.5,.6\n");
  const std::string document = Replaced(
      Replaced(kDocument, "mesh.vtu", "mesh.vtk"), "[0, 1, 4]", "[0, 1, 2, 5]");
  const Scene scene = Read(document).scene;
  EXPECT_EQ(scene.load_cases[0].displacement.col(3),
            Eigen::Vector3d(.1, .2, .3));
  EXPECT_THAT(Held(document), ElementsAre(0, 1, 4));
  EXPECT_THROWS_WITH(Read(Replaced(document, "[0, 1, 2, 5]", "[2]")),
                     "nodes selects no node that a tetrahedron uses");
}

TEST_F(JsonSceneTest, KeepsWhatMovedAndWasWeighedWithItsNodes) {
  folder_.Write("mesh.vtk", LegacySceneText());
  folder_.Write("u.csv",
                "x,y,z\n0,0,0\n0,0,0\n9,9,9\n0,0,0\n.1,.2,.3\n.4,.5,.6\n");
  const std::string resultant =
      R"({"type": "resultant", "value": [null, null, 1], "sd": 0.1,
          "surface": {"ids": [2, 5]}})";
  const Scene scene =
      Read(Replaced(Replaced(WithLoad(resultant), "mesh.vtu", "mesh.vtk"),
                    R"({"nodes": {"ids": [0, 1, 4]}, "components": "xyz"})",
                    R"({"nodes": {"ids": [0, 1, 2]}, "displacement": "rigid"},
                       {"nodes": {"ids": [2, 5]}, "displacement": "measured"})"))
          .scene;
  ASSERT_EQ(scene.supports.rigid_faces.size(), 1);
  EXPECT_THAT(scene.supports.rigid_faces[0].nodes, ElementsAre(0, 1));
  EXPECT_EQ(scene.supports.unknown.cols(), 5);
  EXPECT_THAT(scene.load_cases[0].resultants[0].nodes, ElementsAre(4));
}

TEST_F(JsonSceneTest, RefusesIdsAndRowsWhereGmshLeavesNodesOut) {
  UseGmshMesh(
      Replaced(GmshVersion2Mesh(), "$Nodes\n5\n", "$Nodes\n6\n1 7 7 7\n"));
  EXPECT_THROWS_WITH(Read(kDocument), "mesh.msh: Gmsh leaves out 1 node that");
  EXPECT_THROWS_WITH(Read(WithNodes(R"({"physical": 71})")),
                     "mesh.msh: Gmsh leaves out 1 node that");
  const SceneReading reading =
      Read(Replaced(WithNodes(R"({"physical": 71})"),
                    R"("displacement": {"file": "u.csv"},)", ""),
           Measurement::kOptional);
  EXPECT_THAT(reading.notices,
              ElementsAre(::testing::HasSubstr("1 point that no")));
}

TEST_F(JsonSceneTest, HoldsComponentsAtDisplacements) {
  UseGmshMesh(GmshVersion2Mesh());
  const Supports supports = Read(WithSupports(R"([
        {"nodes": {"ids": [0, 1]}, "components": "zx",
         "displacement": [1, 2, 3]},
        {"nodes": {"ids": [1, 4]}, "components": "y"},
        {"nodes": {"ids": [1]}, "components": "x", "displacement": [1, 9, 9]}
      ])"))
                                .scene.supports;
  EXPECT_EQ(supports.held.count(), 6);
  EXPECT_EQ(supports.displacement.col(0), Eigen::Vector3d(1, 0, 3));
  EXPECT_EQ(supports.displacement.col(1), Eigen::Vector3d(1, 0, 3));
  EXPECT_EQ(supports.displacement.col(4), Eigen::Vector3d(0, 0, 0));
  EXPECT_THROWS_WITH(
      Read(WithSupports(R"([
        {"nodes": {"ids": [0]}},
        {"nodes": {"ids": [0]}, "displacement": [0, 1, 0]} ])")),
      "scene.json: supports\\[1\\] holds the y component of node 0 \\(number "
      "2 in Gmsh\\) differently from supports\\[0\\]");
  EXPECT_FALSE(Read(WithSupports("[]")).scene.supports.held.any());
}

TEST_F(JsonSceneTest, TakesSupportsThatSayTheSameOfANode) {
  const auto both = [&](const std::string& first, const std::string& second) {
    return WithSupports(R"([ {"nodes": {"ids": [0, 1]}, )" + first +
                        R"(}, {"nodes": {"ids": [1, 4]}, )" + second + "} ]");
  };
  const std::string measured = R"("displacement": "measured")";
  // The shared node is the corner of two planes of symmetry, or of a plane and
  // a whole clamp.
  for (const char* const components : {"x", "xyz"}) {
    const Supports supports =
        Read(both(R"("components": "x", )" + measured,
                  R"("components": ")" + std::string(components) + "\", " +
                      measured))
            .scene.supports;
    EXPECT_TRUE(supports.held(0, 0) && supports.unknown(0, 0));
    EXPECT_TRUE(supports.held(0, 1) && supports.unknown(0, 1));
    EXPECT_TRUE(supports.held(0, 4) && supports.unknown(0, 4));
  }
  const std::string rigid = R"("displacement": "rigid")";
  const std::string given = R"("displacement": [0, 0, 0])";
  for (const auto& [first, second] : {std::pair{measured, given},
                                      {given, measured},
                                      {measured, rigid},
                                      {rigid, measured},
                                      {rigid, rigid},
                                      {given, rigid},
                                      {rigid, given}}) {
    EXPECT_THROWS_WITH(Read(both(first, second)),
                       "supports\\[1\\] holds the x component of node 1 "
                       "differently from supports\\[0\\]");
  }
  const Supports apart = Read(both(R"("components": "x", )" + rigid,
                                   R"("components": "yz", )" + measured))
                             .scene.supports;
  EXPECT_TRUE(apart.held.col(1).all());
}

TEST_F(JsonSceneTest, TakesRegionsFromTheArrayThatIsNamed) {
  folder_.Write("mesh.vtk", LegacySceneText().replace(
                                LegacySceneText().find("POINT_DATA"), 0,
                                "SCALARS dataset int 1\nLOOKUP_TABLE default\n"
                                "0 3 0 4\n"
                                "SCALARS share double 1\nLOOKUP_TABLE default\n"
                                "0 .5 0 1\n"));
  folder_.Write("u.csv",
                "x,y,z\n0,0,0\n0,0,0\n9,9,9\n0,0,0\n.1,.2,.3\n.4,.5,.6\n");
  const auto regions = [&](const std::string& value) {
    return Read(Replaced(kDocument, R"("mesh": "mesh.vtu",)",
                         R"("mesh": "mesh.vtk", "regions": )" + value +
                             R"(, "materials": [ {"region": 3},
                                                 {"region": 4} ],)"))
        .scene.mesh.regions;
  };
  EXPECT_EQ(regions(R"({"array": "dataset"})"), Eigen::Vector2i(3, 4));
  EXPECT_THROWS_WITH(regions(R"({"array": "datset"})"),
                     "regions.array is \"datset\", but .*mesh.vtk' has no such "
                     "cell array; .*region, dataset, share");
  EXPECT_THROWS_WITH(regions(R"({"array": "share"})"),
                     "the cell array 'share' is 0.5 .*integers");
  EXPECT_THROWS_WITH(regions(R"("dataset")"), "regions must be");
  EXPECT_THROWS_WITH(regions(R"({"name": "dataset"})"),
                     "regions has the unknown key");
}

TEST_F(JsonSceneTest, ReadsNodalForces) {
  const auto force = [&](const std::string& load) {
    return std::get<NodalForces>(ReadLoad(load)).force;
  };
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(3, 5);
  expected.col(2) = expected.col(3) = Eigen::Vector3d(0, 0, -30);
  EXPECT_EQ(
      force(
          R"({"type": "nodal_force", "value": [0, 0, -30], "nodes": "free"})"),
      expected);
  EXPECT_EQ(force(R"({"type": "nodal_force", "file": "u.csv"})").col(2),
            Eigen::Vector3d(.1, .2, .3));
  UseGmshMesh(GmshVersion2Scene());
  EXPECT_EQ(force(R"({"type": "nodal_force", "array": "force"})").col(2),
            Eigen::Vector3d(1, 2, 3));
}

TEST_F(JsonSceneTest, SaysThatNothingIsFree) {
  EXPECT_THROWS_WITH(
      Read(Replaced(WithLoad(R"({"type": "nodal_force", "value": [0, 0, 1],
                                 "nodes": "free"})"),
                    R"({"ids": [0, 1, 4]})", R"("all")")),
      "loads\\[0\\].nodes is \"free\", but the supports hold every node");
}

TEST_F(JsonSceneTest, LetsAPressureFollowTheSurface) {
  UseGmshMesh(GmshVersion2Mesh());
  const std::string document =
      Replaced(WithLoad(R"({"type": "pressure", "value": 500, "follows": true,
                   "surface": {"physical": "top"}})"),
               "\"mesh\"", R"("materials": [{"law": "neo_hookean"}], "mesh")");
  EXPECT_TRUE(
      std::get<Pressure>(Read(document).scene.load_cases.at(0).loads.at(0))
          .follows);
}

TEST_F(JsonSceneTest, SelectsOutwardFacets) {
  UseGmshMesh(GmshVersion2Mesh());
  for (const std::string surface :
       {R"({"physical": "top"})", R"({"physical": 70})"}) {
    const auto pressure = std::get<Pressure>(ReadLoad(
        R"({"type": "pressure", "value": 500, "surface": )" + surface + "}"));
    EXPECT_EQ(pressure.pressure, 500);
    EXPECT_FALSE(pressure.follows);
    ASSERT_EQ(pressure.facets.cols(), 2);
    // The total is that of the facets y = 0 and x + y + z = 1, both pushed
    // inwards.
    const Eigen::Vector3d total =
        AssembleLoads(Read(kDocument).scene.mesh, {pressure}).rowwise().sum();
    EXPECT_TRUE(total.isApprox(Eigen::Vector3d(-250, 0, -250), 1e-12))
        << total.transpose();
  }
  const auto traction = std::get<Traction>(ReadLoad(
      R"({"type": "traction", "value": [1, 2, 3],
          "surface": {"box": [[0, 0, 0], [1, 1, 1]]}})"));
  EXPECT_EQ(traction.traction, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(traction.facets.cols(), 3);  // The inner face is none of them.
}

TEST_F(JsonSceneTest, ReadsATotalForceOnASurface) {
  UseGmshMesh(GmshVersion2Mesh());
  const auto force =
      std::get<SurfaceForce>(ReadLoad(R"({"type": "force", "value": [1, 0, -5],
                   "surface": {"physical": "top"}})"));
  EXPECT_EQ(force.force, Eigen::Vector3d(1, 0, -5));
  EXPECT_EQ(force.facets.cols(), 2);
  const Scene scene = Read(kDocument).scene;
  const LoadResultant resultant = ResultantOf(scene.mesh, force);
  // The area is half a square and an equilateral triangle of edge sqrt(2).
  EXPECT_NEAR(*resultant.area, 0.5 + std::sqrt(3) / 2, 1e-15);
  EXPECT_TRUE(AssembleLoads(scene.mesh, {force})
                  .rowwise()
                  .sum()
                  .isApprox(Eigen::Vector3d(1, 0, -5), 1e-15));
  const auto other =
      std::get<SurfaceForce>(ReadLoad(R"({"type": "force", "value": [1, 0, -5],
                   "surface": {"box": [[0, 0, 0], [1, 1, 1]]}})"));
  EXPECT_EQ(other.facets.cols(), 3);
}

// Facets get new node numbers when points of the file are dropped.
TEST_F(JsonSceneTest, PutsATotalForceOnNodesThatAreKept) {
  folder_.Write("mesh.vtk", LegacySceneText());
  const std::string document =
      Replaced(Replaced(WithLoad(R"({"type": "force", "value": [0, 0, -5],
                            "surface": {"ids": [0, 1, 4]}})"),
                        "mesh.vtu", "mesh.vtk"),
               R"({"file": "u.csv"})", R"({"array": "displacement"})");
  const Scene scene = Read(document).scene;
  const auto force = AssembleLoads(scene.mesh, scene.load_cases[0].loads);
  EXPECT_THAT(force.row(2),
              ::testing::Pointwise(::testing::DoubleEq(),
                                   {-5. / 3, -5. / 3, 0., -5. / 3, 0.}));
}

TEST_F(JsonSceneTest, ErrsOnAForceThatIsNone) {
  UseGmshMesh(GmshVersion2Mesh());
  const auto expect = [&](const std::string& load, const std::string& pattern) {
    EXPECT_THROWS_WITH(ReadLoad(load),
                       "scene.json: cases\\[0\\].loads\\[0\\]" + pattern);
  };
  expect(R"({"type": "force", "value": [0, 0, -5], "nodes": "free"})",
         " has the unknown key \"nodes\"; the keys known here are type, value, "
         "surface");
  expect(R"({"type": "force", "value": [0, 0, -5], "follows": true})",
         ".follows is for loads of the type pressure only");
  expect(R"({"type": "force", "value": [0, 0, -5]})",
         ".surface is missing; add it");
  expect(R"({"type": "force", "surface": {"physical": "top"}})",
         ".value is missing; add it");
  for (const std::string value : {"-5", "[0, -5]", "[0, 0, -5, 0]", "\"5\""}) {
    expect(R"({"type": "force", "surface": {"physical": "top"}, "value": )" +
               value + "}",
           ".value must be a list of 3 numbers");
  }
  expect(R"({"type": "forces", "value": [0, 0, -5]})",
         ".type is \"forces\"; the types known here are force, nodal_force, ");
}

TEST_F(JsonSceneTest, NotesANodalForceThatMayBeMeantAsATotal) {
  UseGmshMesh(GmshVersion2Mesh());
  const auto notices = [&](const std::string& nodes) {
    return Read(
               WithLoad(
                   R"({"type": "nodal_force", "value": [0, 0, -0.5], "nodes": )" +
                   nodes + "}"))
        .notices;
  };
  for (const std::string nodes :
       {R"({"physical": "top"})", R"({"box": [[0, 0, 0], [1, 1, 1]]})"}) {
    EXPECT_THAT(
        notices(nodes),
        ElementsAre(::testing::EndsWith(
            "scene.json: cases[0].loads[0] is a nodal_force, which acts on "
            "each node: [0, 0, -0.5] on each of 4 nodes, [0, 0, -2] in total; "
            "if [0, 0, -0.5] is the total, give it as \"type\": \"force\" with "
            "a \"surface\"")));
  }
  // There is no notice for all free nodes (the load of the paper), for all
  // nodes, for nodes that are named one by one, for a single node, and for no
  // force.
  for (const std::string nodes : {R"("free")", R"("all")", R"({"ids": [1, 2]})",
                                  R"({"box": [[0, 0, 1], [1, 1, 1]]})"}) {
    EXPECT_THAT(notices(nodes), ::testing::IsEmpty()) << nodes;
  }
  EXPECT_THAT(Read(WithLoad(R"({"type": "nodal_force", "value": [0, 0, 0],
                                "nodes": {"physical": "top"}})"))
                  .notices,
              ::testing::IsEmpty());
}

TEST_F(JsonSceneTest, ErrsOnSurfacesThatAreNone) {
  UseGmshMesh(GmshVersion2Mesh());
  const std::string load =
      R"({"type": "TYPE", "value": VALUE, "surface": SURFACE})";
  const auto expect = [&](const std::string& surface,
                          const std::string& pattern) {
    for (const auto& [type, value] :
         {std::pair("pressure", "1"), std::pair("force", "[0, 0, 1]")}) {
      EXPECT_THROWS_WITH(
          ReadLoad(
              Replaced(Replaced(Replaced(load, "TYPE", type), "VALUE", value),
                       "SURFACE", surface)),
          "scene.json: cases\\[0\\].loads\\[0\\].surface" + pattern);
    }
  };
  expect(R"({"physical": "inside"})",
         " names a physical group whose triangle 0 is not a face on the "
         "boundary");
  expect(R"({"ids": [0, 1, 4]})", " selects no whole facet");
  expect(R"({"physical": "bottom"})",
         ".physical names no physical group of '.*mesh.msh'; its groups are: "
         "70 \"top\", 71 \"inside\", 1 \"body\"");
}

TEST_F(JsonSceneTest, ReadsWhatWasObserved) {
  const auto observed = [&](const std::string& selection) {
    return Read(Replaced(kDocument, "\"noise_sd\": 1e-5",
                         "\"observed\": " + selection))
        .scene.load_cases[0]
        .observed;
  };
  ComponentMask expected = ComponentMask::Constant(3, 5, false);
  expected.col(2) = expected.col(3) = true;
  EXPECT_TRUE((observed(R"("free")") == expected).all());
  EXPECT_TRUE((observed(R"({"ids": [2, 3]})") == expected).all());
  folder_.Write("u.csv", Replaced(kField, "0,0,0", "nan,0,inf"));
  EXPECT_TRUE((observed(R"("free")") == expected).all());
  UseGmshMesh(GmshVersion2Mesh());
  EXPECT_THROWS_WITH(observed(R"("all")"),
                     "u.csv: the row of node 0 .* \\(x\\) is nan; correct it "
                     "or leave it out of the observed nodes");
}

TEST_F(JsonSceneTest, ReadsObservedComponentsFromAnArray) {
  UseGmshMesh(GmshVersion2Mesh() + GmshNodeData("seen", "0 1 1"));
  const Scene scene = Read(Replaced(kDocument, "\"noise_sd\": 1e-5",
                                    R"("observed": {"array": "seen"})"))
                          .scene;
  EXPECT_EQ(scene.load_cases[0].observed.count(), 2);
  EXPECT_FALSE(scene.load_cases[0].observed(0, 2));
}

TEST_F(JsonSceneTest, NamesRegionsByPhysicalGroups) {
  const std::string groups = Replaced(
      Replaced(GmshVersion2Mesh(), "5 4 2 1 1 10 2 3 7", "5 4 2 2 2 10 2 3 7"),
      "3\n2 70 \"top\"", "4\n3 2 \"tissue\"\n2 70 \"top\"");
  UseGmshMesh(groups);
  const auto materials = [](const std::string& list) {
    return Replaced(kDocument, "{\n", "{ \"materials\": " + list + ",\n");
  };
  const Scene scene =
      Read(materials(R"([{"region": "tissue"}, {"region": 1}])")).scene;
  EXPECT_THAT(scene.materials.at(0).regions, ElementsAre(2));
  EXPECT_THAT(scene.materials.at(1).regions, ElementsAre(1));
  EXPECT_THAT(Read(materials(R"([{"region": ["tissue", "body"]}])"))
                  .scene.materials.at(0)
                  .regions,
              ElementsAre(2, 1));
  EXPECT_THROWS_WITH(
      Read(materials(R"([{"region": "top"}, {"region": 1}])")),
      "materials\\[0\\].region is \"top\", but the regions of the mesh are "
      "named \"body\", \"tissue\"; give one of these, or an id");
  UseGmshMesh(groups +
              "$ElementData\n1\n\"region\"\n1\n0\n3\n0\n1\n2\n4 1\n"
              "5 2\n$EndElementData\n");
  EXPECT_THROWS_WITH(
      Read(materials(R"([{"region": "tissue"}, {"region": 1}])")),
      "is \"tissue\", but the regions of the mesh have no names; give the id");
}

TEST_F(JsonSceneTest, ErrsOnWhatIsNotInTheSchema) {
  const auto expect = [&](const std::string& from, const std::string& to,
                          const std::string& pattern) {
    EXPECT_THROWS_WITH(Read(Replaced(kDocument, from, to)),
                       "scene.json: " + pattern);
  };
  expect("\"mesh\"", "\"Mesh\"", "the document has the unknown key \"Mesh\"");
  expect("\"mesh\": \"mesh.vtu\",", "", "mesh is missing; add it");
  expect("\"mesh.vtu\"", "3", "mesh must be a string");
  expect("\"mesh.vtu\"", "\"\"", "mesh is empty");
  expect("\"components\"", "\"component\"",
         "supports\\[0\\] has the unknown key \"component\"; the keys known "
         "here are nodes, components, displacement");
  expect("\"xyz\"", "\"xw\"", "supports\\[0\\].components must name");
  expect("\"xyz\"", "\"xx\"", "supports\\[0\\].components must name");
  expect("\"xyz\"", "\"\"", "supports\\[0\\].components is empty");
  expect("[0, 1, 4]", "[0, 5]",
         "supports\\[0\\].nodes.ids\\[1\\] is 5, but the mesh has the nodes 0 "
         "to 4");
  expect("[0, 1, 4]", "[-1]", "supports\\[0\\].nodes.ids\\[0\\] is -1");
  expect("[0, 1, 4]", "[1.5]", "supports.*ids\\[0\\] must be an integer");
  expect("[0, 1, 4]", "[18446744073709551615]",
         "supports.*must be an integer of at most 12 digits");
  expect("[0, 1, 4]", "[]", "supports\\[0\\].nodes selects no node");
  expect("[0, 1, 4]", "3", "supports\\[0\\].nodes.ids must be a list");
  expect("{\"ids\": [0, 1, 4]}", "\"some\"",
         "supports\\[0\\].nodes is \"some\"; the words known");
  expect("{\"ids\": [0, 1, 4]}", "\"free\"",
         "supports\\[0\\].nodes is \"free\", which cannot be used here");
  expect("{\"ids\": [0, 1, 4]}", "{}", "supports\\[0\\].nodes must have");
  expect("{\"ids\": [0, 1, 4]}", "7", "supports\\[0\\].nodes must be");
  expect("{\"ids\": [0, 1, 4]}", "{\"box\": [[0,0,0]]}",
         "supports\\[0\\].nodes.box must be two corners");
  expect("{\"ids\": [0, 1, 4]}", "{\"box\": [[0,0,0],[1,-1,0]]}",
         "supports\\[0\\].nodes.box has a first corner that is above");
  expect("{\"ids\": [0, 1, 4]}", "{\"box\": [[0,0],[1,1,0]]}",
         "supports.*box\\[0\\] must be a list of 3 numbers");
  expect("{\"file\": \"u.csv\"}", "{}",
         "cases\\[0\\].displacement must have exactly one");
  expect("\"displacement\": {\"file\": \"u.csv\"},", "",
         "cases\\[0\\].displacement is missing");
  expect("body_force", "gravity", "cases.*loads\\[0\\].type is \"gravity\"; ");
  expect("[0, 0, -9810]", "[0, 0, \"a\"]",
         "cases.*loads\\[0\\].value\\[2\\] must be a number");
  expect("\"value\": [0, 0, -9810]", "\"value\": [0, 0, 0], \"nodes\": \"all\"",
         "cases.*loads\\[0\\] has the unknown key \"nodes\"");
  expect("1e-5", "0", "cases\\[0\\].noise_sd must be positive");
  expect("1e-5", "\"small\"", "cases\\[0\\].noise_sd must be a number");
  EXPECT_THROWS_WITH(Read(R"({"mesh": "mesh.vtu", "supports": [],
                              "cases": []})"),
                     "scene.json: cases is empty");
  EXPECT_THROWS_WITH(Read("[1, 2]"), "scene.json: the document must be");
}

// A terminal obeys ESC sequences, and a long token hides the rest of the
// sentence.
TEST_F(JsonSceneTest, QuotesOnlyWhatIsFitToPrint) {
  const std::string control = "\\u001b[2J\\n\\u0000";
  const std::string shown = "\\\\x1b\\[2J\\\\n\\\\x00";
  const std::string longest(2000, 'a');
  const std::string cut =
      std::string(37, 'a') + "\\.\\.\\." + std::string(20, 'a');
  for (const auto& [text, quoted] :
       {std::pair(control, shown), std::pair(longest, cut)}) {
    const auto expect = [&](const std::string& from, const std::string& to,
                            const std::string& pattern) {
      EXPECT_THROWS_WITH(Read(Replaced(kDocument, from, to)), pattern + quoted);
    };
    expect("\"mesh\"", "\"" + text + "\"", "has the unknown key \"");
    expect("body_force", text, "type is \"");
    expect("{\"ids\": [0, 1, 4]}", "\"" + text + "\"", "nodes is \"");
    expect("{\"ids\": [0, 1, 4]}", "{\"array\": \"" + text + "\"}",
           "names the array '");
    expect("\"noise_sd\"", "\"" + text + "\": 1, \"" + text + "\"",
           "the key \"");
    expect("\"noise_sd\": 1e-5", "\"" + text + "\": 1e999",
           "the number 1e999 of the key \"");
  }
  // A message of the parser is cut in its middle, so that both ends are kept.
  for (const std::string& text :
       {"\033]0;title\a" + longest, "\xFF" + longest, longest}) {
    try {
      Read(Replaced(kDocument, "1e-5", text));
      ADD_FAILURE() << "no error";
    } catch (const std::invalid_argument& error) {
      const std::string sentence = error.what();
      EXPECT_LT(sentence.size(), 400);
      EXPECT_THAT(sentence, ::testing::HasSubstr("line 7, column "));
      EXPECT_THAT(sentence, ::testing::EndsWith("; correct the JSON"));
      EXPECT_EQ(sentence.find_first_of("\033\a\n\xFF"), std::string::npos);
    }
  }
}

TEST_F(JsonSceneTest, PlacesSyntaxErrors) {
  EXPECT_THROWS_WITH(Read(Replaced(kDocument, "\"supports\":", "\"supports\"")),
                     "scene.json: line 3, column 14: syntax error");
  EXPECT_THROWS_WITH(Read(Replaced(kDocument, "1e-5", "1e999")),
                     "^[^ ]*scene.json: the number 1e999 of the key "
                     "\"noise_sd\" is beyond the range of a double; correct "
                     "it$");
  EXPECT_THROWS_WITH(Read(Replaced(kDocument, "1e-5", "1e-5, \"noise_sd\": 1")),
                     "scene.json: the key \"noise_sd\" is given twice");
  for (std::size_t size = 1; size < kDocument.size() - 2; size += 7) {
    EXPECT_THROWS_WITH(Read(kDocument.substr(0, size)),
                       "scene.json: line .*column");
  }
}

TEST_F(JsonSceneTest, NamesTheFilesItNeeds) {
  EXPECT_THROWS_WITH(Read(Replaced(kDocument, "mesh.vtu", "no.msh")),
                     "no.msh: no such file");
  EXPECT_THROWS_WITH(Read(Replaced(kDocument, "u.csv", "no.csv")),
                     "no.csv: no such file");
  EXPECT_THROWS_WITH(Read(Replaced(kDocument, "mesh.vtu", "scene.json")),
                     "scene.json: mesh is 'scene.json', which is a scene; "
                     "name a mesh file");
  EXPECT_THROWS_WITH(
      Read(Replaced(kDocument, "mesh.vtu",
                    folder_.Write("mesh.stl", "solid").filename())),
      "mesh.stl: the file name does not end in");
}

TEST_F(JsonSceneTest, JoinsWithOtherFilesOfTheMesh) {
  UseGmshMesh(GmshVersion2Mesh());
  const auto json = folder_.Write("scene.json", OverMesh(kDocument));
  const auto msh = folder_.Write("scene.msh", GmshVersion2Scene());
  EXPECT_EQ(
      ReadScene({json, msh}, Measurement::kRequired).scene.load_cases.size(),
      2);
  // The only group of this mesh is a region that holds all of it, which is as
  // good as none.
  Scene scene = ReadScene({msh}, Measurement::kRequired).scene;
  EXPECT_EQ(scene.mesh.regions, Eigen::Vector2i(1, 1));
  scene.mesh.regions.resize(0);
  scene.load_cases[0].displacement *= 2;
  const auto vtu = folder_.Path() / "without.vtu";
  WriteVtu(vtu, scene.mesh, SceneFields(scene));
  EXPECT_EQ(
      ReadScene({msh, vtu}, Measurement::kRequired).scene.load_cases.size(), 2);
}

TEST_F(JsonSceneTest, ErrsOnALoadCaseGivenTwice) {
  const std::string load_case = kDocument.substr(
      kDocument.find("{ \"displacement"),
      kDocument.rfind("]") - kDocument.find("{ \"displacement"));
  const std::string twice =
      Replaced(kDocument, load_case, load_case + ", " + load_case);
  EXPECT_THROWS_WITH(
      Read(twice),
      "scene.json: load case 2 has the displacements and forces of load case 1 "
      "of '.*scene.json'; give each load case only once");
  EXPECT_NO_THROW(Read(Replaced(twice, "-9810", "-9811")));
}

}  // namespace
}  // namespace elastimate
