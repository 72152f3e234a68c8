#include "elastimate/io/vtk_reader.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArraySelection.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <algorithm>
#include <new>
#include <stdexcept>
#include <string>

#include "elastimate/core/large_pages.h"
#include "elastimate/io/input_error.h"
#include "elastimate/io/legacy_vtk_check.h"
#include "elastimate/io/vtk_messages.h"
#include "elastimate/io/xml_vtk_check.h"

namespace elastimate {
namespace {

[[noreturn]] void ThrowDamaged(const std::filesystem::path& path,
                               const std::string& reason) {
  ThrowInputError(path,
                  "the file is damaged or not a VTK file of an unstructured "
                  "grid (" +
                      reason + "); write it again");
}

/// The values of an array of any numeric type, at once in the type and the
/// place where they are wanted.
template <typename Value>
void CopyValues(vtkDataArray* array, Value* to) {
  switch (array->GetDataType()) {
    vtkTemplateMacro(
        std::copy_n(static_cast<const VTK_TT*>(array->GetVoidPointer(0)),
                    array->GetNumberOfValues(), to));
    default: {  // Bits.
      vtkNew<vtkDoubleArray> doubles;
      doubles->DeepCopy(array);
      std::copy_n(doubles->GetPointer(0), doubles->GetNumberOfValues(), to);
    }
  }
}

/// One column per tuple.
Eigen::MatrixXd ToMatrix(vtkDataArray* array) {
  Eigen::MatrixXd matrix;
  ResizeInLargePages(array->GetNumberOfComponents(), array->GetNumberOfTuples(),
                     matrix);
  CopyValues(array, matrix.data());
  return matrix;
}

/// The named numeric arrays; strings are left out.
std::vector<FileArray> ToArrays(vtkDataSetAttributes* attributes) {
  std::vector<FileArray> arrays;
  for (int i = 0; i < attributes->GetNumberOfArrays(); ++i) {
    vtkDataArray* array = attributes->GetArray(i);
    if (array != nullptr && array->GetName() != nullptr) {
      arrays.push_back({array->GetName(), ToMatrix(array)});
    }
  }
  return arrays;
}

VtkGrid ToVtkGrid(vtkUnstructuredGrid* from) {
  VtkGrid grid;
  if (from->GetPoints() != nullptr) {
    grid.points.resize(3, from->GetNumberOfPoints());
    CopyValues(from->GetPoints()->GetData(), grid.points.data());
  }
  if (from->GetCells() != nullptr && from->GetCellTypesArray() != nullptr) {
    grid.cell_types.resize(from->GetCellTypesArray()->GetNumberOfValues());
    CopyValues(from->GetCellTypesArray(), grid.cell_types.data());
    grid.cells = from->GetCells();
    grid.cells->ConvertTo64BitStorage();
  }
  grid.point_arrays = ToArrays(from->GetPointData());
  grid.cell_arrays = ToArrays(from->GetCellData());
  return grid;
}

template <typename Reader>
VtkGrid Read(const std::filesystem::path& path, const VtkMessages& messages,
             Reader* reader) {
  reader->SetFileName(path.c_str());
  reader->Update();
  if (messages.HasError() || reader->GetErrorCode() != 0) {
    ThrowDamaged(path, messages.HasError() ? messages.FirstError()
                                           : "VTK could not read it");
  }
  return ToVtkGrid(reader->GetOutput());
}

}  // namespace

VtkGrid ReadXmlVtk(const std::filesystem::path& path) {
  const VtkMessages messages(VtkMessages::Warnings::kIgnored);
  try {
    const XmlVtkFrame frame = CheckXmlVtk(path);
    if (messages.HasError() || !frame.damage.empty()) {
      ThrowDamaged(path,
                   messages.HasError() ? messages.FirstError() : frame.damage);
    }
    vtkNew<vtkXMLUnstructuredGridReader> reader;
    for (const std::string& name : frame.text_point_arrays) {
      reader->GetPointDataArraySelection()->DisableArray(name.c_str());
    }
    for (const std::string& name : frame.text_cell_arrays) {
      reader->GetCellDataArraySelection()->DisableArray(name.c_str());
    }
    return Read(path, messages, reader.Get());
  } catch (const std::bad_alloc&) {
    ThrowDamaged(path, "its sizes exceed the memory");
  } catch (const std::length_error&) {
    ThrowDamaged(path, "its sizes exceed the memory");
  }
}

VtkGrid ReadLegacyVtk(const std::filesystem::path& path) {
  // Much that is wrong is a mere warning for VTK.
  const VtkMessages messages(VtkMessages::Warnings::kAreErrors);
  try {
    const std::string damage = WhyLegacyVtkIsDamaged(path);
    if (!damage.empty()) {
      ThrowDamaged(path, damage);
    }
    vtkNew<vtkUnstructuredGridReader> reader;
    reader->ReadAllVectorsOn();
    reader->ReadAllScalarsOn();
    reader->ReadAllFieldsOn();
    reader->ReadAllNormalsOn();
    reader->ReadAllTensorsOn();
    return Read(path, messages, reader.Get());
  } catch (const std::bad_alloc&) {
    ThrowDamaged(path, "its sizes exceed the memory");
  } catch (const std::length_error&) {
    ThrowDamaged(path, "its sizes exceed the memory");
  }
}

}  // namespace elastimate
