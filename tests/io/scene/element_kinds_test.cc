// Scenes of every kind of element, written and read.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "elastimate/estimators/registry.h"
#include "elastimate/io/scene/mesh_reader.h"
#include "elastimate/io/scene/scene_reader.h"
#include "elastimate/io/vtk/vtu_writer.h"
#include "tests/io/kind_scenes.h"
#include "tests/io/scene_files.h"
#include "tests/io/vtk_files.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

class ElementKinds : public ::testing::TestWithParam<std::string> {
 protected:
  /// The nodes in another order than that of the scene, where mid-edge nodes
  /// come before vertices.
  std::vector<int> ShuffledNodes() const {
    std::vector<int> order(scene_.mesh.NumNodes());
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(order.begin(), order.end(), std::mt19937(20071));
    return order;
  }

  std::filesystem::path Path(const std::string& name) const {
    return folder_.Path() / name;
  }

  const TemporaryFolder folder_;
  const Scene scene_ = SceneOf(GetParam());
};

void ExpectEstimated(const Scene& scene) {
  for (const std::string_view name : EstimatorNames()) {
    const Estimate estimate = MakeEstimator(name)->Run(scene, {});
    EXPECT_TRUE(estimate.IsUsable()) << name << ": " << estimate.message;
    // What is iterated stops short of rounding.
    const double tolerance = name == "closed-form" ? 1e-9 : 1e-6;
    EXPECT_NEAR(
        estimate.elasticity.youngs_modulus / kMeasuredElasticity.youngs_modulus,
        1, tolerance)
        << name;
    EXPECT_NEAR(estimate.elasticity.poisson_ratio,
                kMeasuredElasticity.poisson_ratio, tolerance)
        << name;
  }
}

TEST_P(ElementKinds, ComeBackInTheOrderOfTheFile) {
  WriteVtu(Path("scene.vtu"), scene_.mesh, SceneFields(scene_),
           ShuffledNodes());
  const SceneReading reading =
      ReadScene({Path("scene.vtu")}, Measurement::kRequired);
  EXPECT_EQ(reading.file_order.empty(), scene_.mesh.Order() == 1);
  EXPECT_EQ(reading.scene.mesh.NumVertices(), scene_.mesh.NumVertices());
  WriteVtu(Path("again.vtu"), reading.scene.mesh, SceneFields(reading.scene),
           reading.file_order);
  const MeshFile first = ReadMeshFile(Path("scene.vtu"));
  const MeshFile again = ReadMeshFile(Path("again.vtu"));
  EXPECT_EQ(again.kind, scene_.mesh.kind);
  EXPECT_EQ(again.nodes, first.nodes);
  EXPECT_EQ(again.elements, first.elements);
  ASSERT_EQ(again.node_arrays.size(), first.node_arrays.size());
  for (std::size_t i = 0; i < again.node_arrays.size(); ++i) {
    EXPECT_EQ(again.node_arrays[i].name, first.node_arrays[i].name);
    EXPECT_EQ(again.node_arrays[i].values, first.node_arrays[i].values);
    EXPECT_EQ(again.node_arrays[i].values.rows(), 3);
  }
  EXPECT_EQ(again.model, first.model);
  EXPECT_EQ(again.thickness, first.thickness);
}

TEST_P(ElementKinds, AreEstimatedByEveryEstimator) {
  WriteVtu(Path("scene.vtu"), scene_.mesh, SceneFields(scene_),
           ShuffledNodes());
  const Scene scene =
      ReadScene({Path("scene.vtu")}, Measurement::kRequired).scene;
  EXPECT_EQ(scene.mesh.kind, scene_.mesh.kind);
  EXPECT_EQ(scene.mesh.section.model, scene_.mesh.section.model);
  EXPECT_EQ(scene.mesh.section.thickness, scene_.mesh.section.thickness);
  ExpectEstimated(scene);
}

