#include "elastimate/io/scene/frames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <iomanip>
#include <sstream>
#include <string>
#include <vector>

#include "elastimate/io/examples/example_scenes.h"
#include "elastimate/io/scene/scene_reader.h"
#include "elastimate/io/vtk/vtu_writer.h"
#include "tests/io/scene_files.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

using ::testing::ElementsAre;

// A strip of 4 x 2 that a camera sees, the load of which is recorded.
const std::string kFilmedStrip = R"({
  "model": "plane_stress", "thickness": 0.5,
  "mesh": {"points": "frame_1.csv", "margin": 0},
  "supports": [ {"nodes": {"box": [[0, 0], [0, 2]]}, "displacement": "measured"},
                {"nodes": {"box": [[4, 0], [4, 2]]}, "displacement": "measured"} ],
  "cases": [ {"loads": [ {"type": "resultant", "value": [2, null],
                          "surface": {"box": [[4, 0], [4, 2]]},
                          "relative_sd": 0.01},
                         {"type": "traction", "value": [0, 3],
                          "surface": {"box": [[4, 0], [4, 2]]}} ]} ],
  "frames": {"files": "frame_*.csv",
             "load_record": {"file": "load.csv", "column": "Force [N]"}}
})";

class FramesTest : public ::testing::Test {
 protected:
  FramesTest() {
    for (const int number : {1, 2, 10}) {
      folder_.Write("frame_" + std::to_string(number) + ".csv", Frame(number));
    }
    folder_.Write("load.csv", "time;Force [N]\n1;5\n2;-6\n3;\n");
    folder_.Write("other.csv", "not a frame\n");
  }

  // Displacements of `number`, but for points left of `from`.
  static std::string Frame(int number, double from = 0) {
    std::ostringstream text;
    text << std::setprecision(17) << "x,y,ux,uy\n";
    for (int i = 0; i <= 8; ++i) {
      for (int j = 0; j <= 4; ++j) {
        if (0.5 * i >= from) {
          text << 0.5 * i << "," << 0.5 * j << "," << number * 0.5 * i << ",-"
               << number << "\n";
        }
      }
    }
    return text.str();
  }

  FrameSeries Read(const std::string& document) const {
    return *ReadScene({folder_.Write("scene.json", document)},
                      Measurement::kRequired)
                .frames;
  }

  const TemporaryFolder folder_;
};

