#include "elastimate/estimators/interface/finding_sentences.h"

#include <gtest/gtest.h>
#include <regex.h>

#include <cmath>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

namespace elastimate {
namespace {
TEST(OneCombination, NamesTheModulusThatStays) {
  const IsotropicElasticity elasticity{100, 0.25};
  EXPECT_NE(
      OneCombination(elasticity, {0, 1}).text.find("Young's modulus = 100"),
      std::string::npos);
  EXPECT_NE(OneCombination(elasticity, {1 / 1.25, 1})
                .text.find("the shear modulus = 40"),
            std::string::npos);
  EXPECT_NE(OneCombination(elasticity, {-2 / 0.5, 1})
                .text.find("the bulk modulus = 66.6667"),
            std::string::npos);
  EXPECT_EQ(OneCombination(elasticity, {1, 0}).text.find(" = "),
            std::string::npos);
}

// Below, findings with the longest numbers that they print.
constexpr double kLong = -1.23456e-100;
std::vector<std::string> ManyParameters() {
  return std::vector<std::string>(20, "nu of region 1000 (+- 0.45)");
}

std::vector<Finding> OfSolutions() {
  return {NotFinite(),
          SingularStiffness(),
          SearchFailed("reason"),
          NoConvergence(1000),
          FitNotCertified(),
          FacetsOfRoundBody(kLong),
          ErrorsMissing("name", "a standard error of nu of region 1000"),
          DisplacementsOpposeLoads(),
          YoungsModulusDiverges(),
          PoissonRatioAtMinusOne(),
          PoissonRatioDivergesByNoise(),
          LoadsDoNoWork()};
}

std::vector<Finding> OfUndeterminedParameters() {
  return {OneCombination({100, 0.25}, {1 / 1.25, 1}),
          ShearModulusOnly({"E (+- 1000 %)", "nu (+- 0.91)"}, {kLong, kLong})};
}

std::vector<Finding> OfResiduals() {
  const Eigen::VectorXd numbers = Eigen::VectorXd::Constant(1, kLong);
  return {TooFewMeasurements(100000),
          NoFrameUsable(100000, "why"),
          FramesScatter(kLong, 100000),
          FramesAlike(kLong),
          ResultantsContradicted(kLong),
          InvertedElements(100000, 1000000, kLong),
          RigidFaceTurned(100000, kLong),
          FramesLeftOut(99999, 100000),
          TrendOverFrames("nu of region 1000", false,
                          {true, numbers, numbers, numbers}, 0),
          TrendOverFrames("E of region 1000", true,
                          {false, numbers, numbers, numbers}, 0),
          BoundContradicted("E of region 1000", true),
          KnownPoissonRatioContradicted("nu of region 1000", kLong, kLong,
                                        Severity::kWarning),
          LargeCorrection(kLong),
          LoadsOutOfBalance(kLong, Severity::kError),
          ResidualAboveNoise(ResidualKind::kDisplacement, kLong),
          ResidualAboveNoise(ResidualKind::kForce, kLong),
          ResidualAboveNoise(ResidualKind::kVirtualWork, kLong),
          SmoothResidual(kLong),
          LargeSmoothResidual(kLong),
          LargeResidual(kLong),
          VirtualWorkImbalance(),
          VirtualWorkImbalance(kLong, Severity::kError),
          VirtualWorkImbalance(kLong, Severity::kWarning),
          OutliersAtLimit({"nu of region 1", "nu of region 2"}),
          Outliers({kLong, kLong}, {}),
          FarNeighbours(),
          OutliersLeftOut({{0, 1000000, false},
                           {0, 1000001, false},
                           {0, 1000002, true},
                           {1, 1000003, true}},
                          {kLong, kLong}, {}),
          HeldNodesMoved({1000}),
          HeldNodesMoved({1000, 1001, 1002})};
}

std::vector<Finding> OfParameters() {
  return {
      UnphysicalParameters(ManyParameters(), true),
      UnphysicalParameters(ManyParameters(), false),
      ParametersUndetermined({"E of region 3 (+- 45 %)"}),
      ParametersUndetermined(ManyParameters()),
      ParametersUndeterminedByElements({"E of region 3 (+- 45 %)"}),
      ParametersUndeterminedByElements(ManyParameters()),
      ParametersUndeterminedOnBounds(ManyParameters()),
      RatiosAtLimit({"nu of region 3"}),
      RatiosAtLimit(ManyParameters()),
      AxisUndetermined({"the axis of region 3 (+- 24 degrees)"}),
      AxisUndetermined(ManyParameters()),
      OtherAxisAlike(),
      DependentForces(),
      CombinationsOnly({"the product of E of regions 1, 2 and 17 more and E "
                        "of regions 3, 4 and 17 more"}),
      CombinationsOnly({"12 combinations of E of regions 1, 2 and 17 more, E "
                        "of regions 3, 4 and 17 more and 12 more"}),
      ResidualInRegion("regions 1, 2 and 17 more", kLong),
      AxisTurned(0.0123, "regions 1, 2 and 17 more", kLong),
      RegionsMayDiffer({"3.1 % in E", "0.012 in nu"}, Severity::kNotice),
      RegionMayBeAnother("regions 1, 2 and 17 more",
                         {"31 % in E", "0.17 in nu"}),
      RegionsNotCompared({"region 1", "region 2", "region 3", "region 4"}),
      LawsFitAlike("transversely_isotropic_free_axis", "anisotropic", 3.21),
      ParametersOnBounds({"nu of region 1000"}),
      ParametersOnBounds(ManyParameters()),
      ParametersNearLimits(ManyParameters(), Severity::kError),
      ParametersNearLimits({"nu of region 3"}, Severity::kWarning),
      ParameterBias("nu of regions 1, 2 and 17 more", kLong, false,
                    Severity::kError),
      ParameterBias("E", std::numeric_limits<double>::infinity(), true,
                    Severity::kError)};
}

// One that the mesh leaves open, of E by this share.
Estimate EstimateOfElements(double share) {
  Estimate estimate;
  estimate.parameters.resize(2);
  estimate.parameters[0].symbol = "E";
  estimate.parameters[0].is_modulus = true;
  estimate.parameters[1].symbol = "nu";
  estimate.error_budget.discretization = Eigen::Vector2d(share, 0.0212345);
  return estimate;
}

std::vector<Finding> OfElements() {
  return {
      LargeDeformation({0.2, 0.1}, 0.17, Severity::kError, false),
      LargeDeformation({0.2, 2.4}, 0.05, Severity::kWarning, false),
      LargeDeformation({30, 0.1}, 24, Severity::kError, false),
      NegativePoissonRatio([] {
        ParameterEstimate nu;
        nu.symbol = "nu";
        nu.value = -0.3;
        return nu;
      }()),
      MarginNotGiven(0.06),
      PriorContradicted(
          [] {
            ParameterEstimate nu;
            nu.symbol = "nu";
            nu.value = 0.3;
            nu.standard_error = 0.01;
            return nu;
          }(),
          0.0004),
      DiscretizationErrorFinding(EstimateOfElements(0.0312345)),
      MeshErrorUnknown(),
      MeshErrorOfMapUnknown(),
      ComputedByLinearElements(Severity::kError),
      ComputedByLinearElements(Severity::kWarning),
      SupportsEndWithinElements(Eigen::Vector2d(0.0312345, 0.0212345),
                                EstimateOfElements(0.0312345)),
      SolverFallback("multigrid did not converge, so the stiffness matrix was "
                     "factorised")};
}

std::vector<Finding> OfMaps() {
  return {Misfit(1.23),
          NotResolved({"region 1 (0.12 wide)", "region 2 (0.12 wide)",
                       "region 3 (0.12 wide)"},
                      false),
          NoiseNeeded(123456, 12345),
          MayBeTheMesh(0.0123),
          StructureWithinMeshError(0.0123, 0.0234),
          LocalMapNeedsExactData(kLong),
          LocalMapUndetermined(),
          LocalModuliNotPositive(1000000, 1000000)};
}

std::vector<Finding> EveryFinding() {
  std::vector<Finding> findings = Estimate().findings;
  for (const auto& group :
       {OfSolutions(), OfUndeterminedParameters(), OfResiduals(),
        OfParameters(), OfElements(), OfMaps()}) {
    findings.insert(findings.end(), group.begin(), group.end());
  }
  return findings;
}

// Parameters, regions or nodes that are listed are one word.  By POSIX, since
// gcc 12 warns of std::regex under the sanitizers.
std::string WithoutLists(std::string text) {
  regex_t list;
  EXPECT_EQ(
      regcomp(&list,
              "((E|nu) of )?(region|node|point)s? [0-9]+( \\([-+ 0-9.]+\\))?"
              "((, | and )(((E|nu) of )?(region|node|point)s? )?([0-9]+"
              "( \\([-+ 0-9.]+\\))?|[.]{3}))*( and [0-9]+ more)?",
              REG_EXTENDED),
      0);
  regmatch_t match;
  while (regexec(&list, text.c_str(), 1, &match, 0) == 0) {
    text.replace(std::size_t(match.rm_so),
                 std::size_t(match.rm_eo - match.rm_so), "list");
  }
  regfree(&list);
  return text;
}

TEST(FindingSentences, AreShort) {
  for (const Finding& finding : EveryFinding()) {
    SCOPED_TRACE(finding.text);
    std::istringstream words(WithoutLists(finding.text) + " " + finding.advice);
    int num_words = 0;
    for (std::string word; words >> word;) {
      ++num_words;
    }
    EXPECT_GT(num_words, 3);
    EXPECT_LE(num_words, 40);
    EXPECT_FALSE(finding.advice.empty());
    for (const std::string& sentence : {finding.text, finding.advice}) {
      EXPECT_NE(sentence.back(), '.');
      EXPECT_EQ(sentence.find(". "), std::string::npos);
    }
  }
}

TEST(FindingSentences, HaveNoPercentageBeyondAThousand) {
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double ratio : {-20.0, 12.0, 82.0, 4.3e12, infinity}) {
    const Eigen::VectorXd numbers = Eigen::VectorXd::Constant(1, ratio);
    const Estimate open = EstimateOfElements(ratio);
    for (const Finding& finding :
         {LargeCorrection(ratio), LoadsOutOfBalance(ratio, Severity::kError),
          LargeSmoothResidual(ratio), LargeResidual(ratio),
          AxisTurned(0.01, "", ratio), Outliers({ratio, 0}, {}),
          OutliersLeftOut({{0, 1, false}}, {ratio, 0}, {}),
          TrendOverFrames("E", true, {true, numbers, numbers, numbers}, 0),
          ParameterBias("E", ratio, true, Severity::kError),
          DiscretizationErrorFinding(open),
          SupportsEndWithinElements(Eigen::Vector2d(ratio, 0), open)}) {
      const std::size_t place = finding.text.find(" %");
      if (place != std::string::npos) {  // That of a limit.
        const std::size_t start = finding.text.rfind(' ', place - 1) + 1;
        EXPECT_LE(std::stod(finding.text.substr(start)), 1000) << finding.text;
      }
      EXPECT_EQ(finding.text.find("e+"), std::string::npos) << finding.text;
    }
  }
}

TEST(FindingSentences, NameARigidMotionFirstWhereRotationsAreFarAboveStrains) {
  const auto advice = [](double strain, double rotation, bool is_free) {
    return LargeDeformation({strain, rotation}, 0.05, Severity::kWarning,
                            is_free)
        .advice;
  };
  EXPECT_EQ(advice(0.05, 2.4, false).find("give \"rigid_motion\": \"free\""),
            0);
  EXPECT_EQ(advice(0.05, 0.06, false).find("rigid_motion"), std::string::npos);
  EXPECT_EQ(advice(0.05, 2.4, true).find("rigid_motion"), std::string::npos);
}

TEST(FindingSentences, CountOneThingInTheSingular) {
  EXPECT_EQ(OutliersLeftOut({{0, 5, false}}, {0.05, 0}, {})
                .text.find("1 outlier (node 5, counted from 0) is left out"),
            0);
  EXPECT_EQ(FramesLeftOut(1, 10).text, "1 of 10 frames is not used");
  EXPECT_EQ(NoConvergence(1).text.find("iterations"), std::string::npos);
}

TEST(FindingSentences, AreThereForEveryCode) {
  for (const FindingCode code : AllFindingCodes()) {
    bool is_there = false;
    for (const Finding& finding : EveryFinding()) {
      is_there = is_there || finding.code == code;
    }
    EXPECT_TRUE(is_there) << FindingCodeName(code);
  }
}

// Confined compression determines lambda + 2 mu, which is none of the moduli
// that are named; next to nu = 1/2 it changes as the bulk modulus does.
TEST(OneCombination, NamesTheModulusThatIsConstantAndNoOther) {
  for (const double nu : {0.3, 0.45, 0.499, 0.4999}) {
    const double gradient = 2 / (1 - 2 * nu) - 1 / (1 + nu) - 1 / (1 - nu);
    const Finding finding = OneCombination({500, nu}, {-gradient, 1});
    EXPECT_EQ(finding.text.find("bulk"), std::string::npos) << finding.text;
    EXPECT_EQ(finding.text.find("shear"), std::string::npos) << finding.text;
  }
  for (const double nu : {0.3, 0.45, 0.499, 0.4999}) {
    const Finding bulk = OneCombination({500, nu}, {-2 / (1 - 2 * nu), 1});
    EXPECT_NE(bulk.text.find("the bulk modulus = "), std::string::npos)
        << bulk.text;
  }
  const Finding shear = OneCombination({500, 0.25}, {1 / 1.25, 1});
  EXPECT_NE(shear.text.find("the shear modulus = 200"), std::string::npos)
      << shear.text;
}

}  // namespace
}  // namespace elastimate
