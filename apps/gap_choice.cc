#include "apps/gap_choice.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "elastimate/core/scene/observed_displacements.h"
#include "elastimate/core/text/numbers.h"
#include "elastimate/estimators/registry.h"

namespace elastimate {
namespace {

/// A scene with some gaps filled, and what a fit of it leaves.
struct Outline {
  SceneReading reading;
  std::optional<Estimate> estimate;  // Nothing where no fit takes the scene.
  double num_observed = 0;

  std::vector<bool> IsFilled() const {
    std::vector<bool> is_filled;
    for (const PointGap& gap : reading.gaps) {
      is_filled.push_back(gap.is_filled);
    }
    return is_filled;
  }
  double Residual() const {
    return estimate ? estimate->displacement_residual.value_or(NAN) : NAN;
  }
};

// Enters the frame of the largest load as the measurement of the scene.
void EnterLargestFrame(const FrameSeries& frames, Scene& scene) {
  std::size_t largest = 0;
  for (std::size_t i = 1; i < frames.files.size(); ++i) {
    // Loads that grow are the rule where no record says what they are.
    if (!(std::abs(frames.Load(i)) < std::abs(frames.Load(largest)))) {
      largest = i;
    }
  }
  scene.load_cases = {frames.read(largest)};
}

// Fits the elements as they are, whose error is alike with and without a gap.
void Fit(Outline& outline) {
  Scene scene = outline.reading.scene;
  scene.origin = Origin::kComputed;
  try {
    if (outline.reading.frames) {
      EnterLargestFrame(*outline.reading.frames, scene);
    }
    outline.estimate = MakeEstimator("iterative-fe")->Run(scene, {});
    outline.num_observed =
        static_cast<double>(ObservedDisplacements(scene).Size());
  } catch (const std::invalid_argument&) {
    // The estimator that was asked for says what is wrong with the scene.
  }
}

double CorrelationOf(const Outline& outline) {
  return outline.estimate
             ? std::clamp(outline.estimate->residual_correlation.value_or(0),
                          0.0, 0.99)
             : 0;
}

// Returns how much better `b` fits than `a`, as twice the difference of
// logarithmic likelihoods of independent residuals; NaN without both fits.
double Evidence(const Outline& a, const Outline& b) {
  const Outline& better = b.Residual() < a.Residual() ? b : a;
  const double alike = CorrelationOf(better);
  const double num_independent =
      better.num_observed * (1 - alike) / (1 + alike);
  return 2 * num_independent * std::log(a.Residual() / b.Residual());
}

// Returns the largest logarithmic change of a modulus.
double ChangeOfModuli(const Estimate& a, const Estimate& b) {
  double change = 0;
  for (std::size_t i = 0;
       i < std::min(a.parameters.size(), b.parameters.size()); ++i) {
    const double ratio = b.parameters[i].value / a.parameters[i].value;
    if (a.parameters[i].IsStiffness() && ratio > 0) {
      change = std::max(change, std::abs(std::log(ratio)));
    }
  }
  return change;
}

// Returns "21 places around (10, 5), 6 places around (3, 2) and 4 more gaps" of
// the gaps that are filled, or of the others; empty without any.
std::string GapsWhere(bool is_filled, const Outline& outline) {
  constexpr std::size_t kMostNamed = 3;
  std::string text;
  std::size_t count = 0;
  for (const PointGap& gap : outline.reading.gaps) {
    if (gap.is_filled == is_filled && ++count <= kMostNamed) {
      text += (text.empty() ? "" : ", ") + std::to_string(gap.num_places) +
              " places around (" + NumberText(gap.center(0)) + ", " +
              NumberText(gap.center(1)) + ")";
    }
  }
  return count > kMostNamed
             ? text + " and " + Counted(count - kMostNamed, "more gap")
             : text;
}

// Says which gaps are filled, and why.
void AddNotices(double change, Outline& outline) {
  // A change of less is said in the error alone.
  constexpr double kNotable = 0.01;
  const std::string why =
      change > kNotable
          ? "although the displacements do not decide that, and E may change "
            "by " +
                Percent(change)
          : "because that fits the displacements better";
  std::vector<std::string>& notices = outline.reading.notices;
  const std::string filled = GapsWhere(true, outline);
  if (!filled.empty()) {
    notices.push_back("no point was measured at " + filled +
                      "; the specimen is assumed to go on there, " + why +
                      "; if it ends there, give \"gaps\": \"open\" beside "
                      "\"points\"");
  }
  const std::string open = GapsWhere(false, outline);
  if (!open.empty()) {
    notices.push_back("no point was measured at " + open +
                      "; the specimen is assumed to end there, " + why +
                      "; if it goes on there, give \"gaps\": \"filled\" beside "
                      "\"points\"");
  }
}

/// Starts from the better of all gaps filled and all open, then tries each of
/// the largest by itself.
class OutlineSearch {
 public:
  explicit OutlineSearch(const ReadOutline& read)
      : read_(read), best_{read({}), {}, 0} {}

  Outline Run() {
    constexpr std::size_t kMostTried = 8;
    if (NumGaps() == 0) {
      return std::move(best_);
    }
    Fit(best_);
    Compare(std::vector<bool>(NumGaps(), true));
    for (std::size_t i = 0;
         NumGaps() > 1 && i < std::min(NumGaps(), kMostTried); ++i) {
      std::vector<bool> is_filled = best_.IsFilled();
      is_filled[i] = !is_filled[i];
      Compare(is_filled);
    }
    const double change = std::sqrt(variance_);
    AddNotices(change, best_);
    double& sd = best_.reading.scene.mesh.section.thickness_relative_sd;
    sd = std::hypot(sd, change);
    return std::move(best_);
  }

 private:
  std::size_t NumGaps() const { return best_.reading.gaps.size(); }

  void Compare(const std::vector<bool>& is_filled) {
    // Twice the logarithm of a likelihood ratio that leaves no doubt.
    constexpr double kDecisive = 10;
    if (is_filled == best_.IsFilled()) {
      return;
    }
    Outline other;
    try {
      other.reading = read_(is_filled);
    } catch (const std::invalid_argument&) {
      return;  // No mesh has such gaps.
    }
    Fit(other);
    const double evidence = Evidence(best_, other);
    if (std::isnan(evidence)) {
      return;
    }
    const double change = ChangeOfModuli(*best_.estimate, *other.estimate);
    const double ratio = other.Residual() / best_.Residual();
    if (evidence > kDecisive) {
      best_ = std::move(other);
    }
    // Where the better fit leaves more than noise, and hardly less than the
    // other one, it may not be right either.
    const double doubt = std::abs(evidence) > kDecisive
                             ? CorrelationOf(best_) * std::min(ratio, 1 / ratio)
                             : 1;
    variance_ += std::pow(doubt * change, 2);
  }

  ReadOutline read_;
  Outline best_;
  double variance_ = 0;
};

}  // namespace

SceneReading ReadWithGapsChosen(const ReadOutline& read) {
  return OutlineSearch(read).Run().reading;
}

}  // namespace elastimate