// A series of ParaView names its files in any order, with their times.
TEST_F(FramesTest, AreTheArraysOfVtkFiles) {
  RectangleOptions options;
  options.cells = {2, 1};
  Scene scene = RectangleScene(options);
  const auto write = [&](const std::string& name, double size) {
    scene.load_cases[0].displacement.setConstant(2, scene.mesh.NumNodes(),
                                                 size);
    WriteVtu(folder_.Path() / name, scene.mesh, SceneFields(scene));
  };
  write("u_1.vtu", 1);
  write("u_2.vtu", 2);
  write("u_10.vtu", 10);
  folder_.Write("u.pvd", R"(<?xml version="1.0"?>
<VTKFile type="Collection"><Collection>
 <DataSet timestep="3" part="0" file="u_1.vtu"/>
 <DataSet timestep="1" part="0" file="u_2.vtu"/>
 <DataSet timestep="2" part="0" file="u_10.vtu"/></Collection></VTKFile>)");
  const auto document = [](const std::string& files) {
    return R"({"mesh": "u_1.vtu", "supports": [{"nodes": {"ids": [0, 1, 2]}}],
      "cases": [{"displacement": {"array": "displacement"},
                 "loads": [{"type": "body_force", "value": [0, 1]}]}],
      "frames": {"files": ")" +
           files + "\"}}";
  };
  const auto sizes = [&](const std::string& files) {
    const FrameSeries series = Read(document(files));
    std::vector<double> found;
    for (std::size_t i = 0; i < series.files.size(); ++i) {
      found.push_back(series.read(i).displacement(1, 3));
    }
    return found;
  };
  EXPECT_THAT(sizes("u_*.vtu"), ElementsAre(1, 2, 10));
  EXPECT_THAT(sizes("u.pvd"), ElementsAre(2, 10, 1));
  options.cells = {3, 1};
  scene = RectangleScene(options);
  write("u_2.vtu", 2);
  EXPECT_THROWS_WITH(sizes("u.pvd"), "u_2.vtu: its points are not those");
}

TEST_F(FramesTest, AreInTheOrderOfTheirNumbers) {
  const FrameSeries series = Read(kFilmedStrip);
  std::vector<std::string> names;
  for (const std::filesystem::path& file : series.files) {
    names.push_back(file.filename().string());
  }
  EXPECT_THAT(names, ElementsAre("frame_1.csv", "frame_2.csv", "frame_10.csv"));
  EXPECT_THAT(series.read(1).displacement(1, 7), -2);
}

TEST_F(FramesTest, MultiplyTheLoads) {
  const FrameSeries series = Read(kFilmedStrip);
  EXPECT_EQ(series.load_error.relative, 0.01);
  EXPECT_TRUE(series.load_error.is_in_frames);
  const LoadCase frame = series.read(1);
  EXPECT_EQ(frame.resultants[0].force(0), -12);
  EXPECT_TRUE(std::isnan(frame.resultants[0].force(1)));
  EXPECT_NEAR(frame.resultants[0].noise_sd(0), 0.12, 1e-15);
  EXPECT_EQ(std::get<Traction>(frame.loads[0]).traction(1), -18);
  EXPECT_THROWS_WITH(series.read(2), "no number for this frame");
  EXPECT_EQ(Read(Replaced(kFilmedStrip, "\"Force [N]\"",
                          "\"Force [N]\", \"relative_sd\": 0.002"))
                .load_error.relative,
            0.002);
  // An error in units of force stays what it is.
  EXPECT_EQ(Read(Replaced(kFilmedStrip, "\"relative_sd\": 0.01", "\"sd\": 0.3"))
                .read(1)
                .resultants[0]
                .noise_sd(0),
            0.3);
}

TEST_F(FramesTest, MayHaveLostPoints) {
  folder_.Write("frame_2.csv", Frame(2, 1));
  const LoadCase frame = Read(kFilmedStrip).read(1);
  EXPECT_EQ(frame.observed.count(), 2 * 35);
  EXPECT_FALSE(frame.observed(0, 0));
  folder_.Write("frame_2.csv", Frame(2, 2.5));
  EXPECT_THROWS_WITH(Read(kFilmedStrip).read(1),
                     "frame_2.csv: only 20 of the 45 points of the mesh");
}

TEST_F(FramesTest, MayBeOfPointsOrOfNodes) {
  WriteVtu(folder_.Path() / "mesh.vtu", RectangleScene({}).mesh, {});
  const std::string document = R"({
    "mesh": "mesh.vtu", "model": "plane_stress", "thickness": 1,
    "supports": [ {"nodes": {"box": [[0, -1], [0, 1]]}} ],
    "cases": [ {"loads": [ {"type": "body_force", "value": [2, 0]} ]} ],
    "frames": {"files": ["a.csv", "b.csv"]} })";
  folder_.Write("a.csv", "x,y,ux,uy\n.01,.01,1,2\n.03,.01,,4\n");
  folder_.Write("b.csv", "x,y,ux,uy\n.01,.01,5,6\n9,9,1,1\n");
  const FrameSeries points = Read(document);
  EXPECT_EQ(points.Load(0), 1);
  EXPECT_EQ(points.read(0).points.displacement(1, 0), 2);
  EXPECT_THROWS_WITH(points.read(1), "b.csv: line 3");

  std::string field = "ux,uy\n";
  for (int i = 0; i < 105; ++i) {
    field += std::to_string(i) + ",0\n";
  }
  folder_.Write("a.csv", field);
  const FrameSeries nodes = Read(Replaced(
      document, "\"loads\"", R"("displacement": {"file": "a.csv"}, "loads")"));
  EXPECT_EQ(nodes.read(0).displacement(0, 104), 104);
  EXPECT_THROWS_WITH(nodes.read(1), "b.csv");
}

TEST_F(FramesTest, AreOfTheNodesThatElementsUse) {
  folder_.Write("mesh.vtk", LegacySceneText());
  folder_.Write("u.csv",
                "x,y,z\n0,0,0\n0,0,0\n9,9,9\n0,0,0\n.1,.2,.3\n.4,.5,.6\n");
  const FrameSeries series = Read(R"({
    "mesh": "mesh.vtk", "supports": [ {"nodes": {"ids": [0, 1, 3]}} ],
    "cases": [ {"displacement": {"file": "u.csv"},
                "loads": [ {"type": "body_force", "value": [0, 0, 1]} ]} ],
    "frames": {"files": "u.csv"} })");
  EXPECT_EQ(series.read(0).displacement.col(3), Eigen::Vector3d(.1, .2, .3));
}

TEST_F(FramesTest, AreInTheOrderOfDecimals) {
  for (const std::string load : {"1.0", "1.25", "1.5", "2.0"}) {
    folder_.Write("load_" + load + "kN.csv", Frame(1));
  }
  folder_.Write("load.csv", "Force [N]\n1000\n1250\n1500\n2000\n");
  const FrameSeries series =
      Read(Replaced(kFilmedStrip, "frame_*.csv", "load_*.csv"));
  ASSERT_EQ(series.files.size(), 4U);
  EXPECT_EQ(series.files[1].filename(), "load_1.25kN.csv");
  EXPECT_EQ(series.files[2].filename(), "load_1.5kN.csv");
  EXPECT_EQ(series.Load(2), 1500);
}

