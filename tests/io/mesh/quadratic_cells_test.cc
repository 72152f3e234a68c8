// Cells of VTK and Gmsh that have nodes in the middle of their edges alone.

#include <gmock/gmock.h>
#include <gmsh.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "elastimate/core/mesh/mesh.h"
#include "elastimate/estimators/registry.h"
#include "elastimate/io/mesh/simplices.h"
#include "elastimate/io/scene/mesh_reader.h"
#include "elastimate/io/scene/scene_reader.h"
#include "tests/io/mixed_block.h"
#include "tests/io/scene_files.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

using ::testing::HasSubstr;

// The block under tension along z, at the modulus 1000 and the ratio 0.25.
Eigen::Matrix3Xd StretchedBy(const Eigen::Matrix3Xd& nodes) {
  return Eigen::Vector3d(-0.25, -0.25, 1).asDiagonal() * nodes * 0.01;
}

// The arrays of a scene whose bottom is held along z, and two sides across.
std::string VtkArrays(const QuadraticBlock& block) {
  const Eigen::Matrix3Xd u = StretchedBy(block.nodes);
  std::ostringstream text;
  text.precision(17);
  text << "POINT_DATA " << block.nodes.cols()
       << "\nVECTORS displacement double\n"
       << u.transpose() << "\nVECTORS fixed double\n"
       << (block.nodes.array() == 0).cast<double>().transpose()
       << "\nVECTORS force double\n"
       << Eigen::MatrixXd::Zero(block.nodes.cols(), 3)
       << "\nSCALARS bottom int 1\nLOOKUP_TABLE default\n"
       << (block.nodes.row(2).array() == 0).cast<int>().transpose() << "\n";
  return text.str();
}

std::string VtkText(const QuadraticBlock& block) {
  std::ostringstream text;
  text.precision(17);
  text << "# vtk DataFile Version 3.0\nblock\nASCII\n"
       << "DATASET UNSTRUCTURED_GRID\nPOINTS " << block.nodes.cols()
       << " double\n"
       << block.nodes.transpose() << "\n";
  std::size_t size = 0;
  for (const MixedBlock::Cell& cell : block.cells) {
    size += 1 + cell.nodes.size();
  }
  text << "CELLS " << block.cells.size() << " " << size << "\n";
  for (const MixedBlock::Cell& cell : block.cells) {
    text << cell.nodes.size();
    for (const int node : cell.nodes) {
      text << " " << node;
    }
    text << "\n";
  }
  text << "CELL_TYPES " << block.cells.size() << "\n";
  for (const MixedBlock::Cell& cell : block.cells) {
    text << (cell.nodes.size() == 20 ? 25 : 26) << "\n";
  }
  return text.str() + VtkArrays(block);
}

TEST(QuadraticCells, OfVtkAreCutAsThoseOfAbaqus) {
  const TemporaryFolder folder;
  for (const double bend : {0.0, 0.06}) {
    const QuadraticBlock block(bend);
    const MeshFile mesh =
        ReadMeshFile(folder.Write("mesh.vtk", VtkText(block)));
    const MeshFile same = ReadMeshFile(folder.Write("mesh.inp", block.Text()));
    EXPECT_EQ(mesh.kind, same.kind);
    EXPECT_NEAR(VolumeOf(mesh), 8 + 4 * 4 * bend / 3, 1e-12);
    EXPECT_THAT(mesh.notices[0], HasSubstr("6 hexahedra and 4 wedges are"));
    EXPECT_EQ(mesh.added.size(), same.added.size());
    EXPECT_EQ(ElementName(mesh, 0), "tetrahedron 0 (of cell 0)");
    EXPECT_EQ(ElementName(same, 0), "tetrahedron 0 (of number 91 in Abaqus)");
  }
}

