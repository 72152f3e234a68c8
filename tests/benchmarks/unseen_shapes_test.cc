// The shapes are what the study says, and their hexahedra are the same bodies.

#include "benchmarks/unseen_shapes.h"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>

#include "elastimate/core/equilibrium/simulated_measurement.h"
#include "elastimate/core/scene/loads.h"

namespace elastimate {
namespace {

constexpr double kSumRounding = 1e-10;  // Relative, of sums.

TEST(UnseenShapes, AreManyInTwoHalves) {
  std::set<std::string> names;
  std::map<Half, int> halves;
  for (const UnseenShape& shape : UnseenShapes()) {
    SCOPED_TRACE(shape.name);
    EXPECT_TRUE(names.insert(shape.name).second);
    ++halves[shape.half];
    EXPECT_GE(shape.experiments.size(), 2);
    for (const LoadedShape& experiment : shape.experiments) {
      // A comma would end a cell of the table.
      EXPECT_EQ((shape.name + experiment.name).find(','), std::string::npos);
    }
    const VoxelMesh voxels = TetrahedralMesh(shape.body);
    EXPECT_GE(voxels.mesh.NumElements(), 800);
    EXPECT_LE(voxels.mesh.NumElements(), 1100);
    const Scene scene = UnmeasuredScene(shape, voxels);
    ValidateScene(scene);
    EXPECT_GT(scene.supports.held.count(), 0);
  }
  EXPECT_GE(names.size(), 12);
  EXPECT_EQ(halves[Half::kCalibration], halves[Half::kReport]);
}

// Tractions around an axis have no resultant.
TEST(UnseenShapes, AreTwistedByAMomentAlone) {
  int count = 0;
  for (const UnseenShape& shape : UnseenShapes()) {
    const VoxelMesh voxels = TetrahedralMesh(shape.body);
    for (const LoadedShape& experiment : shape.experiments) {
      if (experiment.name == "torsion") {
        const Eigen::MatrixXd force =
            AssembleLoads(voxels.mesh, experiment.loads(voxels));
        EXPECT_LT(force.rowwise().sum().norm(), kSumRounding * force.norm())
            << shape.name;
        ++count;
      }
    }
  }
  EXPECT_GT(count, 0);
}

// The tetrahedra of a voxel body without a map fill its voxels; so do the
// hexahedra, under loads of the same resultants.  Their displacements are
// softer than those of the coarse mesh, and at the same nodes.
TEST(UnseenShapes, AreTheSameBodiesOfHexahedra) {
  int count = 0;
  for (const UnseenShape& shape : UnseenShapes()) {
    if (shape.hexahedra_per_edge == 0) {
      continue;
    }
    SCOPED_TRACE(shape.name);
    ++count;
    const VoxelMesh fine = HexahedralMesh(shape.body, 2);
    Scene coarse = UnmeasuredScene(shape, TetrahedralMesh(shape.body));
    Scene world = UnmeasuredScene(shape, fine);
    ValidateScene(world);
    const double volume = ElementVolumes(coarse.mesh).sum();
    EXPECT_NEAR(ElementVolumes(world.mesh).sum(), volume,
                kSumRounding * volume);
    EXPECT_EQ(world.mesh.nodes.leftCols(coarse.mesh.NumNodes()),
              coarse.mesh.nodes);
    const Eigen::MatrixXd force = AssembleLoadCases(coarse);
    const Eigen::MatrixXd fine_force = AssembleLoadCases(world);
    Measure({5e3, 0.3}, coarse);
    Measure({5e3, 0.3}, world);
    for (Eigen::Index k = 0; k < force.cols(); ++k) {
      const auto resultant = [k](const Eigen::MatrixXd& forces) {
        return Eigen::Vector3d(
            forces.col(k).reshaped(3, forces.rows() / 3).rowwise().sum());
      };
      EXPECT_LT((resultant(fine_force) - resultant(force)).norm(),
                kSumRounding * force.col(k).norm());
      EXPECT_GT(
          fine_force.col(k).dot(world.load_cases[k].displacement.reshaped()),
          force.col(k).dot(coarse.load_cases[k].displacement.reshaped()));
    }
  }
  EXPECT_GT(count, 0);
}

}  // namespace
}  // namespace elastimate
