// Files of every kind of element as Gmsh writes them.

#include <gmsh.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "elastimate/core/mesh/facets.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/io/scene/file_scene.h"
#include "elastimate/io/scene/mesh_reader.h"
#include "elastimate/io/scene/scene_reader.h"
#include "tests/io/scene_files.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

/// The rectangle from (0, 0, 5) to (2, 1, 5), or the cuboid on it of height 3,
/// meshed with elements of one kind; the group "end" is where x = 2.
void WriteByGmsh(ElementKind kind,
                 const std::vector<std::filesystem::path>& paths,
                 const std::vector<std::pair<double, int>>& versions) {
  const ElementTopology& topology = TopologyOf(kind);
  const bool is_cut = topology.num_vertices == topology.dimension + 1;
  gmsh::initialize(0, nullptr, false);
  gmsh::option::setNumber("General.Terminal", 0);
  const int points[4] = {
      gmsh::model::geo::addPoint(0, 0, 5), gmsh::model::geo::addPoint(2, 0, 5),
      gmsh::model::geo::addPoint(2, 1, 5), gmsh::model::geo::addPoint(0, 1, 5)};
  std::vector<int> lines;
  for (int i = 0; i < 4; ++i) {
    lines.push_back(gmsh::model::geo::addLine(points[i], points[(i + 1) % 4]));
    gmsh::model::geo::mesh::setTransfiniteCurve(lines.back(), 3);
  }
  const int surface = gmsh::model::geo::addPlaneSurface(
      {gmsh::model::geo::addCurveLoop(lines)});
  gmsh::model::geo::mesh::setTransfiniteSurface(surface);
  if (!is_cut) {
    gmsh::model::geo::mesh::setRecombine(2, surface);
  }
  int body = surface;
  int end = lines[1];
  if (topology.dimension == 3) {
    gmsh::vectorpair made;
    gmsh::model::geo::extrude({{2, surface}}, 0, 0, 3, made, {2}, {}, !is_cut);
    body = made[1].second;
    end = made[3].second;  // Swept by the second line.
  }
  gmsh::model::geo::synchronize();
  const int group = gmsh::model::addPhysicalGroup(topology.dimension, {body});
  gmsh::model::setPhysicalName(topology.dimension, group, "body");
  const int ends = gmsh::model::addPhysicalGroup(topology.dimension - 1, {end});
  gmsh::model::setPhysicalName(topology.dimension - 1, ends, "end");
  gmsh::model::mesh::generate(topology.dimension);
  gmsh::model::mesh::setOrder(topology.order);
  for (std::size_t i = 0; i < paths.size(); ++i) {
    gmsh::option::setNumber("Mesh.MshFileVersion", versions[i].first);
    gmsh::option::setNumber("Mesh.Binary", versions[i].second);
    gmsh::write(paths[i].string());
  }
  gmsh::finalize();
}

class GmshKinds : public ::testing::TestWithParam<ElementKind> {
 protected:
  const TemporaryFolder folder_;
};

TEST_P(GmshKinds, AreRead) {
  std::vector<std::filesystem::path> paths = {
      folder_.Path() / "v2.msh", folder_.Path() / "v41.msh",
      folder_.Path() / "v41_binary.msh", folder_.Path() / "m.unv"};
  if (GetParam() == ElementKind::kHex27 || GetParam() == ElementKind::kQuad9) {
    paths.pop_back();  // Which has no such elements.
  }
  WriteByGmsh(GetParam(), paths, {{2.2, 0}, {4.1, 0}, {4.1, 1}, {4.1, 0}});
  const ElementTopology& topology = TopologyOf(GetParam());
  for (const std::filesystem::path& path : paths) {
    SCOPED_TRACE(path.filename());
    const MeshFile file = ReadMeshFile(path);
    EXPECT_EQ(file.kind, GetParam());
    EXPECT_TRUE(file.used.all());
    if (path.extension() == ".msh") {
      EXPECT_EQ(ReadRegions(file),
                Eigen::VectorXi::Constant(file.elements.cols(), 1));
    }
    const auto end = std::find_if(
        file.groups.begin(), file.groups.end(),
        [](const PhysicalGroup& group) { return group.name == "end"; });
    if (path.extension() == ".unv") {
      continue;  // Which has the groups of nodes only.
    }
    ASSERT_NE(end, file.groups.end());
    EXPECT_EQ(end->facets.rows(), topology.NumVerticesOfFace());
    EXPECT_GT(end->facets.cols(), 1);
    for (const int node : end->facets.reshaped()) {
      EXPECT_DOUBLE_EQ(file.nodes(0, node), 2);
    }
  }
}

