#include "elastimate/io/abaqus/abaqus_elements.h"

#include <array>
#include <map>
#include <optional>
#include <string_view>
#include <tuple>
#include <utility>

namespace elastimate {
namespace {

bool BeginsWith(const std::string& text, std::string_view begin) {
  return text.rfind(begin, 0) == 0;
}

bool IsOneOf(const std::string& name,
             const std::vector<std::string_view>& begins) {
  for (const std::string_view begin : begins) {
    if (BeginsWith(name, begin)) {
      return true;
    }
  }
  return false;
}

int DimensionOfType(const std::string& name) {
  if (IsOneOf(name, {"C3D", "AC3D", "DC3D", "COH3D", "CCL", "SC6", "SC8",
                     "CSS8", "Q3D", "EC3D"})) {
    return 3;
  }
  return IsOneOf(name, {"CPS", "CPE", "CAX", "CGAX", "CPEG", "S3", "S4", "S6",
                        "S8", "S9", "STRI", "M3D", "SFM3D", "R3D3", "R3D4",
                        "DC2D", "AC2D", "COH2D", "R2D"})
             ? 2
             : 1;
}

/// Returns the number at the end of the family: 8 for "C3D8R" and "CPE8H".
int NumNodesInName(const std::string& name) {
  std::size_t end = name.find_last_of("0123456789");
  std::size_t first = end;
  while (first != std::string::npos && first > 0 &&
         std::string_view("0123456789").find(name[first - 1]) !=
             std::string_view::npos) {
    --first;
  }
  return end == std::string::npos || end - first > 2
             ? 0
             : std::stoi(name.substr(first, end - first + 1));
}

std::string MendOf(const std::string& name) {
  if (BeginsWith(name, "CAX") || BeginsWith(name, "CGAX")) {
    return "which is axisymmetric, but a scene is solid, or in plane stress or "
           "plane strain; mesh the body itself (C3D10 or C3D8)";
  }
  const bool is_solid = DimensionOfType(name) == 3;
  return std::string("but the ") + (is_solid ? "solid" : "planar") +
         " elements that are read are " +
         (is_solid ? "C3D4, C3D5, C3D6, C3D8, C3D10, C3D15 and C3D20"
                   : "CPS3, CPS4, CPS6, CPS8, CPE3, CPE4, CPE6 and CPE8") +
         "; mesh the specimen with these (in Abaqus/CAE, Mesh > Element Type "
         "and Mesh > Controls)";
}

}  // namespace

std::string FullAbaqusType(const std::string& name) {
  return name.substr(0, name.find_last_of("0123456789") + 1);
}

NumberedType AbaqusType(const std::string& name) {
  static const std::map<std::string, ElementKind> kKinds = {
      {"C3D4", ElementKind::kTet4}, {"C3D10", ElementKind::kTet10},
      {"C3D8", ElementKind::kHex8}, {"CPS3", ElementKind::kTri3},
      {"CPE3", ElementKind::kTri3}, {"CPS6", ElementKind::kTri6},
      {"CPE6", ElementKind::kTri6}, {"CPS4", ElementKind::kQuad4},
      {"CPE4", ElementKind::kQuad4}};
  NumberedType type;
  type.name = name;
  type.dimension = DimensionOfType(name);
  if (const auto found = kKinds.find(FullAbaqusType(name));
      found != kKinds.end()) {
    type.kind = found->second;
    type.num_vertices = TopologyOf(found->second).num_vertices;
    return type;
  }
  // The vertices of what is cut into simplices, and whether it is quadratic.
  static const std::map<std::string, std::pair<int, bool>> kCut = {
      {"C3D5", {5, false}}, {"C3D6", {6, false}}, {"C3D15", {6, true}},
      {"C3D20", {8, true}}, {"CPS8", {4, true}},  {"CPE8", {4, true}}};
  if (const auto found = kCut.find(FullAbaqusType(name)); found != kCut.end()) {
    std::tie(type.num_vertices, type.has_middles) = found->second;
    return type;
  }
  type.mend = MendOf(name);
  if (type.dimension == 2) {
    const int num_nodes = NumNodesInName(name);
    type.num_vertices = num_nodes == 3 || num_nodes == 6 ? 3 : 4;
  } else if (type.dimension == 1) {
    type.num_vertices = 2;
  }
  return type;
}

std::vector<int> AbaqusFace(const NumberedType& type,
                            const std::string& label) {
  using Faces = std::vector<std::vector<int>>;
  static const Faces kTetrahedron = {
      {0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
  static const Faces kHexahedron = {{0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1},
                                    {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}};
  static const Faces kPyramid = {
      {0, 1, 2, 3}, {0, 4, 1}, {1, 4, 2}, {2, 4, 3}, {3, 4, 0}};
  static const Faces kWedge = {
      {0, 1, 2}, {3, 5, 4}, {0, 3, 4, 1}, {1, 4, 5, 2}, {2, 5, 3, 0}};
  // The edges of planar elements are in the order of Abaqus.
  const Faces& faces = type.dimension == 2
                           ? FindCellShape(2, type.num_vertices)->faces
                       : type.num_vertices == 4 ? kTetrahedron
                       : type.num_vertices == 5 ? kPyramid
                       : type.num_vertices == 6 ? kWedge
                                                : kHexahedron;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (label == "S" + std::to_string(i + 1)) {
      return faces[i];
    }
  }
  return {};
}

}  // namespace elastimate
