#include "elastimate/io/points/node_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "elastimate/io/scene/scene_reader.h"
#include "tests/io/abaqus_files.h"
#include "tests/io/scene_files.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class NodeTableTest : public ::testing::Test {
 protected:
  NodeTable Read(const std::string& content, int dimension = 3) const {
    return ReadNodeTable(folder_.Write("u.txt", content), dimension);
  }
  void ExpectTwoNodes(const std::string& content) const {
    const NodeTable table = Read(content);
    EXPECT_THAT(table.numbers, ElementsAre(5, 12));
    Eigen::MatrixXd displacement(3, 2);
    displacement.transpose() << 0.5, -0.25, 0, 1e-3, 2, -3;
    EXPECT_EQ(table.displacement, displacement);
  }

  const TemporaryFolder folder_;
};

TEST_F(NodeTableTest, ReadsTheReportOfAbaqus) {
  ExpectTwoNodes(R"(********************************************************
Field Output Report, written Mon Jan  1 10:00:00 2024

Source 1
---------
   ODB: C:/temp/Job-1.odb
   Step: Step-1
   Frame: Increment      1: Step Time =    1.000
   Loc 1 : Nodal values from source 1
Output sorted by column "Node Label".
Field Output reported at nodes for part: BODY-1

            Node     U.Magnitude            U.U1            U.U2            U.U3
           Label          @Loc 1          @Loc 1          @Loc 1          @Loc 1
---------------------------------------------------------------------------------
               5              9.             0.5         -250.E-03              0.
              12              9.         1.E-03               2.             -3.


  Minimum                     9.          1.E-03        -250.E-03             -3.
      At Node                 5              12               5              12
)");
}

TEST_F(NodeTableTest, ReadsTablesWithNodeNumbers) {
  ExpectTwoNodes("node,ux,uy,uz\n5,0.5,-0.25,0\n12,1e-3,2,-3\n");
  ExpectTwoNodes("# a comment\nid;U3;U2;U1\n5;0;-0.25;0.5\n12;-3;2;1e-3\n");
  ExpectTwoNodes(
      "ODB Name, Step, Part Instance Name, Node Label, X, U-Magnitude, U-U1, "
      "U-U2, U-U3\n"
      "a.odb, Step-1, BODY-1, 5, 7., 9., 0.5, -0.25, 0\n"
      "a.odb, Step-1, BODY-1, 12, 7., 9., 0.001, 2, -3\n");
}

TEST_F(NodeTableTest, ReadsTheLastStateOfFebio) {
  const std::string first =
      "*Step  = 1\n*Time  = 0.5\n*Data  = ux;uy;uz\n5,9,9,9\n12,9,9,9\n";
  const std::string second =
      "*Step  = 2\n*Time  = 1\n*Data  = ux;uy;uz\n5,0.5,-0.25,0\n"
      "12 0.001 2 -3\n";
  ExpectTwoNodes(first + second);
  EXPECT_EQ(Read(first + second).num_states, 2U);
  EXPECT_EQ(Read(first + second).state, "time 1");
  // In a log file, other data and text stand between them.
  ExpectTwoNodes(
      "===== beginning time step 1 : 1 =====\n\nData Record #1\n"
      "==========\nStep = 1\nTime = 1\nData = ux;uy;uz\n5 0.5 -0.25 0\n"
      "12 0.001 2 -3\n\nData Record #2\nStep = 1\nTime = 1\nData = sx;sy\n"
      "5 1 2\n 1 2 3 4\n");
}

TEST_F(NodeTableTest, ReadsTheLastStateOfCalculix) {
  ExpectTwoNodes(
      "\n displacements (vx,vy,vz) for set ALL and time  0.5000000E+00\n\n"
      "   5  9.E+00  9.E+00  9.E+00\n\n"
      " displacements (vx,vy,vz) for set ALL and time  0.1000000E+01\n\n"
      "   5  0.500000E+00 -0.250000E+00  0.000000E+00\n"
      "  12  1.000000E-03  2.000000E+00 -3.000000E+00\n\n"
      " forces (fx,fy,fz) for set ALL and time  0.1000000E+01\n\n"
      "   5  7.E+00  7.E+00  7.E+00\n");
}

