// Scenes: from arrays, from files, and by simulation.

#include <pybind11/eigen.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "elastimate/core/materials/material_parameters.h"
#include "elastimate/core/mesh/bounding_box.h"
#include "elastimate/core/scene/quadratic_scene.h"
#include "elastimate/core/scene/scene_builder.h"
#include "elastimate/core/text/numbers.h"
#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/io/points/point_locator.h"
#include "elastimate/io/scene/origin.h"
#include "elastimate/io/scene/scene_reader.h"
#include "elastimate/io/scene/section.h"
#include "elastimate/io/vtk/vtk_cells.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/given_mesh.h"
#include "python/python_scene.h"
#include "python/simulation.h"

namespace py = pybind11;

namespace elastimate {
namespace {

using Numbers = Array<double>;
using Integers = Array<int>;
using Flags = Array<bool>;
using Released = py::call_guard<py::gil_scoped_release>;

SectionModel SectionModelNamed(const std::string& name) {
  const std::optional<SectionModel> model = SectionModelOfName(name);
  if (!model) {
    throw std::invalid_argument("section=\"" + name + "\"; it must be " +
                                kSectionModels);
  }
  return *model;
}

Origin OriginNamed(const std::string& name) {
  const std::optional<Origin> origin = OriginOfName(name);
  if (!origin) {
    throw std::invalid_argument("origin=\"" + name + "\"; it must be " +
                                kOrigins);
  }
  return *origin;
}

std::shared_ptr<PythonScene> MakeScene(
    const Numbers& points, const Array<unsigned char>& types,
    const Array<std::int64_t>& connectivity, const Array<std::int64_t>& offsets,
    const std::optional<std::string>& section, double thickness) {
  const auto copied = [](const auto& array) {
    return std::vector(array.data(), array.data() + array.size());
  };
  VtkCells cells = {ColumnsOf(points), copied(types), copied(connectivity),
                    copied(offsets)};
  const py::gil_scoped_release release;
  auto made = std::make_shared<PythonScene>();
  made->given = std::make_shared<const GivenMesh>(std::move(cells));
  const MeshFile& file = made->given->File();
  const SectionModel model = section ? SectionModelNamed(*section)
                             : file.Dimension() == 2
                                 ? SectionModel::kPlaneStress
                                 : SectionModel::kSolid;
  made->scene = UnsupportedScene(
      {file.kind, {model, thickness}, made->given->Nodes(), file.elements, {}});
  made->notices = made->given->Notices();
  return made;
}

void Hold(PythonScene& self, const Flags& held, const Numbers& displacement) {
  Supports& supports = self.scene.supports;
  supports.held = ColumnsOf(held).array();
  supports.displacement = ColumnsOf(displacement);
  self.given->Complete(supports);
}

void HoldBox(
    PythonScene& self, const Eigen::VectorXd& lower,
    const Eigen::VectorXd& upper,
    const std::optional<Eigen::Array<bool, Eigen::Dynamic, 1>>& components,
    const std::optional<Eigen::VectorXd>& displacement) {
  const Eigen::Index dimension = self.scene.mesh.Dimension();
  HoldInBox(lower, upper,
            components.value_or(Eigen::Array<bool, Eigen::Dynamic, 1>::Constant(
                dimension, true)),
            displacement.value_or(Eigen::VectorXd::Zero(dimension)),
            self.scene);
}

// Holds the nodes of a box that moved as it was measured, or as a rigid face.
void HoldMovedBox(
    PythonScene& self, const Eigen::VectorXd& lower,
    const Eigen::VectorXd& upper,
    const std::optional<Eigen::Array<bool, Eigen::Dynamic, 1>>& components,
    bool is_rigid) {
  const Eigen::Index dimension = self.scene.mesh.Dimension();
  const Eigen::Array<bool, Eigen::Dynamic, 1> held = components.value_or(
      Eigen::Array<bool, Eigen::Dynamic, 1>::Constant(dimension, true));
  Supports& supports = self.scene.supports;
  // It checks the box, and that no other support holds its nodes.
  const std::size_t num_boxes = supports.boxes.size();
  const ComponentMask before = supports.held;
  HoldInBox(lower, upper, held, Eigen::VectorXd::Zero(dimension), self.scene);
  supports.boxes.resize(num_boxes);
  if (supports.unknown.size() == 0) {
    supports.unknown.setConstant(before.rows(), before.cols(), false);
  }
  RigidFace face = {{}, held};
  for (Eigen::Index node = 0; node < self.scene.mesh.NumNodes(); ++node) {
    const auto x = self.scene.mesh.nodes.col(node).array();
    if (!((x >= lower.array()).all() && (x <= upper.array()).all())) {
      continue;
    }
    if ((before.col(node) && held).any()) {
      throw std::invalid_argument(
          "two supports hold node " + std::to_string(node) +
          ", one of which moved; leave the node out of one of them");
    }
    face.nodes.push_back(int(node));
    supports.unknown.col(node) = supports.unknown.col(node) || held;
  }
  if (is_rigid) {
    supports.rigid_faces.push_back(std::move(face));
  }
}

PointDisplacements Locate(const Mesh& mesh, const Numbers& positions,
                          const Numbers& displacement,
                          std::optional<double> given_tolerance) {
  const Eigen::MatrixXd columns = ColumnsOf(positions);
  if (columns.rows() != mesh.Dimension() || !columns.allFinite()) {
    throw std::invalid_argument(
        "points need " + std::to_string(mesh.Dimension()) +
        " finite coordinates each; give an array of one row for each point");
  }
  const double tolerance =
      given_tolerance.value_or(kUsualPointTolerance * DiagonalOf(mesh.nodes));
  const LocatedPoints located = PointLocator(mesh).Locate(columns);
  Eigen::Index farthest = 0;
  if (columns.cols() > 0 && located.distance.maxCoeff(&farthest) > tolerance) {
    throw std::invalid_argument(
        "point " + std::to_string(farthest) + " lies " +
        NumberText(located.distance(farthest), 4) +
        " outside the mesh, more than the tolerance of " +
        NumberText(tolerance, 4) +
        "; give points in the unit and the coordinates of the mesh, leave the "
        "point out, or give a larger tolerance");
  }
  return {located.points, ColumnsOf(displacement), {}};
}

void AddCase(PythonScene& self, const std::vector<Load>& loads,
             const std::optional<Numbers>& displacement,
             const std::optional<Flags>& observed,
             const std::optional<Numbers>& points,
             const std::optional<Numbers>& point_displacement,
             std::optional<double> tolerance, std::optional<double> noise_sd,
             const std::vector<std::tuple<std::vector<int>, Eigen::VectorXd,
                                          Eigen::VectorXd>>& resultants) {
  LoadCase load_case;
  load_case.loads = loads;
  if (displacement) {
    load_case.displacement = ColumnsOf(*displacement);
  }
  if (observed) {
    load_case.observed = ColumnsOf(*observed).array();
  }
  if (points && point_displacement) {
    load_case.points =
        Locate(self.scene.mesh, *points, *point_displacement, tolerance);
  }
  load_case.noise_sd = noise_sd;
  for (const auto& [nodes, force, sd] : resultants) {
    load_case.resultants.push_back({nodes, force, sd});
  }
  self.given->Complete(load_case);
  self.scene.load_cases.push_back(std::move(load_case));
}

std::shared_ptr<PythonScene> Read(
    const std::vector<std::filesystem::path>& paths, bool is_optional,
    const std::optional<std::string>& section,
    const std::optional<double>& thickness, const std::string& regions,
    const std::string& material) {
  const std::map<std::string, RegionChoice> choices = {
      {"given", RegionChoice::kAsGiven},
      {"one", RegionChoice::kOne},
      {"each", RegionChoice::kEach}};
  if (choices.count(regions) == 0) {
    throw std::invalid_argument("regions=\"" + regions +
                                "\"; it must be given, one or each");
  }
  SceneChoices chosen;
  if (section) {
    chosen.section.model = SectionModelNamed(*section);
  }
  chosen.section.thickness = thickness;
  chosen.regions = choices.at(regions);
  chosen.law.law = material;
  const auto start = std::chrono::steady_clock::now();
  SceneReading reading = ReadScene(
      paths, is_optional ? Measurement::kOptional : Measurement::kRequired,
      chosen);
  if (reading.frames) {
    throw std::invalid_argument(
        paths.at(0).string() +
        " has the key \"frames\"; estimate it with the command line, or read a "
        "scene of one frame and give the others to Scene.prepare()");
  }
  auto read = std::make_shared<PythonScene>();
  read->scene = std::move(reading.scene);
  read->notices = std::move(reading.notices);
  read->read_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start)
          .count();
  return read;
}

// Returns a copy with other choices; null ones leave what there is.
std::shared_ptr<PythonScene> WithChoices(
    const PythonScene& self, int order, std::optional<double> noise_sd,
    const std::optional<std::string>& origin,
    const std::optional<std::string>& map) {
  if (order != 1 && order != 2) {
    throw std::invalid_argument("order=" + std::to_string(order) +
                                "; it must be 1 for linear elements or 2 for "
                                "quadratic ones");
  }
  auto chosen = std::make_shared<PythonScene>(self);
  Scene& scene = chosen->scene;
  for (LoadCase& load_case : scene.load_cases) {
    load_case.noise_sd = noise_sd ? noise_sd : load_case.noise_sd;
  }
  scene.origin = origin ? OriginNamed(*origin) : scene.origin;
  if (map) {
    GiveField(*map, scene.materials);
  }
  ValidateScene(scene);
  if (order > scene.mesh.Order()) {
    scene = QuadraticScene(scene);
  }
  return chosen;
}

std::vector<ParameterEstimate> ParametersOf(const PythonScene& self) {
  const Scene& scene = self.scene;
  std::vector<Material> materials = scene.materials;
  if (materials.empty()) {
    materials.emplace_back();
  }
  const MaterialParameters chart(materials, scene.mesh.section.model);
  std::vector<ParameterEstimate> parameters;
  for (const MaterialParameters::Parameter& parameter : chart.All()) {
    ParameterEstimate described;
    described.name = std::string(parameter.law_parameter->name);
    described.symbol = std::string(parameter.law_parameter->symbol);
    described.regions = materials[parameter.material].regions;
    described.is_modulus = parameter.law_parameter->is_modulus;
    described.is_known = parameter.known.has_value();
    described.value = parameter.known.value_or(described.value);
    parameters.push_back(described);
  }
  return parameters;
}

std::shared_ptr<PythonScene> Simulate(const PythonScene& self,
                                      const Eigen::VectorXd& parameters,
                                      int order, double noise_sd,
                                      std::uint64_t seed) {
  auto simulated = std::make_shared<PythonScene>();
  simulated->scene =
      SimulatedScene(self.scene, parameters, order, noise_sd, seed);
  simulated->given = self.given;
  return simulated;
}

py::array Nodes(const py::object& self) {
  const auto& scene = self.cast<const PythonScene&>();
  return scene.given == nullptr || scene.given->IsScene()
             ? RowsOf(scene.scene.mesh.nodes, self)
             : CopiedRows(scene.given->Nodes());
}

py::array Elements(const py::object& self) {
  const auto& scene = self.cast<const PythonScene&>();
  return RowsOf(scene.given == nullptr ? scene.scene.mesh.elements
                                       : scene.given->File().elements,
                self);
}

const LoadCase& CaseAt(const PythonScene& self, std::size_t k) {
  if (k >= self.scene.load_cases.size()) {
    throw py::index_error("there is no load case " + std::to_string(k));
  }
  return self.scene.load_cases[k];
}

py::array Displacement(const py::object& self, std::size_t k) {
  const auto& scene = self.cast<const PythonScene&>();
  const LoadCase& load_case = CaseAt(scene, k);
  const bool has_same_nodes = scene.given == nullptr || scene.given->IsScene();
  if (load_case.displacement.size() == 0 ||
      (has_same_nodes && load_case.observed.size() == 0)) {
    return RowsOf(load_case.displacement, self);
  }
  Eigen::MatrixXd measured = load_case.displacement;
  if (load_case.observed.size() > 0) {
    measured = load_case.observed.select(
        measured.array(), std::numeric_limits<double>::quiet_NaN());
  }
  return CopiedRows(has_same_nodes ? measured
                                   : scene.given->OfPoints(measured));
}

Material MakeMaterial(
    const std::string& law, const std::vector<int>& regions,
    const std::map<std::string, double>& known,
    const std::map<std::string,
                   std::pair<std::optional<double>, std::optional<double>>>&
        bounds,
    const std::map<std::string, std::pair<double, double>>& priors,
    const std::vector<Eigen::MatrixXd>& axes,
    const std::vector<std::string>& fields) {
  Material material;
  material.law = law;
  material.regions = regions;
  for (const auto& [name, value] : known) {
    material.known.push_back({name, value});
  }
  for (const auto& [name, ends] : bounds) {
    material.bounds.push_back({name, {ends.first, ends.second}});
  }
  for (const auto& [name, prior] : priors) {
    material.priors.push_back({name, prior.first, prior.second});
  }
  for (const Eigen::MatrixXd& axis : axes) {
    // A single axis is a column either way; one for each element comes as rows.
    material.axes.push_back(axis.cols() == 1 ? axis : axis.transpose());
  }
  material.fields = fields;
  return material;
}

void BindLoads(py::module_& module) {
  py::class_<NodalForces>(module, "NodalForces")
      .def(py::init([](const Numbers& force) {
             return NodalForces{ColumnsOf(force)};
           }),
           py::arg("force"), "Forces on nodes: shape (n, d) [force].");
  py::class_<BodyForce>(module, "BodyForce")
      .def(py::init([](const Numbers& density) {
             return BodyForce{ColumnsOf(density)};
           }),
           py::arg("force_density"),
           "A force per volume: shape (1, d) or (m, d) [force / length^3].");
  py::class_<Traction>(module, "Traction")
      .def(py::init([](const Integers& facets, const Numbers& traction) {
             return Traction{ColumnsOf(facets), ColumnsOf(traction)};
           }),
           py::arg("facets"), py::arg("traction"),
           "A force per area on facets: shape (1, d) or (f, d) [force / "
           "length^2].");
  py::class_<Pressure>(module, "Pressure")
      .def(py::init([](const Integers& facets, double pressure, bool follows) {
             return Pressure{ColumnsOf(facets), pressure, follows};
           }),
           py::arg("facets"), py::arg("pressure"), py::arg("follows"),
           "A pressure on facets [force / length^2]; positive pushes inwards.");
  py::class_<SurfaceForce>(module, "SurfaceForce")
      .def(py::init([](const Integers& facets, const Eigen::VectorXd& force) {
             return SurfaceForce{ColumnsOf(facets), force};
           }),
           py::arg("facets"), py::arg("force"),
           "A total force, spread evenly over facets: shape (d,) [force].");
}

void BindMaterial(py::module_& module) {
  py::class_<Material>(module, "Material",
                       R"(What a part of a specimen is made of.

law      one of elastimate.laws()
regions  the region ids that it fills; the whole mesh if there are none
known    values of parameters, by their name
bounds   (lower, upper) of parameters that are not known, by their name; None
         for an end that is open
priors   (value, standard deviation) of such parameters, by their name
axes     directions, shape (d,) or (m, d), as many as the law has axes
fields   names of parameters with a value for each element: "youngs_modulus")")
      .def(py::init(&MakeMaterial), py::arg("law") = "isotropic", py::kw_only(),
           py::arg("regions") = std::vector<int>(),
           py::arg("known") = std::map<std::string, double>(),
           py::arg("bounds") =
               std::map<std::string, std::pair<std::optional<double>,
                                               std::optional<double>>>(),
           py::arg("priors") =
               std::map<std::string, std::pair<double, double>>(),
           py::arg("axes") = std::vector<Eigen::MatrixXd>(),
           py::arg("fields") = std::vector<std::string>())
      .def_readonly("law", &Material::law)
      .def_readonly("regions", &Material::regions);
}

void BindParameter(py::module_& module) {
  py::class_<ParameterEstimate>(module, "Parameter",
                                "What is said of one parameter of a material.")
      .def_readonly("name", &ParameterEstimate::name,
                    "As its law calls it, such as \"youngs_modulus\".")
      .def_readonly("symbol", &ParameterEstimate::symbol, "Such as \"E\".")
      .def_property_readonly("label", &ParameterEstimate::Label,
                             "Such as \"E\" or \"nu of region 3\".")
      .def_readonly("regions", &ParameterEstimate::regions,
                    "The region ids of its material; none where that fills "
                    "the mesh.")
      .def_readonly("is_modulus", &ParameterEstimate::is_modulus,
                    "Whether it is a stiffness [pressure], else a ratio [1].")
      .def_readonly("is_known", &ParameterEstimate::is_known,
                    "Whether it was given, and not estimated.")
      .def_readonly("value", &ParameterEstimate::value,
                    "[pressure] or, of a ratio, [1]; NaN where unknown.")
      .def_readonly("standard_error", &ParameterEstimate::standard_error,
                    "In the unit of the value; None where unknown.")
      .def_property_readonly("is_determined", &ParameterEstimate::IsDetermined,
                             "Whether it is given, or has a standard error of "
                             "at most a third of a "
                             "modulus or 0.15 of a ratio.")
      .def_property_readonly(
          "interval",
          [](const ParameterEstimate& self)
              -> std::optional<std::pair<double, double>> {
            if (!self.interval) {
              return std::nullopt;
            }
            return std::pair(self.interval->lower, self.interval->upper);
          },
          "Where it lies with a probability of 95 %; None where unknown.")
      .def("__repr__", [](const ParameterEstimate& self) {
        return "<Parameter " + self.Label() + " = " +
               py::str(py::float_(self.value)).cast<std::string>() + ">";
      });
}

}  // namespace

