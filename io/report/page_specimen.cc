#include "elastimate/io/report/page_specimen.h"

#include <vtkBase64Utilities.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "elastimate/core/mesh/facets.h"
#include "elastimate/core/mesh/mesh_points.h"
#include "elastimate/core/scene/loads.h"

namespace elastimate {
namespace {

using Json = nlohmann::ordered_json;

// A page of at most two megabytes has room for so many characters of load
// cases.
constexpr std::size_t kMostCharacters = 1000000;
constexpr Eigen::Index kMostPoints = 2000;
constexpr Eigen::Index kMostLoads = 40;

template <typename Number>
std::string Base64(const std::vector<Number>& values) {
  const std::size_t size = values.size() * sizeof(Number);
  std::string text(4 * ((size + 2) / 3), '=');
  const unsigned long written = vtkBase64Utilities::Encode(
      reinterpret_cast<const unsigned char*>(values.data()), size,
      reinterpret_cast<unsigned char*>(text.data()));
  text.resize(written);
  return text;
}

std::string Floats(const Eigen::MatrixXd& values) {
  return Base64(
      std::vector<float>(values.reshaped().begin(), values.reshaped().end()));
}

// Returns vectors of a plane as those of space.
Eigen::MatrixXd InSpace(const Eigen::MatrixXd& vectors) {
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(3, vectors.cols());
  all.topRows(vectors.rows()) = vectors;
  return all;
}

// The facets that are drawn, with the nodes in them.
struct Surface {
  Eigen::MatrixXi facets;    // Vertices alone, as places in `nodes`.
  Eigen::VectorXi elements;  // One for each facet.
  std::vector<int> nodes;    // The nodes of the mesh.
};

Surface SurfaceOf(const Mesh& mesh) {
  Surface surface;
  const ElementTopology& topology = mesh.Topology();
  if (mesh.Dimension() == 2) {
    surface.facets = mesh.elements.topRows(topology.num_vertices);
    surface.elements = Eigen::VectorXi::LinSpaced(mesh.NumElements(), 0,
                                                  int(mesh.NumElements()) - 1);
  } else {
    surface.facets = BoundaryFacets(mesh).topRows(topology.NumVerticesOfFace());
    surface.elements = ElementsOfFacets(mesh, surface.facets);
  }
  std::vector<int> places(mesh.NumNodes(), -1);
  for (int& node : surface.facets.reshaped()) {
    if (places[node] < 0) {
      places[node] = int(surface.nodes.size());
      surface.nodes.push_back(node);
    }
    node = places[node];
  }
  return surface;
}

// Returns about `most` of the items, evenly from the list.
std::vector<Eigen::Index> SomeOf(const std::vector<Eigen::Index>& items,
                                 Eigen::Index most) {
  const auto size = Eigen::Index(items.size());
  const Eigen::Index count = std::min(size, most);
  std::vector<Eigen::Index> some;
  for (Eigen::Index i = 0; i < count; ++i) {
    some.push_back(items[i * size / count]);
  }
  return some;
}

class SpecimenWriter {
 public:
  SpecimenWriter(const Scene& scene, const Estimate& estimate,
                 const SceneResults& results)
      : scene_(scene),
        estimate_(estimate),
        results_(results),
        surface_(SurfaceOf(scene.mesh)) {}

  Json Write() const {
    Json cases = Json::array();
    std::size_t size = 0;
    for (std::size_t k = 0; k < scene_.load_cases.size(); ++k) {
      Json one = CaseJson(Eigen::Index(k));
      size += one.dump().size();
      if (k > 0 && size > kMostCharacters) {
        break;
      }
      cases.push_back(std::move(one));
    }
    const std::vector<std::uint32_t> facets(surface_.facets.reshaped().begin(),
                                            surface_.facets.reshaped().end());
    return {{"dimension", scene_.mesh.Dimension()},
            {"corners", surface_.facets.rows()},
            {"nodes", Floats(AtNodes(InSpace(scene_.mesh.nodes)))},
            {"facets", Base64(facets)},
            {"facet_fields", FieldsOfMaterials()},
            {"cases_left_out", scene_.load_cases.size() - cases.size()},
            {"cases", cases}};
  }

 private:
  Eigen::MatrixXd AtNodes(const Eigen::MatrixXd& values) const {
    return values(Eigen::all, surface_.nodes);
  }

  const Eigen::MatrixXd* Find(const std::vector<Field>& fields,
                              const std::string& name,
                              Eigen::Index load_case) const {
    const std::string full =
        name + (load_case == 0 ? "" : "_" + std::to_string(load_case + 1));
    const auto field =
        std::find_if(fields.begin(), fields.end(),
                     [&](const Field& other) { return other.name == full; });
    return field == fields.end() ? nullptr : &field->values;
  }

  const Eigen::MatrixXd* PointField(const std::string& name,
                                    Eigen::Index load_case) const {
    return Find(results_.fields.point, name, load_case);
  }

