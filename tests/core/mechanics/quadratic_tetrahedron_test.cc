// Everything of core that takes a mesh, on quadratic tetrahedra.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "elastimate/core/laws/elasticity.h"
#include "elastimate/core/mechanics/internal_forces.h"
#include "elastimate/core/mechanics/stiffness_assembly.h"
#include "elastimate/core/mechanics/stiffness_product.h"
#include "elastimate/core/mechanics/stiffness_traces.h"
#include "elastimate/core/mechanics/tet10_stiffness_product.h"
#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/mesh/middle_nodes.h"
#include "elastimate/core/scene/degrees_of_freedom.h"
#include "elastimate/core/scene/quadratic_scene.h"
#include "tests/core/instruction_sets.h"
#include "tests/core/mechanics/strain_energy.h"
#include "tests/core/random_values.h"
#include "tests/dense_reference.h"
#include "tests/element_kinds.h"
#include "tests/quadratic_reference.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

using testing::BoxMesh;
using testing::DenseDH;
using testing::DenseDJ;
using testing::Distorted;
using testing::ForEachGaussPoint;
using testing::HookeMatrix;
using testing::QuadraticField;
using testing::QuadraticShapeFunctions;
using testing::RandomMatrix;
using testing::RandomSupports;
using testing::StrainEnergyDensity;
using testing::TextbookStiffness;
using testing::WithBothOrientations;
using testing::WithMidEdgeNodes;

// A row sums some thousand products that have each lost one or two digits to
// the differences of node positions; the reference loses two more to the
// inverse of its matrix of monomials.
constexpr double kQuadraticRounding = 1e-13;
constexpr double kReferenceRounding = 1e-12;

class QuadraticTetrahedra : public ::testing::Test {
 protected:
  QuadraticTetrahedra()
      : linear_(
            WithBothOrientations(Distorted(BoxMesh({2, 2, 2}, {1, 0.8, 1.2})))),
        mesh_(WithMidEdgeNodes(linear_)),
        dense_h_(TextbookStiffness(mesh_, DenseDH())),
        dense_j_(TextbookStiffness(mesh_, DenseDJ())),
        q_(RandomMatrix(3 * mesh_.NumNodes(), 3, 1)) {}

  // Largest entry of |K| |q|: what rounding is relative to.
  double Scale(const Eigen::MatrixXd& q) const {
    return (dense_j_.cwiseAbs() * q.cwiseAbs()).maxCoeff();
  }

  // For each node whether it lies on the surface.
  std::vector<bool> OnSurface() const {
    std::vector<bool> on_surface(mesh_.NumNodes(), false);
    const Eigen::MatrixXi facets = BoundaryFacets(mesh_);
    for (const int node : facets.reshaped()) {
      on_surface[node] = true;
    }
    return on_surface;
  }

  Mesh linear_;
  Mesh mesh_;
  Eigen::MatrixXd dense_h_;
  Eigen::MatrixXd dense_j_;
  Eigen::MatrixXd q_;
};

TEST_F(QuadraticTetrahedra, AreAValidMesh) {
  EXPECT_NO_THROW(ValidateMesh(mesh_));
  EXPECT_EQ(mesh_.Order(), 2);
  EXPECT_EQ(mesh_.NumVertices(), linear_.NumNodes());
  EXPECT_EQ(linear_.Order(), 1);
  EXPECT_EQ(linear_.NumVertices(), linear_.NumNodes());
}

TEST_F(QuadraticTetrahedra, ProductEqualsTheTextbookStiffness) {
  const StiffnessProducts products = MultiplyStiffnessBasis(mesh_, q_);
  const double tolerance = kReferenceRounding * Scale(q_);
  EXPECT_LT((products.h - dense_h_ * q_).cwiseAbs().maxCoeff(), tolerance);
  EXPECT_LT((products.j - dense_j_ * q_).cwiseAbs().maxCoeff(), tolerance);
}

// Two kernels of the library that share no formula.
TEST_F(QuadraticTetrahedra, ProductEqualsTheAssembledStiffness) {
  const Supports free = {ComponentMask::Constant(3, mesh_.NumNodes(), false),
                         Eigen::MatrixXd::Zero(3, mesh_.NumNodes())};
  const StiffnessAssembly assembly(mesh_, DegreesOfFreedom(free));
  const SymmetricPattern& pattern = assembly.Pattern();
  Eigen::MatrixXd h = Eigen::MatrixXd::Zero(q_.rows(), q_.cols());
  Eigen::MatrixXd j = h;
  for (std::int64_t column = 0; column < pattern.Size(); ++column) {
    for (std::int64_t k = pattern.column_start[column];
         k < pattern.column_start[column + 1]; ++k) {
      const std::int64_t row = pattern.row[k];
      h.row(row) += assembly.H()(k) * q_.row(column);
      j.row(row) += assembly.J()(k) * q_.row(column);
      if (row != column) {
        h.row(column) += assembly.H()(k) * q_.row(row);
        j.row(column) += assembly.J()(k) * q_.row(row);
      }
    }
  }
  const StiffnessProducts products = MultiplyStiffnessBasis(mesh_, q_);
  const double tolerance = kQuadraticRounding * Scale(q_);
  EXPECT_LT((products.h - h).cwiseAbs().maxCoeff(), tolerance);
  EXPECT_LT((products.j - j).cwiseAbs().maxCoeff(), tolerance);
}

