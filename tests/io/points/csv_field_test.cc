#include "elastimate/io/points/csv_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include "tests/io/scene_files.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

class CsvFieldTest : public ::testing::Test {
 protected:
  Eigen::MatrixXd Read(const std::string& content) const {
    return ReadCsvField(folder_.Write("u.csv", content), 2, 3).values;
  }
  const TemporaryFolder folder_;
};

TEST_F(CsvFieldTest, ReadsBothHeadersAndTheirSpaces) {
  Eigen::MatrixXd expected(3, 2);
  expected.transpose() << 1, -2.5, 3e-7, 0.1, 5, 6;
  EXPECT_EQ(Read("x,y,z\n1,-2.5,3e-7\n0.1,5,6\n"), expected);
  EXPECT_EQ(Read(" ux , uy,uz\r\n 1,\t-2.5,3e-7 \r\n+0.1,5,6\r\n\r\n\n"),
            expected);
  EXPECT_EQ(Read("\xEF\xBB\xBFx,y,z\n1,-2.5,3e-7\n0.1,5,6"), expected);
  EXPECT_EQ(Read("# mm\nU [mm];V [mm];W [mm]\n\n1;-2,5;3e-7\n,1;5;6\n"),
            expected);
  EXPECT_TRUE(std::isnan(Read("x,y,z\nnan,0,0\n0,0,0")(0, 0)));
}

TEST_F(CsvFieldTest, ReadsTwoColumnsOfAPlane) {
  Eigen::MatrixXd expected(2, 2);
  expected.transpose() << 1, -2.5, 0.1, 5;
  for (const std::string header : {"x,y", "ux,uy"}) {
    const auto path = folder_.Write("u.csv", header + "\n1,-2.5\n0.1,5\n");
    EXPECT_EQ(ReadCsvField(path, 2, 2).values, expected);
    EXPECT_THROWS_WITH(ReadCsvField(path, 2, 3),
                       "the header must be x,y,z or ux,uy,uz, but has");
  }
  const auto three = folder_.Write("u.csv", "x,y,z\n1,-2.5,0\n0.1,5,0\n");
  EXPECT_EQ(ReadCsvField(three, 2, 2).values.rows(), 3);
  const auto mixed = folder_.Write("u.csv", "x,y\n1,-2.5,0\n0.1,5\n");
  EXPECT_THROWS_WITH(ReadCsvField(mixed, 2, 2),
                     "line 2 has 3 columns, but the titles have 2");
}

TEST_F(CsvFieldTest, NamesLineAndColumn) {
  EXPECT_THROWS_WITH(Read("a,b,c\n1,2,3\n4,5,6\n"),
                     "u.csv: the header must .* columns a, b, c");
  EXPECT_THROWS_WITH(Read("1,2,3\n4,5,6\n"), "the header must be");
  EXPECT_THROWS_WITH(Read("x,y,z\n1,2,3\n4,five,6\n"),
                     "u.csv: line 3, column 2: 'five' is not a number");
  EXPECT_THROWS_WITH(Read("x,y,z\n1,2,3\n4,5,6 7\n"),
                     "line 3, column 3: '6 7' is not a number");
  EXPECT_THROWS_WITH(Read("x,y,z\n1,2,3\n4,,6\n"),
                     "line 3, column 2: the cell is empty");
  EXPECT_THROWS_WITH(Read("x,y,z\n1,2\n4,5,6\n"), "line 2 has 2 columns");
  EXPECT_THROWS_WITH(Read("x,y,z\n1,2,3,4\n4,5,6\n"), "line 2 has 4 columns");
  EXPECT_THROWS_WITH(Read("x,y,z\n1,2,1e999\n4,5,6\n"),
                     "line 2, column 3: '1e999' is beyond");
}

TEST_F(CsvFieldTest, QuotesOnlyWhatIsFitToPrint) {
  using namespace std::string_literals;
  EXPECT_THROWS_WITH(Read("x,y,z\n1,\033[31m\0\xFF,3\n4,5,6\n"s),
                     "line 2, column 2: '\\\\x1b\\[31m\\\\x00\\\\xff' is not");
  EXPECT_THROWS_WITH(Read("x,y,z\n1," + std::string(2000, 'x') + ",3\n1,2,3\n"),
                     "column 2: 'x{37}\\.\\.\\.x{20}' is not a number");
  EXPECT_THROWS_WITH(Read("x,y,z\n1," + std::string(2000, '7') + ",3\n1,2,3\n"),
                     "column 2: '7{37}\\.\\.\\.7{20}' is beyond the range");
  EXPECT_THROWS_WITH(Read("\033[2Jx,y,z\n1,2,3\n"),
                     "the header must be .* columns \\\\x1b");
}

TEST_F(CsvFieldTest, KnowsWhereRowsStand) {
  const auto path =
      folder_.Write("u.csv", "# by hand\nx,y,z\n\n1,2,3\n4,5,6\n");
  EXPECT_EQ(ReadCsvField(path, 2, 3).lines, (std::vector<std::size_t>{4, 5}));
}

// The unit of the mesh is not known.
TEST_F(CsvFieldTest, RefusesUnitsThatDifferOrAreSmall) {
  EXPECT_THROWS_WITH(Read("U [um],V [um],W [um]\n1,2,3\n4,5,6\n"),
                     "column 'U \\[um\\]' is in another unit than the mesh");
  EXPECT_THROWS_WITH(Read("U [mm],V [m],W [mm]\n1,2,3\n4,5,6\n"), "'V ");
  EXPECT_THROWS_WITH(Read("U [mm],V [ell],W [mm]\n1,2,3\n4,5,6\n"), "'ell'");
}

TEST_F(CsvFieldTest, RefusesPositions) {
  EXPECT_THROWS_WITH(Read("x,y,z,ux,uy,uz\n0,0,0,1,2,3\n1,0,0,4,5,6\n"),
                     "with their positions as \"points\"");
}

TEST_F(CsvFieldTest, CountsRows) {
  EXPECT_THROWS_WITH(Read("x,y,z\n1,2,3\n"),
                     "u.csv: the file has 1 rows below its header, but the "
                     "mesh has 2 nodes");
  EXPECT_THROWS_WITH(Read("x,y,z\n1,2,3\n1,2,3\n1,2,3\n"), "has 3 rows");
  EXPECT_THROWS_WITH(Read(""), "u.csv: the file is empty");
  EXPECT_THROWS_WITH(ReadCsvField(folder_.Path() / "none.csv", 2, 3),
                     "none.csv: no such file");
}

}  // namespace
}  // namespace elastimate