TEST_P(ElementKinds, AreReadFromOtherWritersOfVtk) {
  for (const VtkEncoding& encoding : AllVtkEncodings()) {
    SCOPED_TRACE(encoding.name);
    const auto path = Path("scene" + encoding.Extension());
    WriteEncoded(path, scene_.mesh, SceneFields(scene_), encoding);
    const Scene scene = ReadScene({path}, Measurement::kRequired).scene;
    EXPECT_EQ(scene.mesh.kind, scene_.mesh.kind);
    EXPECT_EQ(scene.mesh.elements, scene_.mesh.elements);
    EXPECT_EQ(scene.mesh.section.model, scene_.mesh.section.model);
    EXPECT_EQ(scene.mesh.section.thickness, scene_.mesh.section.thickness);
    EXPECT_TRUE(scene.load_cases[0].displacement.isApprox(
        scene_.load_cases[0].displacement, 1e-6));
  }
}

TEST_P(ElementKinds, AreNamedByTheFileInMessages) {
  Fields fields = SceneFields(scene_);
  const std::vector<int> order = ShuffledNodes();
  fields.point.back().values.col(order[5]).setConstant(std::nan(""));
  ASSERT_EQ(fields.point.back().name, "displacement");
  WriteVtu(Path("scene.vtu"), scene_.mesh, fields, order);
  EXPECT_THROWS_WITH(ReadScene({Path("scene.vtu")}, Measurement::kRequired),
                     "'displacement' of node 5 \\(x\\) is nan");
}

TEST_P(ElementKinds, MayNotComeTwice) {
  Mesh mesh = scene_.mesh;
  mesh.elements.col(1) = mesh.elements.col(0);
  WriteVtu(Path("scene.vtu"), mesh, {});
  EXPECT_THROWS_WITH(ReadMeshFile(Path("scene.vtu")),
                     std::string(mesh.Topology().shapes) +
                         " 0 and 1 have the same nodes; keep one of them");
}

INSTANTIATE_TEST_SUITE_P(All, ElementKinds, ::testing::ValuesIn(SceneNames()),
                         [](const auto& name) { return name.param; });

class QuadraticFiles : public ::testing::TestWithParam<std::string> {
 protected:
  std::filesystem::path Write(const Mesh& mesh) const {
    WriteVtu(folder_.Path() / "mesh.vtu", mesh, {});
    return folder_.Path() / "mesh.vtu";
  }

  const TemporaryFolder folder_;
  const Mesh mesh_ = SceneOf(GetParam()).mesh;
};

TEST_P(QuadraticFiles, ErrOnCurvedEdges) {
  Mesh mesh = mesh_;
  const int num_vertices = mesh.Topology().num_vertices;
  const int node = mesh.elements(num_vertices, 0);
  mesh.nodes(1, node) += 1e-3;
  EXPECT_THROWS_WITH(ReadMeshFile(Write(mesh)),
                     "mesh.vtu: the mid-edge node " + std::to_string(node) +
                         " of " + std::string(mesh.Topology().shape) +
                         " 0 is not in the middle between node " +
                         std::to_string(mesh.elements(0, 0)) + " and node " +
                         std::to_string(mesh.elements(1, 0)));
}

TEST_P(QuadraticFiles, ErrOnMidEdgeNodesThatAreVertices) {
  Mesh mesh = mesh_;
  const int num_vertices = mesh.Topology().num_vertices;
  mesh.elements(num_vertices, 0) = mesh.elements(0, 0);
  EXPECT_THROWS_WITH(
      ReadMeshFile(Write(mesh)),
      "the mid-edge node " + std::to_string(mesh.elements(0, 0)) + " of " +
          std::string(mesh.Topology().shape) + " 0 is a vertex of another one");
}

INSTANTIATE_TEST_SUITE_P(All, QuadraticFiles,
                         ::testing::Values("tet10", "tri6"),
                         [](const auto& name) { return name.param; });

}  // namespace
}  // namespace elastimate
