#include "tests/io/vtk_files.h"

#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <map>

namespace elastimate {
namespace {

const std::map<ElementKind, int> kCellTypes = {
    {ElementKind::kTet4, VTK_TETRA},
    {ElementKind::kTet10, VTK_QUADRATIC_TETRA},
    {ElementKind::kCurvedTet10, VTK_QUADRATIC_TETRA},
    {ElementKind::kHex8, VTK_HEXAHEDRON},
    {ElementKind::kHex27, VTK_TRIQUADRATIC_HEXAHEDRON},
    {ElementKind::kTri3, VTK_TRIANGLE},
    {ElementKind::kTri6, VTK_QUADRATIC_TRIANGLE},
    {ElementKind::kCurvedTri6, VTK_QUADRATIC_TRIANGLE},
    {ElementKind::kQuad4, VTK_QUAD},
    {ElementKind::kQuad9, VTK_BIQUADRATIC_QUAD}};

void AddFields(const std::vector<Field>& fields, vtkDataSetAttributes* to) {
  for (const Field& field : fields) {
    vtkNew<vtkDoubleArray> array;
    array->SetName(field.name.c_str());
    array->SetNumberOfComponents(static_cast<int>(field.values.rows()));
    array->SetNumberOfTuples(field.values.cols());
    Eigen::Map<Eigen::MatrixXd>(array->GetPointer(0), field.values.rows(),
                                field.values.cols()) = field.values;
    to->AddArray(array);
  }
}

void FillGrid(const Mesh& mesh, const Fields& fields,
              vtkUnstructuredGrid* grid) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (Eigen::Index node = 0; node < mesh.NumNodes(); ++node) {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    position.head(mesh.Dimension()) = mesh.nodes.col(node);
    points->InsertNextPoint(position.data());
  }
  grid->SetPoints(points);
  for (Eigen::Index element = 0; element < mesh.NumElements(); ++element) {
    const Eigen::Matrix<vtkIdType, Eigen::Dynamic, 1> nodes =
        mesh.elements.col(element).cast<vtkIdType>();
    grid->InsertNextCell(kCellTypes.at(mesh.kind), nodes.size(), nodes.data());
  }
  if (mesh.Dimension() == 2) {
    vtkNew<vtkDoubleArray> model;
    model->SetName("model");
    model->InsertNextValue(
        mesh.section.model == SectionModel::kPlaneStress ? 1 : 2);
    grid->GetFieldData()->AddArray(model);
    vtkNew<vtkDoubleArray> thickness;
    thickness->SetName("thickness");
    thickness->InsertNextValue(mesh.section.thickness);
    grid->GetFieldData()->AddArray(thickness);
  }
  AddFields(fields.point, grid->GetPointData());
  AddFields(fields.cell, grid->GetCellData());
}

void WriteXml(const std::filesystem::path& path, vtkUnstructuredGrid* grid,
              const VtkEncoding& encoding) {
  using Data = VtkEncoding::Data;
  using Compression = VtkEncoding::Compression;
  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->SetFileName(path.c_str());
  writer->SetInputData(grid);
  writer->SetDataMode(encoding.data == Data::kAscii ? vtkXMLWriter::Ascii
                      : encoding.data == Data::kBinary
                          ? vtkXMLWriter::Binary
                          : vtkXMLWriter::Appended);
  writer->SetEncodeAppendedData(encoding.data == Data::kAppendedBase64);
  writer->SetCompressorType(
      encoding.compression == Compression::kZlib   ? vtkXMLWriter::ZLIB
      : encoding.compression == Compression::kLz4  ? vtkXMLWriter::LZ4
      : encoding.compression == Compression::kLzma ? vtkXMLWriter::LZMA
                                                   : vtkXMLWriter::NONE);
  writer->SetHeaderType(encoding.is_64_bit ? vtkXMLWriter::UInt64
                                           : vtkXMLWriter::UInt32);
  writer->SetByteOrder(encoding.is_big_endian ? vtkXMLWriter::BigEndian
                                              : vtkXMLWriter::LittleEndian);
  writer->Write();
}

void WriteLegacy(const std::filesystem::path& path, vtkUnstructuredGrid* grid,
                 const VtkEncoding& encoding) {
  vtkNew<vtkUnstructuredGridWriter> writer;
  writer->SetFileName(path.c_str());
  writer->SetInputData(grid);
  writer->SetFileType(encoding.data == VtkEncoding::Data::kAscii ? VTK_ASCII
                                                                 : VTK_BINARY);
  writer->SetFileVersion(encoding.version);
  writer->Write();
}

}  // namespace

