#include "elastimate/estimators/series/joint_estimate.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/algebra/median.h"
#include "elastimate/estimators/interface/finding_sentences.h"
#include "elastimate/estimators/interface/judge.h"
#include "elastimate/estimators/interface/statistics.h"
#include "elastimate/estimators/series/trend.h"

namespace elastimate {
namespace {

// What rounding leaves of a logarithm, or of a ratio, and of the share of noise
// in the variance of exact data.
constexpr double kLeastError = 1e-12;
constexpr double kLeastShare = 1e-6;
// How often a trend, or a scatter, of any parameter is found where there is
// none.
constexpr double kProbabilityOfTrend = 0.01;
constexpr double kProbabilityOfScatter = 1e-3;
// Standard deviations are those of linear models at estimated parameters, and
// hardly better known than that.
constexpr double kNotableScatter = 1.25;
constexpr double kNotableLikeness = 0.1;

// A frame that is used, in the logarithms of moduli and the ratios that are
// free.
struct UsedFrame {
  const FrameEstimate* frame;
  std::size_t number;  // From 1 on.
  Eigen::VectorXd values;
  Eigen::MatrixXd covariance;  // Without what is common by the loads.
  // How much of the variance of each parameter varies between frames: zero for
  // all parameters where it is not known.
  Eigen::ArrayXd noise_share;
  double noise_sd;  // Not a number where it is not known.

  Eigen::ArrayXd Variances() const { return covariance.diagonal().array(); }
  bool IsNoiseKnown() const { return (noise_share > 0).all(); }
  // The covariance of what varies.
  Eigen::MatrixXd OfNoise() const { return Part(noise_share); }
  // The covariance of the rest.
  Eigen::MatrixXd Common() const { return Part(1 - noise_share); }

