#ifndef ELASTIMATE_IO_VTK_XML_VTK_CHECK_H_
#define ELASTIMATE_IO_VTK_XML_VTK_CHECK_H_

#include <filesystem>
#include <string>
#include <vector>

namespace elastimate {

/// What the frame of a VTK XML file says ahead of its data.
struct XmlVtkFrame {
  /// The damage in a few words, or empty.  It concerns the kind of the file,
  /// its counts, names, and where the blocks of its binary arrays lie and how
  /// large they are.  VTK 9.1 trusts most of these, and crashes or hangs when
  /// they are wrong.
  std::string damage;
  /// The names of arrays of strings, which VTK 9.1 cannot read safely.
  std::vector<std::string> text_point_arrays;
  std::vector<std::string> text_cell_arrays;
};

/// XML errors go to VtkMessages.
XmlVtkFrame CheckXmlVtk(const std::filesystem::path& path);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_VTK_XML_VTK_CHECK_H_
