#include "elastimate/estimators/interface/finding.h"

#include <gtest/gtest.h>

#include <set>

#include "elastimate/estimators/interface/estimate.h"

namespace elastimate {
namespace {

const Finding kWarning{FindingCode::kOutliers, Severity::kWarning, "a", "b"};
const Finding kError{FindingCode::kUnphysical, Severity::kError, "c", "d"};

TEST(Finding, EveryCodeHasItsName) {
  std::set<std::string_view> names;
  int index = 0;
  for (const FindingCode code : AllFindingCodes()) {
    EXPECT_EQ(static_cast<int>(code), index++);
    EXPECT_TRUE(names.insert(FindingCodeName(code)).second);
    EXPECT_NE(StatusOf(code), Status::kOk);
  }
  EXPECT_EQ(AllFindingCodes().back(), FindingCode::kLocalMap);
  EXPECT_EQ(FindingCodeName(FindingCode::kSmoothResidual), "smooth_residual");
}

TEST(Finding, IsEnteredOnce) {
  Estimate estimate;
  estimate.Accept();
  EXPECT_TRUE(estimate.findings.empty());
  estimate.Add(kWarning);
  estimate.Add({kWarning.code, Severity::kWarning, "another", "b"});
  ASSERT_EQ(estimate.findings.size(), 1U);
  EXPECT_TRUE(estimate.Has(FindingCode::kOutliers));
  EXPECT_EQ(estimate.Sentences(Severity::kWarning),
            std::vector<std::string>{"a; b"});
}

TEST(Finding, AFailureLeavesItsReasonAndNoStandardError) {
  Estimate estimate;
  estimate.Accept();
  estimate.Add(kWarning);
  estimate.covariance.setIdentity();
  estimate.Fail(kError);
  EXPECT_EQ(estimate.status, Status::kUnphysical);
  EXPECT_EQ(estimate.message, "c; d");
  EXPECT_TRUE(estimate.covariance.array().isNaN().all());
  EXPECT_FALSE(estimate.why_no_standard_error.empty());
  EXPECT_TRUE(estimate.Has(FindingCode::kOutliers));
  EXPECT_FALSE(estimate.IsRefusedFor(FindingCode::kOutliers));
  EXPECT_TRUE(estimate.IsRefusedFor(FindingCode::kUnphysical));
  // There is one reason.
  estimate.Fail({FindingCode::kOutliers, Severity::kError, "e", "f"});
  ASSERT_EQ(estimate.findings.size(), 1U);
  EXPECT_EQ(estimate.status, Status::kNotIdentifiable);
  EXPECT_EQ(estimate.message, "e; f");
}

}  // namespace
}  // namespace elastimate
