#include "elastimate/core/text/numbers.h"

#include <cmath>
#include <iomanip>
#include <sstream>

namespace elastimate {
namespace {

constexpr double kLargestRatio = 10;

}  // namespace

std::string NumberText(double value, int digits) {
  if (std::isnan(value)) {
    return "nan";  // Streams write the sign of some.
  }
  std::ostringstream text;
  text << std::setprecision(digits) << value;
  return text.str();
}

std::string TwoDigits(double value) {
  if (value == 0 || !std::isfinite(value)) {
    return NumberText(value);
  }
  // With a precision of 2, 100 is 1e+02.
  const double unit = std::pow(10, std::floor(std::log10(std::abs(value))) - 1);
  return NumberText(std::round(value / unit) * unit);
}

std::string Percent(double ratio) {
  return std::abs(ratio) > kLargestRatio ? "more than ten times its value"
                                         : TwoDigits(100 * ratio) + " %";
}

std::string PercentOf(double ratio, const std::string& whole) {
  return std::abs(ratio) > kLargestRatio ? "more than ten times " + whole
                                         : Percent(ratio) + " of " + whole;
}

}  // namespace elastimate
