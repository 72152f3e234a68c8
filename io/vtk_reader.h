#ifndef ELASTIMATE_IO_VTK_READER_H_
#define ELASTIMATE_IO_VTK_READER_H_

#include <filesystem>

#include "elastimate/io/vtk_grid.h"

namespace elastimate {

/// Reads an unstructured grid from VTK's XML format (.vtu), in any encoding,
/// through the VTK library.  Throws std::invalid_argument, naming the file.
VtkGrid ReadXmlVtk(const std::filesystem::path& path);

/// The same from VTK's legacy format (.vtk), text or binary.
VtkGrid ReadLegacyVtk(const std::filesystem::path& path);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_VTK_READER_H_
