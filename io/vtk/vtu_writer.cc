#include "elastimate/io/vtk/vtu_writer.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include "elastimate/core/scene/loads.h"
#include "elastimate/io/text/file_output.h"
#include "elastimate/io/text/input_error.h"
#include "elastimate/io/vtk/vtk_messages.h"

namespace elastimate {
namespace {

vtkSmartPointer<vtkDoubleArray> ToVtkArray(
    const Eigen::Ref<const Eigen::MatrixXd>& values) {
  auto array = vtkSmartPointer<vtkDoubleArray>::New();
  array->SetNumberOfComponents(static_cast<int>(values.rows()));
  array->SetNumberOfTuples(values.cols());
  Eigen::Map<Eigen::MatrixXd>(array->GetPointer(0), values.rows(),
                              values.cols()) = values;
  return array;
}

vtkSmartPointer<vtkCellArray> ToVtkCells(const Eigen::MatrixXi& elements) {
  vtkNew<vtkIdTypeArray> offsets;
  offsets->SetNumberOfValues(elements.cols() + 1);
  for (Eigen::Index i = 0; i <= elements.cols(); ++i) {
    offsets->SetValue(i, i * elements.rows());
  }
  vtkNew<vtkIdTypeArray> nodes;
  nodes->SetNumberOfValues(elements.size());
  for (Eigen::Index i = 0; i < elements.size(); ++i) {
    nodes->SetValue(i, elements.data()[i]);
  }
  auto cells = vtkSmartPointer<vtkCellArray>::New();
  cells->SetData(offsets, nodes);
  return cells;
}

void AddFields(const std::filesystem::path& path,
               const std::vector<Field>& fields, Eigen::Index num_columns,
               vtkDataSetAttributes* attributes) {
  for (const Field& field : fields) {
    if (field.values.cols() != num_columns || field.values.rows() == 0) {
      ThrowInputError(path, "the field '" + field.name + "' is " +
                                std::to_string(field.values.rows()) + " x " +
                                std::to_string(field.values.cols()) +
                                "; give it " + std::to_string(num_columns) +
                                " columns");
    }
    const auto array = ToVtkArray(field.values);
    array->SetName(field.name.c_str());
    attributes->AddArray(array);
  }
}

vtkSmartPointer<vtkUnstructuredGrid> ToVtkGrid(
    const std::filesystem::path& path, const Mesh& mesh, const Fields& fields) {
  if (mesh.elements.rows() != 4) {
    ThrowInputError(path, "only meshes of linear tetrahedra can be written");
  }
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  points->SetData(ToVtkArray(mesh.nodes));
  grid->SetPoints(points);
  grid->SetCells(VTK_TETRA, ToVtkCells(mesh.elements));
  AddFields(path, fields.point, mesh.NumNodes(), grid->GetPointData());
  AddFields(path, fields.cell, mesh.NumElements(), grid->GetCellData());
  return grid;
}

Eigen::MatrixXd ToNumbers(const ComponentMask& mask) {
  return mask.cast<double>().matrix();
}

}  // namespace

Fields SceneFields(const Scene& scene) {
  Fields fields;
  const Supports& supports = scene.supports;
  fields.point.push_back({"fixed", ToNumbers(supports.held)});
  const Eigen::MatrixXd prescribed =
      supports.held.select(supports.displacement.array(), 0.0).matrix();
  if (!prescribed.isZero(0.0)) {
    fields.point.push_back({"prescribed", prescribed});
  }
  for (std::size_t i = 0; i < scene.load_cases.size(); ++i) {
    const LoadCase& load_case = scene.load_cases[i];
    const std::string suffix = i == 0 ? "" : "_" + std::to_string(i + 1);
    fields.point.push_back(
        {"force" + suffix, AssembleLoads(scene.mesh, load_case.loads)});
    if (load_case.displacement.size() > 0) {
      fields.point.push_back({"displacement" + suffix, load_case.displacement});
    }
    if (load_case.observed.size() > 0) {
      fields.point.push_back(
          {"observed" + suffix, ToNumbers(load_case.observed)});
    }
  }
  if (scene.mesh.regions.size() > 0) {
    fields.cell.push_back(
        {"region", scene.mesh.regions.cast<double>().transpose()});
  }
  return fields;
}

std::string VtuContent(const std::filesystem::path& path, const Mesh& mesh,
                       const Fields& fields) {
  const VtkMessages messages(VtkMessages::Warnings::kIgnored);
  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->SetInputData(ToVtkGrid(path, mesh, fields));
  writer->SetDataModeToBinary();
  writer->SetCompressionLevel(1);  // Doubles hardly shrink further.
  writer->WriteToOutputStringOn();
  if (writer->Write() == 0 || writer->GetErrorCode() != 0 ||
      messages.HasError()) {
    ThrowInputError(path, "cannot be written (" + messages.FirstError() + ")");
  }
  return writer->GetOutputString();
}

void WriteVtu(const std::filesystem::path& path, const Mesh& mesh,
              const Fields& fields) {
  CheckWritable(path);
  WriteWholeFile(path, VtuContent(path, mesh, fields));
}

}  // namespace elastimate
