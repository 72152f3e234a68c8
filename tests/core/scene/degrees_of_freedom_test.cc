#include "elastimate/core/scene/degrees_of_freedom.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace elastimate {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

// Three nodes; held are y of node 0, all of node 1, x and z of node 2.
Supports SomeSupports() {
  Supports supports;
  supports.held.resize(3, 3);
  supports.held << false, true, true,  //
      true, true, false,               //
      false, true, true;
  supports.displacement.resize(3, 3);
  supports.displacement << 1, 4, 7, 2, 5, 8, 3, 6, 9;
  return supports;
}

TEST(DegreesOfFreedom, ListsTheFreeOnesInOrder) {
  const DegreesOfFreedom dofs(SomeSupports());
  EXPECT_THAT(dofs.free, ElementsAre(0, 2, 7));
  EXPECT_THAT(dofs.place, ElementsAre(0, -1, 1, -1, -1, -1, -1, 2, -1));
  EXPECT_EQ(dofs.NumFree(), 3);
  EXPECT_EQ(dofs.NumAll(), 9);
}

TEST(DegreesOfFreedom, WithoutHeldOnesAreAll) {
  Supports supports = SomeSupports();
  supports.held.setConstant(false);
  const DegreesOfFreedom dofs(supports);
  EXPECT_EQ(dofs.NumFree(), 9);
  for (Eigen::Index i = 0; i < 9; ++i) {
    EXPECT_EQ(dofs.free[i], i);
    EXPECT_EQ(dofs.place[i], i);
  }
}

TEST(DegreesOfFreedom, AreNoneWhenAllAreHeld) {
  Supports supports = SomeSupports();
  supports.held.setConstant(true);
  const DegreesOfFreedom dofs(supports);
  EXPECT_THAT(dofs.free, IsEmpty());
  EXPECT_EQ(dofs.NumAll(), 9);
}

TEST(DegreesOfFreedom, RestrictTakesTheFreeRows) {
  const DegreesOfFreedom dofs(SomeSupports());
  Eigen::MatrixXd all(9, 2);
  all.col(0) = Eigen::VectorXd::LinSpaced(9, 0, 8);
  all.col(1) = 10 * all.col(0);
  Eigen::MatrixXd expected(3, 2);
  expected << 0, 0, 2, 20, 7, 70;
  EXPECT_EQ(dofs.Restrict(all), expected);
}

TEST(DegreesOfFreedom, ExtendPutsZerosIntoTheHeldRows) {
  const DegreesOfFreedom dofs(SomeSupports());
  Eigen::MatrixXd values(3, 2);
  values << 1, 4, 2, 5, 3, 6;
  const Eigen::MatrixXd all = dofs.Extend(values);
  ASSERT_EQ(all.rows(), 9);
  EXPECT_EQ(dofs.Restrict(all), values);
  EXPECT_EQ(all.sum(), values.sum());
}

TEST(HeldDisplacement, IsZeroInTheFreeRows) {
  Eigen::VectorXd expected(9);
  expected << 0, 2, 0, 4, 5, 6, 7, 0, 9;
  EXPECT_EQ(HeldDisplacement(SomeSupports()), expected);
}

TEST(HeldDisplacement, IgnoresWhatIsWrittenInFreeRows) {
  Supports supports = SomeSupports();
  supports.displacement(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(HeldDisplacement(supports).allFinite());
}

}  // namespace
}  // namespace elastimate
