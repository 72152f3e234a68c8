#include "elastimate/io/mesh/simplices.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "elastimate/core/mesh/facets.h"
#include "elastimate/core/mesh/mesh.h"
#include "elastimate/estimators/registry.h"
#include "elastimate/io/scene/mesh_reader.h"
#include "elastimate/io/scene/scene_reader.h"
#include "tests/io/mixed_block.h"
#include "tests/io/scene_files.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

Mesh MeshOf(const MixedBlock& block) {
  Simplices simplices(3);
  for (const MixedBlock::Cell& cell : block.cells) {
    simplices.Add(*FindCellShape(3, int(cell.nodes.size())), cell.nodes);
  }
  EXPECT_EQ(simplices.FirstFolded(block.nodes), std::nullopt);
  Mesh mesh;
  mesh.nodes = block.nodes;
  mesh.elements = simplices.Elements();
  return mesh;
}

// Every inner face has two tetrahedra if and only if the boundary is that of
// the block.
TEST(SimplicesTest, OfCellsOfSeveralShapesShareTheirFaces) {
  for (int shift = 0; shift < 29; ++shift) {
    const Mesh mesh = MeshOf(MixedBlock(shift));
    ASSERT_NO_THROW(ValidateMesh(mesh)) << shift;
    EXPECT_NEAR(ElementVolumes(mesh).sum(), 8, 1e-12);
    const Eigen::MatrixXi facets = BoundaryFacets(mesh);
    double area = 0;
    for (const auto& facet : facets.colwise()) {
      const Eigen::Vector3d a = mesh.nodes.col(facet(0));
      const Eigen::Vector3d b = mesh.nodes.col(facet(1));
      const Eigen::Vector3d c = mesh.nodes.col(facet(2));
      area += (b - a).cross(c - a).norm() / 2;
    }
    EXPECT_NEAR(area, 24, 1e-12) << shift;
    EXPECT_EQ(facets.cols(), 48) << shift;
  }
}

TEST(SimplicesTest, LeaveOutThoseOfCollapsedEdges) {
  // A hexahedron with two collapsed edges is a wedge.
  Simplices simplices(3);
  EXPECT_EQ(simplices.Add(*FindCellShape(3, 8), {0, 1, 2, 2, 3, 4, 5, 5}), 3U);
  Eigen::Matrix3Xd nodes(3, 6);
  nodes << 0, 1, 0, 0, 1, 0,  //
      0, 0, 1, 0, 0, 1,       //
      0, 0, 0, 1, 1, 1;
  EXPECT_EQ(simplices.FirstFolded(nodes), std::nullopt);
  EXPECT_EQ(simplices.Cells().size(), 3U);
}

TEST(SimplicesTest, CountCollapsedCells) {
  Simplices simplices(3);
  simplices.Add(*FindCellShape(3, 6), {0, 1, 2, 3, 4, 5});
  simplices.Add(*FindCellShape(3, 6), {0, 1, 2, 0, 4, 5});
  simplices.Add(*FindCellShape(3, 8), {0, 1, 2, 2, 3, 4, 5, 5});
  EXPECT_THAT(simplices.Notice(),
              ::testing::StartsWith(
                  "1 hexahedron (with collapsed edges) and 2 wedges (1 of them "
                  "with collapsed edges) are read as 8 tetrahedra"));
}

TEST(SimplicesTest, TellFoldedAndFlatCells) {
  Simplices simplices(2);
  simplices.Add(*FindCellShape(2, 4), {0, 1, 2, 3});
  Eigen::Matrix3Xd nodes(3, 4);
  nodes << 0, 1, 1, 0,  //
      0, 0, 1, 1,       //
      0, 0, 0, 0;
  EXPECT_EQ(simplices.FirstFolded(nodes), std::nullopt);
  nodes.col(3) << 0.9, 0.2, 0;
  EXPECT_EQ(simplices.FirstFolded(nodes), 0U);
  Simplices collapsed(2);
  collapsed.Add(*FindCellShape(2, 4), {0, 1, 1, 0});
  EXPECT_EQ(collapsed.FirstFolded(nodes), 0U);
}

TEST(SimplicesTest, OfAPlaneAreTriangles) {
  Simplices simplices(2);
  simplices.Add(*FindCellShape(2, 4), {3, 1, 0, 2});
  simplices.Add(*FindCellShape(2, 3), {4, 2, 1});
  EXPECT_EQ(simplices.Elements().cols(), 3);
  EXPECT_THAT(simplices.Cells(), ElementsAre(0, 0, 1));
  EXPECT_EQ(simplices.Notice(),
            "1 quadrilateral and 1 triangle are read as 3 triangles with the "
            "same nodes");
}

