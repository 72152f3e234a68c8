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

TEST_F(PointsFileTest, KnowsTitlesByTheirMeaning) {
  Eigen::Vector2d position(1, 2);
  Eigen::Vector2d displacement(3, 4);
  for (const std::string titles :
       {"x,y,ux,uy", "X,Y,U,V", "x [mm],y [mm],u_x [mm],u_y [mm]",
        "x (mm),y (mm),dx (mm),dy (mm)", "x_mm,y_mm,u_mm,v_mm",
        "X / mm,Y / mm,Displacement X / mm,Displacement Y / mm",
        "\"X [mm]\",\"Y [mm]\",\"Displacement_x [mm]\",\"Displacement_y "
        "[mm]\"",
        "x-coordinate [mm],y-coordinate [mm],x-displacement [mm],"
        "y-displacement [mm]",
        "pos_x,pos_y,disp.x,disp.y", "x_undef,y_undef,u,v"}) {
    const PointsFile file = Read(titles + "\n1,2,3,4\n", 2);
    EXPECT_EQ(file.positions, position) << titles;
    EXPECT_EQ(file.displacement, displacement) << titles;
    EXPECT_TRUE(file.notices.empty()) << titles;
  }
}

TEST_F(PointsFileTest, RefusesTitlesOfSeveralMeanings) {
  EXPECT_THROWS_WITH(Read("x,y,dx,dy,u,v\n1,2,3,4,5,6\n", 2),
                     "'dx' or 'u' of x, y, dx, dy, u, v.* as .columns.");
  EXPECT_EQ(Read("x,y,ux,uy,u,v\n1,2,3,4,5,6\n", 2).displacement(0, 0), 3);
  EXPECT_THROWS_WITH(Read("coor.X [mm],coor.X [px],coor.Y [mm],"
                          "disp.Horizontal Displacement U [mm],"
                          "disp.Vertical Displacement V [mm]\n1,2,3,4,5\n",
                          2),
                     "several columns have the name 'coor.X'");
}

TEST_F(PointsFileTest, ConvertsToTheUnitOfPositions) {
  Eigen::Vector2d displacement(3e-3, 4e-3);
  for (const std::string titles :
       {"x [mm],y [mm],u [um],v [um]", "x [mm],y [mm],u [\xC2\xB5m],v [\xB5m]",
        "x (m),y (m),u (mm),v (Millimeters)", "x_mm,y_mm,u_um,v_um"}) {
    const PointsFile file = Read(titles + "\n1,2,3,4\n", 2);
    EXPECT_EQ(file.positions, Eigen::Vector2d(1, 2)) << titles;
    EXPECT_EQ(file.displacement, displacement) << titles;
    EXPECT_EQ(file.notices.size(), 1U) << titles;
  }
}

TEST_F(PointsFileTest, ConvertsByTheRowOfUnitsAndTheColumnsOfTheScene) {
  Eigen::Vector2d displacement(3e-3, 4e-3);
  EXPECT_EQ(Read("x;y;ux;uy\nmm;mm;um;um\n1;2;3;4\n", 2).displacement,
            displacement);
  EXPECT_EQ(Read("x;y;ux;uy\n[mm];[mm];[um];[um]\n1;2;3;4\n", 2).displacement,
            displacement);
  TableOptions options;
  options.columns = {"a [mm]", "b [mm]", "c [um]", "d [um]"};
  const auto path = folder_.Write("points.csv", "a,b,c,d\n1,2,3,4\n");
  EXPECT_EQ(ReadPointsFile(path, 2, options).displacement, displacement);
}

TEST_F(PointsFileTest, RefusesAColumnThatIsNamedTwice) {
  TableOptions options;
  options.columns = {"a", "b", "c", "b"};
  const auto path = folder_.Write("points.csv", "a,b,c,d\n1,2,3,4\n");
  EXPECT_THROWS_WITH(ReadPointsFile(path, 2, options),
                     "points.csv: the column 'b' is named twice");
}

TEST_F(PointsFileTest, ConvertsToTheUnitOfTheScene) {
  TableOptions options;
  options.unit = LengthUnitOf("m");
  const auto path =
      folder_.Write("points.csv", "x [mm],y [mm],ux [um],uy [um]\n1,2,3,4\n");
  const PointsFile file = ReadPointsFile(path, 2, options);
  EXPECT_EQ(file.positions, Eigen::Vector2d(1e-3, 2e-3));
  EXPECT_EQ(file.displacement, Eigen::Vector2d(3e-6, 4e-6));
}

TEST_F(PointsFileTest, ScalesDeviationsAsTheirDisplacements) {
  const std::string titles = "x [mm],y [mm],ux [um],uy [um],";
  EXPECT_EQ(Read(titles + "sd_ux,sd_uy\n1,2,3,4,5,6\n", 2).noise_sd,
            Eigen::Vector2d(5e-3, 6e-3));
  EXPECT_EQ(Read(titles + "sd_u [mm],sd_v [mm]\n1,2,3,4,5,6\n", 2).noise_sd,
            Eigen::Vector2d(5, 6));
}