 private:
  Eigen::MatrixXd Part(const Eigen::ArrayXd& share) const {
    const Eigen::VectorXd root = share.sqrt();
    return root.asDiagonal() * covariance * root.asDiagonal();
  }
};

// Their places among the parameters.
Eigen::VectorXi FreeParametersOf(const Estimate& estimate) {
  Eigen::VectorXi free(Eigen::Index(estimate.parameters.size()));
  Eigen::Index num_free = 0;
  for (std::size_t i = 0; i < estimate.parameters.size(); ++i) {
    if (!estimate.parameters[i].is_known) {
      free(num_free++) = static_cast<int>(i);
    }
  }
  return free.head(num_free);
}

Eigen::ArrayXd NoiseShare(const Estimate& estimate, const Eigen::VectorXi& free,
                          const Eigen::VectorXd& by_loads,
                          const Eigen::MatrixXd& covariance) {
  const ParameterErrors& noise = estimate.error_budget.noise;
  Eigen::ArrayXd unknown = Eigen::ArrayXd::Zero(free.size());
  if (noise.size() != Eigen::Index(estimate.parameters.size())) {
    return unknown;
  }
  const Eigen::ArrayXd share =
      (noise(free).array().square() - by_loads.array().square()).max(0) /
      covariance.diagonal().array();
  return share.isFinite().all() ? Eigen::ArrayXd(share.max(kLeastShare).min(1))
                                : unknown;
}

// Without the part of an error that is alike in all frames, and without
// directions of no error.
Eigen::MatrixXd Without(const Eigen::VectorXd& common,
                        const Eigen::MatrixXd& covariance) {
  constexpr double kLeastPart = 1e-4;
  const SymmetricEigenDecomposition parts =
      DecomposeSymmetric(covariance - common * common.transpose());
  const double least =
      kLeastPart * covariance.diagonal().minCoeff() + kLeastError * kLeastError;
  return parts.vectors * parts.values.cwiseMax(least).asDiagonal() *
         parts.vectors.transpose();
}

// Whether neither E nor nu is a value that could be averaged.
bool DeterminesShearModulusAlone(const Estimate& estimate) {
  return estimate.shear_modulus && !estimate.parameters[0].IsDetermined();
}

std::optional<UsedFrame> Use(const FrameEstimate& frame, std::size_t number,
                             const LoadError& load_error) {
  const Estimate& estimate = frame.estimate;
  const Eigen::VectorXi free = FreeParametersOf(estimate);
  if (!estimate.IsUsable() || DeterminesShearModulusAlone(estimate) ||
      free.size() == 0 ||
      estimate.parameter_covariance.rows() !=
          Eigen::Index(estimate.parameters.size())) {
    return std::nullopt;
  }
  UsedFrame used = {
      &frame, number, Eigen::VectorXd(free.size()),
      {},     {},     estimate.noise_sd.value_or(Estimate::kUnknown)};
  Eigen::VectorXd slopes(free.size());
  Eigen::VectorXd by_loads = Eigen::VectorXd::Zero(free.size());
  for (Eigen::Index j = 0; j < used.values.size(); ++j) {
    const ParameterEstimate& parameter = estimate.parameters[free(j)];
    used.values(j) =
        parameter.is_modulus ? std::log(parameter.value) : parameter.value;
    slopes(j) = parameter.is_modulus ? 1 / parameter.value : 1;
    if (load_error.is_in_frames && parameter.IsStiffness()) {
      by_loads(j) =
          load_error.relative * (parameter.beside ? parameter.value : 1);
    }
  }
  used.covariance = slopes.asDiagonal() *
                    estimate.parameter_covariance(free, free) *
                    slopes.asDiagonal();
  if (!used.covariance.allFinite() || !used.values.allFinite()) {
    return std::nullopt;
  }
  used.covariance = Without(by_loads, used.covariance);
  used.noise_share = NoiseShare(estimate, free, by_loads, used.covariance);
  return used;
}

// The variance of noise over the load, to which those of parameters are
// proportional; not a number where it is not known.
double NoiseOverLoad(const UsedFrame& frame) {
  const double ratio = frame.noise_sd / frame.frame->load;
  return ratio * ratio;
}

// Noise that each frame knows from few degrees of freedom only is taken to be
// the same in all of them: by the median of its variances, of chi^2.
void ShareNoiseOfFewDegreesOfFreedom(std::vector<UsedFrame>& frames) {
  std::vector<double> variances;
  for (const UsedFrame& frame : frames) {
    const std::optional<double>& freedom =
        frame.frame->estimate.noise_degrees_of_freedom;
    if (!freedom || !(frame.noise_sd > 0)) {
      return;
    }
    variances.push_back(frame.noise_sd * frame.noise_sd * *freedom /
                        ChiSquaredQuantile(*freedom, 0.5));
  }
  const double noise_sd = std::sqrt(Median(variances));
  for (UsedFrame& frame : frames) {
    const double factor = noise_sd / frame.noise_sd;
    frame.covariance *= factor * factor;
    frame.noise_sd = noise_sd;
  }
}

// How the variances of each parameter compare with the noise over the load of
// their frames, usually; empty where that is not known of all.
std::optional<Eigen::ArrayXd> UsualVariances(
    const std::vector<UsedFrame>& frames) {
  Eigen::ArrayXd usual(frames.front().values.size());
  for (Eigen::Index p = 0; p < usual.size(); ++p) {
    std::vector<double> ratios;
    for (const UsedFrame& frame : frames) {
      ratios.push_back(frame.covariance(p, p) / NoiseOverLoad(frame));
      if (!(std::isfinite(ratios.back()) && ratios.back() > 0)) {
        return std::nullopt;
      }
    }
    usual(p) = Median(ratios);
  }
  return usual;
}

// Raises standard deviations that are far smaller than those of other frames.
void RaiseSmallErrors(const Eigen::ArrayXd& usual,
                      std::vector<UsedFrame>& frames) {
  constexpr double kFarSmaller = 0.5;
  for (UsedFrame& frame : frames) {
    const Eigen::ArrayXd raise =
        (usual * NoiseOverLoad(frame) / frame.Variances()).sqrt();
    const Eigen::VectorXd factors = (raise > 1 / kFarSmaller).select(raise, 1);
    frame.covariance =
        factors.asDiagonal() * frame.covariance * factors.asDiagonal();
  }
}

// The weights of each parameter of the frames, in columns: the inverses of the
// variances.  A frame whose estimate errs may err in its
// variance as well, so that these are the usual ones beside noise and load, as
// far as its own are not far from them.
Eigen::ArrayXXd WeightsOfFrames(const std::optional<Eigen::ArrayXd>& usual,
                                const std::vector<UsedFrame>& frames) {
  constexpr double kFar = 4;
  Eigen::ArrayXXd weights(frames.front().values.size(),
                          Eigen::Index(frames.size()));
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const UsedFrame& frame = frames[i];
    const Eigen::ArrayXd own = frame.Variances();
    Eigen::ArrayXd variances = own;
    if (usual) {
      variances =
          (*usual * NoiseOverLoad(frame)).max(own / kFar).min(kFar * own);
    }
    weights.col(Eigen::Index(i)) = variances.inverse();
  }
  return weights.colwise() / weights.rowwise().sum();
}

// The correlation of residuals that frames have in common, if it is one.
double LikenessOf(const std::vector<UsedFrame>& frames) {
  constexpr double kSignificant = 3;
  double sum = 0;
  double count = 0;
  for (const UsedFrame& frame : frames) {
    if (frame.frame->likeness) {
      sum += *frame.frame->likeness * double(frame.frame->num_alike);
      count += double(frame.frame->num_alike);
    }
  }
  return sum > kSignificant * std::sqrt(count) ? sum / count : 0;
}

Eigen::MatrixXd SquareRoot(const Eigen::MatrixXd& covariance) {
  const SymmetricEigenDecomposition parts = DecomposeSymmetric(covariance);
  return parts.vectors * parts.values.cwiseMax(0).cwiseSqrt().asDiagonal() *
         parts.vectors.transpose();
}

// The scatter of the frames.
struct Scatter {
  // chi^2 per degree of freedom over the noise, of each parameter.
  Eigen::ArrayXd over_noise;
  // How probable as large a scatter of any parameter is by the errors of the
  // frames.
  double p_value = 1;
  std::size_t farthest = 0;  // The number of the frame that is.