// Uniaxial tension along z with supports of symmetry, which any mesh of
// conforming elements has exactly.
constexpr double kTensileModulus = 2000;
constexpr double kTensileRatio = 0.3;

Eigen::Vector3d TensileDisplacement(const Eigen::Vector3d& x) {
  return Eigen::Vector3d(-kTensileRatio, -kTensileRatio, 1).cwiseProduct(x) *
         (10 / kTensileModulus);
}

// The displacements of nodes with numbers from 10 on.
std::string TensileTable(const Eigen::Matrix3Xd& nodes) {
  std::ostringstream table;
  table.precision(17);
  table << "node,ux,uy,uz\n";
  for (Eigen::Index i = 0; i < nodes.cols(); ++i) {
    const Eigen::Vector3d u = TensileDisplacement(nodes.col(i));
    table << 10 + i << "," << u(0) << "," << u(1) << "," << u(2) << "\n";
  }
  return table.str();
}

std::string AbaqusText(const MixedBlock& block) {
  std::ostringstream text;
  text << "*NODE\n";
  for (Eigen::Index i = 0; i < block.nodes.cols(); ++i) {
    text << 10 + i << ", " << block.nodes(0, i) << ", " << block.nodes(1, i)
         << ", " << block.nodes(2, i) << "\n";
  }
  std::ostringstream top;
  std::string others;
  for (std::size_t i = 0; i < block.cells.size(); ++i) {
    const MixedBlock::Cell& cell = block.cells[i];
    text << "*ELEMENT, TYPE=" << cell.type << ", ELSET=EALL\n" << 100 - i;
    for (const int node : cell.nodes) {
      text << ", " << 10 + node;
    }
    text << "\n";
    // Face S2 of the hexahedra and wedges is above, S1 of a pyramid its base.
    const bool is_above = [&] {
      const std::size_t first = cell.type == "C3D5" ? 0 : cell.nodes.size() / 2;
      const std::size_t last = cell.type == "C3D5" ? 4 : cell.nodes.size();
      for (std::size_t k = first; k < last; ++k) {
        if (block.nodes(2, cell.nodes[k]) != 2) {
          return false;
        }
      }
      return true;
    }();
    if (is_above) {
      top << 100 - i << ", " << (cell.type == "C3D5" ? "S1" : "S2") << "\n";
    }
    others += i % 2 == 0 ? std::to_string(100 - i) + "\n" : "";
  }
  text << "*SURFACE, NAME=TOP\n"
       << top.str() << "*ELSET, ELSET=EVEN\n"
       << others << "*SOLID SECTION, ELSET=EVEN, MATERIAL=M\n";
  return text.str();
}

TEST(MixedMeshes, OfAbaqusAreEstimatedWithTheirSurfaces) {
  const TemporaryFolder folder;
  const MixedBlock block(5);
  folder.Write("mesh.inp", AbaqusText(block));
  folder.Write("nodes.csv", TensileTable(block.nodes));
  const SceneReading reading = ReadScene({folder.Write("scene.json", R"({
        "mesh": "mesh.inp",
        "supports": [
          {"nodes": {"box": [[0, 0, 0], [0, 2, 2]]}, "components": "x"},
          {"nodes": {"box": [[0, 0, 0], [2, 0, 2]]}, "components": "y"},
          {"nodes": {"box": [[0, 0, 0], [2, 2, 0]]}, "components": "z"}],
        "cases": [{"loads": [{"type": "pressure", "value": -10,
                              "surface": {"set": "TOP"}}],
                   "displacement": {"nodes": "nodes.csv"}}]})")},
                                         Measurement::kRequired);
  EXPECT_THAT(
      reading.notices,
      ::testing::Contains(HasSubstr(
          "4 hexahedra, 4 wedges and 12 pyramids are read as 60 tetrahedra")));
  const Scene& scene = reading.scene;
  EXPECT_EQ(scene.mesh.NumElements(), 60);
  EXPECT_EQ(std::get<Pressure>(scene.load_cases[0].loads[0]).facets.cols(), 8);
  const Estimate estimate = MakeEstimator("closed-form")->Run(scene, {});
  EXPECT_TRUE(estimate.IsUsable()) << estimate.message;
  EXPECT_NEAR(estimate.elasticity.youngs_modulus, kTensileModulus, 1e-6);
  EXPECT_NEAR(estimate.elasticity.poisson_ratio, kTensileRatio, 1e-9);
}

