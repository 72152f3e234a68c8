// Several materials by virtual-fields where the measurement is not that of the
// model: displacements check what it says, which no virtual field weighs.

#include "elastimate/estimators/force_balance/displacement_check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "elastimate/core/equilibrium/simulated_measurement.h"
#include "elastimate/core/scene/quadratic_scene.h"
#include "elastimate/core/scene/simplicial_scene.h"
#include "elastimate/estimators/force_balance/virtual_fields.h"
#include "elastimate/estimators/plan/load_plan.h"
#include "tests/regions.h"
#include "tests/scenes.h"
#include "tests/shapes.h"

namespace elastimate {
namespace {

// Region 1 up to a part of the length along an axis, behind it region 2.
void Divide(double part, int axis, Scene& scene) {
  const Mesh& mesh = scene.mesh;
  const double low = mesh.nodes.row(axis).minCoeff();
  const double length = mesh.nodes.row(axis).maxCoeff() - low;
  scene.mesh.regions.resize(mesh.NumElements());
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    const double place =
        mesh.nodes(Eigen::all, mesh.elements.col(e)).row(axis).mean();
    scene.mesh.regions(e) = place < low + part * length ? 1 : 2;
  }
  scene.materials = IsotropicMaterialOfEachRegion(scene.mesh);
}

// Displacements of quadratic elements of half the size, at the nodes.
void MeasureInFinestWorld(const Eigen::VectorXd& truth, Scene& scene) {
  Scene world = QuadraticScene(SimplicialScene(QuadraticScene(scene)));
  MeasureMaterials(truth, world);
  testing::TakeDisplacements(world, scene);
}

// Estimates that are usable, and what their intervals hold of the parameters.
struct Count {
  int estimates = 0;
  int usable = 0;
  int parameters = 0;
  int held = 0;
  // Off by three standard errors and by a tenth of E or .03 of nu.
  int dishonest = 0;

  void Add(const Estimate& estimate, const Eigen::VectorXd& truth) {
    ++estimates;
    if (!estimate.IsUsable()) {
      return;
    }
    ++usable;
    bool is_wrong = false;
    for (Eigen::Index i = 0; i < truth.size(); ++i) {
      const ParameterEstimate& parameter = estimate.parameters[std::size_t(i)];
      const bool is_held = parameter.interval &&
                           parameter.interval->lower <= truth(i) &&
                           truth(i) <= parameter.interval->upper;
      const double error = std::abs(parameter.value - truth(i));
      const double large = parameter.is_modulus ? 0.1 * truth(i) : 0.03;
      ++parameters;
      held += is_held;
      is_wrong = is_wrong || (!is_held && error > large &&
                              error > 3 * parameter.standard_error.value_or(0));
    }
    dishonest += is_wrong;
  }
};

const Eigen::VectorXd kSoftBehindStiff = Eigen::Vector4d(5e3, 0.3, 2e3, 0.4);

// In each, of 1 % and 5 % of noise.
Count CountShapes(const std::function<void(Scene&)>& measure) {
  Count count;
  for (const std::string shape : {"bracket", "ring"}) {
    for (const std::string load : {"tension", "torsion", "bending"}) {
      Scene scene = testing::ShapeScene(shape, load);
      const Eigen::Vector3d extent = scene.mesh.nodes.rowwise().maxCoeff() -
                                     scene.mesh.nodes.rowwise().minCoeff();
      int axis = 0;
      extent.maxCoeff(&axis);
      Divide(0.5, axis, scene);
      measure(scene);
      for (const double noise : {0.01, 0.05}) {
        Scene noisy = scene;
        testing::AddNoise(noise, 7, noisy);
        count.Add(VirtualFields().Run(noisy, {}), kSoftBehindStiff);
      }
    }
  }
  return count;
}

TEST(DisplacementCheckStatistics, HoldsWhatElementsMiss) {
  const Count count = CountShapes(
      [](Scene& scene) { MeasureInFinestWorld(kSoftBehindStiff, scene); });
  EXPECT_EQ(count.dishonest, 0);
  EXPECT_GE(count.held, 0.9 * count.parameters);
}

TEST(DisplacementCheckStatistics, TakesWhatIsOfItsElements) {
  const Count count = CountShapes(
      [](Scene& scene) { MeasureMaterials(kSoftBehindStiff, scene); });
  EXPECT_GE(count.usable, count.estimates / 2);
  EXPECT_EQ(count.dishonest, 0);
  // Of so many parameters, those of an estimate being one draw: three standard
  // deviations below 95 %.
  EXPECT_GE(count.held, (0.95 - 3 * std::sqrt(0.95 * 0.05 / count.usable)) *
                            count.parameters);
}

Scene Block() { return testing::BlockUnderTraction({4, 4, 12}, {1, 1, 3}); }

// Of four measurements of a block of two halves, the second of which begins
// after this part of the length in the model.
Count CountBlocks(const Eigen::VectorXd& truth, double noise,
                  double part_of_model) {
  Scene specimen = Block();
  Divide(0.5, 2, specimen);
  MeasureMaterials(truth, specimen);
  Count count;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    Scene scene = specimen;
    testing::AddNoise(noise, seed, scene);
    Divide(part_of_model, 2, scene);
    count.Add(VirtualFields().Run(scene, {}), truth);
  }
  return count;
}

// By a twelfth of the length.
TEST(DisplacementCheckStatistics, NoticesABoundaryThatIsElsewhere) {
  EXPECT_EQ(CountBlocks(kSoftBehindStiff, 0.01, 7.0 / 12).dishonest, 0);
}