// Six pyramids around the middle of a cube.
TEST(QuadraticCells, OfVtkMayBePyramids) {
  const TemporaryFolder folder;
  const MixedBlock linear(0);
  std::map<std::pair<int, int>, int> middles;
  std::vector<Eigen::Vector3d> nodes;
  for (const auto& x : linear.nodes.colwise()) {
    nodes.emplace_back(x);
  }
  std::ostringstream cells;
  int num_cells = 0;
  const CellShape& shape = *FindCellShape(3, 5);
  Simplices simplices(3);
  for (const MixedBlock::Cell& cell : linear.cells) {
    if (cell.type != "C3D5" || num_cells == 6) {
      continue;
    }
    ++num_cells;
    simplices.Add(shape, cell.nodes);
    cells << "13";
    for (const int node : cell.nodes) {
      cells << " " << node;
    }
    for (const auto& [i, j] : shape.edges) {
      const auto [a, b] = std::minmax(cell.nodes[i], cell.nodes[j]);
      const auto [place, is_new] =
          middles.insert({{a, b}, static_cast<int>(nodes.size())});
      if (is_new) {
        nodes.emplace_back((nodes[a] + nodes[b]) / 2);
      }
      cells << " " << place->second;
    }
    cells << "\n";
  }
  std::ostringstream text;
  text.precision(17);
  text << "# vtk DataFile Version 3.0\nblock\nASCII\n"
       << "DATASET UNSTRUCTURED_GRID\nPOINTS " << nodes.size() << " double\n";
  for (const Eigen::Vector3d& x : nodes) {
    text << x.transpose() << "\n";
  }
  text << "CELLS 6 84\n"
       << cells.str() << "CELL_TYPES 6\n27\n27\n27\n27\n27\n27\n";
  const MeshFile mesh = ReadMeshFile(folder.Write("mesh.vtk", text.str()));
  EXPECT_EQ(mesh.kind, ElementKind::kTet10);
  EXPECT_THAT(mesh.notices[0], HasSubstr("6 pyramids are read as 12"));
  MeshFile linear_mesh;
  linear_mesh.nodes = linear.nodes;
  linear_mesh.elements = simplices.Elements();
  EXPECT_NEAR(VolumeOf(mesh), VolumeOf(linear_mesh), 1e-12);
}

TEST(QuadraticCells, OfThePlaneAreCutIntoTriangles) {
  const TemporaryFolder folder;
  // A square whose right side bulges by 0.1, which adds 2 / 3 of that.
  const MeshFile mesh = ReadMeshFile(folder.Write(
      "mesh.vtk",
      "# vtk DataFile Version 3.0\nplane\nASCII\n"
      "DATASET UNSTRUCTURED_GRID\nPOINTS 8 double\n0 0 0 1 0 0 1 1 0 0 1 0\n"
      "0.5 0 0 1.1 0.5 0 0.5 1 0 0 0.5 0\n"
      "CELLS 1 9\n8 0 1 2 3 4 5 6 7\nCELL_TYPES 1\n23\n"));
  EXPECT_EQ(mesh.kind, ElementKind::kCurvedTri6);
  EXPECT_NEAR(VolumeOf(mesh), 1 + 0.2 / 3, 1e-14);
}

// Added nodes are held where all around them are, and nothing is known of their
// displacements.
TEST(QuadraticCells, OfVtkKeepTheirArrays) {
  const TemporaryFolder folder;
  const QuadraticBlock block(0);
  folder.Write("mesh.vtk", VtkText(block));
  const auto read =
      [&](const std::string& displacement) {
        return ReadScene({folder.Write("scene.json", R"({"mesh": "mesh.vtk",
        "supports": [
          {"nodes": {"box": [[0, 0, 0], [0, 2, 2]]}, "components": "x"},
          {"nodes": {"box": [[0, 0, 0], [2, 0, 2]]}, "components": "y"},
          {"nodes": {"array": "bottom"}, "components": "z"}],
        "cases": [{"loads": [{"type": "traction", "value": [0, 0, 10],
                              "surface": {"box": [[0, 0, 2], [2, 2, 2]]}}],
                   "displacement": {)" + displacement + "}}]}")},
                         Measurement::kRequired)
            .scene;
      };
  std::ostringstream table;
  table.precision(17);
  table << "ux,uy,uz\n";
  const Eigen::Matrix3Xd displacements = StretchedBy(block.nodes);
  for (const auto& u : displacements.colwise()) {
    table << u(0) << "," << u(1) << "," << u(2) << "\n";
  }
  folder.Write("u.csv", table.str());
  for (const std::string displacement :
       {R"("array": "displacement")", R"("file": "u.csv")"}) {
    const Scene scene = read(displacement);
    // All nodes at the bottom are held, those that were added too.
    const Eigen::Array<bool, 1, Eigen::Dynamic> at_bottom =
        scene.mesh.nodes.row(2).array() == 0;
    EXPECT_TRUE((scene.supports.held.row(2) == at_bottom).all());
    EXPECT_EQ(scene.load_cases[0].observed.row(0).count(), block.nodes.cols());
    EXPECT_LT(scene.load_cases[0].observed.row(0).count(),
              scene.mesh.NumNodes());
    const Estimate estimate = MakeEstimator("iterative-fe")->Run(scene, {});
    EXPECT_NEAR(estimate.elasticity.youngs_modulus, 1000, 1e-3);
    EXPECT_NEAR(estimate.elasticity.poisson_ratio, 0.25, 1e-6);
  }
  const SceneReading arrays =
      ReadScene({folder.Path() / "mesh.vtk"}, Measurement::kRequired);
  const Eigen::Array<bool, 3, Eigen::Dynamic> at_zero =
      arrays.scene.mesh.nodes.array() == 0;
  EXPECT_TRUE((arrays.scene.supports.held == at_zero).all());
  EXPECT_EQ(arrays.scene.load_cases[0].observed.row(0).count(),
            block.nodes.cols());
}