TEST(MixedMeshes, OfQuadraticElementsHaveNewNodesInSets) {
  const TemporaryFolder folder;
  const QuadraticBlock block(0);
  const MeshFile mesh = ReadMeshFile(folder.Write("mesh.inp", block.Text()));
  EXPECT_EQ(mesh.kind, ElementKind::kTet10);
  const Eigen::Index num_added = mesh.nodes.cols() - block.nodes.cols();
  EXPECT_GT(num_added, 20);
  // All nodes at x = 0, those that were added too.
  const auto left = std::find_if(
      mesh.groups.begin(), mesh.groups.end(),
      [](const PhysicalGroup& group) { return group.name == "LEFT"; });
  ASSERT_NE(left, mesh.groups.end());
  EXPECT_EQ(Eigen::Index(left->nodes.size()),
            (mesh.nodes.row(0).array() == 0).count());
  EXPECT_GE(left->nodes.back(), block.nodes.cols());
  ASSERT_EQ(mesh.notices.size(), 1U);
  EXPECT_THAT(mesh.notices[0], HasSubstr("6 hexahedra and 4 wedges are read"));
}

// A side of a serendipity element whose four edges bend by b bulges by 4 b / 3
// on average, since the integral of each of their functions is a third.
TEST(MixedMeshes, OfQuadraticElementsKeepCurvedSides) {
  const TemporaryFolder folder;
  const double bend = 0.06;
  const double flat = VolumeOf(
      ReadMeshFile(folder.Write("flat.inp", QuadraticBlock(0).Text())));
  const MeshFile mesh =
      ReadMeshFile(folder.Write("bent.inp", QuadraticBlock(bend).Text()));
  EXPECT_EQ(mesh.kind, ElementKind::kCurvedTet10);
  EXPECT_NEAR(flat, 8, 1e-12);
  EXPECT_NEAR(VolumeOf(mesh) - flat, 4 * 4 * bend / 3, 1e-12);
}

TEST(MixedMeshes, OfQuadraticElementsAreEstimated) {
  const TemporaryFolder folder;
  const QuadraticBlock block(0);
  folder.Write("mesh.inp", block.Text());
  folder.Write("nodes.csv", TensileTable(block.nodes));
  const Scene scene = ReadScene({folder.Write("scene.json", R"({
        "mesh": "mesh.inp",
        "supports": [
          {"nodes": {"set": "left"}, "components": "x"},
          {"nodes": {"box": [[0, 0, 0], [2, 0, 2]]}, "components": "y"},
          {"nodes": {"box": [[0, 0, 0], [2, 2, 0]]}, "components": "z"}],
        "cases": [{"loads": [{"type": "traction", "value": [0, 0, 10],
                              "surface": {"box": [[0, 0, 2], [2, 2, 2]]}}],
                   "displacement": {"nodes": "nodes.csv"}}]})")},
                                Measurement::kRequired)
                          .scene;
  EXPECT_EQ(scene.mesh.kind, ElementKind::kTet10);
  const Estimate estimate = MakeEstimator("iterative-fe")->Run(scene, {});
  EXPECT_TRUE(estimate.IsUsable()) << estimate.message;
  EXPECT_NEAR(estimate.elasticity.youngs_modulus, kTensileModulus, 1e-4);
  EXPECT_NEAR(estimate.elasticity.poisson_ratio, kTensileRatio, 1e-7);
}

// Other elements than those that are fitted computed the displacements.
TEST(MixedMeshes, CannotHaveComputedDisplacements) {
  const TemporaryFolder folder;
  const MixedBlock block(5);
  folder.Write("mesh.inp", AbaqusText(block));
  folder.Write("nodes.csv", TensileTable(block.nodes));
  const std::string text = R"({"mesh": "mesh.inp", "origin": "computed",
    "supports": [{"nodes": {"box": [[0, 0, 0], [2, 2, 0]]}}],
    "cases": [{"displacement": {"nodes": "nodes.csv"}, "loads": []}]})";
  const std::filesystem::path scene = folder.Write("scene.json", text);
  EXPECT_THROWS_WITH(ReadScene({scene}, Measurement::kRequired),
                     "the cells of '.*mesh.inp' were cut into tetrahedra, so "
                     "that other elements computed them; give \"origin\"");
  SceneChoices choices;
  choices.origin = Origin::kMeasured;
  EXPECT_EQ(ReadScene({scene}, Measurement::kRequired, choices).scene.origin,
            Origin::kMeasured);
}

