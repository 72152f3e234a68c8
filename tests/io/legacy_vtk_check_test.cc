#include "elastimate/io/legacy_vtk_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "elastimate/io/mesh_file.h"
#include "tests/io/scene_files.h"

namespace elastimate {
namespace {

using ::testing::HasSubstr;

const std::string kGrid =
    "# vtk DataFile Version 2.0\ntitle\nASCII\nDATASET UNSTRUCTURED_GRID\n"
    "POINTS 4 double\n0 0 0 1 0 0 0 1 0 0 0 1\nCELLS 1 5\n4 0 1 2 3\n"
    "CELL_TYPES 1\n10\nPOINT_DATA 4\n";

class LegacyVtkCheckTest : public ::testing::Test {
 protected:
  std::string Damage(const std::string& text) const {
    return WhyLegacyVtkIsDamaged(folder_.Write("grid.vtk", text));
  }
  const TemporaryFolder folder_;
};

TEST_F(LegacyVtkCheckTest, KnowsEveryKindOfAttribute) {
  const std::string text =
      kGrid +
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
      "last 2 4 short\n1 2 3 4 5 6 7 8\n";
  EXPECT_EQ(Damage(text), "");
  const MeshFile mesh = ReadMeshFile(folder_.Path() / "grid.vtk");
  for (const std::string name :
       {"one", "two", "vectors", "normals", "texture", "with space%", "last"}) {
    EXPECT_NE(FindArray(mesh.node_arrays, name), nullptr) << name;
  }
}

TEST_F(LegacyVtkCheckTest, KnowsBinaryTypes) {
  const std::string begin =
      "# vtk DataFile Version 2.0\ntitle\nBINARY\nDATASET UNSTRUCTURED_GRID\n"
      "POINT_DATA 2\nFIELD FieldData 4\nbits 1 9 bit\n";
  const std::string text = begin + "ab\nbytes 1 2 char\nab\n" +
                           "shorts 1 2 unsigned_short\nabcd\n" +
                           "doubles 1 1 double\nabcdefgh";
  EXPECT_EQ(Damage(text), "");
  EXPECT_THAT(Damage(text.substr(0, text.size() - 1)),
              HasSubstr("ends inside the section FIELD, array 'doubles'"));
  EXPECT_THAT(Damage(Replaced(text, "double\n", "string\n")),
              HasSubstr("the type 'STRING' is unknown"));
}

TEST_F(LegacyVtkCheckTest, FindsWhatDoesNotAddUp) {
  const auto expect = [this](const std::string& from, const std::string& to,
                             const std::string& damage) {
    EXPECT_THAT(Damage(Replaced(kGrid, from, to)), HasSubstr(damage));
  };
  EXPECT_EQ(Damage(kGrid), "");
  expect("4 0 1 2 3", "5 0 1 2 3", "sizes of its cells do not add up");
  expect("4 0 1 2 3", "3 0 1 2 3", "sizes of its cells do not add up");
  expect("4 0 1 2 3", "-4 0 1 2 3", "sizes of its cells do not add up");
  expect("CELLS 1 5", "CELLS 999999 5", "cannot have the 999999 items");
  expect("CELLS 1 5", "CELLS -1 5", "cannot have the -1 items");
  expect("CELL_TYPES 1\n10", "CELL_TYPES 2\n10 10", "1 cells but 2 cell types");
  expect("0 1 0", "0 nan 0", "'nan' is no number, in the section POINTS");
  expect("ASCII", "TEXT", "neither ASCII nor BINARY");
  expect("2.0", "two", "its version is none");
  expect("CELL_TYPES", "KINDS", "the section 'KINDS' is unknown");
  EXPECT_THAT(Damage(kGrid + "VECTORS v float\n1 2 3"),
              HasSubstr("it ends inside the section VECTORS 'v'"));
  EXPECT_THAT(Damage(kGrid + "SCALARS s float\n1 2"),
              HasSubstr("LOOKUP_TABLE is missing"));
  EXPECT_THAT(Damage("<VTKFile/>"), HasSubstr("its first line is not"));
}

}  // namespace
}  // namespace elastimate