  // The noise that it shows, never below what frames say.
  Eigen::ArrayXd Excess() const { return over_noise.max(1); }
};

// What smooth noise, elements and the correction for them contribute may differ
// between frames as well, so that the test allows for all of it.  Parameters
// are looked at one by one: the errors that frames have in common correlate
// them otherwise than those that differ.
Scatter ScatterOf(const std::vector<UsedFrame>& frames,
                  const Eigen::VectorXd& mean) {
  const Eigen::Index size = mean.size();
  Scatter scatter = {Eigen::ArrayXd::Zero(size)};
  Eigen::ArrayXd by_all = scatter.over_noise;
  double largest = 0;
  for (const UsedFrame& frame : frames) {
    if (!frame.IsNoiseKnown()) {
      return {Eigen::ArrayXd::Zero(size)};
    }
    const Eigen::ArrayXd squares =
        (frame.values - mean).array().square() / frame.Variances();
    scatter.over_noise += squares / frame.noise_share;
    by_all += squares;
    if (squares.maxCoeff() > largest) {
      largest = squares.maxCoeff();
      scatter.farthest = frame.number;
    }
  }
  const double freedom = static_cast<double>(frames.size()) - 1;
  if (freedom > 0 && by_all.isFinite().all()) {
    scatter.over_noise /= freedom;
    scatter.p_value =
        std::min(1.0, static_cast<double>(size) *
                          ChiSquaredProbability(freedom, by_all.maxCoeff()));
  }
  return scatter;
}

// The mean of least variance, and what its errors are made of.
struct Mean {
  Eigen::VectorXd values;
  Eigen::MatrixXd of_noise;  // Covariance of what differs between frames.
  Eigen::MatrixXd common;    // Of what they have in common.
  Scatter scatter;
};

Mean MeanOf(const std::vector<UsedFrame>& frames,
            const Eigen::ArrayXXd& weights) {
  const Eigen::Index size = frames.front().values.size();
  Mean mean;
  mean.values.setZero(size);
  mean.of_noise.setZero(size, size);
  Eigen::MatrixXd root = Eigen::MatrixXd::Zero(size, size);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Eigen::VectorXd weight = weights.col(Eigen::Index(i));
    mean.values += weight.cwiseProduct(frames[i].values);
    mean.of_noise +=
        weight.asDiagonal() * frames[i].OfNoise() * weight.asDiagonal();
    root += weight.asDiagonal() * SquareRoot(frames[i].Common());
  }
  mean.scatter = ScatterOf(frames, mean.values);
  const Eigen::VectorXd excess = mean.scatter.Excess().sqrt();
  mean.of_noise = excess.asDiagonal() * mean.of_noise * excess.asDiagonal();
  mean.common = root * root.transpose();
  return mean;
}

