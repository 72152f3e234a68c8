#include "elastimate/io/vtk/vtu_writer.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <algorithm>

#include "elastimate/core/scene/loads.h"
#include "elastimate/io/mesh/section_number.h"
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

vtkSmartPointer<vtkCellArray> ToVtkCells(const Eigen::MatrixXi& elements,
                                         const std::vector<int>& order) {
  std::vector<vtkIdType> point_of_node(order.size());
  for (std::size_t point = 0; point < order.size(); ++point) {
    point_of_node[order[point]] = static_cast<vtkIdType>(point);
  }
  vtkNew<vtkIdTypeArray> offsets;
  offsets->SetNumberOfValues(elements.cols() + 1);
  for (Eigen::Index i = 0; i <= elements.cols(); ++i) {
    offsets->SetValue(i, i * elements.rows());
  }
  vtkNew<vtkIdTypeArray> nodes;
  nodes->SetNumberOfValues(elements.size());
  for (Eigen::Index i = 0; i < elements.size(); ++i) {
    const int node = elements.data()[i];
    nodes->SetValue(i, order.empty() ? node : point_of_node[node]);
  }
  auto cells = vtkSmartPointer<vtkCellArray>::New();
  cells->SetData(offsets, nodes);
  return cells;
}

int CellType(ElementKind kind) {
  switch (kind) {
    case ElementKind::kTet10:
    case ElementKind::kCurvedTet10:
      return VTK_QUADRATIC_TETRA;
    case ElementKind::kHex8:
      return VTK_HEXAHEDRON;
    case ElementKind::kHex27:
      return VTK_TRIQUADRATIC_HEXAHEDRON;
    case ElementKind::kTri3:
      return VTK_TRIANGLE;
    case ElementKind::kTri6:
    case ElementKind::kCurvedTri6:
      return VTK_QUADRATIC_TRIANGLE;
    case ElementKind::kQuad4:
      return VTK_QUAD;
    case ElementKind::kQuad9:
      return VTK_BIQUADRATIC_QUAD;
    case ElementKind::kTet4:
      break;
  }
  return VTK_TETRA;
}

/// Returns vectors in the order of the points, with z = 0 for those of a plane.
Eigen::MatrixXd AtPoints(const Eigen::MatrixXd& values, const Mesh& mesh,
                         const std::vector<int>& order) {
  Eigen::MatrixXd at_points =
      order.empty() ? values : Eigen::MatrixXd(values(Eigen::all, order));
  if (mesh.Dimension() == 2 && values.rows() == 2) {
    at_points.conservativeResize(3, Eigen::NoChange);
    at_points.row(2).setZero();
  }
  return at_points;
}

void CheckFields(const std::filesystem::path& path,
                 const std::vector<Field>& fields, Eigen::Index num_columns) {
  for (const Field& field : fields) {
    if (field.values.cols() != num_columns || field.values.rows() == 0) {
      ThrowInputError(path, "the field '" + field.name + "' is " +
                                std::to_string(field.values.rows()) + " x " +
                                std::to_string(field.values.cols()) +
                                "; give it " + std::to_string(num_columns) +
                                " columns");
    }
  }
}

void AddField(const std::string& name, const Eigen::MatrixXd& values,
              vtkDataSetAttributes* attributes) {
  const auto array = ToVtkArray(values);
  array->SetName(name.c_str());
  attributes->AddArray(array);
}

void AddNumber(const char* name, int value, vtkFieldData* data) {
  vtkNew<vtkIntArray> number;
  number->SetName(name);
  number->InsertNextValue(value);
  data->AddArray(number);
}

void AddSection(const Section& section, vtkFieldData* data) {
  AddNumber("model",
            static_cast<int>(std::find(kNumberedModels.begin(),
                                       kNumberedModels.end(), section.model) -
                             kNumberedModels.begin()),
            data);
  vtkNew<vtkDoubleArray> thickness;
  thickness->SetName("thickness");
  thickness->InsertNextValue(section.thickness);
  data->AddArray(thickness);
}

vtkSmartPointer<vtkUnstructuredGrid> ToVtkGrid(
    const std::filesystem::path& path, const Mesh& mesh, const Fields& fields,
    const std::vector<int>& order) {
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  points->SetData(ToVtkArray(AtPoints(mesh.nodes, mesh, order)));
  grid->SetPoints(points);
  grid->SetCells(CellType(mesh.kind), ToVtkCells(mesh.elements, order));
  CheckFields(path, fields.point, mesh.NumNodes());
  CheckFields(path, fields.cell, mesh.NumElements());
  for (const Field& field : fields.point) {
    AddField(field.name, AtPoints(field.values, mesh, order),
             grid->GetPointData());
  }
  for (const Field& field : fields.cell) {
    AddField(field.name, field.values, grid->GetCellData());
  }
  if (mesh.Dimension() == 2) {
    AddSection(mesh.section, grid->GetFieldData());
  }
  if (fields.origin != Origin::kMeasured) {
    AddNumber("computed", fields.origin == Origin::kComputed ? 1 : 2,
              grid->GetFieldData());
  }
  return grid;
}

Eigen::MatrixXd ToNumbers(const ComponentMask& mask) {
  return mask.cast<double>().matrix();
}

// The array is left out where all displacements are zero, unless those of the
// scene are not.
void AddSupports(const Supports& supports, const std::string& suffix,
                 Fields& fields) {
  fields.point.push_back({"fixed" + suffix, ToNumbers(supports.held)});
  const Eigen::MatrixXd prescribed =
      supports.held.select(supports.displacement.array(), 0.0).matrix();
  if (!prescribed.isZero(0.0) || !suffix.empty()) {
    fields.point.push_back({"prescribed" + suffix, prescribed});
  }
}

}  // namespace

std::string CaseSuffix(std::size_t k) {
  return k == 0 ? "" : "_" + std::to_string(k + 1);
}

Fields SceneFields(const Scene& scene) {
  Fields fields;
  fields.origin = scene.origin;
  AddSupports(scene.supports, "", fields);
  for (std::size_t i = 0; i < scene.load_cases.size(); ++i) {
    const LoadCase& load_case = scene.load_cases[i];
    const std::string suffix = CaseSuffix(i);
    fields.point.push_back(
        {"force" + suffix, AssembleLoads(scene.mesh, load_case.loads)});
    if (load_case.supports) {
      AddSupports(*load_case.supports, suffix, fields);
    }
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
                       const Fields& fields,
                       const std::vector<int>& file_order) {
  const VtkMessages messages(VtkMessages::Warnings::kIgnored);
  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->SetInputData(ToVtkGrid(path, mesh, fields, file_order));
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
              const Fields& fields, const std::vector<int>& file_order) {
  CheckWritable(path);
  WriteWholeFile(path, VtuContent(path, mesh, fields, file_order));
}

}  // namespace elastimate