// If only positions or only displacements have a unit, the others are taken to
// have it too, but only where that is likely.
TEST_F(PointsFileTest, SaysWhichColumnsHaveNoUnit) {
  const PointsFile file = Read("X [mm],Y [mm],U,V\n1,2,3,4\n", 2);
  EXPECT_EQ(file.displacement, Eigen::Vector2d(3, 4));
  EXPECT_EQ(file.notices.size(), 1U);
  // The other displacement says the unit, rather than the positions.
  EXPECT_EQ(Read("X [mm],Y [mm],U [um],V\n1,2,3,4\n", 2).displacement,
            Eigen::Vector2d(3e-3, 4e-3));
  for (const std::string unit : {"m", "cm", "mm", "um", "nm", "px"}) {
    EXPECT_THROWS_WITH(
        Read("X,Y,U [" + unit + "],V [" + unit + "]\n1,2,3,4\n", 2),
        "'X' has no unit; .* .columns.: .*X .mm.");
  }
  EXPECT_THROWS_WITH(Read("X [mm],Y [mm],U [ell],V [ell]\n1,2,3,4\n", 2),
                     "the unit 'ell' of the column 'U .ell.'");
}

TEST_F(PointsFileTest, ScalesPixelsOnly) {
  const auto path =
      folder_.Write("points.csv", "X [mm],Y [mm],U [px],V [Pixel]\n1,2,3,4\n");
  EXPECT_THROWS_WITH(ReadPointsFile(path, 2, {}),
                     "'U .px.'. are in pixels; give .length_per_pixel.");
  TableOptions options;
  options.length_per_pixel = 0.5;
  const PointsFile file = ReadPointsFile(path, 2, options);
  EXPECT_EQ(file.positions, Eigen::Vector2d(1, 2));
  EXPECT_EQ(file.displacement, Eigen::Vector2d(1.5, 2));
  folder_.Write("points.csv", "X [mm],Y [mm],U [mm],V [mm]\n1,2,3,4\n");
  EXPECT_THROWS_WITH(ReadPointsFile(path, 2, options),
                     "leave out .length_per_pixel.");
}

TEST_F(PointsFileTest, ReadsFormatsOfCamerasInSpace) {
  const PointsFile matchid = Read(
      "coor.X [mm];coor.Y [mm];coor.Z [mm];disp.Horizontal Displacement U [mm];"
      "disp.Vertical Displacement V [mm];disp.Out-Of-Plane: W [mm]\n"
      "1,5;2;3;4;5;6\nNaN;NaN;NaN;NaN;NaN;NaN\n;;;;;\n");
  EXPECT_EQ(matchid.positions, Eigen::Vector3d(1.5, 2, 3));
  EXPECT_EQ(matchid.displacement, Eigen::Vector3d(4, 5, 6));
  ASSERT_FALSE(matchid.notices.empty());
  EXPECT_THAT(matchid.notices.back(),
              ::testing::HasSubstr(" of 3 points have no displacement"));
  const PointsFile vic = Read(
      "\"X [mm]\",\"Y [mm]\",\"Z [mm]\",\"U [mm]\",\"V [mm]\",\"W [mm]\",x,y,"
      "\"sigma [pixel]\"\n0,0,0,9,9,9,0,0,-1\n1,2,3,4,5,6,0,0,0.01\n");
  EXPECT_EQ(vic.positions, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(vic.lines, (std::vector<std::size_t>{3}));
}

// GOM Correlate, ARAMIS Professional and ZEISS Inspect write a component in
// this form.
TEST_F(PointsFileTest, ReadsTheTableBelowThatOfTheStage) {
  const PointsFile file = Read(
      "# Units: length:mm angle:deg time:s\n"
      "stage;index;relative_time;date\n"
      "\"Stage 2\";2;21.5;\"2024-01-01T00:00:00\"\n"
      "# Name : Surface component 1\n"
      "id;x;y;z;displacement_x;displacement_y;displacement_z\n"
      "0;1;2;3;4;5;6\n");
  EXPECT_EQ(file.positions, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(file.displacement, Eigen::Vector3d(4, 5, 6));
}

TEST_F(PointsFileTest, LeavesOutWhatWasNotMeasured) {
  const PointsFile file =
      Read("x,y,ux,uy\n1,2,3,4\n5,6,nan,\n,,,\n7,8,,9\n", 2);
  EXPECT_EQ(file.lines, (std::vector<std::size_t>{2, 5}));
  EXPECT_THROWS_WITH(Read("x,y,ux,uy\n1,2,nan,nan\n", 2), "no row has");
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
                     "line 3 has 3 columns, but the titles have 4");
  EXPECT_THROWS_WITH(Read("x,y,ux,uy\n1,2,3,\"4\n", 2),
                     "line 2: the quotes do not match");
  EXPECT_THROWS_WITH(Read("x,y,ux,uy\n1,2,3,4\n5,6,7,8\n1,2,3,4\n", 2),
                     "line 4 repeats the point and displacement of line 2");
  EXPECT_THROWS_WITH(Read("x,y,ux,uy\n", 2), "no row of numbers");
  EXPECT_THROWS_WITH(Read("\n", 2), "no row of numbers");
  EXPECT_THROWS_WITH(Read("", 2), "the file is empty");
}

}  // namespace
}  // namespace elastimate