std::optional<Trend> TrendOver(const std::vector<UsedFrame>& frames,
                               const Eigen::VectorXi& free,
                               Eigen::Index num_parameters) {
  const Eigen::Index num_frames = Eigen::Index(frames.size());
  Eigen::VectorXd loads(num_frames);
  Eigen::MatrixXd values(num_frames, free.size());
  Eigen::MatrixXd variances = values;
  for (Eigen::Index i = 0; i < num_frames; ++i) {
    const UsedFrame& frame = frames[i];
    loads(i) = frame.frame->load;
    values.row(i) = frame.values.transpose();
    const Eigen::ArrayXd varying =
        frame.IsNoiseKnown()
            ? Eigen::ArrayXd(frame.noise_share * frame.Variances())
            : frame.Variances();
    variances.row(i) = varying.matrix().transpose();
  }
  std::optional<Trend> of_free = FindTrend(loads, values, variances);
  const bool is_over_load = of_free.has_value();
  if (!is_over_load) {
    of_free = FindTrend(Eigen::VectorXd::LinSpaced(num_frames, 0, 1), values,
                        variances);
  }
  if (!of_free) {
    return std::nullopt;
  }
  const Eigen::VectorXd unknown =
      Eigen::VectorXd::Constant(num_parameters, Estimate::kUnknown);
  Trend trend = {is_over_load, unknown, unknown, unknown};
  trend.change(free) = of_free->change;
  trend.standard_error(free) = of_free->standard_error;
  trend.p_value(free) = of_free->p_value;
  return trend;
}

// Whether frames that have no part of a cause in their budget do not know it,
// or do not have it.
enum class Missing { kUnknown, kZero };

// The part of a cause that frames have in common, weighted by the variance of
// each parameter; empty where no frame has it, not a number where it is
// unknown.
ParameterErrors MeanPart(const std::vector<UsedFrame>& frames,
                         ParameterErrors ErrorBudget::*cause, Missing missing,
                         const Eigen::VectorXi& free,
                         Eigen::Index num_parameters) {
  Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(free.size());
  Eigen::ArrayXd weights = sum;
  bool has_any = false;
  for (const UsedFrame& frame : frames) {
    const ParameterErrors& errors = frame.frame->estimate.error_budget.*cause;
    const bool is_known =
        errors.size() == num_parameters && errors(free).allFinite();
    has_any = has_any || is_known;
    const Eigen::ArrayXd weight = frame.Variances().inverse();
    if (is_known) {
      sum += weight * errors(free).array();
    }
    if (is_known || missing == Missing::kZero) {
      weights += weight;
    }
  }
  if (!has_any && missing == Missing::kZero) {
    return {};
  }
  ParameterErrors mean =
      ParameterErrors::Constant(num_parameters, Estimate::kUnknown);
  mean(free) = sum / weights;
  return mean;
}