TEST(DisplacementCheckStatistics, IsHonestBesideANearlyIncompressiblePart) {
  EXPECT_EQ(
      CountBlocks(Eigen::Vector4d(1e4, 0.499, 2e4, 0.2), 0.02, 0.5).dishonest,
      0);
}

// The reactions become loads; nothing holds the specimen, which has moved and
// turned as a whole.
void SetFree(const std::vector<IsotropicElasticity>& elasticities,
             Scene& scene) {
  LoadCase& measured = scene.load_cases[0];
  measured.loads = {
      NodalForces{(testing::TextbookStiffness(scene, elasticities) *
                   measured.displacement.reshaped())
                      .reshaped(3, scene.mesh.NumNodes())}};
  scene.supports.held.setConstant(false);
}

void Move(Scene& scene) {
  Eigen::MatrixXd& displacement = scene.load_cases[0].displacement;
  const double size = displacement.cwiseAbs().maxCoeff();
  const Eigen::Vector3d turn = size * Eigen::Vector3d(0.3, -0.2, 0.5);
  for (Eigen::Index node = 0; node < displacement.cols(); ++node) {
    const Eigen::Vector3d x = scene.mesh.nodes.col(node);
    displacement.col(node) +=
        turn.cross(x) + size * Eigen::Vector3d(1, -2, 0.5);
  }
}

TEST(DisplacementCheckStatistics, IsHonestWhereNothingHoldsTheSpecimen) {
  Scene specimen = Block();
  Divide(0.5, 2, specimen);
  MeasureMaterials(kSoftBehindStiff, specimen);
  SetFree({{5e3, 0.3}, {2e3, 0.4}}, specimen);
  Count count;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    Scene scene = specimen;
    testing::AddNoise(0.01, seed, scene);
    Move(scene);
    count.Add(VirtualFields().Run(scene, {}), kSoftBehindStiff);
  }
  EXPECT_EQ(count.usable, count.estimates);
  EXPECT_EQ(count.dishonest, 0);
  // Two of four measurements without any interval that holds happen to one of
  // seventy.
  EXPECT_GE(count.held, 8);
}

// Pieces of a bar one behind the other, stiff and soft in turn.
struct Pieces {
  Scene scene;
  Eigen::VectorXd truth;
};

Pieces MeasuredPieces(int count) {
  Pieces pieces = {testing::BlockUnderTraction({3, 3, 12}, {1, 1, 4}),
                   Eigen::VectorXd(2 * count)};
  testing::DivideIntoRegions({1, 1, count}, {1, 1, 4}, pieces.scene);
  for (int i = 0; i < count; ++i) {
    pieces.truth.segment<2>(2 * i) << (i % 2 == 0 ? 1e4 : 2e4), 0.2 + 0.02 * i;
  }
  MeasureMaterials(pieces.truth, pieces.scene);
  return pieces;
}

// The root mean square of errors over their Cramer-Rao bounds, of usable
// estimates.
double ErrorOverBounds(const Pieces& pieces, double noise, unsigned num_seeds,
                       Count& count) {
  Scene noisy = pieces.scene;
  noisy.load_cases[0].noise_sd = testing::AddNoise(noise, 1, noisy);
  const Eigen::VectorXd bounds =
      PlanLoads(noisy, {{"again", noisy.load_cases[0]}}, pieces.truth, noise)
          .before.OfParameters();
  double square_sum = 0;
  int size = 0;
  for (unsigned seed = 1; seed <= num_seeds; ++seed) {
    Scene scene = pieces.scene;
    testing::AddNoise(noise, seed, scene);
    const Estimate estimate = VirtualFields().Run(scene, {});
    count.Add(estimate, pieces.truth);
    for (Eigen::Index i = 0; i < bounds.size() && estimate.IsUsable(); ++i) {
      const ParameterEstimate& parameter = estimate.parameters[std::size_t(i)];
      square_sum += std::pow((parameter.value - pieces.truth(i)) /
                                 parameter.ErrorUnit() / bounds(i),
                             2);
      ++size;
    }
  }
  return std::sqrt(square_sum / size);
}

// Materials that polynomials over the whole of a specimen do not tell apart
// have fields of their own.
TEST(WindowStatistics, TellFewMaterialsApart) {
  for (const int num_pieces : {3, 4}) {
    Count count;
    EXPECT_LT(ErrorOverBounds(MeasuredPieces(num_pieces), 0.01, 4, count), 2)
        << num_pieces;
    EXPECT_EQ(count.usable, count.estimates) << num_pieces;
    EXPECT_EQ(count.dishonest, 0) << num_pieces;
  }
}

TEST(WindowStatistics, TellManyMaterialsApart) {
  Count count;
  EXPECT_LT(ErrorOverBounds(MeasuredPieces(6), 2e-3, 6, count), 2);
  EXPECT_EQ(count.usable, count.estimates);
  EXPECT_EQ(count.dishonest, 0);
}

// What the check costs is said; that of one material is another.
TEST(DisplacementCheck, IsOfSeveralMaterialsAlone) {
  Scene scene = Block();
  Divide(0.5, 2, scene);
  MeasureMaterials(kSoftBehindStiff, scene);
  testing::AddNoise(0.01, 1, scene);
  const Estimate several = VirtualFields().Run(scene, {});
  ASSERT_TRUE(several.IsUsable()) << several.message;
  EXPECT_GE(several.work.factorizations, 1);
  ASSERT_EQ(several.materials.size(), 2U);
  EXPECT_TRUE(several.materials[0].residual_chi_square.has_value());
  scene.materials.clear();
  EXPECT_EQ(VirtualFields().Run(scene, {}).work.factorizations, 1);
}

}  // namespace
}  // namespace elastimate
