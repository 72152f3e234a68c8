// Tests of scenes of every kind of element, which are written and read.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <numeric>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "elastimate/estimators/registry.h"
#include "elastimate/io/scene/mesh_reader.h"
#include "elastimate/io/scene/node_selection.h"
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
  /// Returns the nodes in another order than that of the scene, in which some
  /// mid-edge nodes come before vertices.
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
    // Iterations stop short of rounding.
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

double RoundedToSixDigits(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", x);
  return std::atof(text);
}

// Rounded positions put mid-edge nodes off the middle of straight edges.
TEST_P(QuadraticFiles, AreStraightenedWhereTheirPositionsAreRounded) {
  const auto to_single = [](double x) { return double(float(x)); };
  for (const bool is_far : {false, true}) {
    Mesh mesh = mesh_;
    mesh.nodes *= 1 / 3.0;
    // At a distance of a thousand times the size, single precision has four
    // digits left.
    mesh.nodes.array() += is_far ? 700 : 0;
    mesh.nodes = is_far ? mesh.nodes.unaryExpr(to_single).eval()
                        : mesh.nodes.unaryExpr(&RoundedToSixDigits).eval();
    ASSERT_THROW(ValidateMesh(mesh), std::invalid_argument);
    const MeshFile file = ReadMeshFile(Write(mesh));
    EXPECT_EQ(file.kind, mesh_.kind);
    ASSERT_FALSE(file.moved.empty());
    Eigen::MatrixXd in_file = file.nodes;
    for (const MovedNode& moved : file.moved) {
      in_file.col(moved.node) = moved.in_file;
    }
    EXPECT_EQ(in_file.topRows(mesh.nodes.rows()), mesh.nodes);
    EXPECT_GT((file.nodes - in_file).norm(), 0);
    mesh.nodes = file.nodes.topRows(mesh.nodes.rows());
    EXPECT_NO_THROW(ValidateMesh(mesh));
  }
}

TEST_P(QuadraticFiles, AreEstimatedWhereTheirPositionsAreRounded) {
  Scene scene = SceneOf(GetParam());
  scene.mesh.nodes = scene.mesh.nodes.unaryExpr(
      [](double x) { return RoundedToSixDigits(x + 1.0 / 3); });
  const auto path = folder_.Path() / "scene.vtu";
  WriteVtu(path, scene.mesh, SceneFields(scene));
  const SceneReading reading = ReadScene({path}, Measurement::kRequired);
  EXPECT_THAT(reading.notices,
              ::testing::Contains(::testing::HasSubstr("mid-edge nodes")));
  const Estimate estimate =
      MakeEstimator("closed-form")->Run(reading.scene, {});
  EXPECT_EQ(estimate.status, Status::kOk) << estimate.message;
  EXPECT_NEAR(
      estimate.elasticity.youngs_modulus / kMeasuredElasticity.youngs_modulus,
      1, 1e-4);
  EXPECT_NEAR(estimate.elasticity.poisson_ratio,
              kMeasuredElasticity.poisson_ratio, 1e-4);
}

// A box of one point holds the node at its place in the file, or at the place
// where reading moved it to, and no other node.
TEST_P(QuadraticFiles, HaveTheirMovedNodesInTheBoxesOfTheFile) {
  Mesh mesh = mesh_;
  const int node = mesh.elements(mesh.Topology().num_vertices, 0);
  mesh.nodes(1, node) += 1e-4;
  const MeshFile file = ReadMeshFile(Write(mesh));
  ASSERT_EQ(file.moved.size(), 1U);
  for (const Eigen::VectorXd& x : {Eigen::VectorXd(mesh.nodes.col(node)),
                                   Eigen::VectorXd(mesh_.nodes.col(node))}) {
    std::ostringstream text;
    text.precision(17);
    const char* separator = "[";
    for (const double coordinate : x) {
      text << separator << coordinate;
      separator = ", ";
    }
    const nlohmann::json box = nlohmann::json::parse(
        "{\"box\": [" + text.str() + "], " + text.str() + "]]}");
    const std::filesystem::path path = "scene.json";
    const NodeMask mask = SelectNodes(JsonValue(path, box), file, nullptr);
    EXPECT_EQ(mask.count(), 1);
    EXPECT_TRUE(mask(node));
  }
}

TEST_P(QuadraticFiles, AreCurvedWhereOneEdgeIs) {
  Mesh mesh = mesh_;
  const int node = mesh.elements(mesh.Topology().num_vertices, 0);
  mesh.nodes(1, node) += 0.01;
  if (!IsSimplex(mesh.kind)) {
    EXPECT_THROWS_WITH(ReadMeshFile(Write(mesh)),
                       std::string(mesh.Topology().shape) +
                           " 0 is curved, which only tetrahedra and triangles "
                           "may be");
    return;
  }
  const MeshFile file = ReadMeshFile(Write(mesh));
  EXPECT_EQ(file.kind, CurvedKind(mesh.kind));
  EXPECT_TRUE(file.moved.empty());
  EXPECT_EQ(file.nodes.topRows(mesh.nodes.rows()), mesh.nodes);
}

TEST_P(QuadraticFiles, ErrOnElementsThatFold) {
  Scene scene = SceneOf(GetParam());
  // Swapping two middle nodes folds an element, as another order of nodes
  // would.
  scene.mesh.elements.bottomRows(2).row(0).swap(
      scene.mesh.elements.bottomRows(2).row(1));
  const auto path = folder_.Path() / "scene.vtu";
  WriteVtu(path, scene.mesh, SceneFields(scene));
  EXPECT_THROWS_WITH(ReadScene({path}, Measurement::kRequired),
                     "scene.vtu: " + std::string(scene.mesh.Topology().shape) +
                         (IsSimplex(scene.mesh.kind)
                              ? " 0 .* is bent so far that it folds onto itself"
                              : " 0 is curved"));
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
                         ::testing::Values("tet10", "hex27", "tri6", "quad9"),
                         [](const auto& name) { return name.param; });

}  // namespace
}  // namespace elastimate
