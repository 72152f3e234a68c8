#include "elastimate/io/dic/dic_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/io/scene_files.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

using ::testing::ElementsAre;

class DicFileTest : public ::testing::Test {
 protected:
  DicFrame Read(const std::string& text,
                const TableOptions& options = {}) const {
    return ReadDicFile(folder_.Write("frame.csv", text), options);
  }

  const TemporaryFolder folder_;
};

void ExpectPoint(const DicFrame& frame, Eigen::Index i, double x, double y,
                 double u, double v) {
  ASSERT_LT(i, frame.positions.cols());
  EXPECT_EQ(frame.positions.col(i), Eigen::Vector2d(x, y));
  EXPECT_EQ(frame.displacement.col(i), Eigen::Vector2d(u, v));
}

TEST_F(DicFileTest, OfMatchId) {
  const DicFrame frame = Read(
      "coor.X [mm];coor.Y [mm];disp.Horizontal Displacement U [mm];"
      "disp.Vertical Displacement V [mm]\n"
      "1.5;2;0.25;-0.5\n"
      "NaN;3;0;0\n");
  EXPECT_EQ(frame.format, "matchid");
  ExpectPoint(frame, 0, 1.5, 2, 0.25, -0.5);
  EXPECT_EQ(frame.num_invalid, 1);
  EXPECT_THAT(frame.lines, ElementsAre(2));
  ExpectPoint(Read("x_pic,y_pic,x,y,u,v\n100,200,1,2,3,4\n"), 0, 1, 2, 3, 4);
}

TEST_F(DicFileTest, OfMatchIdInPixelsNeedsAScale) {
  const std::string text =
      "coor.X [Pixel],coor.Y [Pixel],"
      "disp.Horizontal Displacement U [Pixel],"
      "disp.Vertical Displacement V [Pixel]\n10,20,1,2\n";
  EXPECT_THROWS_WITH(Read(text), "are in pixels; give \"length_per_pixel\"");
  TableOptions options;
  options.length_per_pixel = 0.5;
  ExpectPoint(Read(text, options), 0, 5, 10, 0.5, 1);
  options.flip_y = true;
  ExpectPoint(Read(text, options), 0, 5, -10, 0.5, -1);
}

TEST_F(DicFileTest, OfVic) {
  const DicFrame frame = Read(
      "\"X [mm]\",\"Y [mm]\",\"Z [mm]\",\"U [mm]\",\"V [mm]\",\"W [mm]\","
      "\"sigma [pixel]\"\n"
      "1,2,0,3,4,0,0.01\n"
      "0,0,0,0,0,0,-1\n");
  EXPECT_EQ(frame.format, "vic");
  EXPECT_EQ(frame.positions.cols(), 1);
  EXPECT_EQ(frame.num_invalid, 1);
  ExpectPoint(frame, 0, 1, 2, 3, 4);
}

TEST_F(DicFileTest, OfDice) {
  const DicFrame frame = Read(
      "***\n*** Digital Image Correlation Engine\n*** Subset size: 21\n***\n"
      "SUBSET_ID,COORDINATE_X,COORDINATE_Y,DISPLACEMENT_X,DISPLACEMENT_Y,"
      "SIGMA,STATUS_FLAG\n"
      "0,10,20,1,2,0.003,4\n1,30,20,0,0,-1,4\n",
      [] {
        TableOptions options;
        options.length_per_pixel = 0.1;
        return options;
      }());
  EXPECT_EQ(frame.format, "dice");
  EXPECT_EQ(frame.num_invalid, 1);
  EXPECT_DOUBLE_EQ(frame.positions(1, 0), 2);
  EXPECT_DOUBLE_EQ(frame.displacement(1, 0), 0.2);
}

TEST_F(DicFileTest, OfPyvaleWithSpaces) {
  TableOptions options;
  options.length_per_pixel = 1;
  const DicFrame frame = Read(
      "x y u v mag converged cost\n"
      "10 20 1 2 2.2 1 0.01\n"
      "30 20 9 9 9.9 0 0.90\n",
      options);
  EXPECT_EQ(frame.format, "pyvale");
  ExpectPoint(frame, 0, 10, 20, 1, 2);
  EXPECT_EQ(frame.num_invalid, 1);
}

TEST_F(DicFileTest, OfAramisNamesItsColumnsInAComment) {
  const DicFrame frame = Read(
      "# specimen : Pr\xFC"
      "fling\n"
      "# force : 1500.5\n"
      "####################\n"
      "#      ID;  x_undef [mm];  y_undef [mm];  z_undef [mm];  u [mm];  v "
      "[mm];"
      "  w [mm];  epsx [%]\n"
      "        1;  -80.5;  84.25;  0.15;  0.5;  0.25;  -0.1;  0.1\n"
      "        2;  nan;  84.25;  0.15;  nan;  nan;  nan;  nan\n");
  EXPECT_EQ(frame.format, "aramis");
  ExpectPoint(frame, 0, -80.5, 84.25, 0.5, 0.25);
  EXPECT_EQ(frame.num_invalid, 1);
}

TEST_F(DicFileTest, OfOtherColumnsByTheirNames) {
  TableOptions options;
  options.columns = {"a", "b [mm]", "c", "e"};
  ExpectPoint(Read("e,c,b [mm],a\n4,3,2,1\n", options), 0, 1, 2, 3, 4);
  EXPECT_THROWS_WITH(Read("a,b,c,d\n1,2,3,4\n", options),
                     "there is no column 'e' among a, b, c, d");
}

TEST_F(DicFileTest, OfNamedColumnsKnowsWhatTheFormatMarks) {
  TableOptions options;
  options.columns = {"a", "b", "c", "d"};
  const std::string text = "a,b,c,d,sigma\n1,2,3,4,0.01\n5,6,7,8,-1\n";
  EXPECT_EQ(Read(text, options).positions.cols(), 2);
  options.format = "vic";
  EXPECT_EQ(Read(text, options).positions.cols(), 1);
}

TEST_F(DicFileTest, OfUnknownColumnsNamesThem) {
  EXPECT_THROWS_WITH(Read("a,b\n1,2\n"),
                     "are not those of a format known here");
  EXPECT_THROWS_WITH(Read("a,b\n1,2\n"),
                     "name those of x, y, u and v as \"columns\"");
  TableOptions options;
  options.format = "vic";
  EXPECT_THROWS_WITH(Read("x,y,ux,uy\n1,2,3,4\n", options),
                     "are not those of vic");
}

TEST_F(DicFileTest, TellsFilesThatAreNone) {
  EXPECT_THROWS_WITH(Read("x,y,ux,uy\n1,2,3\n"), "line 2 has 3 columns");
  EXPECT_THROWS_WITH(Read("x,y,ux,uy\n1,two,3,4\n"), "'two' is not a number");
  EXPECT_THROWS_WITH(ReadDicFile(folder_.Path() / "none.csv", {}), "none.csv");
}

}  // namespace
}  // namespace elastimate
