#include "elastimate/estimators/material_fit/inlier_fit.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "elastimate/core/scene/unknown_motion.h"
#include "elastimate/estimators/interface/finding_sentences.h"
#include "elastimate/estimators/material_fit/outliers.h"

namespace elastimate {
namespace {

// The largest change of ln E, or of another stiffness, and of nu, from one
// estimate to another.
Eigen::Vector2d LargestChange(const Estimate& from, const Estimate& to) {
  Eigen::Vector2d largest = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < to.parameters.size(); ++i) {
    const ParameterEstimate& parameter = to.parameters[i];
    const double before = from.parameters[i].value;
    const double after = parameter.value;
    const double change = parameter.is_modulus
                              ? std::log(after / before)
                              : (after - before) / parameter.ErrorUnit();
    double& value = largest(parameter.IsStiffness() ? 0 : 1);
    value = std::abs(change) > std::abs(value) ? change : value;
  }
  return largest;
}

// Whether it is a node of a support that moved as measured.
bool IsAsMeasured(const Scene& scene, const Outlier& outlier) {
  const ComponentMask supports =
      AsMeasured(SupportsOf(scene, outlier.load_case));
  return !outlier.is_point && supports.size() != 0 &&
         supports.col(outlier.index).any();
}

// The outliers of a fit that some were left out of.  Little is known of the
// motion of a support that was not followed, which has to be farther off.
std::vector<Outlier> OutliersOf(const Scene& scene,
                                const ObservedDisplacements& observed,
                                const MaterialFit& fit,
                                const std::vector<Outlier>& left_out) {
  constexpr double kFarFromUnknown = 3;
  const OutlierSearch search(
      scene, observed,
      SeenDisplacements(scene.mesh, fit.displacement, fit.cameras));
  const std::vector<Outlier> far = search.Beyond(kFarFromUnknown);
  std::vector<Outlier> outliers = search.Beyond(1);
  const auto is_among = [](const std::vector<Outlier>& all,
                           const Outlier& outlier) {
    return std::find(all.begin(), all.end(), outlier) != all.end();
  };
  outliers.erase(std::remove_if(outliers.begin(), outliers.end(),
                                [&](const Outlier& outlier) {
                                  return is_among(left_out, outlier) &&
                                         !is_among(far, outlier) &&
                                         IsAsMeasured(scene, outlier);
                                }),
                 outliers.end());
  return outliers;
}

// The outliers that are found when supports next to them are left out as well.
std::vector<Outlier> OutliersWithoutSuspects(
    const Scene& scene, const FitFunction& fit_without,
    const ObservedDisplacements& observed, const MaterialFit& fit,
    const std::vector<Outlier>& outliers, Work& work) {
  std::vector<Outlier> left_out = SuspectedSupports(scene, outliers);
  if (left_out.empty()) {
    return outliers;
  }
  left_out.insert(left_out.end(), outliers.begin(), outliers.end());
  const MaterialFit other = fit_without(left_out, fit.Variables());
  work = work + other.estimate.work;
  return other.displacement.size() == 0
             ? outliers
             : OutliersOf(scene, observed, other, left_out);
}

}  // namespace

InlierFit LeaveOutliersOut(const Scene& scene, const FitFunction& fit_without,
                           const MaterialFit& of_all) {
  constexpr int kRounds = 8;
  // What more points contradict is wrong in another way.
  constexpr double kMost = 1.0 / 3;
  const ObservedDisplacements observed(scene);
  const auto num_points = static_cast<double>(observed.Points().size());
  InlierFit others = {of_all, {}};
  MaterialFit& fit = others.fit;
  std::vector<Outlier>& left_out = others.left_out;
  const auto leave_out = [&](const std::vector<Outlier>& outliers) {
    const Work work = fit.estimate.work;
    left_out = outliers;
    if (outliers.empty()) {
      fit = of_all;
      fit.estimate.work = work;
      return;
    }
    fit = fit_without(outliers, fit.Variables());
    fit.estimate.work = fit.estimate.work + work;
  };
  Work of_suspects;
  std::vector<std::vector<Outlier>> tried = {{}};
  for (int i = 0; i < kRounds && fit.displacement.size() != 0; ++i) {
    std::vector<Outlier> outliers = OutliersOf(scene, observed, fit, left_out);
    if (outliers == left_out) {
      outliers = OutliersWithoutSuspects(scene, fit_without, observed, fit,
                                         outliers, of_suspects);
    }
    // Others were left out before, and led here.
    if (std::find(tried.begin(), tried.end(), outliers) != tried.end()) {
      break;
    }
    tried.push_back(outliers);
    if (static_cast<double>(outliers.size()) > kMost * num_points) {
      leave_out({});
      break;
    }
    leave_out(outliers);
  }
  const std::vector<Outlier> apart = OutliersApart(scene, observed, left_out);
  if (apart != left_out) {
    leave_out(apart);
  }
  fit.estimate.work = fit.estimate.work + of_suspects;
  return others;
}

void EnterOutliers(const std::vector<Outlier>& left_out, const Estimate& of_all,
                   const Estimate& of_inliers, Estimate& estimate) {
  if (left_out.empty()) {
    return;
  }
  estimate.outliers = left_out;
  estimate.Add(
      OutliersLeftOut(left_out, LargestChange(of_all, of_inliers), estimate));
}

}  // namespace elastimate
