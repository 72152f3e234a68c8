#include "elastimate/io/helper/mesh_message.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

namespace elastimate {
namespace {

using Kind = MeshMessage::Kind;

MeshFile SomeMesh() {
  MeshFile mesh;
  mesh.nodes = Eigen::MatrixXd::Random(3, 5);
  mesh.elements.resize(4, 2);
  mesh.elements.transpose() << 0, 1, 2, 3, 0, 1, 2, 4;
  mesh.node_arrays = {{"u", Eigen::MatrixXd::Random(3, 5)}};
  mesh.element_arrays = {{"region", Eigen::MatrixXd::Random(1, 2)}};
  mesh.groups = {{2, 70, "top", {0, 1, 4}, Eigen::MatrixXi::Ones(3, 2)}};
  mesh.are_regions_groups = true;
  mesh.why_no_regions = "tetrahedron 1 is in two groups";
  mesh.has_other_cells = true;
  mesh.is_vtk = false;
  mesh.model = 2;
  mesh.thickness = 0.1;
  mesh.node_numbers = {2, 3, 5, 7, 10};
  mesh.num_nodes_left_out = 1;
  return mesh;
}

template <typename Write>
std::string Bytes(Write write) {
  char* memory = nullptr;
  std::size_t size = 0;
  std::FILE* const file = open_memstream(&memory, &size);
  WriteStart(file, true);
  write(file);
  std::fclose(file);
  std::string bytes(memory, size);
  std::free(memory);
  return bytes;
}

std::string BytesOf(const MeshFile& mesh) {
  return Bytes([&](std::FILE* file) { WriteMesh(file, mesh); });
}

TEST(MeshMessage, BringsAMesh) {
  const MeshFile mesh = SomeMesh();
  const MeshMessage message = ParseMeshMessage(BytesOf(mesh));
  ASSERT_EQ(message.kind, Kind::kMesh);
  EXPECT_TRUE(message.has_started);
  EXPECT_TRUE(message.is_short_of_memory);
  EXPECT_EQ(message.mesh.nodes, mesh.nodes);
  EXPECT_EQ(message.mesh.elements, mesh.elements);
  EXPECT_EQ(message.mesh.node_arrays.at(0).name, "u");
  EXPECT_EQ(message.mesh.node_arrays[0].values, mesh.node_arrays[0].values);
  EXPECT_EQ(message.mesh.element_arrays.at(0).values,
            mesh.element_arrays[0].values);
  EXPECT_EQ(message.mesh.groups.at(0).name, "top");
  EXPECT_EQ(message.mesh.groups[0].nodes, mesh.groups[0].nodes);
  EXPECT_EQ(message.mesh.groups[0].facets, mesh.groups[0].facets);
  EXPECT_TRUE(message.mesh.are_regions_groups);
  EXPECT_EQ(message.mesh.why_no_regions, mesh.why_no_regions);
  EXPECT_EQ(message.mesh.kind, mesh.kind);
  EXPECT_EQ(message.mesh.model, 2);
  EXPECT_EQ(message.mesh.thickness, 0.1);
  EXPECT_TRUE(message.mesh.has_other_cells);
  EXPECT_FALSE(message.mesh.is_vtk);
  EXPECT_EQ(message.mesh.node_numbers, mesh.node_numbers);
  EXPECT_EQ(message.mesh.num_nodes_left_out, 1);
}

TEST(MeshMessage, BringsAPlanarMesh) {
  MeshFile mesh = SomeMesh();
  mesh.kind = ElementKind::kQuad4;
  mesh.groups[0].facets = Eigen::MatrixXi::Ones(2, 3);
  mesh.model.reset();
  mesh.thickness.reset();
  const MeshMessage message = ParseMeshMessage(BytesOf(mesh));
  ASSERT_EQ(message.kind, Kind::kMesh);
  EXPECT_EQ(message.mesh.kind, ElementKind::kQuad4);
  EXPECT_EQ(message.mesh.groups[0].facets, mesh.groups[0].facets);
  EXPECT_FALSE(message.mesh.model.has_value());
  EXPECT_FALSE(message.mesh.thickness.has_value());
}

TEST(MeshMessage, BringsASentence) {
  const MeshMessage message = ParseMeshMessage(Bytes([](std::FILE* file) {
    WriteSentence(file, Kind::kWrongInput, "a.msh: it is empty");
  }));
  EXPECT_EQ(message.kind, Kind::kWrongInput);
  EXPECT_EQ(message.sentence, "a.msh: it is empty");
}

TEST(MeshMessage, IsNoneUnlessItIsWhole) {
  const std::string bytes = BytesOf(SomeMesh());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_EQ(ParseMeshMessage(bytes.substr(0, size)).kind, Kind::kNone);
  }
}

TEST(MeshMessage, IsNoneWhereNodesAreNotThere) {
  for (const int node : {-1, 5, 1 << 30}) {
    MeshFile mesh = SomeMesh();
    mesh.elements(2, 1) = node;
    EXPECT_EQ(ParseMeshMessage(BytesOf(mesh)).kind, Kind::kNone);
    mesh = SomeMesh();
    mesh.groups[0].nodes[2] = node;
    EXPECT_EQ(ParseMeshMessage(BytesOf(mesh)).kind, Kind::kNone);
    mesh = SomeMesh();
    mesh.groups[0].facets(0, 1) = node;
    EXPECT_EQ(ParseMeshMessage(BytesOf(mesh)).kind, Kind::kNone);
  }
}

TEST(MeshMessage, IsNoneWhereSizesDisagree) {
  MeshFile mesh = SomeMesh();
  mesh.node_arrays[0].values.resize(3, 4);
  EXPECT_EQ(ParseMeshMessage(BytesOf(mesh)).kind, Kind::kNone);
  mesh = SomeMesh();
  mesh.element_arrays[0].values.resize(1, 3);
  EXPECT_EQ(ParseMeshMessage(BytesOf(mesh)).kind, Kind::kNone);
  mesh = SomeMesh();
  mesh.kind = ElementKind::kTri3;
  EXPECT_EQ(ParseMeshMessage(BytesOf(mesh)).kind, Kind::kNone);
  mesh = SomeMesh();
  mesh.groups[0].facets.resize(4, 2);
  mesh.groups[0].facets.setZero();
  EXPECT_EQ(ParseMeshMessage(BytesOf(mesh)).kind, Kind::kNone);
  mesh = SomeMesh();
  mesh.kind = static_cast<ElementKind>(6);
  EXPECT_EQ(ParseMeshMessage(BytesOf(mesh)).kind, Kind::kNone);
  mesh = SomeMesh();
  mesh.node_numbers.pop_back();
  EXPECT_EQ(ParseMeshMessage(BytesOf(mesh)).kind, Kind::kNone);
}

// From a program that went wrong.
TEST(MeshMessage, MayBeAnyBytes) {
  const std::string bytes = BytesOf(SomeMesh());
  std::mt19937 random(1);
  for (int i = 0; i < 20000; ++i) {
    std::string spoilt = bytes;
    spoilt[random() % spoilt.size()] = static_cast<char>(random());
    const MeshMessage message = ParseMeshMessage(spoilt);
    if (message.kind == Kind::kMesh) {
      EXPECT_LT(message.mesh.elements.maxCoeff(), message.mesh.nodes.cols());
      EXPECT_GE(message.mesh.elements.minCoeff(), 0);
    }
  }
}

}  // namespace
}  // namespace elastimate