// Their volumes, areas and middle nodes are those of the specimen.
TEST_P(GmshKinds, AreScenes) {
  WriteByGmsh(GetParam(), {folder_.Path() / "mesh.msh"}, {{4.1, 0}});
  const bool is_solid = TopologyOf(GetParam()).dimension == 3;
  const std::string vector = is_solid ? "[6, 0, 0]" : "[6, 0]";
  const Scene scene = ReadScene(
                          {folder_.Write("scene.json", std::string("{") +
                                                           (is_solid ? "" : R"(
    "model": "plane_strain", "thickness": 0.5,)") +
                                                           R"(
    "mesh": "mesh.msh",
    "supports": [{"nodes": {"box": [[0, 0, 5], [0, 1, 8]]}}],
    "cases": [{"loads": [
      {"type": "traction", "value": )" + vector +
                                                           R"(,
       "surface": {"physical": "end"}},
      {"type": "pressure", "value": 6, "surface": {"physical": "end"}},
      {"type": "body_force", "value": )" + vector + "}]}]}")},
                          Measurement::kOptional)
                          .scene;
  EXPECT_EQ(scene.mesh.kind, GetParam());
  const double area = is_solid ? 3 : 0.5;
  const double volume = is_solid ? 6 : 1;
  const double expected[3] = {6 * area, -6 * area, 6 * volume};
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::MatrixXd force =
        AssembleLoads(scene.mesh, {scene.load_cases[0].loads[i]});
    EXPECT_NEAR(force.row(0).sum(), expected[i], 1e-9);
    EXPECT_NEAR(force.bottomRows(force.rows() - 1).cwiseAbs().sum(), 0, 1e-9);
  }
}

std::vector<ElementKind> KindsOfStraightEdges() {
  std::vector<ElementKind> kinds;
  std::remove_copy_if(kElementKinds.begin(), kElementKinds.end(),
                      std::back_inserter(kinds), IsCurved);
  return kinds;
}

INSTANTIATE_TEST_SUITE_P(All, GmshKinds,
                         ::testing::ValuesIn(KindsOfStraightEdges()),
                         [](const auto& kind) {
                           return std::string(TopologyOf(kind.param).name);
                         });

// A quarter of a ring of radii 1 and 2, or of a tube of length 1, of order 2;
// the group "inside" is where the radius is 1.
void WriteQuarterOfRing(int dimension, const std::filesystem::path& path) {
  gmsh::initialize(0, nullptr, false);
  gmsh::option::setNumber("General.Terminal", 0);
  namespace geo = gmsh::model::geo;
  const double size = 0.4;
  const int centre = geo::addPoint(0, 0, 0, size);
  const int points[4] = {
      geo::addPoint(1, 0, 0, size), geo::addPoint(2, 0, 0, size),
      geo::addPoint(0, 2, 0, size), geo::addPoint(0, 1, 0, size)};
  const std::vector<int> lines = {
      geo::addLine(points[0], points[1]),
      geo::addCircleArc(points[1], centre, points[2]),
      geo::addLine(points[2], points[3]),
      geo::addCircleArc(points[3], centre, points[0])};
  int body = geo::addPlaneSurface({geo::addCurveLoop(lines)});
  int inside = lines[3];
  if (dimension == 3) {
    gmsh::vectorpair made;
    geo::extrude({{2, body}}, 0, 0, 1, made);
    body = made[1].second;
    inside = made[5].second;  // Swept by the fourth line.
  }
  geo::synchronize();
  gmsh::model::addPhysicalGroup(dimension, {body});
  gmsh::model::setPhysicalName(
      dimension - 1, gmsh::model::addPhysicalGroup(dimension - 1, {inside}),
      "inside");
  gmsh::model::mesh::generate(dimension);
  gmsh::model::mesh::setOrder(2);
  gmsh::write(path.string());
  gmsh::finalize();
}

