#include "elastimate/core/text/numbers.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace elastimate {
namespace {

constexpr double kLargestRatio = 10;

// Numbers between these are written without an exponent.
constexpr double kSmallestPlain = 1e-4;
constexpr double kLargestPlain = 1e7;
constexpr int kMostDigits = 10;

// The power of ten of the first digit of a number that is not zero.
int PlaceOf(double value) {
  return static_cast<int>(std::floor(std::log10(std::abs(value))));
}

// Rounds to the digit of this power of ten and writes no exponent.
std::string PlainText(double value, int place) {
  const double unit = std::pow(10, place);
  if (std::abs(value) < unit / 2) {
    value = 0;  // Without a sign.
  } else if (place > 0) {
    value = std::round(value / unit) * unit;
  }
  std::ostringstream text;
  text << std::fixed << std::setprecision(std::max(-place, 0)) << value;
  return text.str();
}

}  // namespace

std::string NumberText(double value, int digits) {
  if (std::isnan(value)) {
    return "nan";  // Streams write the sign of some.
  }
  // With a precision of 3, streams write 13200 as 1.32e+04.
  if (std::abs(value) >= 1 && std::abs(value) < kLargestPlain &&
      PlaceOf(value) >= digits - 1) {
    return PlainText(value, PlaceOf(value) - digits + 1);
  }
  std::ostringstream text;
  text << std::setprecision(digits) << value;
  return text.str();
}

std::string TwoDigits(double value) { return NumberText(value, 2); }

std::string Counted(std::size_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

std::string ValueWithError(double value, double error) {
  const double larger = std::max(std::abs(value), error);
  if (!(error > 0) || larger < kSmallestPlain || !(larger < kLargestPlain)) {
    int digits = 6;
    if (error > 0 && value != 0) {
      const double ratio = std::abs(value) / error;
      digits =
          std::clamp(2 + int(std::ceil(std::log10(ratio))), 3, kMostDigits);
    }
    return NumberText(value, digits) + " +- " + NumberText(error, 2);
  }
  // This is the place of the second digit of the error, which rounding may
  // carry into a third.
  int place = PlaceOf(error) - 1;
  place += std::round(error / std::pow(10, place)) > 99 ? 1 : 0;
  const int least = PlaceOf(larger) + 1 - kMostDigits;
  return PlainText(value, std::max(place, least)) + " +- " +
         (place >= least ? PlainText(error, place) : NumberText(error, 2));
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