// The squares of those of free parameters; zero where they are not known.
Eigen::ArrayXd KnownSquares(const ParameterErrors& errors,
                            const Eigen::VectorXi& free) {
  if (errors.size() == 0) {
    return Eigen::ArrayXd::Zero(free.size());
  }
  const Eigen::ArrayXd squares = errors(free).array().square();
  return squares.isNaN().select(0, squares);
}

// What frames have in common is that of the model, but for what the budget has
// already.
void EnterMean(const Mean& mean, const Eigen::VectorXi& free, double load_error,
               Estimate& estimate) {
  Eigen::VectorXd slopes(free.size());
  Eigen::VectorXd of_loads(free.size());
  for (Eigen::Index j = 0; j < slopes.size(); ++j) {
    ParameterEstimate& parameter = estimate.parameters[free(j)];
    parameter.value =
        parameter.is_modulus ? std::exp(mean.values(j)) : mean.values(j);
    slopes(j) = parameter.is_modulus ? parameter.value : 1;
    of_loads(j) = !parameter.IsStiffness() ? 0
                  : parameter.beside       ? load_error * parameter.value
                                           : load_error;
  }
  const Eigen::MatrixXd noise = mean.of_noise + of_loads * of_loads.transpose();
  const auto num_parameters = Eigen::Index(estimate.parameters.size());
  const Eigen::VectorXd unknown =
      Eigen::VectorXd::Constant(num_parameters, Estimate::kUnknown);
  estimate.parameter_covariance = unknown.replicate(1, num_parameters);
  estimate.parameter_covariance(free, free) =
      slopes.asDiagonal() * (noise + mean.common) * slopes.asDiagonal();
  estimate.error_budget.noise = unknown;
  estimate.error_budget.noise(free) = noise.diagonal().cwiseSqrt();
  const ErrorBudget& budget = estimate.error_budget;
  const Eigen::ArrayXd others = KnownSquares(budget.discretization, free) +
                                KnownSquares(budget.curvature, free) +
                                KnownSquares(budget.law, free) +
                                KnownSquares(budget.kinematics, free) +
                                KnownSquares(budget.section, free);
  estimate.error_budget.model = unknown;
  estimate.error_budget.model(free) =
      (mean.common.diagonal().array() - others).max(0).sqrt().matrix();
}

std::optional<double> IfFinite(double value) {
  return std::isfinite(value) ? std::optional<double>(value) : std::nullopt;
}

// Adds the findings that more than half of the used frames have, as the first
// has them.
void AddSharedFindings(const std::vector<UsedFrame>& frames,
                       Estimate& estimate) {
  std::map<FindingCode, std::size_t> counts;
  for (const UsedFrame& frame : frames) {
    for (const Finding& finding : frame.frame->estimate.findings) {
      ++counts[finding.code];
    }
  }
  for (const UsedFrame& frame : frames) {
    for (Finding finding : frame.frame->estimate.findings) {
      const std::size_t count = counts[finding.code];
      if (2 * count > frames.size()) {
        finding.text = "in " + std::to_string(count) +
                       " of the frames (with the numbers of the first), " +
                       finding.text;
        estimate.Add(finding);
      }
    }
  }
}

// Whether there is one.
bool AddTrend(const Eigen::VectorXi& free, Estimate& estimate) {
  const std::optional<Trend>& trend = estimate.series->trend;
  if (!trend) {
    return false;
  }
  Eigen::Index place = 0;
  const double least = trend->p_value(free).minCoeff(&place);
  if (least * double(free.size()) >= kProbabilityOfTrend) {
    return false;
  }
  const Eigen::Index i = free(place);
  estimate.Add(TrendOverFrames(estimate.parameters[i].Label(),
                               estimate.parameters[i].is_modulus, *trend, i));
  return true;
}