  // The values of elements that are the same for all load cases.
  Json FieldsOfMaterials() const {
    const std::string energy = "strain_energy_density";
    Json fields = Json::object();
    for (const Field& field : results_.fields.cell) {
      if (field.name.compare(0, energy.size(), energy) != 0) {
        fields[field.name] = Floats(field.values(0, surface_.elements));
      }
    }
    return fields;
  }

  // Tells whether a component was measured, and is not held at a known place.
  bool IsFitted(Eigen::Index k, int i, Eigen::Index node) const {
    const LoadCase& load_case = scene_.load_cases[k];
    return load_case.displacement.size() != 0 &&
           IsObserved(load_case, i, node) &&
           !SupportsOf(scene_, k).IsGiven(i, node);
  }

  // Measured minus fitted at the nodes; NaN where there is no measurement.
  Eigen::MatrixXd NodalResidual(Eigen::Index k) const {
    const Eigen::MatrixXd* const field = PointField("displacement_residual", k);
    if (field == nullptr || scene_.load_cases[k].displacement.size() == 0) {
      return {};
    }
    Eigen::MatrixXd residual = *field;
    for (Eigen::Index node = 0; node < residual.cols(); ++node) {
      for (int i = 0; i < residual.rows(); ++i) {
        if (!IsFitted(k, i, node)) {
          residual(i, node) = Estimate::kUnknown;
        }
      }
    }
    return residual;
  }

  // The lengths of vectors, of their components that are known.
  static Eigen::RowVectorXd Lengths(const Eigen::MatrixXd& vectors) {
    return vectors.array().isNaN().colwise().all().select(
        Eigen::RowVectorXd::Constant(vectors.cols(), Estimate::kUnknown)
            .array(),
        vectors.array().isNaN().select(0, vectors).matrix().colwise().norm());
  }

  // The measured displacement at the nodes, where it is known at all of them.
  Eigen::MatrixXd MeasuredAtNodes(Eigen::Index k) const {
    const LoadCase& load_case = scene_.load_cases[k];
    const bool is_all =
        load_case.displacement.size() != 0 &&
        (load_case.observed.size() == 0 || load_case.observed.all());
    return is_all ? load_case.displacement : Eigen::MatrixXd();
  }

  Json CaseJson(Eigen::Index k) const {
    const Eigen::MatrixXd* const fitted = PointField("fitted_displacement", k);
    const Eigen::MatrixXd displacement =
        fitted != nullptr ? *fitted : MeasuredAtNodes(k);
    const Eigen::MatrixXd residual = NodalResidual(k);
    Json node_fields = Json::object();
    if (residual.size() != 0) {
      node_fields["residual"] = Floats(AtNodes(Lengths(residual)));
    }
    for (const std::string name : {"mesh_error", "force_residual"}) {
      if (const Eigen::MatrixXd* const field = PointField(name, k)) {
        node_fields[name] = Floats(AtNodes(Lengths(*field)));
      }
    }
    Json facet_fields = Json::object();
    const std::string energy = "strain_energy_density";
    if (const Eigen::MatrixXd* const field =
            Find(results_.fields.cell, energy, k)) {
      facet_fields[energy] = Floats((*field)(0, surface_.elements));
    }
    return {
        {"displacement", displacement.size() == 0
                             ? Json(nullptr)
                             : Json(Floats(AtNodes(InSpace(displacement))))},
        {"is_fitted", fitted != nullptr},
        {"held", Base64(HeldMasks(k))},
        {"moved", Base64(MovedMasks(k))},
        {"loads", LoadsJson(k, displacement)},
        {"node_fields", node_fields},
        {"facet_fields", facet_fields},
        {"points", PointsJson(k, residual)}};
  }

  // A bit for each component of each node that is held.
  std::vector<std::uint8_t> HeldMasks(Eigen::Index k) const {
    const ComponentMask& held = SupportsOf(scene_, k).held;
    std::vector<std::uint8_t> masks;
    for (const int node : surface_.nodes) {
      std::uint8_t mask = 0;
      for (int i = 0; i < scene_.mesh.Dimension(); ++i) {
        mask |= held(i, node) ? 1U << i : 0U;
      }
      masks.push_back(mask);
    }
    return masks;
  }

  static std::vector<double> Numbers(const Eigen::MatrixXd& vector) {
    const Eigen::MatrixXd all = InSpace(vector);
    return {all.reshaped().begin(), all.reshaped().end()};
  }

  // A bit for each component of each node that is held away from zero, or where
  // the support moved by an amount that is not known.
  std::vector<std::uint8_t> MovedMasks(Eigen::Index k) const {
    const Supports& supports = SupportsOf(scene_, k);
    std::vector<std::uint8_t> masks;
    for (const int node : surface_.nodes) {
      std::uint8_t mask = 0;
      for (int i = 0; i < scene_.mesh.Dimension(); ++i) {
        const bool is_moved =
            supports.held(i, node) &&
            (!supports.IsGiven(i, node) || supports.displacement(i, node) != 0);
        mask |= is_moved ? 1U << i : 0U;
      }
      masks.push_back(mask);
    }
    return masks;
  }