std::vector<VtkEncoding> AllVtkEncodings() {
  using Data = VtkEncoding::Data;
  using Compression = VtkEncoding::Compression;
  return {
      {"XmlAscii", false, Data::kAscii, Compression::kNone, false, false, 0},
      {"XmlBinary", false, Data::kBinary, Compression::kNone, false, false, 0},
      {"XmlBinaryZlib", false, Data::kBinary, Compression::kZlib, false, false,
       0},
      {"XmlBinaryLz4", false, Data::kBinary, Compression::kLz4, true, false, 0},
      {"XmlBinaryLzma", false, Data::kBinary, Compression::kLzma, true, false,
       0},
      {"XmlRaw", false, Data::kAppendedRaw, Compression::kNone, true, false, 0},
      {"XmlRawBigEndian", false, Data::kAppendedRaw, Compression::kNone, false,
       true, 0},
      {"XmlRawZlib", false, Data::kAppendedRaw, Compression::kZlib, true, false,
       0},
      {"XmlAppendedBase64", false, Data::kAppendedBase64, Compression::kNone,
       false, false, 0},
      {"XmlAppendedBase64Zlib", false, Data::kAppendedBase64,
       Compression::kZlib, false, false, 0},
      {"LegacyAscii42", true, Data::kAscii, Compression::kNone, false, false,
       42},
      {"LegacyBinary42", true, Data::kBinary, Compression::kNone, false, false,
       42},
      {"LegacyAscii51", true, Data::kAscii, Compression::kNone, false, false,
       51},
      {"LegacyBinary51", true, Data::kBinary, Compression::kNone, false, false,
       51},
  };
}

Scene TwoTetrahedra() {
  Scene scene;
  // Two tetrahedra on one face, the second of negative orientation.
  scene.mesh.nodes.resize(3, 5);
  scene.mesh.nodes.transpose() << 0, 0, 0,  //
      1, 0, 0,                              //
      0, 1, 0,                              //
      0.1, 0.2, 1.0 / 3.0,                  //
      0.3, 0.3, -0.7;
  scene.mesh.elements.resize(4, 2);
  scene.mesh.elements.transpose() << 0, 1, 2, 3, 0, 1, 2, 4;
  scene.mesh.regions.resize(2);
  scene.mesh.regions << 4, -7;
  scene.supports.held.setConstant(3, 5, false);
  scene.supports.held.leftCols(3) = true;
  scene.supports.held(1, 2) = false;
  scene.supports.displacement.setZero(3, 5);
  scene.supports.displacement(0, 1) = 0.1;
  for (int i = 0; i < 2; ++i) {
    LoadCase load_case;
    load_case.displacement =
        Eigen::MatrixXd::NullaryExpr(3, 5, [i](auto row, auto column) {
          return 1e-3 / (1.0 + i + row + 3 * column);
        });
    load_case.loads = {NodalForces{load_case.displacement * 1e6 / 7.0}};
    scene.load_cases.push_back(load_case);
  }
  scene.load_cases[1].observed.setConstant(3, 5, true);
  scene.load_cases[1].observed(2, 4) = false;
  return scene;
}

void WriteEncoded(const std::filesystem::path& path, const Mesh& mesh,
                  const Fields& fields, const VtkEncoding& encoding) {
  vtkNew<vtkUnstructuredGrid> grid;
  FillGrid(mesh, fields, grid);
  if (encoding.is_legacy) {
    WriteLegacy(path, grid, encoding);
  } else {
    WriteXml(path, grid, encoding);
  }
}

}  // namespace elastimate