std::optional<double> MeanNoise(const std::vector<UsedFrame>& frames) {
  double square_sum = 0;
  for (const UsedFrame& frame : frames) {
    const std::optional<double>& noise = frame.frame->estimate.noise_sd;
    if (!noise) {
      return std::nullopt;
    }
    square_sum += *noise * *noise;
  }
  return std::sqrt(square_sum / static_cast<double>(frames.size()));
}

Interval LoadsOf(const std::vector<UsedFrame>& frames) {
  Interval loads = {1, 1};
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const double load = frames[i].frame->load;
    loads.lower = i == 0 ? load : std::min(loads.lower, load);
    loads.upper = i == 0 ? load : std::max(loads.upper, load);
  }
  return loads;
}

void EnterWork(const std::vector<FrameEstimate>& frames, Estimate& estimate) {
  for (const FrameEstimate& frame : frames) {
    estimate.work = estimate.work + frame.estimate.work;
    estimate.seconds += frame.estimate.seconds;
  }
}

std::vector<UsedFrame> UsedOf(const std::vector<FrameEstimate>& frames,
                              const LoadError& load_error) {
  std::vector<UsedFrame> used;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (const std::optional<UsedFrame> use =
            Use(frames[i], i + 1, load_error)) {
      used.push_back(*use);
    }
  }
  return used;
}

// Enters what all frames share but for their noise.
void EnterCommonErrors(const std::vector<UsedFrame>& frames,
                       const Eigen::VectorXi& free, Estimate& estimate) {
  for (const UsedFrame& frame : frames) {
    const DeformationSize& size = frame.frame->estimate.deformation;
    DeformationSize& largest = estimate.deformation;
    largest.strain = std::max(largest.strain, size.strain);
    largest.rotation = std::max(largest.rotation, size.rotation);
  }
  const auto part = [&](ParameterErrors ErrorBudget::*cause, Missing missing) {
    estimate.error_budget.*cause = MeanPart(
        frames, cause, missing, free, Eigen::Index(estimate.parameters.size()));
  };
  part(&ErrorBudget::discretization, Missing::kUnknown);
  part(&ErrorBudget::curvature, Missing::kZero);
  part(&ErrorBudget::law, Missing::kZero);
  part(&ErrorBudget::kinematics, Missing::kZero);
  part(&ErrorBudget::section, Missing::kZero);
}

void AddFindings(const std::vector<UsedFrame>& used, const Scatter& scatter,
                 double likeness, const Eigen::VectorXi& free,
                 Estimate& joint) {
  AddSharedFindings(used, joint);
  const double excess = std::sqrt(scatter.Excess().maxCoeff());
  if (!AddTrend(free, joint) && scatter.p_value < kProbabilityOfScatter &&
      excess > kNotableScatter) {
    joint.Add(FramesScatter(excess, scatter.farthest));
  }
  if (likeness > kNotableLikeness) {
    joint.Add(FramesAlike(likeness));
  }
  const std::size_t num_frames = joint.series->num_frames;
  if (used.size() < num_frames) {
    joint.Add(FramesLeftOut(num_frames - used.size(), num_frames));
  }
}

