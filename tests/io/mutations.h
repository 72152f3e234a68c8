#ifndef ELASTIMATE_TESTS_IO_MUTATIONS_H_
#define ELASTIMATE_TESTS_IO_MUTATIONS_H_

#include <random>
#include <string>

namespace elastimate {

/// `content` with one to three of the damages that files come by: cut, bits
/// flipped, bytes replaced or lost, numbers replaced by others (negative, huge,
/// not a number), lines doubled, lost or swapped, sections swapped, other line
/// ends, long words and control characters put in.  The same on every machine.
std::string Mutated(std::string content, std::mt19937& random);

}  // namespace elastimate

#endif  // ELASTIMATE_TESTS_IO_MUTATIONS_H_
