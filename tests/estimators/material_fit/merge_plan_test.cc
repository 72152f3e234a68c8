#include "elastimate/estimators/material_fit/merge_plan.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

namespace elastimate {
namespace {

// So that all are compared.
const Eigen::VectorXd kLargeErrors = Eigen::VectorXd::Constant(6, 1e3);

std::vector<Material> MaterialsApart(int num) {
  std::vector<Material> materials;
  for (int region = 1; region <= num; ++region) {
    materials.push_back({"isotropic", {region}, {}, {}});
  }
  return materials;
}

Eigen::MatrixXd SomeCovariance(Eigen::Index n) {
  std::srand(3);
  const Eigen::MatrixXd root = Eigen::MatrixXd::Random(n, n);
  return 1e-4 * (root * root.transpose() + Eigen::MatrixXd::Identity(n, n));
}

// Says which of the groups 0 2, 1 has each variable.
Eigen::MatrixXd Spread() {
  Eigen::MatrixXd spread = Eigen::MatrixXd::Zero(6, 4);
  for (int i = 0; i < 2; ++i) {
    spread(i, i) = 1;
    spread(2 + i, 2 + i) = 1;
    spread(4 + i, i) = 1;
  }
  return spread;
}

TEST(MergePlan, IsGeneralisedLeastSquares) {
  const std::vector<Material> materials = MaterialsApart(3);
  const MaterialParameters parameters(materials, SectionModel::kSolid);
  Eigen::VectorXd x(6);
  x << 8.5, 0.30, 9.5, 0.20, 8.51, 0.31;
  const Eigen::MatrixXd covariance = SomeCovariance(6);
  const MergePlan plan =
      PlanMerges(materials, parameters, kLargeErrors, {x, covariance}, 1e3);
  ASSERT_EQ(plan.path.size(), 2U);
  EXPECT_EQ(plan.path[0].groups, MaterialGroups({{0, 2}, {1}}));
  const Eigen::MatrixXd spread = Spread();
  const Eigen::MatrixXd weighted = covariance.inverse() * spread;
  const Eigen::VectorXd merged =
      (spread.transpose() * weighted).ldlt().solve(weighted.transpose() * x);
  EXPECT_LT((plan.path[0].variables - merged).norm(), 1e-9 * merged.norm());
  const Eigen::VectorXd rest = x - spread * merged;
  const double chi_square = rest.dot(covariance.inverse() * rest);
  EXPECT_NEAR(plan.path[0].chi_square, chi_square, 1e-8 * chi_square);
  double sum = 0;
  for (const PlannedMerge& merge : plan.path) {
    sum += merge.chi_square;
    EXPECT_NEAR(DistanceOfGroups(merge.groups, parameters, {x, covariance},
                                 merge.variables),
                sum, 1e-6 * sum);
  }
}

TEST(MergePlan, TakesTheStepsThatTheCriterionAllows) {
  const std::vector<Material> materials = MaterialsApart(3);
  const MaterialParameters parameters(materials, SectionModel::kSolid);
  const Eigen::MatrixXd covariance = 1e-4 * Eigen::MatrixXd::Identity(6, 6);
  const double n = 1e4;
  const double allowed = std::sqrt(2 * 2 * std::log(n)) * 1e-2;
  for (const double share : {0.9, 1.1}) {
    Eigen::VectorXd x(6);
    x << 8.5, 0.3, 9.5, 0.2, 8.5 + share * allowed, 0.3;
    const MergePlan plan =
        PlanMerges(materials, parameters, kLargeErrors, {x, covariance}, n);
    EXPECT_NEAR(plan.path[0].limit, 2 * std::log(n), 1e-12);
    EXPECT_NEAR(plan.path[0].chi_square / plan.path[0].limit, share * share,
                1e-12);
    EXPECT_EQ(plan.num_taken, share < 1 ? 1U : 0U);
  }
}

TEST(MergePlan, KeepsApartWhatIsOfAnotherKind) {
  std::vector<Material> materials = MaterialsApart(4);
  materials[1].known = {{"poisson_ratio", 0.3}};
  materials[3].known = {{"poisson_ratio", 0.3}};
  const MaterialParameters parameters(materials, SectionModel::kSolid);
  const Eigen::VectorXd x =
      (Eigen::VectorXd(6) << 8, .3, 8, 8, .3, 8).finished();
  const MergePlan plan =
      PlanMerges(materials, parameters, kLargeErrors,
                 {x, 1e-4 * Eigen::MatrixXd::Identity(6, 6)}, 1e3);
  EXPECT_EQ(plan.num_taken, 2U);
  ASSERT_EQ(plan.path.size(), 2U);
  EXPECT_EQ(plan.path[1].groups, MaterialGroups({{0, 2}, {1, 3}}));
  const std::vector<Material> merged =
      MaterialsOfGroups(materials, plan.path[1].groups);
  ASSERT_EQ(merged.size(), 2U);
  EXPECT_EQ(merged[0].regions, std::vector<int>({1, 3}));
  EXPECT_EQ(merged[1].known, materials[1].known);
}

// The first is known to so little that it is near both others.
TEST(MergePlan, LeavesOutWhatIsNotDetermined) {
  const std::vector<Material> materials = MaterialsApart(3);
  const MaterialParameters parameters(materials, SectionModel::kSolid);
  Eigen::VectorXd x(6);
  x << 8.5, 0.3, 9.5, 0.2, 9.5, 0.2;
  Eigen::VectorXd variances = Eigen::VectorXd::Constant(6, 1e-4);
  variances.head(2).setConstant(25);
  const Eigen::VectorXd largest = Eigen::VectorXd::Constant(6, 0.3);
  const MergePlan plan = PlanMerges(materials, parameters, largest,
                                    {x, variances.asDiagonal()}, 1e3);
  ASSERT_EQ(plan.path.size(), 1U);
  EXPECT_EQ(plan.num_taken, 1U);
  EXPECT_EQ(plan.path[0].groups, MaterialGroups({{0}, {1, 2}}));
}

// It hangs on another, of which the third knows more.
TEST(MergePlan, ComparesWhatBecomesDetermined) {
  const std::vector<Material> materials = MaterialsApart(3);
  const MaterialParameters parameters(materials, SectionModel::kSolid);
  Eigen::VectorXd x(6);
  x << 8.5, 0.3, 8.5, 0.3, 8.5, 0.3;
  // The sum of the first two is known to 0.01.
  Eigen::MatrixXd covariance = 1e-4 * Eigen::MatrixXd::Identity(6, 6);
  for (int i = 0; i < 2; ++i) {
    covariance(i, i) = covariance(2 + i, 2 + i) += 0.04;
    covariance(i, 2 + i) = covariance(2 + i, i) = -0.04;
  }
  for (const double largest : {0.1, 0.21}) {
    const MergePlan plan = PlanMerges(
        materials, parameters,
        (Eigen::VectorXd(6) << 0.1, 0.1, largest, largest, 0.1, 0.1).finished(),
        {x, covariance}, 1e3);
    EXPECT_EQ(plan.num_taken, largest < 0.2 ? 0U : 2U);
  }
}

// The first two of three members are as far apart as their errors say.
TEST(MergePlan, TellsHowMembersSpread) {
  const std::vector<Material> materials = MaterialsApart(3);
  const MaterialParameters parameters(materials, SectionModel::kSolid);
  Eigen::VectorXd x(6);
  x << 8, 0.3, 8.1, 0.3, 9, 0.3;
  const Eigen::MatrixXd covariance =
      Eigen::VectorXd::Constant(6, 1e-4).asDiagonal();
  const std::vector<MemberSpread> spreads = SpreadOfMembers(
      {{0, 1}, {2}}, parameters, {x, 4 * covariance}, covariance, 100);
  // Each is 0.05 from the mean, with half of the variance of its noise.
  EXPECT_NEAR(spreads[0].variance(0), 0.05 * 0.05 - 0.5e-4, 1e-12);
  EXPECT_EQ(spreads[0].variance(1), 0);
  EXPECT_NEAR(spreads[0].largest_differences(0), 0.1 + 1.96 * std::sqrt(8e-4),
              1e-12);
  EXPECT_NEAR(spreads[0].largest_differences(1), 1.96 * std::sqrt(8e-4), 1e-12);
  // d^2 = 0.1^2 / 8e-4, of two variables.
  const double apart =
      1 / (1 + std::exp((2 * std::log(100) - 0.1 * 0.1 / 8e-4) / 2));
  EXPECT_GT(apart, 0.5);
  for (const Eigen::Index member : {0, 1}) {
    EXPECT_NEAR(spreads[0].errors(0, member),
                std::sqrt((1 - apart) * 2e-4 + apart * (4e-4 + 0.05 * 0.05)),
                1e-12);
    EXPECT_NEAR(spreads[0].errors(1, member),
                std::sqrt((1 - apart) * 2e-4 + apart * 4e-4), 1e-12);
  }
  EXPECT_EQ(spreads[1].variance, Eigen::Vector2d::Zero());
  EXPECT_EQ(spreads[1].largest_differences, Eigen::Vector2d::Zero());
}

// The best known one of ten members is off by 0.015: it pulls the others, as
// far as it may be another.
TEST(MergePlan, HoldsWhatOneMemberPullsTheOthersBy) {
  constexpr int kMembers = 10;
  const std::vector<Material> materials = MaterialsApart(kMembers);
  const MaterialParameters parameters(materials, SectionModel::kSolid);
  Eigen::VectorXd x(2 * kMembers);
  Eigen::VectorXd variances(2 * kMembers);
  MaterialGroups groups(1);
  for (int i = 0; i < kMembers; ++i) {
    const bool is_last = i + 1 == kMembers;
    x.segment<2>(2 * i) << (is_last ? 8.015 : 8), 0.3;
    variances.segment<2>(2 * i).setConstant(is_last ? 9e-6 : 1e-4);
    groups[0].push_back(std::size_t(i));
  }
  const Eigen::MatrixXd covariance = variances.asDiagonal();
  const MemberSpread spread =
      SpreadOfMembers(groups, parameters, {x, covariance}, covariance, 100)[0];
  const double of_rest = 1e-4 / 9;
  const double apart =
      1 / (1 + std::exp((2 * std::log(100) - 0.015 * 0.015 / (of_rest + 9e-6)) /
                        2));
  const double pull = 0.015 * of_rest / (of_rest + 9e-6);
  EXPECT_NEAR(spread.variance(0), apart * pull * pull, 1e-12);
  EXPECT_NEAR(spread.variance(1), 0, 1e-12);
}

TEST(MergePlan, MakesOneOfAll) {
  EXPECT_TRUE(MaterialsOfGroups(MaterialsApart(3), {{0, 1, 2}}).empty());
  std::vector<Material> known = MaterialsApart(2);
  for (Material& material : known) {
    material.known = {{"poisson_ratio", 0.3}};
  }
  const std::vector<Material> merged = MaterialsOfGroups(known, {{0, 1}});
  ASSERT_EQ(merged.size(), 1U);
  EXPECT_TRUE(merged[0].regions.empty());
}

}  // namespace
}  // namespace elastimate
