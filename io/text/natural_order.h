#ifndef ELASTIMATE_IO_TEXT_NATURAL_ORDER_H_
#define ELASTIMATE_IO_TEXT_NATURAL_ORDER_H_

#include <string>
#include <vector>

namespace elastimate {

/// Sorts names by the numbers in them, from left to right by size, and by the
/// text between these: frame_9, frame_10; 1.25kN, 1.5kN; -2mm, -1mm; 1e-3,
/// 2e-3.  A hyphen is a minus sign unless a letter, a digit or a hyphen stands
/// before it.  An "e" begins an exponent behind a number unless a letter stands
/// before that number.  Numbers with two points (2024.01.31, 1.2.3) are several
/// integers.  Where names have such numbers, or have 1.10 beside 1.9, as no
/// decimals are written, all numbers with one point are two integers as well.
/// O(n log n) for n names.
/// like, so are all numbers with one point.  O(n log n) for n names.
void SortByNumbers(std::vector<std::string>& names);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_TEXT_NATURAL_ORDER_H_