// Names of the frames, of their images, or of both with folders.
TEST_F(FramesTest, GetTheLoadsOfTheRowsThatNameThem) {
  for (const std::string record :
       {"Force [N],file\n5,frame_2.csv\n6,frame_10.csv\n7,frame_1.csv\n",
        "image;Force [N]\nframe_10;6,0\nframe_1;7,0\nframe_2;5,0\n",
        "n\tForce [N]\tfile\n1\t5\tC:\\dic\\frame_2.tif\n"
        "2\t7\tframe_1.tif\n10\t6\timages/frame_10.tif\n"}) {
    folder_.Write("load.csv", record);
    EXPECT_THAT(Read(kFilmedStrip).loads, ElementsAre(7, 5, 6)) << record;
  }
  // Numbers are names where the scene says so.
  folder_.Write("1.csv", Frame(1));
  folder_.Write("2.csv", Frame(1));
  folder_.Write("load.csv", "number,Force [N]\n2,8\n1,9\n");
  const std::string document = Replaced(kFilmedStrip, "frame_*.csv", "?.csv");
  EXPECT_THAT(Read(document).loads, ElementsAre(8, 9));
  EXPECT_THAT(Read(Replaced(document, "\"Force [N]\"",
                            "\"Force\", \"files_column\": \"number\""))
                  .loads,
              ElementsAre(9, 8));
}

TEST_F(FramesTest, NeedARowEachAndRowsAFrame) {
  const std::string rows = "file,Force [N]\nframe_1,5\nframe_2,6\n";
  folder_.Write("load.csv", rows);
  EXPECT_THROWS_WITH(Read(kFilmedStrip),
                     "load.csv: no row names the frame frame_10.csv");
  folder_.Write("load.csv", rows + "frame_3,6\n");
  EXPECT_THROWS_WITH(Read(kFilmedStrip),
                     "line 4: 'frame_3' is not the name of exactly one frame");
  folder_.Write("load.csv", rows + "frame_2.tif,6\n");
  EXPECT_THROWS_WITH(Read(kFilmedStrip),
                     "line 4: 'frame_2.tif' names the same frame as line 3");
  folder_.Write("load.csv",
                "a,b,Force [N]\nframe_1,frame_1,5\n,,6\nframe_2,frame_2,7\n");
  EXPECT_THROWS_WITH(Read(kFilmedStrip),
                     "load_record has two columns .* 'a' and 'b'.* "
                     "\"files_column\"");
}

TEST_F(FramesTest, HaveNoRowOfAReferenceFrame) {
  folder_.Write("load.csv", "Force [N]\n0\n1\n2\n3\n");
  EXPECT_THROWS_WITH(Read(kFilmedStrip),
                     "4 rows for 3 frames; leave out line 2, which has no "
                     "load, as a reference frame has");
  folder_.Write("load.csv", "Force [N]\n1\n2\n");
  EXPECT_THROWS_WITH(Read(kFilmedStrip), "leave a reference frame out");
}

// The frames are read as the displacement of the load case is.
TEST_F(FramesTest, MayBeTablesOfOtherTitles) {
  WriteVtu(folder_.Path() / "mesh.vtu", RectangleScene({}).mesh, {});
  folder_.Write("a.csv", "a [m];b [m];c [mm];d [mm]\n0,01;0,01;1;2\n");
  const FrameSeries series = Read(R"({
    "mesh": "mesh.vtu", "model": "plane_stress", "thickness": 1,
    "supports": [ {"nodes": {"box": [[0, -1], [0, 1]]}} ],
    "cases": [ {"displacement": {"points": "a.csv", "columns":
                  {"x": "a", "y": "b", "u": "c", "v": "d"}},
                "loads": [ {"type": "body_force", "value": [2, 0]} ]} ],
    "frames": {"files": ["a.csv"]} })");
  EXPECT_EQ(series.read(0).points.displacement, Eigen::Vector2d(1e-3, 2e-3));
}

TEST_F(FramesTest, TellWhatIsWrong) {
  EXPECT_THROWS_WITH(Read(Replaced(kFilmedStrip, "frame_*.csv", "image_*.csv")),
                     "csv\", which matches no file");
  EXPECT_THROWS_WITH(
      Read(Replaced(kFilmedStrip, "\"frame_*.csv\"", R"(["a.csv", "a.csv"])")),
      "is empty or was named before");
  EXPECT_THROWS_WITH(Read(Replaced(kFilmedStrip, "\"frame_*.csv\"", "[]")),
                     "frames.files is empty");
  EXPECT_THROWS_WITH(Read(Replaced(kFilmedStrip, "Force [N]", "Kraft")),
                     "load.csv: ");
  EXPECT_THROWS_WITH(Read(Replaced(kFilmedStrip, "Force [N]\"",
                                   "Force [N]\", \"relative_sd\": -1")),
                     "frames.load_record.relative_sd must not be negative");
  EXPECT_THROWS_WITH(Read(Replaced(kFilmedStrip, "\"cases\": [", R"("cases": [
      {"loads": [{"type": "body_force", "value": [1, 0]}]}, )")),
                     "frames need exactly one load case, but \"cases\" has 2");
  folder_.Write("load.csv", "Force [N]\n1\n2\n");
  EXPECT_THROWS_WITH(Read(kFilmedStrip), "has 2 rows for 3 frames");
  folder_.Write("load.csv", "Force [N]\n1\n0\ninf\n");
  EXPECT_THROWS_WITH(Read(kFilmedStrip).read(1),
                     "the load of this frame is zero");
  EXPECT_THROWS_WITH(Read(kFilmedStrip).read(2), "is not finite");
}

}  // namespace
}  // namespace elastimate
