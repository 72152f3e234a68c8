#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "elastimate/core/scene/scene.h"
#include "elastimate/io/mesh/mesh_file.h"
#include "elastimate/io/scene/mesh_reader.h"
#include "elastimate/io/vtk/vtu_writer.h"
#include "tests/io/scene_files.h"
#include "tests/scenes.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

// A block in two pieces, each with points of its own, which are numbered in the
// order in which its elements name them.
class PvtuMeshTest : public ::testing::Test {
 protected:
  PvtuMeshTest() {
    const Eigen::Index half = block_.NumElements() / 2;
    pieces_ = {PieceOf(block_.elements.leftCols(half)),
               PieceOf(block_.elements.rightCols(block_.NumElements() - half))};
  }

  MeshFile Read() const {
    std::string text =
        "<VTKFile type=\"PUnstructuredGrid\"><PUnstructuredGrid>";
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const std::string name = "piece_" + std::to_string(i) + ".vtu";
      WriteVtu(folder_.Path() / name, pieces_[i].mesh, pieces_[i].fields);
      text += "<Piece Source=\"" + name + "\"/>";
    }
    return ReadMeshFile(
        folder_.Write("block.pvtu", text + "</PUnstructuredGrid></VTKFile>"));
  }

  struct Piece {
    Mesh mesh;
    Fields fields;
  };

  // Its point array "place" is where a point is.
  Piece PieceOf(const Eigen::MatrixXi& elements) const {
    std::map<int, int> points;
    Piece piece;
    piece.mesh.elements = elements;
    piece.mesh.nodes.resize(3, block_.NumNodes());
    for (int& node : piece.mesh.elements.reshaped()) {
      const auto [found, is_new] =
          points.emplace(node, static_cast<int>(points.size()));
      piece.mesh.nodes.col(found->second) = block_.nodes.col(node);
      node = found->second;
    }
    piece.mesh.nodes.conservativeResize(3, Eigen::Index(points.size()));
    piece.fields.point = {{"place", piece.mesh.nodes}};
    return piece;
  }

  const Mesh block_ = testing::BoxMesh({2, 2, 2}, {1, 2, 3});
  std::vector<Piece> pieces_;
  const TemporaryFolder folder_;
};

TEST_F(PvtuMeshTest, IsOneMesh) {
  const MeshFile read = Read();
  EXPECT_EQ(read.nodes.cols(), block_.NumNodes());
  ASSERT_EQ(read.elements.cols(), block_.NumElements());
  for (Eigen::Index i = 0; i < block_.NumElements(); ++i) {
    for (int k = 0; k < 4; ++k) {
      EXPECT_EQ(read.nodes.col(read.elements(k, i)),
                block_.nodes.col(block_.elements(k, i)));
    }
  }
  ASSERT_NE(FindArray(read.node_arrays, "place"), nullptr);
  EXPECT_EQ(*FindArray(read.node_arrays, "place"), read.nodes);
}

TEST_F(PvtuMeshTest, LeavesGhostCellsOut) {
  // The second piece also has the last element of the first one.
  const Eigen::Index half = block_.NumElements() / 2;
  pieces_[1] =
      PieceOf(block_.elements.rightCols(block_.NumElements() - half + 1));
  Eigen::RowVectorXd ghosts =
      Eigen::RowVectorXd::Zero(pieces_[1].mesh.NumElements());
  ghosts(0) = 1;
  pieces_[1].fields.cell = {{"vtkGhostType", ghosts}};
  pieces_[0].fields.cell = {
      {"vtkGhostType",
       Eigen::RowVectorXd::Zero(pieces_[0].mesh.NumElements())}};
  const MeshFile read = Read();
  EXPECT_EQ(read.nodes.cols(), block_.NumNodes());
  EXPECT_EQ(read.elements.cols(), block_.NumElements());
}

