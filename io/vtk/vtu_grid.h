#ifndef ELASTIMATE_IO_VTK_VTU_GRID_H_
#define ELASTIMATE_IO_VTK_VTU_GRID_H_

#include <vtkSmartPointer.h>

#include <filesystem>

class vtkUnstructuredGrid;

namespace elastimate {

/// Reads an unstructured grid from VTK's XML format, in any encoding, without
/// its arrays of strings.  Throws std::invalid_argument, naming the file, where
/// that is damaged.
vtkSmartPointer<vtkUnstructuredGrid> ReadVtuGrid(
    const std::filesystem::path& path);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_VTK_VTU_GRID_H_
