#ifndef ELASTIMATE_IO_LEGACY_VTK_CHECK_H_
#define ELASTIMATE_IO_LEGACY_VTK_CHECK_H_

#include <filesystem>
#include <string>

namespace elastimate {

/// What is wrong with the frame of a legacy VTK file, in a few words, or an
/// empty string: whether it has as many values as it announces, and whether the
/// sizes of its cells add up.  VTK 9.1 fills the rest of an array that was cut
/// with whatever is in memory, mostly without a word, and crashes on wrong cell
/// sizes.
std::string WhyLegacyVtkIsDamaged(const std::filesystem::path& path);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_LEGACY_VTK_CHECK_H_