TEST_F(PvtuMeshTest, MayHaveAPieceWithoutCells) {
  const std::string empty =
      "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid>"
      "<Piece NumberOfPoints=\"0\" NumberOfCells=\"0\"><Points>"
      "<DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\"/>"
      "</Points><Cells>"
      "<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\"/>"
      "<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\"/>"
      "<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\"/>"
      "</Cells></Piece></UnstructuredGrid></VTKFile>";
  Read();
  folder_.Write("empty.vtu", empty);
  const MeshFile read = ReadMeshFile(folder_.Write(
      "three.pvtu",
      "<VTKFile type=\"PUnstructuredGrid\"><PUnstructuredGrid>"
      "<Piece Source=\"empty.vtu\"/><Piece Source=\"piece_0.vtu\"/>"
      "<Piece Source=\"piece_1.vtu\"/></PUnstructuredGrid></VTKFile>"));
  EXPECT_EQ(read.nodes.cols(), block_.NumNodes());
  EXPECT_NE(FindArray(read.node_arrays, "place"), nullptr);
}

TEST_F(PvtuMeshTest, LeavesOutArraysOnWhichPiecesDisagree) {
  for (Piece& piece : pieces_) {
    const Eigen::MatrixXd& place = piece.fields.point[0].values;
    piece.fields.point.push_back(
        {"process", Eigen::RowVectorXd::Constant(
                        place.cols(), double(&piece - pieces_.data()))});
  }
  const MeshFile read = Read();
  EXPECT_NE(FindArray(read.node_arrays, "place"), nullptr);
  EXPECT_EQ(FindArray(read.node_arrays, "process"), nullptr);
  ASSERT_EQ(read.notices.size(), 1U);
  EXPECT_NE(read.notices[0].find("block.pvtu: the array 'process' is left out"),
            std::string::npos)
      << read.notices[0];
}

TEST_F(PvtuMeshTest, IsRefusedWhereAPieceHasTwoPointsAtOnePlace) {
  Mesh& mesh = pieces_[0].mesh;
  const Eigen::Index num_nodes = mesh.NumNodes();
  mesh.nodes.conservativeResize(3, num_nodes + 1);
  mesh.nodes.col(num_nodes) = mesh.nodes.col(0);
  pieces_[0].fields.point = {{"place", mesh.nodes}};
  EXPECT_THROWS_WITH(Read(), "piece_0.vtu: two points are at");
}

TEST_F(PvtuMeshTest, IsRefusedWhereItIsDamaged) {
  const std::string head =
      "<VTKFile type=\"PUnstructuredGrid\"><PUnstructuredGrid>";
  const std::string tail = "</PUnstructuredGrid></VTKFile>";
  const auto expect = [&](const std::string& text, const std::string& message) {
    EXPECT_THROWS_WITH(ReadMeshFile(folder_.Write("damaged.pvtu", text)),
                       message);
  };
  expect(head, "damaged.pvtu: the file is damaged");
  expect(head + tail, "damaged.pvtu: the file is damaged");
  expect(head + "<Piece Source=\"absent.vtu\"/>" + tail,
         "absent.vtu: no such file");
  expect(head + "<Piece/>" + tail, "damaged.pvtu: the file is damaged");
  // A tetrahedron of points that there are not.
  folder_.Write(
      "far.vtu",
      "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid>"
      "<Piece NumberOfPoints=\"4\" NumberOfCells=\"1\"><Points>"
      "<DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">"
      "0 0 0 1 0 0 0 1 0 0 0 1</DataArray></Points><Cells>"
      "<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">"
      "0 1 2 999999</DataArray>"
      "<DataArray type=\"Int64\" Name=\"offsets\" "
      "format=\"ascii\">4</DataArray>"
      "<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">10</DataArray>"
      "</Cells></Piece></UnstructuredGrid></VTKFile>");
  expect(head + "<Piece Source=\"far.vtu\"/>" + tail,
         "far.vtu: cell 0 names point 999999");
  folder_.Write("cut.vtu", "<VTKFile type=\"Unstruct");
  expect(head + "<Piece Source=\"cut.vtu\"/>" + tail,
         "cut.vtu: the file is damaged");
}

}  // namespace
}  // namespace elastimate
