#include "elastimate/io/vtk/vtu_grid.h"

#include <vtkDataArraySelection.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <memory>
#include <new>
#include <set>
#include <stdexcept>
#include <string>

#include "elastimate/io/vtk/vtk_grid.h"
#include "elastimate/io/vtk/vtk_messages.h"
#include "elastimate/io/vtk/xml_vtk_check.h"

namespace elastimate {
namespace {

/// Leaves all but numbers in the field data alone: VTK 9.1 writes beyond the
/// end of an array of strings where there are more of them than the file says,
/// and crashes where a type is unknown.
class VtuReader : public vtkXMLUnstructuredGridReader {
 public:
  static VtuReader* New();

 protected:
  VtuReader() = default;
  ~VtuReader() override = default;
  VtuReader(const VtuReader&) = delete;
  VtuReader& operator=(const VtuReader&) = delete;

  int ReadPrimaryElement(vtkXMLDataElement* primary) override {
    static const std::set<std::string> kNumbers = {
        "Int8",   "UInt8", "Int16",  "UInt16",  "Int32",
        "UInt32", "Int64", "UInt64", "Float32", "Float64"};
    const int is_read =
        vtkXMLUnstructuredGridReader::ReadPrimaryElement(primary);
    const int count = FieldDataElement == nullptr
                          ? 0
                          : FieldDataElement->GetNumberOfNestedElements();
    for (int i = count - 1; i >= 0; --i) {
      vtkXMLDataElement* const array = FieldDataElement->GetNestedElement(i);
      const char* const type = array->GetAttribute("type");
      if (type == nullptr || kNumbers.count(type) == 0) {
        FieldDataElement->RemoveNestedElement(array);
      }
    }
    return is_read;
  }
};

vtkStandardNewMacro(VtuReader);

/// Tells whether there is as much memory as a sound file takes.
bool HasMemoryFor(const std::filesystem::path& path) {
  const std::unique_ptr<char[]> some(new (
      std::nothrow) char[16'000'000 + 20 * std::filesystem::file_size(path)]);
  return some != nullptr;
}

}  // namespace

vtkSmartPointer<vtkUnstructuredGrid> ReadVtuGrid(
    const std::filesystem::path& path) {
  const VtkMessages messages(VtkMessages::Warnings::kIgnored);
  try {
    const XmlVtkFrame frame = CheckXmlVtk(path);
    if (messages.HasError() || !frame.damage.empty()) {
      ThrowDamagedVtk(
          path, messages.HasError() ? messages.FirstError() : frame.damage);
    }
    vtkNew<VtuReader> reader;
    for (const std::string& name : frame.text_point_arrays) {
      reader->GetPointDataArraySelection()->DisableArray(name.c_str());
    }
    for (const std::string& name : frame.text_cell_arrays) {
      reader->GetCellDataArraySelection()->DisableArray(name.c_str());
    }
    ReadByVtk(path, messages, reader.Get());
    return reader->GetOutput();
  } catch (const std::bad_alloc&) {
    if (!HasMemoryFor(path)) {
      throw;
    }
    ThrowDamagedVtk(path, "its sizes exceed the memory");
  } catch (const std::length_error&) {
    ThrowDamagedVtk(path, "its sizes exceed the memory");
  }
}

}  // namespace elastimate
