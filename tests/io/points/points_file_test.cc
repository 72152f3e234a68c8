#include "elastimate/io/points/points_file.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/io/scene_files.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

class PointsFileTest : public ::testing::Test {
 protected:
  PointsFile Read(const std::string& content, int dimension = 3) const {
    return ReadPointsFile(folder_.Write("points.csv", content), dimension);
  }
  const TemporaryFolder folder_;
};

TEST_F(PointsFileTest, ReadsColumnsByName) {
  const PointsFile file = Read(
      "# of the left camera\n"
      "\"uz\"; ux;uy; x;y;z;quality\n"
      "[mm];[mm];[mm];[mm];[mm];[mm];[1]\n"
      "\n"
      "0.5;0.1;;1;2;3;0.99\n"
      "nan;0.2;0.3;4;5;6;\n");
  Eigen::MatrixXd positions(3, 2);
  positions << 1, 4, 2, 5, 3, 6;
  EXPECT_EQ(file.positions, positions);
  EXPECT_EQ(file.displacement(0, 0), 0.1);
  EXPECT_TRUE(std::isnan(file.displacement(1, 0)));
  EXPECT_EQ(file.displacement(2, 0), 0.5);
  EXPECT_TRUE(std::isnan(file.displacement(2, 1)));
  EXPECT_EQ(file.noise_sd.size(), 0);
  EXPECT_EQ(file.lines, (std::vector<std::size_t>{5, 6}));
}

TEST_F(PointsFileTest, ReadsPlanarPointsWithStandardDeviations) {
  const PointsFile file =
      Read("x,y,ux,uy,sd_ux,sd_uy\n1,2,3,4,.1,.2\n5,6,,8,,.4\n", 2);
  EXPECT_EQ(file.positions.rows(), 2);
  Eigen::MatrixXd noise_sd(2, 2);
  noise_sd << .1, 1, .2, .4;
  EXPECT_EQ(file.noise_sd, noise_sd);
}

TEST_F(PointsFileTest, ReadsWhatIsWrittenToTheLastBit) {
  for (const int dimension : {2, 3}) {
    Eigen::MatrixXd positions(dimension, 4);
    for (Eigen::Index i = 0; i < positions.size(); ++i) {
      positions.reshaped()(i) = std::sin(double(i)) * std::pow(10.0, 7.0 * i);
    }
    const Eigen::MatrixXd displacement = -1e-45 * positions.rowwise().reverse();
    const std::string content = PointsContent(positions, displacement);
    EXPECT_EQ(content.substr(0, content.find('\n')),
              dimension == 2 ? "x,y,ux,uy" : "x,y,z,ux,uy,uz");
    const PointsFile file = Read(content, dimension);
    EXPECT_EQ(file.positions, positions);
    EXPECT_EQ(file.displacement, displacement);
    EXPECT_EQ(file.noise_sd.size(), 0);
  }
}

TEST_F(PointsFileTest, ReadsAPointThatWasMeasuredTwice) {
  const PointsFile file =
      Read("x,y,ux,uy\n1,2,3,4\n1,2,3,5\n1,2,,4\n1,2,,4\n", 2);
  EXPECT_EQ(file.positions.cols(), 4);
}

TEST_F(PointsFileTest, NamesLineAndColumn) {
  EXPECT_THROWS_WITH(Read("x,y,ux,uy,uz\n1,2,3,4,5\n"),
                     "its columns .x, y, ux, uy, uz. are not those of .* name "
                     "those of x, y, z");
  EXPECT_THROWS_WITH(Read("x,y,ux,uy,sd_ux\n1,2,3,4,5\n", 2),
                     "no column 'sd_uy'");
  EXPECT_THROWS_WITH(Read("x,y,ux,uy,x\n1,2,3,4,5\n", 2),
                     "several columns have the name 'x'");
  EXPECT_THROWS_WITH(Read("x,y,ux,uy\n1,2,3,4\n,2,3,4\n", 2),
                     "line 3: x of the position is not a finite number");
  EXPECT_THROWS_WITH(Read("x,y,ux,uy\n1,2,3,inf\n", 2),
                     "line 2: y of the displacement is infinite");
  EXPECT_THROWS_WITH(Read("x,y,ux,uy\n1,2,3,four\n", 2),
                     "line 2, column 4: 'four' is not a number");
  EXPECT_THROWS_WITH(Read("x,y,ux,uy,sd_ux,sd_uy\n1,2,3,4,0,1\n", 2),
                     "line 2: x of the standard deviation must be positive");
  EXPECT_THROWS_WITH(Read("x,y,ux,uy\n1,2,3,4\n1,2,3\n", 2),
                     "line 3 has 3 columns where 4 are due");
  EXPECT_THROWS_WITH(Read("x,y,ux,uy\n1,2,3,\"4\n", 2),
                     "line 2: the quotes do not match");
  EXPECT_THROWS_WITH(Read("x,y,ux,uy\n1,2,3,4\n5,6,7,8\n1,2,3,4\n", 2),
                     "line 4 has the same point and displacement as line 2");
  EXPECT_THROWS_WITH(Read("x,y,ux,uy\n", 2), "no row of numbers");
  EXPECT_THROWS_WITH(Read("\n", 2), "no row of numbers");
  EXPECT_THROWS_WITH(Read("", 2), "the file is empty");
}

}  // namespace
}  // namespace elastimate