// Joins frames of the same parameters; fails where no frame can be used.
Estimate Join(const std::vector<FrameEstimate>& frames,
              const LoadError& load_error) {
  std::vector<UsedFrame> used = UsedOf(frames, load_error);
  Estimate joint;
  joint.series =
      SeriesSummary{frames.size(), used.size(), LoadsOf(used), std::nullopt};
  if (used.empty()) {
    const Estimate& first = frames.front().estimate;
    joint.Fail(NoFrameUsable(frames.size(), first.message.empty()
                                                ? first.why_no_standard_error
                                                : first.message));
    return joint;
  }
  ShareNoiseOfFewDegreesOfFreedom(used);
  const std::optional<Eigen::ArrayXd> usual = UsualVariances(used);
  if (usual) {
    RaiseSmallErrors(*usual, used);
  }
  const double likeness = LikenessOf(used);
  for (UsedFrame& frame : used) {
    frame.noise_share *= 1 - likeness;
  }
  const Estimate& first = used.front().frame->estimate;
  joint.Accept();
  joint.element_order = first.element_order;
  joint.parameters = first.parameters;
  const Eigen::VectorXi free = FreeParametersOf(first);
  EnterCommonErrors(used, free, joint);
  const Mean mean = MeanOf(used, WeightsOfFrames(usual, used));
  EnterMean(mean, free, load_error.relative, joint);
  joint.noise_sd = MeanNoise(used);
  joint.series->trend =
      TrendOver(used, free, Eigen::Index(joint.parameters.size()));
  AddFindings(used, mean.scatter, likeness, free, joint);
  return joint;
}

// Whether most of the usable frames determine the shear modulus alone.
bool IsOfShearModulus(const std::vector<FrameEstimate>& frames) {
  const auto is_usable = [](const FrameEstimate& frame) {
    return frame.estimate.IsUsable();
  };
  const auto is_of_it = [](const FrameEstimate& frame) {
    return frame.estimate.IsUsable() &&
           DeterminesShearModulusAlone(frame.estimate);
  };
  return 2 * std::count_if(frames.begin(), frames.end(), is_of_it) >
         std::count_if(frames.begin(), frames.end(), is_usable);
}

// Returns the shear modulus of E and nu, and the part of its error that noise
// makes: noise is taken to correlate E and nu as all of their errors do, as
// only their variances are known by cause.
std::optional<ModulusEstimate> ShearModulusOfElasticity(
    const Estimate& estimate) {
  const std::optional<double> error = estimate.ShearModulusStandardError();
  if (!error) {
    return std::nullopt;
  }
  ModulusEstimate modulus = {estimate.ShearModulus(), *error};
  const ParameterErrors& noise = estimate.error_budget.noise;
  if (noise.size() == 2) {
    const Eigen::Array2d units(estimate.elasticity.youngs_modulus, 1);
    const Eigen::Vector2d share =
        noise.array() * units / estimate.covariance.diagonal().array().sqrt();
    const Eigen::RowVector2d row =
        ShearAndBulkJacobian(estimate.elasticity).row(0) * share.asDiagonal();
    modulus.of_noise = std::sqrt(row * estimate.covariance * row.transpose());
  }
  return modulus;
}

// Returns a frame whose only parameter is the shear modulus: its own, or that
// of its E and nu. It is not usable if this frame has none.
FrameEstimate FrameOfShearModulus(const FrameEstimate& frame) {
  FrameEstimate of_it = {frame.load, {}, frame.likeness, frame.num_alike};
  const Estimate& estimate = frame.estimate;
  const std::optional<ModulusEstimate> modulus =
      estimate.shear_modulus ? estimate.shear_modulus
                             : ShearModulusOfElasticity(estimate);
  if (!estimate.IsUsable() || !modulus) {
    return of_it;
  }
  of_it.estimate.Accept();
  of_it.estimate.element_order = estimate.element_order;
  of_it.estimate.findings = estimate.findings;
  of_it.estimate.noise_sd = estimate.noise_sd;
  of_it.estimate.noise_degrees_of_freedom = estimate.noise_degrees_of_freedom;
  of_it.estimate.deformation = estimate.deformation;
  of_it.estimate.parameters = {modulus->AsParameter()};
  of_it.estimate.parameter_covariance.setConstant(
      1, 1, std::pow(modulus->standard_error, 2));
  of_it.estimate.error_budget.noise =
      Eigen::VectorXd::Constant(1, modulus->of_noise / modulus->value);
  return of_it;
}

