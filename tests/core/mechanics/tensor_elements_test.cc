// Quadratic hexahedra and quadrilaterals: their kernel with the instructions of
// each processor, and how fast their error falls.

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "elastimate/core/equilibrium/equilibrium.h"
#include "elastimate/core/mechanics/stiffness_product.h"
#include "elastimate/core/mechanics/tensor_stiffness_product.h"
#include "elastimate/core/mesh/facets.h"
#include "elastimate/core/mesh/mesh_points.h"
#include "tests/core/instruction_sets.h"
#include "tests/core/random_values.h"
#include "tests/element_kinds.h"

namespace elastimate {
namespace {

using testing::KindOfSection;
using testing::MeshOfKind;
using testing::RandomMatrix;
using testing::TextbookStiffness;

constexpr KindOfSection kTensorKinds[] = {
    {ElementKind::kHex27, SectionModel::kSolid},
    {ElementKind::kQuad9, SectionModel::kPlaneStrain},
    {ElementKind::kQuad9, SectionModel::kPlaneStress}};

// The stiffness c_0 H + c_1 J is that of the moduli of a law.
Eigen::MatrixXd TextbookSum(const Mesh& mesh,
                            const Eigen::Vector2d& coefficients) {
  const double nu = coefficients(1) / coefficients(0);
  const IsotropicElasticity unit = {1, nu};
  const double scale = unit.StiffnessScale(mesh.section.model);
  return coefficients(0) / scale *
         TextbookStiffness(mesh,
                           testing::HookeMatrixOf(unit, mesh.section.model));
}

using TensorByInstructionSet = testing::InstructionSet;

// The last batch of elements may be full or not.
TEST_P(TensorByInstructionSet, ProductEqualsTheTextbookForAnyCount) {
  for (const KindOfSection& kind : kTensorKinds) {
    const Mesh whole = MeshOfKind(kind, DimensionOf(kind.kind) == 3 ? 2 : 4);
    const Eigen::MatrixXd q = RandomMatrix(whole.NumDofs(), 3, 2);
    for (const int num_elements : {1, 3, 4, 5, 8}) {
      SCOPED_TRACE(testing::NameOf(kind) + " " + std::to_string(num_elements));
      Mesh mesh = whole;
      mesh.elements.conservativeResize(Eigen::NoChange, num_elements);
      const Eigen::Matrix2Xd coefficients =
          Eigen::Vector2d(2, 0.6).replicate(1, num_elements) +
          0.1 * RandomMatrix(2, num_elements, 3);
      Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(q.rows(), q.cols());
      for (int e = 0; e < num_elements; ++e) {
        Mesh one = mesh;
        one.elements = mesh.elements.col(e);
        expected += TextbookSum(one, coefficients.col(e)) * q;
      }
      const Eigen::MatrixXd sum =
          MultiplyTensorElements(QuadraticMesh(mesh), coefficients, q);
      EXPECT_TRUE(sum.isApprox(expected, 1e-12));
      StiffnessProducts products;
      MultiplyTensorElements(QuadraticMesh(mesh), q, products);
      EXPECT_TRUE(
          (2 * products.h + 0.6 * products.j)
              .isApprox(TextbookSum(mesh, Eigen::Vector2d(2, 0.6)) * q, 1e-12));
      for (Eigen::Index i = 0; i < q.cols(); ++i) {
        EXPECT_EQ(
            MultiplyTensorElements(QuadraticMesh(mesh), coefficients, q.col(i)),
            sum.col(i));
        StiffnessProducts of_column;
        MultiplyTensorElements(QuadraticMesh(mesh), q.col(i), of_column);
        EXPECT_EQ(of_column.h, products.h.col(i));
        EXPECT_EQ(of_column.j, products.j.col(i));
      }
    }
  }
}

// Differences of equal numbers have no rounding.
TEST_P(TensorByInstructionSet, ProductOfATranslationIsZero) {
  for (const KindOfSection& kind : kTensorKinds) {
    const Mesh mesh = MeshOfKind(kind, 2);
    const Eigen::VectorXd q = Eigen::Vector3d(1e3, -7, 0.1)
                                  .head(mesh.Dimension())
                                  .replicate(mesh.NumNodes(), 1);
    const StiffnessProducts products = MultiplyStiffnessBasis(mesh, q);
    EXPECT_TRUE(products.h.isZero(0));
    EXPECT_TRUE(products.j.isZero(0));
  }
}

INSTANTIATE_TEST_SUITE_P(Supported, TensorByInstructionSet,
                         ::testing::ValuesIn(testing::InstructionSets()),
                         testing::InstructionSetName);

// The gradient of a harmonic function is in equilibrium without a load in any
// isotropic material, in plane strain and in plane stress too.
Eigen::MatrixXd HarmonicGradient(const Eigen::MatrixXd& x) {
  Eigen::MatrixXd u = Eigen::MatrixXd::Zero(x.rows(), x.cols());
  u.row(0) = x.row(0).array().exp() * x.row(1).array().cos();
  u.row(1) = -x.row(0).array().exp() * x.row(1).array().sin();
  return u;
}

// Returns the root mean square error on a distorted block that is held all
// around.
double HarmonicError(const KindOfSection& kind, int cells) {
  const Mesh mesh = MeshOfKind(kind, cells);
  Supports supports;
  supports.held =
      ComponentMask::Constant(mesh.Dimension(), mesh.NumNodes(), false);
  const Eigen::MatrixXi facets = BoundaryFacets(mesh);
  for (const int node : facets.reshaped()) {
    supports.held.col(node).setConstant(true);
  }
  supports.displacement = HarmonicGradient(mesh.nodes);
  const Scene scene = {mesh, {}, supports, {LoadCase()}};
  const Eigen::MatrixXd solution =
      DisplacementsAt(scene, Eigen::Vector2d(2.5, 0.3))
          .reshaped(mesh.Dimension(), mesh.NumNodes());
  std::mt19937_64 generator(1);
  const MeshPoints points = DrawPoints(mesh, 4000, generator);
  const Eigen::MatrixXd error =
      Interpolate(mesh, points, solution) -
      HarmonicGradient(Interpolate(mesh, points, mesh.nodes));
  return error.norm() / std::sqrt(4000.0);
}

// The error falls with the cube of the mesh width.
TEST(TensorElements, AreOfThirdOrder) {
  for (const KindOfSection& kind : kTensorKinds) {
    SCOPED_TRACE(testing::NameOf(kind));
    const double coarse = HarmonicError(kind, 2);
    const double fine = HarmonicError(kind, 4);
    EXPECT_GT(std::log2(coarse / fine), 2.7);
    EXPECT_LT(std::log2(coarse / fine), 3.3);
  }
}

}  // namespace
}  // namespace elastimate
