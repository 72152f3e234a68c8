#ifndef ELASTIMATE_CORE_MATERIALS_MATERIAL_H_
#define ELASTIMATE_CORE_MATERIALS_MATERIAL_H_

#include <optional>
#include <string>
#include <vector>

#include "elastimate/core/mesh/mesh.h"

namespace elastimate {

/// Closed interval that a parameter must lie in; an absent end is open.
struct Bounds {
  std::optional<double> lower;
  std::optional<double> upper;

  bool AreGiven() const { return lower || upper; }
};

/// A parameter of a law that has bounds.
struct BoundsOfParameter {
  std::string name;
  Bounds bounds;

  bool operator==(const BoundsOfParameter& other) const {
    return name == other.name && bounds.lower == other.bounds.lower &&
           bounds.upper == other.bounds.upper;
  }
};

/// A parameter of a law whose value is known.
struct KnownParameter {
  std::string name;
  double value;

  bool operator==(const KnownParameter& other) const {
    return name == other.name && value == other.value;
  }
};

/// What a part of a specimen is made of.
struct Material {
  std::string law = "isotropic";
  /// The region ids of the mesh that it fills; empty: all elements.
  std::vector<int> regions;
  std::vector<KnownParameter> known;
  /// Of parameters that are not known.
  std::vector<BoundsOfParameter> bounds;

  bool operator==(const Material& other) const {
    return law == other.law && regions == other.regions &&
           known == other.known && bounds == other.bounds;
  }
};

/// Throws std::invalid_argument, with one sentence, unless each material has a
/// law that exists and takes the section, and known parameters and bounds of
/// parameters of that law, once each, with values in their range; and each
/// element is of one material.
/// No materials at all are one isotropic one.  O(num_elements).
void ValidateMaterials(const std::vector<Material>& materials,
                       const Mesh& mesh);

/// Whether this is one isotropic material of which nothing is known.
bool IsOneIsotropicMaterial(const std::vector<Material>& materials);

/// An isotropic material for each region id of the mesh, ascending.
std::vector<Material> IsotropicMaterialOfEachRegion(const Mesh& mesh);

/// The place in `materials` of that of each element.  Precondition: valid ones.
std::vector<int> MaterialOfElements(const std::vector<Material>& materials,
                                    const Mesh& mesh);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MATERIALS_MATERIAL_H_
