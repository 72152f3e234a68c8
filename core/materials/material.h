#ifndef ELASTIMATE_CORE_MATERIALS_MATERIAL_H_
#define ELASTIMATE_CORE_MATERIALS_MATERIAL_H_

#include <Eigen/Core>
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
  /// The bounds of parameters that are not known.
  std::vector<BoundsOfParameter> bounds;
  /// Directions of any length that fix its frame (MaterialFrames), as many as
  /// its law has: each dimension x 1, or dimension x num_elements, of which
  /// those of its elements count.
  std::vector<Eigen::MatrixXd> axes = {};

  bool operator==(const Material& other) const;
};

/// Throws std::invalid_argument, with one sentence, unless each material has a
/// law that exists and takes the section, and known parameters and bounds of
/// parameters of that law, once each, with values in their range; the axes that
/// its law takes, orthogonal ones; and each element is of one material.
/// No materials at all are one isotropic one.  O(num_elements).
void ValidateMaterials(const std::vector<Material>& materials,
                       const Mesh& mesh);

/// Whether this is one isotropic material of which nothing is known.
[[nodiscard]] bool IsOneIsotropicMaterial(
    const std::vector<Material>& materials);

/// An isotropic material for each region id of the mesh, ascending.
[[nodiscard]] std::vector<Material> IsotropicMaterialOfEachRegion(
    const Mesh& mesh);

/// The place in `materials` of that of each element.  Precondition: valid ones.
[[nodiscard]] std::vector<int> MaterialOfElements(
    const std::vector<Material>& materials, const Mesh& mesh);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MATERIALS_MATERIAL_H_