TEST(QuadraticCells, OfVtkNeedTheirPointsInOrder) {
  const TemporaryFolder folder;
  QuadraticBlock block(0);
  std::swap(block.cells[0].nodes[9], block.cells[0].nodes[17]);
  EXPECT_THROWS_WITH(
      ReadMeshFile(folder.Write("mesh.vtk", VtkText(block))),
      "cell 0 is a quadratic hexahedron that has node .* in the middle of its "
      "edge from node .* but that node lies elsewhere");
}

// Gmsh writes the nodes of an element in another order to each format.
TEST(QuadraticCells, OfGmshAreThoseOfItsOtherFormats) {
  const TemporaryFolder folder;
  gmsh::initialize(0, nullptr, false);
  gmsh::option::setNumber("General.Terminal", 0);
  // A quarter of a ring, of hexahedra, on the quarter of a disc, of wedges.
  const int ring = gmsh::model::occ::addRectangle(1, 0, 0, 1, 1);
  const int disc = gmsh::model::occ::addRectangle(2, 0, 0, 1, 1);
  gmsh::vectorpair fused;
  std::vector<gmsh::vectorpair> map;
  gmsh::model::occ::fragment({{2, ring}}, {{2, disc}}, fused, map);
  gmsh::model::occ::synchronize();
  gmsh::vectorpair surfaces;
  gmsh::model::getEntities(surfaces, 2);
  gmsh::vectorpair out;
  gmsh::model::occ::revolve(surfaces, 0, 0, 0, 0, 1, 0, 1.0, out, {3}, {},
                            true);
  gmsh::model::occ::synchronize();
  gmsh::vectorpair bottom;
  gmsh::model::getEntitiesInBoundingBox(0.9, -0.1, -0.1, 2.1, 1.1, 0.1, bottom,
                                        2);
  for (const auto& [dimension, tag] : bottom) {
    gmsh::model::mesh::setRecombine(2, tag);
  }
  gmsh::model::addPhysicalGroup(2, {bottom[0].second}, 7);
  gmsh::model::setPhysicalName(2, 7, "bottom");
  gmsh::vectorpair volumes;
  gmsh::model::getEntities(volumes, 3);
  std::vector<int> tags;
  for (const auto& [dimension, tag] : volumes) {
    tags.push_back(tag);
  }
  gmsh::model::addPhysicalGroup(3, tags, 8);
  gmsh::option::setNumber("Mesh.MeshSizeMin", 0.4);
  gmsh::option::setNumber("Mesh.MeshSizeMax", 0.5);
  gmsh::option::setNumber("Mesh.ElementOrder", 2);
  gmsh::option::setNumber("Mesh.SecondOrderIncomplete", 1);
  gmsh::model::mesh::generate(3);
  std::vector<int> types;
  gmsh::model::mesh::getElementTypes(types, 3);
  for (const std::string name : {"mesh.msh", "mesh.inp", "mesh.vtk"}) {
    gmsh::write((folder.Path() / name).string());
  }
  gmsh::finalize();
  EXPECT_THAT(types, ::testing::UnorderedElementsAre(17, 18));
  const MeshFile mesh = ReadMeshFile(folder.Path() / "mesh.msh");
  const MeshFile abaqus = ReadMeshFile(folder.Path() / "mesh.inp");
  const MeshFile vtk = ReadMeshFile(folder.Path() / "mesh.vtk");
  EXPECT_EQ(mesh.kind, ElementKind::kCurvedTet10);
  EXPECT_EQ(mesh.added.size(), abaqus.added.size());
  EXPECT_NEAR(VolumeOf(mesh), VolumeOf(abaqus), 1e-9);
  EXPECT_NEAR(VolumeOf(mesh), VolumeOf(vtk), 1e-9);
  // Pappus: the area times the way of its centre.
  EXPECT_NEAR(VolumeOf(mesh), 2 * 2 * 1.0, 0.01);
  // A side of quadratic facets, with the nodes in the middle of their parts.
  const PhysicalGroup& group = mesh.groups[0];
  EXPECT_EQ(group.name, "bottom");
  EXPECT_GT(group.facets.cols(), 0);
  EXPECT_TRUE(std::any_of(group.nodes.begin(), group.nodes.end(), [&](int n) {
    return n >= mesh.nodes.cols() - Eigen::Index(mesh.added.size());
  }));
}

}  // namespace
}  // namespace elastimate
