#include "elastimate/io/vtk_reader.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArraySelection.h>
#include <vtkDoubleArray.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <new>
#include <stdexcept>
#include <string>

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

/// Any numeric array as doubles, one column per tuple.
Eigen::MatrixXd ToMatrix(vtkDataArray* array) {
  vtkNew<vtkDoubleArray> doubles;
  doubles->DeepCopy(array);
  return Eigen::Map<const Eigen::MatrixXd>(doubles->GetPointer(0),
                                           doubles->GetNumberOfComponents(),
                                           doubles->GetNumberOfTuples());
}

std::vector<std::int64_t> ToIntegers(vtkDataArray* array) {
  vtkNew<vtkIdTypeArray> integers;
  integers->DeepCopy(array);
  const vtkIdType* begin = integers->GetPointer(0);
  return {begin, begin + integers->GetNumberOfValues()};
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
    grid.points = ToMatrix(from->GetPoints()->GetData());
  }
  if (from->GetCells() != nullptr && from->GetCellTypesArray() != nullptr) {
    grid.cell_types = ToIntegers(from->GetCellTypesArray());
    grid.offsets = ToIntegers(from->GetCells()->GetOffsetsArray());
    grid.connectivity = ToIntegers(from->GetCells()->GetConnectivityArray());
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
