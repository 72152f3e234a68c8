#ifndef ELASTIMATE_IO_XML_VTK_CHECK_H_
#define ELASTIMATE_IO_XML_VTK_CHECK_H_

#include <filesystem>
#include <string>

namespace elastimate {

/// What is wrong with the frame of a VTK XML file, in a few words, or an empty
/// string: its kind, its counts, and where the blocks of its binary arrays lie
/// and how large they are.  VTK 9.1 trusts all of these, and crashes or hangs
/// when they are wrong.  XML errors go to VtkMessages.
std::string WhyXmlVtkIsDamaged(const std::filesystem::path& path);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_XML_VTK_CHECK_H_