class CurvedByGmsh : public ::testing::TestWithParam<int> {};

TEST_P(CurvedByGmsh, AreScenes) {
  const TemporaryFolder folder;
  const bool is_solid = GetParam() == 3;
  WriteQuarterOfRing(GetParam(), folder.Path() / "mesh.msh");
  const Scene scene =
      ReadScene(
          {folder.Write(
              "scene.json",
              std::string("{") +
                  (is_solid ? ""
                            : R"("model": "plane_strain", "thickness": 1,)") +
                  R"(
    "mesh": "mesh.msh",
    "supports": [{"nodes": {"box": )" +
                  (is_solid ? "[[0, -1, 0], [3, 1e-9, 1]]"
                            : "[[0, -1], [3, 1e-9]]") +
                  R"(}}],
    "cases": [{"loads": [
      {"type": "pressure", "value": 6, "surface": {"physical": "inside"}}]}]})")},
          Measurement::kOptional)
          .scene;
  EXPECT_EQ(scene.mesh.kind,
            is_solid ? ElementKind::kCurvedTet10 : ElementKind::kCurvedTri6);
  EXPECT_NEAR(ElementVolumes(scene.mesh).sum(), M_PI * 3 / 4, 1e-4);
  const Eigen::MatrixXd force =
      AssembleLoads(scene.mesh, scene.load_cases[0].loads);
  // The inner edge has no gap, so that x and y of its ends are all there is.
  EXPECT_NEAR(force.row(0).sum(), 6, 1e-9);
  EXPECT_NEAR(force.row(1).sum(), 6, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(All, CurvedByGmsh, ::testing::Values(2, 3),
                         [](const auto& info) {
                           return std::to_string(info.param) + "d";
                         });

constexpr char kGmshPlate[] =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
    "$PhysicalNames\n3\n1 7 \"right\"\n2 3 \"soft\"\n2 4 \"stiff\"\n"
    "$EndPhysicalNames\n"
    "$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 2 0 0\n$EndNodes\n"
    "$Elements\n3\n1 1 2 7 1 5 3\n2 3 2 3 1 1 2 3 4\n3 2 2 4 2 2 5 3\n"
    "$EndElements\n";

TEST(GmshMixture, OfLinearElementsIsCut) {
  const TemporaryFolder folder;
  const MeshFile mesh = ReadMeshFile(folder.Write("mesh.msh", kGmshPlate));
  EXPECT_EQ(mesh.kind, ElementKind::kTri3);
  EXPECT_EQ(*FindArray(mesh.element_arrays, "region"),
            Eigen::RowVector3d(3, 3, 4));
  ASSERT_EQ(mesh.groups[0].name, "right");
  EXPECT_EQ(mesh.groups[0].facets, Eigen::Vector2i(4, 2));
  ASSERT_EQ(mesh.notices.size(), 1U);
}

TEST(GmshMixture, OfPyramidsHasItsSidesCut) {
  const TemporaryFolder folder;
  const MeshFile mesh = ReadMeshFile(folder.Write(
      "mesh.msh",
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
      "$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0 0 1\n$EndNodes\n"
      "$Elements\n2\n1 3 2 9 1 1 2 3 4\n2 7 2 8 2 1 2 3 4 5\n"
      "$EndElements\n"));
  EXPECT_EQ(mesh.elements.cols(), 2);
  EXPECT_EQ(mesh.groups[0].facets.cols(), 2);
}

TEST(GmshMixture, OfOrdersIsRefused) {
  const TemporaryFolder folder;
  EXPECT_THROWS_WITH(
      ReadMeshFile(folder.Write(
          "mesh.msh",
          Replaced(Replaced(kGmshPlate, "5\n1 0 0 0",
                            "8\n6 1 1 1\n7 2 2 2\n8 3 3 3\n1 0 0 0"),
                   "3 2 2 4 2 2 5 3", "3 9 2 4 2 2 5 3 6 7 8"))),
      "mesh.msh: ");
}

}  // namespace
}  // namespace elastimate
