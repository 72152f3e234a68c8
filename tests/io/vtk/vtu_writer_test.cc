#include "elastimate/io/vtk/vtu_writer.h"

#include <gtest/gtest.h>
#include <vtkCell.h>
#include <vtkCellType.h>
#include <vtkGenericCell.h>
#include <vtkSmartPointer.h>

#include <limits>
#include <numeric>
#include <utility>

#include "elastimate/core/mesh/shape_functions.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/io/mesh/mesh_file.h"
#include "elastimate/io/scene/mesh_reader.h"
#include "elastimate/io/scene/scene_reader.h"
#include "tests/io/scene_files.h"
#include "tests/io/vtk_files.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

TEST(VtuWriterTest, KeepsEveryBit) {
  const TemporaryFolder folder;
  const auto path = folder.Path() / "out.vtu";
  const Mesh mesh = TwoTetrahedra().mesh;
  Fields fields;
  Eigen::MatrixXd values(2, 5);
  values << 1.0 / 3.0, -0.0, 5e-324, 1.7976931348623157e308, 0.1,  //
      1e-300, -1.0 / 7.0, std::numeric_limits<double>::infinity(),
      -std::numeric_limits<double>::infinity(), 2.0 / 3.0;
  fields.point = {{"with space", values}};
  fields.cell = {{"energy", Eigen::RowVector2d(1e-9, 1.0 / 9.0)}};
  WriteVtu(path, mesh, fields);
  const MeshFile read = ReadMeshFile(path);
  EXPECT_EQ(read.nodes, mesh.nodes);
  EXPECT_EQ(read.elements, mesh.elements);
  ASSERT_EQ(read.node_arrays.size(), 1);
  EXPECT_EQ(read.node_arrays[0].name, fields.point[0].name);
  EXPECT_EQ(read.node_arrays[0].values, values);
  EXPECT_TRUE(std::signbit(read.node_arrays[0].values(0, 1)));
  ASSERT_EQ(read.element_arrays.size(), 1);
  EXPECT_EQ(read.element_arrays[0].values, fields.cell[0].values);
}

TEST(VtuWriterTest, SceneComesBackAsItWas) {
  const TemporaryFolder folder;
  const auto path = folder.Path() / "scene.vtu";
  Scene scene = TwoTetrahedra();
  scene.load_cases[0].loads.push_back(BodyForce{Eigen::Vector3d(0, 0, -9810)});
  scene.load_cases[0].loads.push_back(Pressure{BoundaryFacets(scene.mesh), 3});
  scene.origin = Origin::kComputed;
  WriteVtu(path, scene.mesh, SceneFields(scene));
  const Scene read = ReadScene({path}, Measurement::kRequired).scene;
  EXPECT_EQ(read.mesh.nodes, scene.mesh.nodes);
  EXPECT_EQ(read.mesh.elements, scene.mesh.elements);
  EXPECT_EQ(read.mesh.regions, scene.mesh.regions);
  EXPECT_TRUE((read.supports.held == scene.supports.held).all());
  EXPECT_EQ(read.supports.displacement, scene.supports.displacement);
  ASSERT_EQ(read.load_cases.size(), 2);
  EXPECT_EQ(std::get<NodalForces>(read.load_cases[0].loads.at(0)).force,
            AssembleLoads(scene.mesh, scene.load_cases[0].loads));
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(read.load_cases[i].displacement,
              scene.load_cases[i].displacement);
  }
  EXPECT_EQ(read.origin, Origin::kComputed);
  EXPECT_EQ(read.load_cases[0].observed.size(), 0);
  EXPECT_TRUE(
      (read.load_cases[1].observed == scene.load_cases[1].observed).all());
}

TEST(VtuWriterTest, NamesFieldsOnlyWhereThereIsSomething) {
  Scene scene = TwoTetrahedra();
  scene.supports.displacement.setZero();
  scene.mesh.regions.resize(0);
  scene.load_cases.resize(1);
  scene.load_cases[0].displacement.resize(3, 0);
  const Fields fields = SceneFields(scene);
  ASSERT_EQ(fields.point.size(), 2);
  EXPECT_EQ(fields.point[0].name, "fixed");
  EXPECT_EQ(fields.point[1].name, "force");
  EXPECT_TRUE(fields.cell.empty());
}

TEST(VtuWriterTest, ErrsOnFieldsOfAnotherLength) {
  const TemporaryFolder folder;
  const auto path = folder.Path() / "out.vtu";
  Fields fields;
  fields.cell = {{"energy", Eigen::RowVector3d(1, 2, 3)}};
  EXPECT_THROWS_WITH(WriteVtu(path, TwoTetrahedra().mesh, fields),
                     "out.vtu: the field 'energy' is 1 x 3");
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(VtuWriterTest, ErrsWhereNothingCanBeWritten) {
  EXPECT_THROWS_WITH(WriteVtu("/dev/full", TwoTetrahedra().mesh, {}),
                     "/dev/full: cannot be written \\(No space left");
  EXPECT_THROWS_WITH(WriteVtu("/no/folder/out.vtu", TwoTetrahedra().mesh, {}),
                     "out.vtu: there is no folder '/no/folder'");
}

// VTK says where the nodes of its cells are: from 0 to 1 along each axis.
TEST(VtuWriterTest, HasTheNodesInTheOrderOfVtk) {
  const std::pair<ElementKind, int> cells[] = {
      {ElementKind::kTet4, VTK_TETRA},
      {ElementKind::kTet10, VTK_QUADRATIC_TETRA},
      {ElementKind::kHex8, VTK_HEXAHEDRON},
      {ElementKind::kHex27, VTK_TRIQUADRATIC_HEXAHEDRON},
      {ElementKind::kTri3, VTK_TRIANGLE},
      {ElementKind::kTri6, VTK_QUADRATIC_TRIANGLE},
      {ElementKind::kQuad4, VTK_QUAD},
      {ElementKind::kQuad9, VTK_BIQUADRATIC_QUAD}};
  for (const auto& [kind, type] : cells) {
    SCOPED_TRACE(TopologyOf(kind).name);
    const auto cell =
        vtkSmartPointer<vtkCell>::Take(vtkGenericCell::InstantiateCell(type));
    const Eigen::MatrixXd nodes = ReferenceNodes(kind);
    ASSERT_EQ(cell->GetNumberOfPoints(), nodes.cols());
    const Eigen::Map<const Eigen::Matrix3Xd> in_vtk(cell->GetParametricCoords(),
                                                    3, nodes.cols());
    const Eigen::MatrixXd expected =
        IsSimplex(kind) ? nodes : Eigen::MatrixXd((nodes.array() + 1) / 2);
    EXPECT_TRUE(in_vtk.topRows(nodes.rows()).isApprox(expected, 1e-14));
  }
}

}  // namespace
}  // namespace elastimate
