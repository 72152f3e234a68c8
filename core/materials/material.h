#ifndef ELASTIMATE_CORE_MATERIALS_MATERIAL_H_
#define ELASTIMATE_CORE_MATERIALS_MATERIAL_H_

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "elastimate/core/mesh/mesh.h"

namespace elastimate {

/// A closed interval in which a parameter must lie; an absent end is open.
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

/// What is believed of a parameter of a law before anything is measured: a
/// normal distribution, of ln p for a modulus with sd / value.
struct Prior {
  std::string name;
  double value;
  double sd;  ///< In the unit of the value.

  bool operator==(const Prior& other) const {
    return name == other.name && value == other.value && sd == other.sd;
  }
};

/// What a part of a specimen is made of.
struct Material {
  std::string law = "isotropic";
  /// The region ids of the mesh that it fills; it fills all elements if empty.
  std::vector<int> regions;
  std::vector<KnownParameter> known;
  /// The bounds of parameters that are not known.
  std::vector<BoundsOfParameter> bounds;
  /// The directions, of any length, that fix its frame (MaterialFrames), as
  /// many as its law has axes.  Each is dimension x 1, or dimension x
  /// num_elements, where only the columns of its own elements count.
  std::vector<Eigen::MatrixXd> axes = {};
  /// The priors of parameters that are not known.
  std::vector<Prior> priors = {};
  /// The names of parameters that differ between its elements, each with a
  /// value of its own: "youngs_modulus", or none.
  std::vector<std::string> fields = {};

  bool operator==(const Material& other) const;
};

/// Throws std::invalid_argument, with one sentence, unless the materials are
/// valid.  Each needs a law that exists and takes the section; known
/// parameters, bounds and priors have to be parameters of that law, once each,
/// with values in their range; axes have to be as many as the law takes, and
/// orthogonal.  Each element has to be of one material.  An empty list means
/// one isotropic material.  O(num_elements).
void ValidateMaterials(const std::vector<Material>& materials,
                       const Mesh& mesh);

/// Tells whether a parameter of any material differs between elements.
[[nodiscard]] bool HasFields(const std::vector<Material>& materials);

/// Has a parameter of the first material, which is an isotropic one if there is
/// none, differ between elements.
void GiveField(const std::string& parameter, std::vector<Material>& materials);

/// Tells whether any material has a prior.
[[nodiscard]] bool HasPriors(const std::vector<Material>& materials);

/// Tells whether this is one isotropic material without known parameters or
/// bounds.
[[nodiscard]] bool IsOneIsotropicMaterial(
    const std::vector<Material>& materials);

/// Returns an isotropic material for each region id of the mesh, ascending.
[[nodiscard]] std::vector<Material> IsotropicMaterialOfEachRegion(
    const Mesh& mesh);

/// Returns the place in `materials` of each element's material.  Precondition:
/// valid materials.
[[nodiscard]] std::vector<int> MaterialOfElements(
    const std::vector<Material>& materials, const Mesh& mesh);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MATERIALS_MATERIAL_H_