double RelativeErrorOfOnly(const Estimate& estimate) {
  return std::sqrt(estimate.parameter_covariance(0, 0)) /
         estimate.parameters[0].value;
}

// Adds the error of the loads to an estimate of E and nu that was made without
// it.
void AddErrorOfLoads(double relative, Estimate& estimate) {
  estimate.parameter_covariance(0, 0) +=
      std::pow(relative * estimate.parameters[0].value, 2);
  ParameterErrors& noise = estimate.error_budget.noise;
  if (noise.size() > 0) {
    noise(0) = std::hypot(noise(0), relative);
  }
}

// Returns the trend of the only parameter as that of the shear modulus, which
// comes after `num_others` parameters that are not joined.
Trend AfterOthers(const Trend& of_only, std::size_t num_others) {
  const auto after_unknown = [num_others](const Eigen::VectorXd& value) {
    Eigen::VectorXd values = Eigen::VectorXd::Constant(
        Eigen::Index(num_others) + 1, Estimate::kUnknown);
    values.tail(1) = value;
    return values;
  };
  return {of_only.is_over_load, after_unknown(of_only.change),
          after_unknown(of_only.standard_error),
          after_unknown(of_only.p_value)};
}

// Joins the shear moduli of frames most of which determine nothing else.  E and
// nu are those of the frame that knows its shear modulus best.
Estimate JoinShearModuli(const std::vector<FrameEstimate>& frames,
                         const LoadError& load_error) {
  std::vector<FrameEstimate> moduli;
  std::size_t best = 0;
  bool is_noise_known = true;
  for (const FrameEstimate& frame : frames) {
    moduli.push_back(FrameOfShearModulus(frame));
    const Estimate& estimate = moduli.back().estimate;
    if (!estimate.IsUsable()) {
      continue;
    }
    is_noise_known =
        is_noise_known && std::isfinite(estimate.error_budget.noise(0));
    if (!moduli[best].estimate.IsUsable() ||
        RelativeErrorOfOnly(estimate) <
            RelativeErrorOfOnly(moduli[best].estimate)) {
      best = moduli.size() - 1;
    }
  }
  Estimate joint = Join(moduli, load_error);
  if (!joint.IsUsable()) {
    return joint;
  }
  joint.shear_modulus = ModulusEstimate{
      joint.parameters[0].value, std::sqrt(joint.parameter_covariance(0, 0))};
  if (is_noise_known) {
    joint.shear_modulus->of_noise =
        joint.parameters[0].value * joint.error_budget.noise(0);
  }
  const Estimate& of_best = frames[best].estimate;
  joint.parameters = of_best.parameters;
  joint.parameter_covariance = of_best.parameter_covariance;
  joint.error_budget = of_best.error_budget;
  if (!load_error.is_in_frames) {
    AddErrorOfLoads(load_error.relative, joint);
  }
  if (std::optional<Trend>& trend = joint.series->trend) {
    trend = AfterOthers(*trend, joint.parameters.size());
  }
  return joint;
}

}  // namespace

Estimate JointEstimate(const Scene& scene, const EstimatorOptions& options,
                       const Estimator& estimator,
                       const std::vector<FrameEstimate>& frames,
                       const LoadError& load_error) {
  Estimate joint = IsOfShearModulus(frames)
                       ? JoinShearModuli(frames, load_error)
                       : Join(frames, load_error);
  joint.estimator = estimator.Name();
  EnterWork(frames, joint);
  if (!joint.IsUsable()) {
    return joint;
  }
  if (IsOneIsotropicMaterial(scene.materials)) {
    const ParameterErrors& by_elements = joint.error_budget.discretization;
    if (by_elements.size() == 2) {
      joint.discretization_error = IfFinite(by_elements(0));
      joint.poisson_ratio_discretization_error = IfFinite(by_elements(1));
    }
  }
  FinishEstimate(estimator.Name(), scene, options, {}, joint);
  return joint;
}

}  // namespace elastimate