TEST_F(QuadraticTetrahedra, ProductOfSeveralColumnsIsThatOfEachBitForBit) {
  const StiffnessProducts all = MultiplyStiffnessBasis(mesh_, q_);
  for (Eigen::Index i = 0; i < q_.cols(); ++i) {
    const StiffnessProducts one = MultiplyStiffnessBasis(mesh_, q_.col(i));
    EXPECT_EQ(one.h, all.h.col(i));
    EXPECT_EQ(one.j, all.j.col(i));
  }
  const StiffnessProducts none =
      MultiplyStiffnessBasis(mesh_, Eigen::MatrixXd(q_.rows(), 0));
  EXPECT_EQ(none.h.rows(), q_.rows());
  EXPECT_EQ(none.j.cols(), 0);
}

// Each coefficient counts in its own element alone.
TEST_F(QuadraticTetrahedra, ProductOfCoefficientsIsTheSumOverElements) {
  const Eigen::Matrix2Xd coefficients = RandomMatrix(2, mesh_.NumElements(), 7);
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(q_.rows(), q_.cols());
  for (Eigen::Index e = 0; e < mesh_.NumElements(); ++e) {
    Mesh one = mesh_;
    one.elements = mesh_.elements.col(e);
    expected += TextbookStiffness(one, coefficients(0, e) * DenseDH() +
                                           coefficients(1, e) * DenseDJ()) *
                q_;
  }
  const Eigen::MatrixXd product =
      MultiplyQuadraticTetrahedra(QuadraticMesh(mesh_), coefficients, q_);
  EXPECT_LT((product - expected).cwiseAbs().maxCoeff(),
            kReferenceRounding * Scale(q_) *
                coefficients.cwiseAbs().colwise().sum().maxCoeff());
  for (Eigen::Index i = 0; i < q_.cols(); ++i) {
    EXPECT_EQ(MultiplyQuadraticTetrahedra(QuadraticMesh(mesh_), coefficients,
                                          q_.col(i)),
              product.col(i));
  }
}

using QuadraticByInstructionSet = testing::InstructionSet;

// The last batch of elements and the last group of columns may be full or not.
TEST_P(QuadraticByInstructionSet, ProductEqualsTheTextbookForAnyCount) {
  const Mesh whole = WithMidEdgeNodes(
      WithBothOrientations(Distorted(BoxMesh({2, 1, 2}, {1, 0.8, 1.2}))));
  const Eigen::MatrixXd q = RandomMatrix(3 * whole.NumNodes(), 9, 2);
  for (const int num_elements : {1, 3, 4, 5, 7, 8, 9, 16, 17}) {
    Mesh mesh = whole;
    mesh.elements.conservativeResize(10, num_elements);
    const Eigen::MatrixXd h = TextbookStiffness(mesh, DenseDH());
    const Eigen::MatrixXd j = TextbookStiffness(mesh, DenseDJ());
    const double tolerance =
        kReferenceRounding * (j.cwiseAbs() * q.cwiseAbs()).maxCoeff();
    for (const int num_columns : {1, 4, 5, 9}) {
      SCOPED_TRACE(std::to_string(num_elements) + " elements, " +
                   std::to_string(num_columns) + " columns");
      const Eigen::MatrixXd columns = q.leftCols(num_columns);
      const StiffnessProducts products = MultiplyStiffnessBasis(mesh, columns);
      EXPECT_LT((products.h - h * columns).cwiseAbs().maxCoeff(), tolerance);
      EXPECT_LT((products.j - j * columns).cwiseAbs().maxCoeff(), tolerance);
      const Eigen::MatrixXd sum = MultiplyQuadraticTetrahedra(
          QuadraticMesh(mesh),
          Eigen::Vector2d(2, -0.5).replicate(1, num_elements), columns);
      EXPECT_LT((sum - (2 * h - 0.5 * j) * columns).cwiseAbs().maxCoeff(),
                3 * tolerance);
    }
  }
}

TEST_P(QuadraticByInstructionSet, ProductOfATranslationIsZero) {
  const Mesh mesh = WithMidEdgeNodes(Distorted(BoxMesh({2, 1, 2}, {1, 1, 1})));
  const Eigen::VectorXd q =
      Eigen::Vector3d(1e3, -7, 0.1).replicate(mesh.NumNodes(), 1);
  const StiffnessProducts products = MultiplyStiffnessBasis(mesh, q);
  EXPECT_TRUE(products.h.isZero(0));
  EXPECT_TRUE(products.j.isZero(0));
}

