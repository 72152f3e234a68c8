#include "elastimate/io/scene/json_materials.h"

#include <cmath>
#include <limits>
#include <map>
#include <string>

#include "elastimate/core/materials/free_axis_law.h"
#include "elastimate/core/materials/laws.h"
#include "elastimate/core/materials/transversely_isotropic_law.h"
#include "elastimate/io/text/printable.h"

namespace elastimate {
namespace {

int ReadRegion(const JsonValue& value) {
  const long long region = value.Integer();
  if (region < std::numeric_limits<int>::min() ||
      region > std::numeric_limits<int>::max()) {
    value.Fail("is out of range; give the id of a region");
  }
  return static_cast<int>(region);
}

// Returns the numbers of the groups of that name that are regions of the mesh.
std::vector<int> ReadNamedRegion(const JsonValue& value, const MeshFile& mesh) {
  const std::string name = value.String();
  std::vector<int> regions;
  std::string names;
  for (const PhysicalGroup& group : mesh.groups) {
    if (!mesh.are_regions_groups || group.dimension != mesh.Dimension() ||
        group.name.empty() || (!mesh.sets_of.empty() && group.number == 0)) {
      continue;
    }
    names += (names.empty() ? "\"" : ", \"") + Printable(group.name) + "\"";
    if (AreSameNames(mesh, group.name, name)) {
      regions.push_back(group.number);
    }
  }
  if (regions.empty()) {
    value.Fail(
        "is \"" + Printable(name) + "\", but " +
        (!names.empty() ? "the regions of the mesh are named " + names +
                              "; give one of these, or an id"
         : mesh.why_no_regions.empty()
             ? "the regions of the mesh have no names; give the id of a "
               "region, an integer"
             : mesh.why_no_regions + "; make groups that do not overlap"));
  }
  return regions;
}

std::vector<int> ReadRegions(const JsonValue& value, const MeshFile& mesh) {
  if (value.IsString()) {
    return ReadNamedRegion(value, mesh);
  }
  if (!value.IsList()) {
    if (!value.IsInteger()) {
      value.Fail("must be the id of a region, or its name, or a list of these");
    }
    return {ReadRegion(value)};
  }
  std::vector<int> regions;
  for (const JsonValue& each : value.Items()) {
    const std::vector<int> of_one = each.IsString()
                                        ? ReadNamedRegion(each, mesh)
                                        : std::vector<int>{ReadRegion(each)};
    regions.insert(regions.end(), of_one.begin(), of_one.end());
  }
  if (regions.empty()) {
    value.Fail("is empty; name a region, or leave it out");
  }
  return regions;
}

[[noreturn]] void FailForLackOfCellArray(const JsonValue& name,
                                         const MeshFile& mesh,
                                         const std::string& else_do) {
  name.Fail("is \"" + Printable(name.String()) + "\", but '" +
            PrintablePath(mesh.path) +
            "' has no such cell array; name one of its cell arrays (" +
            ArrayNames(mesh.element_arrays) + "), " + else_do);
}

// Reads {"value", "sd"} or {"value", "relative_sd"}.
Prior ReadPrior(const std::string& name, const JsonValue& value) {
  value.CheckKeys({"value", "sd", "relative_sd"});
  const double mean = value.At("value").Number();
  if (value.Has("sd") == value.Has("relative_sd")) {
    value.Fail("must have exactly one of the keys sd, relative_sd");
  }
  if (value.Has("relative_sd") && mean == 0) {
    value.At("relative_sd").Fail("is relative to the value 0; give \"sd\"");
  }
  return {name, mean,
          value.Has("sd") ? value.At("sd").Number()
                          : value.At("relative_sd").Number() * std::abs(mean)};
}

// Reads numbers, bounds and priors of parameters of a law, by their names.
void ReadWhatIsKnown(const JsonValue& value, const Law& law,
                     Material& material) {
  std::vector<std::string> names;
  for (const LawParameter& parameter : law.Parameters()) {
    names.emplace_back(parameter.name);
  }
  if (value.Has("known")) {
    value.At("known").CheckKeys(names);
  }
  if (value.Has("bounds")) {
    value.At("bounds").CheckKeys(names);
  }
  if (value.Has("prior")) {
    value.At("prior").CheckKeys(names);
  }
  for (const std::string& name : names) {
    if (value.Has("prior") && value.At("prior").Has(name)) {
      material.priors.push_back(ReadPrior(name, value.At("prior").At(name)));
    }
    if (value.Has("known") && value.At("known").Has(name)) {
      material.known.push_back({name, value.At("known").At(name).Number()});
    }
    if (value.Has("bounds") && value.At("bounds").Has(name)) {
      const Eigen::VectorXd ends = value.At("bounds").At(name).Vector(2);
      material.bounds.push_back({name, {ends(0), ends(1)}});
    }
  }
}

// Reads the parameters that differ between elements,
// {"youngs_modulus": {"over": "elements"}}.
std::vector<std::string> ReadFields(const JsonValue& value) {
  value.CheckKeys({"youngs_modulus"});
  const JsonValue field = value.At("youngs_modulus");
  field.CheckKeys({"over"});
  if (field.At("over").String() != "elements") {
    field.At("over").Fail("is \"" + Printable(field.At("over").String()) +
                          "\"; it must be \"elements\"");
  }
  return {"youngs_modulus"};
}

// Reads a direction, or the cell array with a direction for each element.
Eigen::MatrixXd ReadAxis(const JsonValue& value, const MeshFile& mesh) {
  const int dimension = mesh.Dimension();
  Eigen::MatrixXd axis;
  if (!value.IsString() && value.ListSize() == 0) {
    value.Fail(
        "must be a direction of 3 numbers, the name of a cell array, or "
        "\"free\"");
  }
  if (value.IsString()) {
    const std::string name = value.String();
    const Eigen::MatrixXd* const array = FindArray(mesh.element_arrays, name);
    if (array == nullptr) {
      FailForLackOfCellArray(value, mesh, "or give a direction");
    }
    if (array->rows() != 3 && array->rows() != dimension) {
      value.Fail("is the cell array \"" + Printable(name) + "\" of " +
                 std::to_string(array->rows()) + " components; give it 3");
    }
    axis = *array;
  } else {
    axis = value.Vector(value.ListSize() == 2 && dimension == 2 ? 2 : 3);
  }
  if (!IsInPlane(axis, dimension)) {
    value.Fail("is out of the plane of the mesh; make its component z 0");
  }
  return axis.topRows(dimension);
}

bool IsFree(const JsonValue& axis) {
  return axis.IsString() && axis.String() == "free";
}

std::vector<Eigen::MatrixXd> ReadAxes(const JsonValue& value,
                                      const MeshFile& mesh) {
  if (value.Has("axis") && value.Has("axes")) {
    value.At("axes").Fail("is given beside \"axis\"; give one of them");
  }
  std::vector<Eigen::MatrixXd> axes;
  if (value.Has("axis")) {
    if (IsFree(value.At("axis"))) {
      return axes;
    }
    axes.push_back(ReadAxis(value.At("axis"), mesh));
  } else if (value.Has("axes")) {
    for (const JsonValue& axis : value.At("axes").Items()) {
      axes.push_back(ReadAxis(axis, mesh));
    }
  }
  return axes;
}

Material ReadMaterial(const JsonValue& value, const MeshFile& mesh) {
  value.CheckKeys(
      {"law", "region", "known", "bounds", "prior", "fields", "axis", "axes"});
  Material material;
  if (value.Has("law")) {
    material.law = value.At("law").String();
  }
  const Law* law = FindLaw(material.law);
  if (law == nullptr) {
    value.At("law").Fail("is \"" + Printable(material.law) +
                         "\", which is no law; make it one of " + LawNames());
  }
  if (value.Has("axis") && IsFree(value.At("axis"))) {
    const std::string free = LawOfFreeAxis(material.law);
    if (free.empty()) {
      value.At("axis").Fail("is \"free\", but the law is " + material.law +
                            WhyNoFreeAxis());
    }
    material.law = free;
    law = FindLaw(free);
  }
  if (value.Has("region")) {
    material.regions = ReadRegions(value.At("region"), mesh);
  }
  ReadWhatIsKnown(value, *law, material);
  if (value.Has("fields")) {
    material.fields = ReadFields(value.At("fields"));
  }
  material.axes = ReadAxes(value, mesh);
  return material;
}

}  // namespace

bool IsInPlane(const Eigen::MatrixXd& axis, int dimension) {
  return axis.rows() <= dimension ||
         axis.bottomRows(axis.rows() - dimension).isZero(0);
}

std::string LawOfFreeAxis(const std::string& law) {
  return law == TransverselyIsotropicLaw::kName || law == FreeAxisLaw::kName
             ? std::string(FreeAxisLaw::kName)
             : "";
}

std::string WhyNoFreeAxis() {
  return ", whose axis cannot be found; \"free\" is only for "
         "transversely_isotropic in three dimensions";
}

void ChooseRegions(const JsonValue& document, MeshFile& mesh) {
  if (!document.Has("regions")) {
    return;
  }
  document.At("regions").CheckKeys({"array"});
  const JsonValue name = document.At("regions").At("array");
  if (FindArray(mesh.element_arrays, name.String()) == nullptr) {
    FailForLackOfCellArray(name, mesh, "or leave out \"regions\"");
  }
  if (name.String() != mesh.region_array) {
    mesh.region_array = name.String();
    mesh.are_regions_groups = false;
    mesh.why_no_regions.clear();
  }
}

std::vector<Material> ReadMaterials(const JsonValue& document,
                                    const MeshFile& mesh) {
  std::vector<Material> materials;
  if (document.Has("materials")) {
    for (const JsonValue& value : document.At("materials").Items()) {
      materials.push_back(ReadMaterial(value, mesh));
    }
    if (materials.empty()) {
      document.At("materials").Fail("is empty; name one, or leave it out");
    }
  }
  return materials;
}

std::map<std::string, Eigen::MatrixXd> AxisArrays(const JsonValue& document,
                                                  const MeshFile& mesh) {
  std::map<std::string, Eigen::MatrixXd> arrays;
  const auto add = [&](const JsonValue& axis) {
    if (axis.IsString() && !IsFree(axis)) {
      const std::string name = axis.String();
      arrays.emplace(name, *FindArray(mesh.element_arrays, name));
    }
  };
  if (document.Has("materials")) {
    for (const JsonValue& material : document.At("materials").Items()) {
      if (material.Has("axis")) {
        add(material.At("axis"));
      } else if (material.Has("axes")) {
        for (const JsonValue& axis : material.At("axes").Items()) {
          add(axis);
        }
      }
    }
  }
  return arrays;
}

}  // namespace elastimate
