#include "elastimate/estimators/maps/boundary_layer.h"

#include <gtest/gtest.h>

#include "tests/estimators/maps/map_scenes.h"

namespace elastimate::testing {
namespace {

// A square of 8 x 8 quadrilaterals in rows of one region each.
class RowsOfRegions : public ::testing::Test {
 protected:
  bool IsLayer(const std::string& regions, const Eigen::VectorXd& levels) {
    std::vector<int> region_of_element;
    for (Eigen::Index e = 0; e < scene_.mesh.NumElements(); ++e) {
      const double height =
          scene_.mesh.nodes(1, scene_.mesh.elements.col(e)).mean();
      region_of_element.push_back(regions[std::size_t(8 * height)] - '0');
    }
    return IsBoundaryLayer(scene_.mesh, volumes_, region_of_element, levels);
  }

  const Scene scene_ = MakeMapScene("hom", ElementKind::kQuad4, 8, 0.01).scene;
  const Eigen::VectorXd volumes_ =
      Eigen::VectorXd::Ones(scene_.mesh.NumElements());
  const Eigen::Vector3d levels_{0, 0.5, 1};
};

TEST_F(RowsOfRegions, FindElementsBetweenTwoRegions) {
  EXPECT_TRUE(IsLayer("00012222", levels_));
  EXPECT_TRUE(IsLayer("22210122", levels_));
}

TEST_F(RowsOfRegions, TakeNoRegionOfTwoRowsForABoundary) {
  EXPECT_FALSE(IsLayer("00011222", levels_));
}

TEST_F(RowsOfRegions, TakeNoRegionThatIsMostlyElsewhereForABoundary) {
  EXPECT_FALSE(IsLayer("00012111", levels_));
}

TEST_F(RowsOfRegions, TakeNoLayerAtASurfaceForABoundary) {
  EXPECT_FALSE(IsLayer("12220000", levels_));
  EXPECT_FALSE(IsLayer("22000001", levels_));
}

TEST_F(RowsOfRegions, TakeOnlyAModulusBetweenTheOthersForABoundary) {
  EXPECT_FALSE(IsLayer("00012222", Eigen::Vector3d(0, 1.5, 1)));
  EXPECT_FALSE(IsLayer("00012222", Eigen::Vector3d(0, -0.5, 1)));
}

TEST_F(RowsOfRegions, HaveABoundaryOnlyIfThereAreThree) {
  EXPECT_FALSE(IsLayer("00011111", Eigen::Vector2d(0, 1)));
}

}  // namespace
}  // namespace elastimate::testing
