#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "elastimate/io/mesh/mesh_file.h"
#include "elastimate/io/scene/mesh_reader.h"
#include "tests/io/scene_files.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

const std::string kGrid =
    "# vtk DataFile Version 2.0\ntitle\nASCII\nDATASET UNSTRUCTURED_GRID\n"
    "POINTS 4 double\n0 0 0 1 0 0 0 1 0 0 0 1\nCELLS 1 5\n4 0 1 2 3\n"
    "CELL_TYPES 1\n10\nPOINT_DATA 4\n";

class LegacyVtkTest : public ::testing::Test {
 protected:
  MeshFile Read(const std::string& text) const {
    return ReadMeshFile(folder_.Write("grid.vtk", text));
  }
  const TemporaryFolder folder_;
};

TEST_F(LegacyVtkTest, HasEveryKindOfAttribute) {
  const MeshFile mesh =
      Read(kGrid +
           "SCALARS one float\nLOOKUP_TABLE table\n1 2 3 4\n"
           "LOOKUP_TABLE table 1\n0 .1 .2 1\n"
           "SCALARS two int 2\nLOOKUP_TABLE default\n1 2 3 4 5 6 7 8\n"
           "METADATA\nINFORMATION 1\nNAME L2 LOCATION vtk\nDATA 2 0 1\n\n"
           "VECTORS vectors float\n1 2 3 4 5 6 7 8 9 1 2 3\n"
           "NORMALS normals float\n1 0 0 1 0 0 1 0 0 1 0 0\n"
           "TEXTURE_COORDINATES texture 2 float\n1 2 3 4 5 6 7 8\n"
           "COLOR_SCALARS colours 1\n0 0 1 1\n"
           "FIELD FieldData 2\nwith%20space%25 1 4 long\n5 6 7 8\n"
           "METADATA\nCOMPONENT_NAMES\na\n\n"
           "last 2 4 short\n1 2 3 4 5 6 7 8\n");
  for (const std::string name :
       {"one", "two", "vectors", "normals", "texture", "with space%", "last"}) {
    EXPECT_NE(FindArray(mesh.node_arrays, name), nullptr) << name;
  }
  EXPECT_EQ(FindArray(mesh.node_arrays, "two")->col(3), Eigen::Vector2d(7, 8));
}

TEST_F(LegacyVtkTest, IsDamagedWhereItDoesNotAddUp) {
  EXPECT_EQ(Read(kGrid).elements.cols(), 1);
  const auto expect = [this](const std::string& from, const std::string& to) {
    SCOPED_TRACE(to);
    EXPECT_THROWS_WITH(Read(Replaced(kGrid, from, to)),
                       "grid.vtk: the file is damaged");
  };
  expect("4 0 1 2 3", "5 0 1 2 3");
  expect("4 0 1 2 3", "3 0 1 2 3");
  expect("4 0 1 2 3", "-4 0 1 2 3");
  expect("CELLS 1 5", "CELLS 999999 5");
  expect("CELLS 1 5", "CELLS -1 5");
  expect("CELL_TYPES 1\n10", "CELL_TYPES 2\n10 10");
  expect("CELL_TYPES 1\n10", "CELL_TYPES 0\n");
  expect("0 1 0", "0 nan 0");
  expect("ASCII", "TEXT");
  expect("CELL_TYPES", "KINDS");
}

TEST_F(LegacyVtkTest, IsDamagedWhereItWasCut) {
  EXPECT_THROWS_WITH(Read(kGrid + "VECTORS v float\n1 2 3"),
                     "grid.vtk: the file is damaged");
  EXPECT_THROWS_WITH(Read(kGrid + "SCALARS s float\n1 2"),
                     "grid.vtk: the file is damaged");
  EXPECT_THROWS_WITH(Read("<VTKFile/>"), "grid.vtk: the file is damaged");
}

TEST_F(LegacyVtkTest, HasNoArrayTwice) {
  const std::string field =
      "FIELD f 2\na 1 4 int\n1 2 3 4\nb 1 4 int\n5 6 7 8\n";
  EXPECT_EQ(Read(kGrid + field).node_arrays.size(), 2);
  EXPECT_EQ(Read(kGrid + field + "CELL_DATA 1\nFIELD f 1\na 1 1 int\n1\n")
                .element_arrays.size(),
            1);
  EXPECT_THROWS_WITH(Read(kGrid + Replaced(field, "b 1", "a 1")),
                     "grid.vtk: .*it has two arrays 'a'");
  EXPECT_THROWS_WITH(
      Read(kGrid + field + "SCALARS a float\nLOOKUP_TABLE default\n1 2 3 4\n"),
      "grid.vtk: .*it has two arrays 'a'");
}

}  // namespace
}  // namespace elastimate
