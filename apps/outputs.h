#ifndef ELASTIMATE_APPS_OUTPUTS_H_
#define ELASTIMATE_APPS_OUTPUTS_H_

#include <string>
#include <vector>

namespace elastimate {

/// Gives standard input, output and error a place that refuses what is written,
/// where the caller has closed them: otherwise the next file that is opened
/// would be taken for them.
void OpenClosedStandardStreams();

/// The formats that --out may have.
enum class OutFormats { kVtu, kVtuOrTable, kTable, kJson, kPage };

/// Tells whether the name of a file ends with `extension`, in letters of any
/// case.
bool HasExtension(const std::string& file, const std::string& extension);

/// Checks --out and --json before any work is done: that they could be written,
/// and that none of them is an input, the other one, or where standard output
/// goes.  Throws std::invalid_argument.
void CheckOutputFlags(const std::vector<std::string>& inputs,
                      OutFormats formats = OutFormats::kVtu);

/// Throws std::invalid_argument when not all of the text arrives.  Where its
/// reader is gone, as after `| head -1`, this ends the program as SIGPIPE does.
void WriteStandardOutput(const std::string& text);

/// Writes the notices to standard error, one a line.
void PrintNotices(const std::vector<std::string>& notices);

}  // namespace elastimate

#endif  // ELASTIMATE_APPS_OUTPUTS_H_