// Abaqus has the nodes between the layers last, other programs before.
TEST(MixedMeshes, OfQuadraticElementsNeedTheirNodesInOrder) {
  const TemporaryFolder folder;
  QuadraticBlock block(0);
  std::vector<int>& nodes = block.cells[0].nodes;
  ASSERT_EQ(nodes.size(), 20U);
  std::rotate(nodes.begin() + 12, nodes.begin() + 16, nodes.end());
  EXPECT_THROWS_WITH(ReadMeshFile(folder.Write("mesh.inp", block.Text())),
                     "element 100 of type C3D20 has node .* in the middle of "
                     "its edge from node .*, but that node lies elsewhere");
}

// The regions of all parts of an element are those of the element.
TEST(MixedMeshes, OfAbaqusKeepTheirSetsAsRegions) {
  const TemporaryFolder folder;
  const MixedBlock block(11);
  const MeshFile mesh =
      ReadMeshFile(folder.Write("mesh.inp", AbaqusText(block)));
  const Eigen::MatrixXd& region = *FindArray(mesh.element_arrays, "region");
  Mesh tetrahedra;
  tetrahedra.nodes = mesh.nodes;
  tetrahedra.elements = mesh.elements;
  double expected = 0;
  for (std::size_t i = 0; i < block.cells.size(); i += 2) {
    MixedBlock one = block;
    one.cells = {block.cells[i]};
    expected += ElementVolumes(MeshOf(one)).sum();
  }
  EXPECT_NEAR(region.row(0).dot(ElementVolumes(tetrahedra)), expected, 1e-12);
}

TEST(MixedMeshes, OfVtkKeepTheirArrays) {
  const TemporaryFolder folder;
  const std::string text =
      "# vtk DataFile Version 3.0\nmixed\nASCII\nDATASET UNSTRUCTURED_GRID\n"
      "POINTS 5 float\n0 0 0  1 0 0  1 1 0  0 1 0  2 0.5 0\n"
      "CELLS 3 12\n2 0 1\n4 0 1 2 3\n3 1 4 2\nCELL_TYPES 3\n3 9 5\n"
      "CELL_DATA 3\nSCALARS region int 1\nLOOKUP_TABLE default\n9 7 8\n";
  const MeshFile mesh = ReadMeshFile(folder.Write("mesh.vtk", text));
  EXPECT_EQ(mesh.kind, ElementKind::kTri3);
  const Eigen::MatrixXd& region = *FindArray(mesh.element_arrays, "region");
  EXPECT_EQ(region, Eigen::RowVector3d(7, 7, 8));
  ASSERT_EQ(mesh.notices.size(), 1U);
  EXPECT_THAT(mesh.notices[0], HasSubstr("are read as 3 triangles"));
  EXPECT_THROWS_WITH(
      ReadMeshFile(
          folder.Write("mesh.vtk", Replaced(text, "4 0 1 2 3", "4 0 1 3 2"))),
      "cell 1 is a quad that is folded or flat; order its nodes as its format");
}

TEST(MixedMeshes, OfFebioHaveTheirFacesCut) {
  const TemporaryFolder folder;
  const MeshFile mesh = ReadMeshFile(folder.Write("mesh.feb", R"(
<febio_spec version="4.0"><Mesh>
  <Nodes>
    <node id="1">0,0,0</node><node id="2">1,0,0</node><node id="3">1,1,0</node>
    <node id="4">0,1,0</node><node id="5">0,0,1</node><node id="6">1,0,1</node>
    <node id="7">1,1,1</node><node id="8">0,1,1</node><node id="9">2,0,0</node>
    <node id="10">2,0,1</node>
  </Nodes>
  <Elements type="hex8" name="A"><elem id="1">1,2,3,4,5,6,7,8</elem></Elements>
  <Elements type="penta6" name="B"><elem id="2">2,9,3,6,10,7</elem></Elements>
  <Surface name="bottom"><quad4 id="1">1,2,3,4</quad4><tri3 id="2">2,9,3</tri3>
  </Surface>
</Mesh></febio_spec>)"));
  EXPECT_EQ(mesh.elements.cols(), 9);
  ASSERT_EQ(mesh.groups.size(), 3U);
  EXPECT_EQ(mesh.groups[2].facets.cols(), 3);
  const Eigen::MatrixXd& region = *FindArray(mesh.element_arrays, "region");
  EXPECT_EQ((region.array() == 2).count(), 3);
}

}  // namespace
}  // namespace elastimate
