// Tests of pressures that follow the deformed surface.

#include "elastimate/core/mechanics/follower_pressure.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "elastimate/core/mesh/facets.h"
#include "elastimate/core/mesh/shape_functions.h"
#include "elastimate/core/scene/loads.h"
#include "tests/core/random_values.h"
#include "tests/element_kinds.h"

namespace elastimate {
namespace {

using testing::KindOfSection;
using testing::RandomMatrix;

class FollowerPressures : public ::testing::TestWithParam<KindOfSection> {
 protected:
  Eigen::VectorXd Displacement() const {
    return 0.05 * mesh_.nodes.maxCoeff() * RandomMatrix(mesh_.NumDofs(), 1, 3);
  }
  // A pressure on the facets of which all nodes are in the upper half.
  Pressure OfHalf() const {
    const Eigen::VectorXd row = mesh_.nodes.row(0);
    const double middle = (row.minCoeff() + row.maxCoeff()) / 2;
    return {BoundaryFacetsWhere(mesh_,
                                [&](int node) { return row(node) > middle; }),
            2.5, true};
  }
  // Returns dF / du by central differences.
  Eigen::MatrixXd Differences(const FollowerPressure& pressure,
                              const Eigen::VectorXd& u) const {
    constexpr double kStep = 1e-5;
    Eigen::MatrixXd slopes(u.size(), u.size());
    for (Eigen::Index i = 0; i < u.size(); ++i) {
      const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(u.size(), i);
      slopes.col(i) =
          (pressure.Forces(u + step) - pressure.Forces(u - step)) / (2 * kStep);
    }
    return slopes;
  }
  // Returns the symmetric part of dF / du.
  Eigen::MatrixXd Tangent(const FollowerPressure& pressure,
                          const Eigen::VectorXd& u) const {
    const Eigen::Index d = mesh_.Dimension();
    const NodeGraph graph(mesh_);
    Eigen::MatrixXd blocks = Eigen::MatrixXd::Zero(d, d * graph.NumPairs());
    pressure.AddSymmetricBlocks(u, 1, graph, blocks);
    Eigen::MatrixXd tangent = Eigen::MatrixXd::Zero(u.size(), u.size());
    for (Eigen::Index j = 0; j < mesh_.NumNodes(); ++j) {
      for (Eigen::Index k = graph.start[j]; k < graph.start[j + 1]; ++k) {
        const auto block = blocks.middleCols(d * k, d);
        tangent.block(d * graph.row[k], d * j, d, d) = block;
        tangent.block(d * j, d * graph.row[k], d, d) = block.transpose();
      }
    }
    return tangent;
  }

  Mesh mesh_ = testing::MeshOfKind(GetParam(), 2);
};

TEST_P(FollowerPressures, PushAsDeadOnesDoAtRest) {
  const Load load = OfHalf();
  const Eigen::VectorXd forces =
      FollowerPressure(mesh_, {load})
          .Forces(Eigen::VectorXd::Zero(mesh_.NumDofs()));
  EXPECT_GT(forces.norm(), 0.1);
  EXPECT_TRUE(forces.isApprox(
      Eigen::VectorXd(AssembleLoads(mesh_, {load}).reshaped()), 1e-12));
  const Load dead = Pressure{OfHalf().facets, 2.5};
  EXPECT_TRUE(FollowerPressure(mesh_, {dead})
                  .Forces(Eigen::VectorXd::Zero(mesh_.NumDofs()))
                  .isZero(0));
}

TEST_P(FollowerPressures, TurnWithTheSurface) {
  const FollowerPressure pressure(mesh_, {OfHalf()});
  const Eigen::Index d = mesh_.Dimension();
  const Eigen::VectorXd u = Displacement();
  Eigen::MatrixXd turn = Eigen::Rotation2Dd(0.8).toRotationMatrix();
  if (d == 3) {
    turn =
        Eigen::AngleAxisd(0.8, Eigen::Vector3d(2, 1, 2) / 3).toRotationMatrix();
  }
  const Eigen::MatrixXd turned =
      turn * (mesh_.nodes + u.reshaped(d, mesh_.NumNodes())) - mesh_.nodes;
  EXPECT_TRUE(
      pressure.Forces(turned.reshaped())
          .reshaped(d, mesh_.NumNodes())
          .isApprox(turn * pressure.Forces(u).reshaped(d, mesh_.NumNodes()),
                    1e-12));
}

TEST_P(FollowerPressures, HaveTheSymmetricPartOfTheirDerivative) {
  const FollowerPressure pressure(mesh_, {OfHalf()});
  const Eigen::VectorXd u = Displacement();
  const Eigen::MatrixXd slopes = Differences(pressure, u);
  // The edge of the surface is free.
  EXPECT_GT((slopes - slopes.transpose()).norm(), 0.01 * slopes.norm());
  EXPECT_LT((Tangent(pressure, u) - (slopes + slopes.transpose()) / 2).norm(),
            1e-8 * slopes.norm());
}

// On a closed surface the force is p times the gradient of the volume within.
TEST_P(FollowerPressures, HaveASymmetricDerivativeOnAClosedSurface) {
  const FollowerPressure pressure(mesh_,
                                  {Pressure{BoundaryFacets(mesh_), 2.5, true}});
  const Eigen::VectorXd u = Displacement();
  const Eigen::VectorXd forces = pressure.Forces(u);
  const Eigen::MatrixXd slopes = Differences(pressure, u);
  EXPECT_LT((slopes - slopes.transpose()).norm(), 1e-8 * slopes.norm());
  EXPECT_LT((Tangent(pressure, u) - slopes).norm(), 1e-8 * slopes.norm());
  // A uniform growth by 1 changes the volume V by d V.
  const Eigen::Index d = mesh_.Dimension();
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(u.size());
  EXPECT_NEAR(pressure.Forces(rest).dot(mesh_.nodes.reshaped()),
              -2.5 * double(d) * ElementVolumes(mesh_).sum(),
              1e-12 * double(d) * 2.5 * ElementVolumes(mesh_).sum());
  EXPECT_LT(forces.reshaped(d, mesh_.NumNodes()).rowwise().sum().norm(),
            1e-12 * forces.norm());
}

INSTANTIATE_TEST_SUITE_P(Kinds, FollowerPressures,
                         ::testing::ValuesIn(testing::AllKindsOfSections()),
                         [](const auto& info) {
                           return testing::NameOf(info.param);
                         });

}  // namespace
}  // namespace elastimate