void BindScene(py::module_& module) {
  BindLoads(module);
  BindMaterial(module);
  BindParameter(module);
  py::class_<PythonScene, std::shared_ptr<PythonScene>>(module, "Scene")
      .def(py::init(&MakeScene), py::arg("points"), py::arg("types"),
           py::arg("connectivity"), py::arg("offsets"), py::arg("section"),
           py::arg("thickness"))
      .def("hold", &Hold, py::arg("held"), py::arg("displacement"))
      .def("hold_box", &HoldBox, py::arg("lower"), py::arg("upper"),
           py::arg("components"), py::arg("displacement"))
      .def("hold_moved_box", &HoldMovedBox, py::arg("lower"), py::arg("upper"),
           py::arg("components"), py::arg("is_rigid"))
      .def(
          "facets_in_box",
          [](const PythonScene& self, const Eigen::VectorXd& lower,
             const Eigen::VectorXd& upper) {
            return Eigen::MatrixXi(
                FacetsInBox(self.scene.mesh, lower, upper).transpose());
          },
          py::arg("lower"), py::arg("upper"))
      .def(
          "set_regions",
          [](PythonScene& self, const Eigen::VectorXi& regions) {
            self.scene.mesh.regions = regions;
          },
          py::arg("regions"))
      .def(
          "set_materials",
          [](PythonScene& self, const std::vector<Material>& materials) {
            self.scene.materials = materials;
          },
          py::arg("materials"))
      .def(
          "set_rigid_motion_free",
          [](PythonScene& self, bool is_free) {
            self.scene.is_rigid_motion_free = is_free;
          },
          py::arg("is_free"))
      .def(
          "set_origin",
          [](PythonScene& self, const std::string& origin) {
            self.scene.origin = OriginNamed(origin);
          },
          py::arg("origin"))
      .def("add_case", &AddCase, py::arg("loads"), py::arg("displacement"),
           py::arg("observed"), py::arg("points"),
           py::arg("point_displacement"), py::arg("tolerance"),
           py::arg("noise_sd"), py::arg("resultants"))
      .def(
          "finish",
          [](PythonScene& self) {
            self.scene = self.given->Finished(std::move(self.scene));
          },
          Released())
      .def("with_choices", &WithChoices, py::arg("order"), py::arg("noise_sd"),
           py::arg("origin"), py::arg("map"), Released())
      .def("simulate", &Simulate, py::arg("parameters"), py::arg("order"),
           py::arg("noise_sd"), py::arg("seed"), Released())
      .def("parameters", &ParametersOf, Released())
      .def_property_readonly(
          "kind",
          [](const PythonScene& self) {
            return std::string(self.scene.mesh.Topology().name);
          })
      .def_property_readonly(
          "dimension",
          [](const PythonScene& self) { return self.scene.mesh.Dimension(); })
      .def_property_readonly("nodes", &Nodes)
      .def_property_readonly("elements", &Elements)
      .def_property_readonly(
          "num_points",
          [](const PythonScene& self) { return self.given->NumPoints(); })
      .def_property_readonly(
          "num_cells",
          [](const PythonScene& self) { return self.given->NumCells(); })
      .def_property_readonly(
          "cell_of_element",
          [](const PythonScene& self) { return self.given->CellOfElement(); })
      .def_property_readonly(
          "num_cases",
          [](const PythonScene& self) { return self.scene.load_cases.size(); })
      .def("displacement", &Displacement, py::arg("load_case"))
      .def_readonly("notices", &PythonScene::notices);

  module.def("read", &Read, py::arg("paths"), py::arg("is_optional"),
             py::arg("section"), py::arg("thickness"), py::arg("regions"),
             py::arg("material"), Released());
}

}  // namespace elastimate
