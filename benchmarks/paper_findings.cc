#include "benchmarks/paper_findings.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "benchmarks/quantile.h"

namespace elastimate {
namespace {

constexpr const char* kReducedFe = "reduced-fe";
// The noise experiment is evaluated at this deviation, so that it can be
// compared with the experiments of several load cases.
constexpr double kDeviation = 0.09;
constexpr double kManyCases = 20;

using Error = double (*)(const Trial&);

double YoungsModulusError(const Trial& trial) {
  return trial.YoungsModulusError();
}

double RelativePoissonRatioError(const Trial& trial) {
  return trial.PoissonRatioError() / trial.truth.poisson_ratio;
}

// Returns the errors of the trials at this setting, by reduced-fe or else by
// the method of the paper.
std::vector<double> Errors(const PaperTrials& trials, bool of_reduced_fe,
                           double setting, Error error) {
  std::vector<double> errors;
  for (const PaperTrial& row : trials) {
    if (row.setting == setting &&
        (row.trial.estimate.estimator == kReducedFe) == of_reduced_fe) {
      errors.push_back(error(row.trial));
    }
  }
  return errors;
}

double MedianError(const PaperTrials& trials, bool of_reduced_fe,
                   double setting, Error error) {
  return Quantile(Errors(trials, of_reduced_fe, setting, error), 0.5);
}

// Returns the error that this share of the trials does not exceed in absolute
// value.
double AbsoluteErrorQuantile(double share, const PaperTrials& trials,
                             bool of_reduced_fe, double setting, Error error) {
  std::vector<double> errors = Errors(trials, of_reduced_fe, setting, error);
  for (double& value : errors) {
    value = std::abs(value);
  }
  std::sort(errors.begin(), errors.end());
  const double rank = share * static_cast<double>(errors.size());
  return errors[static_cast<std::size_t>(std::ceil(rank)) - 1];
}

double MedianAbsoluteError(const PaperTrials& trials, bool of_reduced_fe,
                           double setting, Error error) {
  return AbsoluteErrorQuantile(0.5, trials, of_reduced_fe, setting, error);
}

double ShareBelowZero(const std::vector<double>& errors) {
  double count = 0;
  for (const double error : errors) {
    count += error < 0 ? 1 : 0;
  }
  return count / static_cast<double>(errors.size());
}

struct LineFit {
  double slope;
  double r_squared;
};

// Fits a line to the median absolute relative error of E over the setting.
LineFit FitErrors(const PaperTrials& trials, bool of_reduced_fe) {
  std::map<double, double> points;
  for (const PaperTrial& row : trials) {
    points.emplace(row.setting, 0);
  }
  const Eigen::Index count = Eigen::Index(points.size());
  Eigen::ArrayXd x(count);
  Eigen::ArrayXd y(count);
  Eigen::Index i = 0;
  for (const auto& [setting, unused] : points) {
    x(i) = setting;
    y(i++) =
        MedianAbsoluteError(trials, of_reduced_fe, setting, YoungsModulusError);
  }
  x -= x.mean();
  y -= y.mean();
  const double slope = (x * y).sum() / x.square().sum();
  return {slope, 1 - (y - slope * x).square().sum() / y.square().sum()};
}

// Returns what is found by reduced-fe, or else by the method of the paper.
using Found = std::function<double(bool)>;

struct Statement {
  const char* section;
  const char* claim;
  std::string quantity;
  Found found;
  // Says what the method of the paper must show for the claim to hold.
  const char* criterion;
  std::function<bool(double)> agrees;
};

bool IsAboveNineTenths(double value) { return value > 0.9; }
bool IsAboutTwoPercent(double value) { return value > 0.01 && value < 0.03; }
bool IsTwoToFourPercent(double value) { return value > 0.015 && value < 0.045; }
bool Remains(double value) { return value > 0.5; }

// Returns by how much an error that this share of the trials does not exceed is
// smaller with many cases than with one.
Found Improvement(double share, const PaperTrials& trials, Error error) {
  return [share, &trials, error](bool of_reduced_fe) {
    return AbsoluteErrorQuantile(share, trials, of_reduced_fe, 1, error) -
           AbsoluteErrorQuantile(share, trials, of_reduced_fe, kManyCases,
                                 error);
  };
}

// Returns which part of the median error with one case many cases leave.
Found Remaining(const PaperTrials& trials, Error error) {
  return [&trials, error](bool of_reduced_fe) {
    return MedianAbsoluteError(trials, of_reduced_fe, kManyCases, error) /
           MedianAbsoluteError(trials, of_reduced_fe, 1, error);
  };
}

// The statements refer to the trials.
std::vector<Statement> StatementsOfNoise(const PaperTrials& noise) {
  return {{"5.1", "E is under-estimated",
           "median relative error of E at deviation 0.09",
           [&](bool reduced) {
             return MedianError(noise, reduced, kDeviation, YoungsModulusError);
           },
           "below 0", [](double value) { return value < 0; }},
          {"5.1", "E is under-estimated",
           "share of trials with E too small at deviation 0.09",
           [&](bool reduced) {
             return ShareBelowZero(
                 Errors(noise, reduced, kDeviation, YoungsModulusError));
           },
           "above 0.9", IsAboveNineTenths},
          {"5.1", "nu is over-estimated",
           "median relative error of nu at deviation 0.09",
           [&](bool reduced) {
             return MedianError(noise, reduced, kDeviation,
                                RelativePoissonRatioError);
           },
           "above 0", [](double value) { return value > 0; }},
          {"5.1", "nu is over-estimated",
           "share of trials with nu too large at deviation 0.09",
           [&](bool reduced) {
             return 1 - ShareBelowZero(Errors(noise, reduced, kDeviation,
                                              RelativePoissonRatioError));
           },
           "above 0.9", IsAboveNineTenths}};
}

// Returns what more cases, which are called `cases`, improve: the median and
// the 90th percentile of the errors of E and of nu.
std::vector<Statement> StatementsOfImprovement(
    const char* section, const char* claim, const std::string& cases,
    const PaperTrials& trials, const char* criterion,
    const std::function<bool(double)>& agrees) {
  std::vector<Statement> statements;
  for (const auto& [share, quantile] :
       {std::pair(0.5, "median"), std::pair(0.9, "90th percentile of the")}) {
    for (const auto& [error, parameter] :
         {std::pair(&YoungsModulusError, "E"),
          std::pair(&RelativePoissonRatioError, "nu")}) {
      statements.push_back(
          {section, claim,
           std::string(quantile) + " absolute relative error of " + parameter +
               " at 1 less that at 20 " + cases,
           Improvement(share, trials, error), criterion, agrees});
    }
  }
  return statements;
}

std::vector<Statement> StatementsOfConvergence(
    const PaperTrials& measurements) {
  return {
      {"5.3", "several measurements do not converge to the truth",
       "median absolute relative error of E at 20 measurements over that at 1",
       Remaining(measurements, YoungsModulusError), "above 0.5", Remains},
      {"5.3", "several measurements do not converge to the truth",
       "median absolute relative error of nu at 20 measurements over that at 1",
       Remaining(measurements, RelativePoissonRatioError), "above 0.5",
       Remains}};
}

std::vector<Statement> StatementsOfBounds(const PaperTrials& organ) {
  return {{"5.5", "the bounded error of E grows linearly with the noise",
           "R^2 of a line through the median absolute relative errors of E",
           [&](bool reduced) { return FitErrors(organ, reduced).r_squared; },
           "above 0.99", [](double value) { return value > 0.99; }},
          {"5.5", "the bounded error of E grows linearly with the noise",
           "slope of that line",
           [&](bool reduced) { return FitErrors(organ, reduced).slope; },
           "above 0", [](double value) { return value > 0; }}};
}

}  // namespace

Table PaperFindings(const PaperTrials& noise, const PaperTrials& measurements,
                    const PaperTrials& forces, const PaperTrials& organ) {
  Table table("paper_findings",
              {"section", "claim", "quantity", "paper_method [1]",
               "reduced_fe [1]", "criterion", "paper_method_agrees"});
  for (const std::vector<Statement>& statements :
       {StatementsOfNoise(noise),
        StatementsOfImprovement(
            "5.3", "several measurements improve by about 2 %", "measurements",
            measurements, "0.01 to 0.03", IsAboutTwoPercent),
        StatementsOfConvergence(measurements),
        StatementsOfImprovement("5.4", "several forces improve by 2 to 4 %",
                                "forces", forces, "0.015 to 0.045",
                                IsTwoToFourPercent),
        StatementsOfBounds(organ)}) {
    for (const Statement& statement : statements) {
      const double found = statement.found(false);
      table.AddRow({statement.section, statement.claim, statement.quantity,
                    found, statement.found(true), statement.criterion,
                    statement.agrees(found) ? "yes" : "no"});
    }
  }
  return table;
}

}  // namespace elastimate