INSTANTIATE_TEST_SUITE_P(Supported, QuadraticByInstructionSet,
                         ::testing::ValuesIn(testing::InstructionSets()),
                         testing::InstructionSetName);

TEST_F(QuadraticTetrahedra, ProductOfARigidMotionIsZero) {
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::VectorXd translation =
        (1e3 * Eigen::Vector3d::Unit(axis)).replicate(mesh_.NumNodes(), 1);
    const StiffnessProducts of_translation =
        MultiplyStiffnessBasis(mesh_, translation);
    // Differences of equal numbers have no rounding.
    EXPECT_TRUE(of_translation.h.isZero(0));
    EXPECT_TRUE(of_translation.j.isZero(0));

    Eigen::MatrixXd rotation = mesh_.nodes;
    for (auto column : rotation.colwise()) {
      column =
          Eigen::Vector3d::Unit(axis).cross(Eigen::Vector3d(column)).eval();
    }
    const StiffnessProducts of_rotation =
        MultiplyStiffnessBasis(mesh_, rotation.reshaped());
    const double tolerance = kQuadraticRounding * Scale(rotation.reshaped());
    EXPECT_LT(of_rotation.h.cwiseAbs().maxCoeff(), tolerance);
    EXPECT_LT(of_rotation.j.cwiseAbs().maxCoeff(), tolerance);
  }
}

TEST_F(QuadraticTetrahedra, ProductIsSymmetric) {
  const StiffnessProducts products = MultiplyStiffnessBasis(mesh_, q_);
  const double tolerance =
      kQuadraticRounding * Scale(q_) * static_cast<double>(q_.rows());
  for (const Eigen::MatrixXd& gram :
       {Eigen::MatrixXd(q_.transpose() * products.h),
        Eigen::MatrixXd(q_.transpose() * products.j)}) {
    EXPECT_LT((gram - gram.transpose()).cwiseAbs().maxCoeff(), tolerance);
  }
  for (Eigen::Index i = 0; i < q_.cols(); ++i) {
    EXPECT_GT(q_.col(i).dot(products.h.col(i)), 0);
  }
}

// The patch test: a uniform stress is in equilibrium inside.
TEST_F(QuadraticTetrahedra, ProductOfALinearFieldIsZeroInside) {
  const Eigen::VectorXd q =
      (QuadraticField().gradient * mesh_.nodes).reshaped();
  const StiffnessProducts products = MultiplyStiffnessBasis(mesh_, q);
  const std::vector<bool> on_surface = OnSurface();
  const double tolerance = kQuadraticRounding * Scale(q);
  int num_interior = 0;
  for (Eigen::Index node = 0; node < mesh_.NumNodes(); ++node) {
    if (!on_surface[node]) {
      ++num_interior;
      EXPECT_LT(products.h.middleRows<3>(3 * node).norm(), tolerance);
      EXPECT_LT(products.j.middleRows<3>(3 * node).norm(), tolerance);
    }
  }
  // A grid of 5^3 points has 3^3 inside.
  EXPECT_EQ(num_interior, 27);
  EXPECT_GT(products.h.norm(), 0.01);
}

