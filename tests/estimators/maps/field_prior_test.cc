#include "elastimate/estimators/maps/field_prior.h"

#include <gtest/gtest.h>

#include <Eigen/Core>

#include "tests/element_kinds.h"
#include "tests/estimators/maps/map_scenes.h"

namespace elastimate::testing {
namespace {

Eigen::MatrixXd DensePrior(const FieldPrior& prior) {
  return prior.Apply(
      Eigen::MatrixXd::Identity(prior.NumElements(), prior.NumElements()));
}

// The field has the variance 1 in each element, also at the surface.
TEST(FieldPrior, HasAnEvenVariance) {
  for (const auto& [kind, cells, least, largest] :
       {std::tuple(ElementKind::kQuad4, 16, 0.95, 1.15),
        std::tuple(ElementKind::kTri3, 12, 0.85, 1.2),
        std::tuple(ElementKind::kHex8, 8, 0.8, 1.3),
        std::tuple(ElementKind::kTet4, 5, 0.7, 1.3)}) {
    const MapScene map = MakeMapScene("hom", kind, cells, 0);
    const Eigen::VectorXd variance =
        DensePrior(FieldPrior(map.scene.mesh)).rowwise().squaredNorm();
    EXPECT_GT(variance.minCoeff(), least) << TopologyOf(kind).name;
    EXPECT_LT(variance.maxCoeff(), largest) << TopologyOf(kind).name;
  }
}

// Neighbours half a length apart are alike, and those far away are not.
TEST(FieldPrior, IsSmoothOverItsLength) {
  const MapScene map = MakeMapScene("hom", ElementKind::kQuad4, 16, 0);
  const Eigen::MatrixXd root = DensePrior(FieldPrior(map.scene.mesh));
  const auto correlation = [&](Eigen::Index a, Eigen::Index b) {
    return root.row(a).normalized().dot(root.row(b).normalized());
  };
  const Eigen::Index middle = 8 * 16 + 4;
  EXPECT_GT(correlation(middle, middle + 1), 0.8);
  // The correlation at the length rho of a Matern field is about 0.14.
  EXPECT_NEAR(correlation(middle, middle + 6), 0.14, 0.1);
  EXPECT_LT(correlation(middle, middle + 11), 0.08);
}

TEST(FieldPrior, HasTransposedAndInverseOfEachKind) {
  for (const KindOfSection& kind : AllKindsOfSections()) {
    const FieldPrior prior(MeshOfKind(kind));
    const Eigen::Index n = prior.NumElements();
    const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(n, -1, 2);
    const Eigen::VectorXd y = x.array().sin();
    const double product = y.dot(prior.Apply(x).col(0));
    EXPECT_NEAR(prior.ApplyTransposed(y).col(0).dot(x), product,
                1e-12 * std::abs(product) + 1e-14)
        << NameOf(kind);
    EXPECT_LT(
        (prior.ApplyInverseTransposed(prior.ApplyTransposed(x)) - x).norm(),
        1e-10 * x.norm())
        << NameOf(kind);
    EXPECT_LT((prior.ApplyInverse(prior.Apply(x)) - x).norm(), 1e-10 * x.norm())
        << NameOf(kind);
  }
}

// A body in millimetres has the same field as one in metres.
TEST(FieldPrior, DoesNotDependOnUnits) {
  Mesh mesh = MakeMapScene("hom", ElementKind::kHex8, 3, 0).scene.mesh;
  const Eigen::MatrixXd in_metres = DensePrior(FieldPrior(mesh));
  mesh.nodes *= 1000;
  EXPECT_LT((DensePrior(FieldPrior(mesh)) - in_metres).norm(),
            1e-10 * in_metres.norm());
}

}  // namespace
}  // namespace elastimate::testing
