#ifndef ELASTIMATE_IO_TEXT_INPUT_ERROR_H_
#define ELASTIMATE_IO_TEXT_INPUT_ERROR_H_

#include <filesystem>
#include <stdexcept>
#include <string>

#include "elastimate/io/text/printable.h"

namespace elastimate {

/// Throws std::invalid_argument: "FILE: sentence", both made printable.
[[noreturn]] inline void ThrowInputError(const std::filesystem::path& file,
                                         const std::string& sentence) {
  throw std::invalid_argument(PrintablePath(file) + ": " +
                              Printable(sentence, kLongestSentence));
}

[[noreturn]] inline void ThrowDamagedFile(const std::filesystem::path& file,
                                          const std::string& reason) {
  ThrowInputError(file, "the file is damaged or of another format (" + reason +
                            "); write it again");
}

}  // namespace elastimate

#endif  // ELASTIMATE_IO_TEXT_INPUT_ERROR_H_
