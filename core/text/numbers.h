#ifndef ELASTIMATE_CORE_TEXT_NUMBERS_H_
#define ELASTIMATE_CORE_TEXT_NUMBERS_H_

#include <cstddef>
#include <string>

namespace elastimate {

// These functions write numbers for the sentences and tables that people read.

/// Writes so many significant digits, with an exponent only below 1e-4 and from
/// 1e7 on: "0.3", "13200", "2e-09".
std::string NumberText(double value, int digits = 6);

/// Writes two significant digits.
std::string TwoDigits(double value);

/// Writes a number of things whose name takes an s in the plural: "1 node",
/// "3 nodes".
std::string Counted(std::size_t count, const std::string& noun);

/// Writes a value and its standard deviation, which has two digits, to the same
/// place: "49890 +- 120", "0.348 +- 0.012".  Both have an exponent where both
/// are below 1e-4 or one is at least 1e7: "1.2346e+09 +- 1.2e+07".
std::string ValueWithError(double value, double error);

/// Writes a share, or a change or an error relative to a value: "5.2 %".
/// Percentages beyond 1000, which tell nobody more, become "more than ten times
/// its value".
std::string Percent(double ratio);

/// Writes a share of something else: "5.2 % of the load", or "more than ten
/// times the load".
std::string PercentOf(double ratio, const std::string& whole);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_TEXT_NUMBERS_H_
