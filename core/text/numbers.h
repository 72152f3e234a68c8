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

/// A share, or a change or an error relative to a value: "5.2 %".  Percentages
/// beyond 1000, which tell nobody more, become "more than ten times its value".
std::string Percent(double ratio);

/// A share of something else: "5.2 % of the load", or "more than ten times the
/// load".
std::string PercentOf(double ratio, const std::string& whole);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_TEXT_NUMBERS_H_
