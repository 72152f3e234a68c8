#include "apps/frame_fit.h"

#include <cstddef>
#include <cstring>
#include <optional>
#include <type_traits>
#include <utility>

namespace elastimate {
namespace {

// Passes all fields of a struct, whose names stand in the order of its
// declaration.
#define ELASTIMATE_PASS_FIELDS(value, ...) \
  auto& [__VA_ARGS__] = value;             \
  All(__VA_ARGS__)

// Writes values to bytes.  If it was constructed from bytes, it reads the
// values from them in the same order.  The names of all fields of a struct are
// listed once, so that this file does not compile once a struct gets another
// field.
class FitArchive {
 public:
  FitArchive() = default;
  explicit FitArchive(std::string bytes)
      : bytes_(std::move(bytes)), is_reading_(true) {}

  template <class... Values>
  void All(Values&... values) {
    (Pass(values), ...);
  }
  std::string TakeBytes() { return std::move(bytes_); }

 private:
  void PassBytes(void* value, std::size_t size) {
    if (size == 0) {  // The address of no values may be null.
      return;
    }
    if (is_reading_) {
      std::memcpy(value, bytes_.data() + place_, size);
      place_ += size;
    } else {
      bytes_.append(static_cast<const char*>(value), size);
    }
  }

  template <class Value>
  void Pass(Value& value) {
    static_assert(std::is_trivially_copyable_v<Value>);
    PassBytes(&value, sizeof(value));
  }
  void Pass(std::string& text) {
    std::size_t size = text.size();
    Pass(size);
    text.resize(size);
    PassBytes(text.data(), size);
  }
  template <class Value>
  void Pass(std::vector<Value>& values) {
    std::size_t size = values.size();
    Pass(size);
    values.resize(size);
    for (Value& value : values) {
      Pass(value);
    }
  }
  template <class Value>
  void Pass(std::optional<Value>& value) {
    bool is_there = value.has_value();
    Pass(is_there);
    if (is_there) {
      Pass(value ? *value : value.emplace());
    } else {
      value.reset();
    }
  }
  template <int kRows, int kColumns>
  void Pass(Eigen::Matrix<double, kRows, kColumns>& matrix) {
    Eigen::Index rows = matrix.rows();
    Eigen::Index columns = matrix.cols();
    All(rows, columns);
    matrix.resize(rows, columns);
    PassBytes(matrix.data(), std::size_t(matrix.size()) * sizeof(double));
  }

  void Pass(Finding& finding) {
    ELASTIMATE_PASS_FIELDS(finding, code, severity, text, advice);
  }
  void Pass(ParameterEstimate& parameter) {
    ELASTIMATE_PASS_FIELDS(parameter, name, symbol, regions, is_modulus,
                           is_known, beside, limits, value, standard_error,
                           interval);
  }
  void Pass(StiffnessEstimate& stiffness) {
    ELASTIMATE_PASS_FIELDS(stiffness, regions, value, standard_error);
  }
  void Pass(AxisEstimate& axis) {
    ELASTIMATE_PASS_FIELDS(axis, regions, first_rotation, direction,
                           standard_error, anisotropy);
  }
  void Pass(ErrorBudget& budget) {
    ELASTIMATE_PASS_FIELDS(budget, noise, bias, model, outliers, discretization,
                           curvature, law, kinematics, section, prior);
  }
  void Pass(Camera& camera) {
    ELASTIMATE_PASS_FIELDS(camera, rotation, translation);
  }
  void Pass(MaterialEstimate& material) {
    ELASTIMATE_PASS_FIELDS(material, regions, determination, energy_share,
                           residual_chi_square, residual_correlation,
                           largest_differences);
  }
  void Pass(LawComparison& comparison) {
    ELASTIMATE_PASS_FIELDS(comparison, law, num_parameters, chi_square,
                           criterion);
  }
  void Pass(MapEstimate& map) {
    ELASTIMATE_PASS_FIELDS(
        map, status, findings, verdict, field_log_evidence, region_log_evidence,
        supported_parameters, youngs_modulus, youngs_modulus_standard_error,
        resolution_length, regions, boundary, region_of_element,
        mean_youngs_modulus, poisson_ratio, covariance, mesh_covariance,
        noise_sd, displacement_residual, fitted_displacement, cameras,
        is_scale_known, element_order, work);
  }
  void Pass(RegionMerge& merge) {
    ELASTIMATE_PASS_FIELDS(merge, first, second, chi_square, limit, is_taken);
  }
  void Pass(Trend& trend) {
    ELASTIMATE_PASS_FIELDS(trend, is_over_load, change, standard_error,
                           p_value);
  }
  void Pass(SeriesSummary& series) {
    ELASTIMATE_PASS_FIELDS(series, num_frames, num_used, loads, trend);
  }
  void Pass(Rung& rung) {
    ELASTIMATE_PASS_FIELDS(rung, estimator, element_order, status, elasticity,
                           work, seconds, decision);
  }
  void Pass(StageTime& time) { ELASTIMATE_PASS_FIELDS(time, stage, seconds); }
  void Pass(Estimate& estimate) {
    ELASTIMATE_PASS_FIELDS(
        estimate, estimator, status, element_order, mesh_divisions,
        is_model_in_doubt, message, elasticity, covariance, findings,
        parameters, parameter_covariance, stiffnesses, axes, shear_modulus,
        error_budget, deformation, poisson_ratio_interval,
        why_no_standard_error, noise_sd, noise_degrees_of_freedom,
        force_residual, displacement_residual, identifiability_angle,
        noise_attenuation, residual_correlation, correlation_length,
        discretization_error, poisson_ratio_discretization_error,
        discretization_correction, uncorrected_parameters, outliers,
        fitted_displacement, cameras, active_bounds, materials, combinations,
        merges, laws, large_strain_law, map, series, rungs, work, stages,
        seconds);
  }
  void Pass(FrameEstimate& frame) {
    ELASTIMATE_PASS_FIELDS(frame, load, estimate, likeness, num_alike);
  }
  void Pass(FrameFit& fit) { ELASTIMATE_PASS_FIELDS(fit, frame, residual); }

  std::string bytes_;
  bool is_reading_ = false;
  std::size_t place_ = 0;
};

#undef ELASTIMATE_PASS_FIELDS

}  // namespace

std::string BytesOf(std::vector<FrameFit> fits) {
  FitArchive archive;
  archive.All(fits);
  return archive.TakeBytes();
}

std::vector<FrameFit> FitsOf(std::string bytes) {
  FitArchive archive(std::move(bytes));
  std::vector<FrameFit> fits;
  archive.All(fits);
  return fits;
}

}  // namespace elastimate
