#ifndef ELASTIMATE_CORE_TEXT_NUMBERS_H_
#define ELASTIMATE_CORE_TEXT_NUMBERS_H_

#include <string>

namespace elastimate {

// Numbers as sentences and tables for people have them.

/// To so many significant digits, whatever the magnitude: "0.3", "2e-09".
std::string NumberText(double value, int digits = 6);

/// To two significant digits, without an exponent where NumberText has one
/// first: "100".
std::string TwoDigits(double value);

/// A value and its standard deviation, which has two digits, to the same place:
/// "49890 +- 120", "0.348 +- 0.012".  Of two that are both below 1e-4, or of
/// which one is from 1e7 on, each has an exponent: "1.2346e+09 +- 1.2e+07".
std::string ValueWithError(double value, double error);

/// A share, or a change or an error relative to a value: "5.2 %".  Percentages
/// beyond 1000, which tell nobody more, become "more than ten times its value".
std::string Percent(double ratio);

/// A share of something else: "5.2 % of the load", or "more than ten times the
/// load".
std::string PercentOf(double ratio, const std::string& whole);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_TEXT_NUMBERS_H_