// A displacement that is linear in each element is the same in both spaces:
// its energy with any other such displacement is that of linear elements.
TEST_F(QuadraticTetrahedra, ContainTheLinearOnes) {
  const Eigen::VectorXd linear = q_.col(0).head(3 * linear_.NumNodes());
  Eigen::VectorXd interpolated(3 * mesh_.NumNodes());
  interpolated.head(linear.size()) = linear;
  constexpr int kEnds[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
  for (Eigen::Index e = 0; e < mesh_.NumElements(); ++e) {
    for (int i = 0; i < 6; ++i) {
      const Eigen::Index node = mesh_.elements(4 + i, e);
      const Eigen::Index a = linear_.elements(kEnds[i][0], e);
      const Eigen::Index b = linear_.elements(kEnds[i][1], e);
      interpolated.segment<3>(3 * node) =
          (linear.segment<3>(3 * a) + linear.segment<3>(3 * b)) / 2;
    }
  }
  const StiffnessProducts expected = MultiplyStiffnessBasis(linear_, linear);
  const StiffnessProducts products =
      MultiplyStiffnessBasis(mesh_, interpolated);
  const double tolerance = kQuadraticRounding * Scale(interpolated);
  EXPECT_LT((MiddleNodes(mesh_).Restrict(products.h) - expected.h)
                .cwiseAbs()
                .maxCoeff(),
            tolerance);
  EXPECT_LT((MiddleNodes(mesh_).Restrict(products.j) - expected.j)
                .cwiseAbs()
                .maxCoeff(),
            tolerance);
  EXPECT_EQ(MiddleNodes(linear_).Restrict(expected.h), expected.h);
}

TEST_F(QuadraticTetrahedra, AssembleIntoTheTextbookStiffness) {
  for (const int seed : {1, 2, 3}) {
    const DegreesOfFreedom dofs(RandomSupports(mesh_.NumNodes(), seed));
    const StiffnessAssembly assembly(mesh_, dofs);
    const SymmetricPattern& pattern = assembly.Pattern();
    ASSERT_EQ(pattern.Size(), dofs.NumFree());
    Eigen::MatrixXd h = Eigen::MatrixXd::Zero(dofs.NumFree(), dofs.NumFree());
    Eigen::MatrixXd j = h;
    for (std::int64_t column = 0; column < pattern.Size(); ++column) {
      for (std::int64_t k = pattern.column_start[column];
           k < pattern.column_start[column + 1]; ++k) {
        h(pattern.row[k], column) = assembly.H()(k);
        j(pattern.row[k], column) = assembly.J()(k);
      }
    }
    const Eigen::MatrixXd expected_h = dense_h_(dofs.free, dofs.free);
    const Eigen::MatrixXd expected_j = dense_j_(dofs.free, dofs.free);
    const double tolerance =
        kReferenceRounding * expected_j.cwiseAbs().maxCoeff();
    EXPECT_LT((h - Eigen::MatrixXd(expected_h.triangularView<Eigen::Lower>()))
                  .cwiseAbs()
                  .maxCoeff(),
              tolerance);
    EXPECT_LT((j - Eigen::MatrixXd(expected_j.triangularView<Eigen::Lower>()))
                  .cwiseAbs()
                  .maxCoeff(),
              tolerance);
  }
}

TEST_F(QuadraticTetrahedra, TracesEqualTheSumsOverTheFreeRowsAndColumns) {
  const DegreesOfFreedom dofs(RandomSupports(mesh_.NumNodes(), 5));
  const Eigen::MatrixXd h = dense_h_(dofs.free, dofs.free);
  const Eigen::MatrixXd j = dense_j_(dofs.free, dofs.free);
  Eigen::Matrix2d expected;
  expected << h.squaredNorm(), h.cwiseProduct(j).sum(), h.cwiseProduct(j).sum(),
      j.squaredNorm();
  EXPECT_TRUE(StiffnessTraces(mesh_, InternalForces(mesh_, {}), dofs)
                  .isApprox(expected, 1e-12));
}

TEST_F(QuadraticTetrahedra, StrainEnergyIsTheMeanOverTheElement) {
  const IsotropicElasticity elasticity{2.5, 0.3};
  const Eigen::MatrixXd u = q_.col(0).reshaped(3, mesh_.NumNodes());
  const Eigen::VectorXd density = StrainEnergyDensity(mesh_, elasticity, u);
  ASSERT_EQ(density.size(), mesh_.NumElements());
  const Eigen::Matrix<double, 6, 6> hooke = HookeMatrix<double>(2.5, 0.3);
  for (Eigen::Index e = 0; e < mesh_.NumElements(); ++e) {
    const QuadraticShapeFunctions shape(mesh_, e);
    Eigen::Matrix<double, 30, 1> q;
    for (int i = 0; i < 10; ++i) {
      q.segment<3>(3 * Eigen::Index(i)) = u.col(mesh_.elements(i, e));
    }
    double expected = 0;
    ForEachGaussPoint([&](const Eigen::Vector4d& point, double weight) {
      const Eigen::Matrix<double, 6, 1> strain =
          shape.StrainDisplacement(shape.Position(point)) * q;
      expected += weight * strain.dot(hooke * strain) / 2;
    });
    EXPECT_NEAR(density(e) / expected, 1, kReferenceRounding);
  }
}

TEST_F(QuadraticTetrahedra, FacetsAreThoseOfTheVerticesAndTheirMiddles) {
  const Eigen::MatrixXi facets = BoundaryFacets(mesh_);
  ASSERT_EQ(facets.rows(), 6);
  EXPECT_EQ(facets.topRows<3>(), BoundaryFacets(linear_));
  for (Eigen::Index i = 0; i < facets.cols(); ++i) {
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d middle = (mesh_.nodes.col(facets(k, i)) +
                                      mesh_.nodes.col(facets((k + 1) % 3, i))) /
                                     2;
      EXPECT_EQ(mesh_.nodes.col(facets(3 + k, i)), middle);
    }
  }
}

TEST_F(QuadraticTetrahedra, HaveTheAnglesOfTheirVertices) {
  EXPECT_EQ(SmallestDihedralAngles(mesh_), SmallestDihedralAngles(linear_));
}

}  // namespace
}  // namespace elastimate