  // Returns the shares of nodes in the area of the facets that they make up,
  // one for each node of the mesh; equal shares where they make up none.
  Eigen::VectorXd SharesOfArea(const std::vector<int>& nodes) const {
    Eigen::VectorXd shares = Eigen::VectorXd::Zero(scene_.mesh.NumNodes());
    std::vector<char> is_member(scene_.mesh.NumNodes(), 0);
    for (const int node : nodes) {
      is_member[node] = 1;
    }
    const Eigen::MatrixXi facets = BoundaryFacetsWhere(
        scene_.mesh, [&](int node) { return is_member[node] != 0; });
    for (const auto& facet : facets.colwise()) {
      shares(facet) += WeightsOfFacet(scene_.mesh, facet).area;
    }
    if (facets.cols() == 0) {
      shares(nodes).setOnes();
    }
    return shares / shares.sum();
  }

  // Nodal forces on the surface, and the resultants of load cells, each in the
  // middle of its face, which moves by `displacement`.
  Json LoadsJson(Eigen::Index k, const Eigen::MatrixXd& displacement) const {
    const LoadCase& load_case = scene_.load_cases[k];
    const Eigen::MatrixXd force = AssembleLoads(scene_.mesh, load_case.loads);
    std::vector<Eigen::Index> loaded;
    const double least = 1e-9 * force.colwise().norm().maxCoeff();
    for (std::size_t i = 0; i < surface_.nodes.size(); ++i) {
      if (force.col(surface_.nodes[i]).norm() > least) {
        loaded.push_back(Eigen::Index(i));
      }
    }
    Json loads = Json::array();
    for (const Eigen::Index i : SomeOf(loaded, kMostLoads)) {
      loads.push_back(
          {{"node", i}, {"force", Numbers(force.col(surface_.nodes[i]))}});
    }
    for (const Resultant& resultant : load_case.resultants) {
      const Eigen::VectorXd known =
          resultant.force.array().isNaN().select(0, resultant.force);
      if (!resultant.nodes.empty() && known.norm() > 0) {
        const Eigen::VectorXd shares = SharesOfArea(resultant.nodes);
        loads.push_back({{"node", nullptr},
                         {"at", Numbers(scene_.mesh.nodes * shares)},
                         {"displacement", displacement.size() == 0
                                              ? std::vector<double>(3, 0)
                                              : Numbers(displacement * shares)},
                         {"force", Numbers(known)}});
      }
    }
    return loads;
  }

  // The measured points, or nodes, with what the fit leaves of them; null
  // without a fit.
  Json PointsJson(Eigen::Index k, const Eigen::MatrixXd& nodal) const {
    const bool are_nodes = nodal.size() != 0;
    const PointDisplacements& points = scene_.load_cases[k].points;
    if (!are_nodes && (results_.point_residuals.empty() ||
                       results_.point_residuals[k].size() == 0)) {
      return nullptr;
    }
    const Eigen::MatrixXd& residual =
        are_nodes ? nodal : results_.point_residuals[k];
    std::vector<Eigen::Index> known;
    for (Eigen::Index i = 0; i < residual.cols(); ++i) {
      if (!residual.col(i).array().isNaN().all()) {
        known.push_back(i);
      }
    }
    const std::vector<Eigen::Index> shown = SomeOf(known, kMostPoints);
    const Eigen::MatrixXd positions =
        are_nodes ? scene_.mesh.nodes
                  : Interpolate(scene_.mesh, points.points, scene_.mesh.nodes);
    const Eigen::MatrixXd& displacement =
        are_nodes ? scene_.load_cases[k].displacement : points.displacement;
    return {{"total", known.size()},
            {"are_nodes", are_nodes},
            {"positions", Floats(InSpace(positions(Eigen::all, shown)))},
            {"displacement", Floats(InSpace(displacement.array().isNaN().select(
                                 0, displacement)(Eigen::all, shown)))},
            {"residual", Floats(InSpace(residual(Eigen::all, shown)))},
            {"left_out", Base64(LeftOut(k, are_nodes, shown))}};
  }

  std::vector<std::uint8_t> LeftOut(
      Eigen::Index k, bool are_nodes,
      const std::vector<Eigen::Index>& shown) const {
    std::vector<std::uint8_t> is_left_out;
    for (const Eigen::Index i : shown) {
      const auto& outliers = estimate_.outliers;
      is_left_out.push_back(std::find(outliers.begin(), outliers.end(),
                                      Outlier{k, i, !are_nodes}) !=
                            outliers.end());
    }
    return is_left_out;
  }

  const Scene& scene_;
  const Estimate& estimate_;
  const SceneResults& results_;
  Surface surface_;
};

}  // namespace

Json PageSpecimen(const Scene& scene, const Estimate& estimate,
                  const SceneResults& results) {
  return SpecimenWriter(scene, estimate, results).Write();
}

}  // namespace elastimate