TEST_F(NodeTableTest, TellsThatAFileIsCut) {
  const std::string whole =
      " displacements (vx,vy,vz) for set ALL and time  0.1000000E+01\n\n"
      "   5  0.500000E+00 -0.250000E+00  0.000000E+00\n"
      "  12  1.000000E-03  2.000000E+00 -3.000000E+00\n";
  ExpectTwoNodes(whole);
  EXPECT_THROWS_WITH(Read(whole.substr(0, whole.size() - 3)),
                     "u.txt: line 4: the file is cut");
  EXPECT_THROWS_WITH(Read(whole.substr(0, whole.size() - 1)),
                     "u.txt: line 4: the file is cut");
  // People leave out the end of the last line.
  ExpectTwoNodes("node,ux,uy,uz\n5,0.5,-0.25,0\n12,1e-3,2,-3");
}

TEST_F(NodeTableTest, RefusesNumbersThatAreNoNumbersOfNodes) {
  const std::string title = "displacements (vx,vy,vz) for set ALL and time 1\n";
  EXPECT_THROWS_WITH(Read(title + " 5 1 2 3\n -12 1 2 3\n"),
                     "u.txt: line 3: '-12' is no number of a node");
  EXPECT_THROWS_WITH(Read("node ux uy uz\n5 1 2 3\n1.5 1 2 3\n"),
                     "line 3: '1.5' is no number of a node");
}

TEST_F(NodeTableTest, NeedsTwoComponentsInThePlane) {
  const NodeTable table = Read("node ux uy\n7 1 2\n", 2);
  EXPECT_EQ(table.displacement, Eigen::Vector2d(1, 2));
  EXPECT_THROWS_WITH(Read("node ux uy\n7 1 2\n"), "no displacements of num");
}

TEST_F(NodeTableTest, NamesWhatIsWrong) {
  EXPECT_THROWS_WITH(Read("node,ux,uy,uz\n5,1,2,x\n"),
                     "u.txt: line 2: 'x' is no finite number");
  EXPECT_THROWS_WITH(Read("node,ux,uy,uz\n5,1,2\n"),
                     "line 2: '' is no finite number");
  EXPECT_THROWS_WITH(Read("node,ux,uy,uz\n5,1,2,nan\n"), "'nan' is no finite");
  EXPECT_THROWS_WITH(Read("node,ux,uy,uz\n5.5,1,2,3\n"),
                     "'5.5' is no number of a node");
  EXPECT_THROWS_WITH(Read("node,ux,uy,uz\n5,1,2,3\n6,1,2,3\n5,1,2,3\n"),
                     "lines 2 and 4 are both of node 5");
}

// The mesh has the nodes 2, 3, 5, 7, 9 (of no element) and 10.
TEST_F(NodeTableTest, GivesDisplacementsToTheNodesOfAMesh) {
  folder_.Write("mesh.inp", AbaqusDeckText());
  const auto scene = [&](const std::string& table) {
    folder_.Write("u.csv", table);
    return ReadScene({folder_.Write("scene.json", R"({"mesh": "mesh.inp",
      "supports": [{"nodes": {"set": "Set-1"}}],
      "cases": [{"displacement": {"nodes": "u.csv"},
                 "loads": [{"type": "body_force", "value": [0, 0, 1]}]}]})")},
                     Measurement::kRequired)
        .scene.load_cases[0];
  };
  const LoadCase some = scene("node,ux,uy,uz\n10,1,2,3\n5,4,5,6\n");
  EXPECT_EQ(some.displacement.col(4), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(some.displacement.col(2), Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(some.observed.count(), 6);
  const LoadCase all =
      scene("node,ux,uy,uz\n2,0,0,0\n3,0,0,0\n5,4,5,6\n7,1,1,1\n10,1,2,3\n");
  EXPECT_EQ(all.observed.size(), 0);
  EXPECT_THROWS_WITH(scene("node,ux,uy,uz\n4,1,2,3\n"),
                     "u.csv: line 2: node 4 is not in the mesh");
}

}  // namespace
}  // namespace elastimate
