#include "elastimate/core/mechanics/large_strain_forces.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "elastimate/core/large_strain/cross_gradient.h"
#include "elastimate/core/large_strain/large_strain_law.h"
#include "elastimate/core/mechanics/mean_dilatation.h"
#include "elastimate/core/mechanics/tet10_point_forces.h"
#include "elastimate/core/mechanics/tet4_point_forces.h"
#include "elastimate/core/mesh/shape_functions.h"

namespace elastimate {
namespace {

// The material of some elements, and how they are evaluated.
struct MaterialPass {
  const Mesh& mesh;
  const std::vector<Eigen::Index>& elements;
  const LargeStrainLaw& law;
  Eigen::VectorXd moduli;
  Dilatation dilatation;
  const MaterialFrames& frames;
  int material;

  // Whether the law is given along axes of the material.
  bool HasFrames() const { return law.NumAxes() > 0; }
};

template <ElementKind kKind>
constexpr int kDimensionOf = ElementSizes<kKind>::kDimension;

template <ElementKind kKind>
using NodeColumns = Eigen::Matrix<double, ElementSizes<kKind>::kDimension,
                                  ElementSizes<kKind>::kNodes>;

// Whether elements of this kind smooth their dilatation.
template <ElementKind kKind>
constexpr bool kHasMean = !IsSimplex(kKind);

template <ElementKind kKind>
bool TakesMean(const MaterialPass& pass) {
  return kHasMean<kKind> && pass.dilatation == Dilatation::kMeanOfElement &&
         pass.mesh.section.model != SectionModel::kPlaneStress;
}

// Whether the stretch across a plate changes with the moduli.
enum class CrossStretch { kStays, kFollows };

// Returns the frame of an element of the pass.
template <ElementKind kKind>
auto FrameOfElement(const MaterialPass& pass, Eigen::Index element) {
  return pass.frames.Of<kDimensionOf<kKind>>(pass.material, element);
}

// Some elements whose points are evaluated together, as seen in the frame of
// the material.
template <ElementKind kKind>
class ElementBatch {
 public:
  static constexpr int kDimension = kDimensionOf<kKind>;
  static constexpr GradientEntries kEntries =
      kDimension == 2 ? GradientEntries::kOfPlane : GradientEntries::kAll;

  // Gathers elements of the pass from the place `first` on.
  ElementBatch(const MaterialPass& pass, std::size_t first,
               const Eigen::VectorXd& displacement)
      : pass_(pass), points_per_element_(int(StiffnessRule<kKind>().size())) {
    const std::size_t num_elements =
        std::min(std::size_t(PointMatrices::kPoints / points_per_element_),
                 pass.elements.size() - first);
    elements_.reserve(num_elements);
    points_.reserve(PointMatrices::kPoints);
    for (std::size_t i = 0; i < num_elements; ++i) {
      const Eigen::Index e = pass.elements[first + i];
      elements_.push_back(e);
      NodeColumns<kKind> u =
          GatherNodes<kKind>(pass.mesh, e, displacement.data());
      if (pass.HasFrames()) {
        u = (FrameOfElement<kKind>(pass, e).transpose() * u).eval();
      }
      VisitPoints<kKind>(
          pass.mesh, e, StiffnessRule<kKind>(),
          [&](ElementPoint<kKind> point, const auto&) {
            if (pass.HasFrames()) {
              point.gradient =
                  (FrameOfElement<kKind>(pass, e).transpose() * point.gradient)
                      .eval();
            }
            SetGradient(int(points_.size()), u * point.gradient.transpose());
            points_.push_back(point);
          });
    }
    if (TakesMean<kKind>(pass)) {
      SmoothDilatation();
    }
    if (pass.mesh.section.model == SectionModel::kPlaneStress) {
      SetCrossGradients(pass.law, pass.moduli, NumPoints(), gradients_);
    }
  }

  int NumPoints() const { return int(points_.size()); }
  std::size_t NumElements() const { return elements_.size(); }
  Eigen::Index Element(std::size_t i) const { return elements_[i]; }
  int PointsPerElement() const { return points_per_element_; }
  const ElementPoint<kKind>& Point(std::size_t element, int i) const {
    return points_[element * std::size_t(points_per_element_) + i];
  }
  // Only where elements smooth their dilatation.
  const MeanDilatation& Mean() const { return *mean_; }

  // Returns P_k of each modulus.
  std::vector<PointMatrices> Stresses() const {
    std::vector<PointMatrices> columns(pass_.law.NumModuli());
    pass_.law.StressesAtPoints(gradients_, kEntries, NumPoints(),
                               columns.data());
    return columns;
  }
  // Returns the derivatives of the stress by each modulus.  In plane stress,
  // P_33(H, theta) = 0 makes H_33 change by -P_k,33 / (dP_33 / dH_33).
  std::vector<PointMatrices> StressDerivatives() const {
    std::vector<PointMatrices> columns = Stresses();
    if (pass_.mesh.section.model != SectionModel::kPlaneStress) {
      return columns;
    }
    PointTangents tangents;
    SetTangents(tangents, nullptr);
    const double* const cross_slope =
        tangents.row[TangentRow(kCrossPlace, kCrossPlace)];
    for (PointMatrices& stress : columns) {
      for (int p = 0; p < NumPoints(); ++p) {
        const double change = -stress.row[kCrossPlace][p] / cross_slope[p];
        for (const int entry : kPlacesOfPlane) {
          stress.row[entry][p] +=
              tangents.row[TangentRow(entry, kCrossPlace)][p] * change;
        }
      }
    }
    return columns;
  }
  void SetTangents(PointTangents& tangents, PointMatrices* stresses) const {
    pass_.law.TangentsAtPoints(pass_.moduli, gradients_, kEntries, NumPoints(),
                               tangents, stresses);
  }

  int PlaceOf(std::size_t element, int i) const {
    return int(element) * points_per_element_ + i;
  }

 private:
  void SetGradient(
      int place,
      const Eigen::Matrix<double, kDimension, kDimension>& gradient) {
    for (int j = 0; j < kDimension; ++j) {
      for (int i = 0; i < kDimension; ++i) {
        gradients_.row[i + 3 * j][place] = gradient(i, j);
      }
    }
  }

  // Smooths the dilatation by the constant 1 and, in elements of order 2, by
  // the coordinates as well.
  void SmoothDilatation() {
    ElementPoints points;
    points.dimension = kDimension;
    points.num_points = NumPoints();
    points.per_element = points_per_element_;
    for (int p = 0; p < NumPoints(); ++p) {
      points.volumes.row[0][p] = points_[p].volume;
      points.polynomials.row[0][p] = 1;
    }
    if (pass_.mesh.Order() == 2) {
      points.num_polynomials = 1 + kDimension;
      for (std::size_t e = 0; e < NumElements(); ++e) {
        SetCoordinates(e, points.polynomials);
      }
    }
    mean_.emplace(points, gradients_);
    gradients_ = mean_->Gradients();
  }

  // Sets the coordinates of the points of an element, from its first node on.
  void SetCoordinates(std::size_t e, PointValues<4>& polynomials) const {
    if constexpr (!IsCurved(kKind)) {
      const auto nodes = GatherMapNodes<kKind>(pass_.mesh, elements_[e]);
      const auto& rule = StiffnessRule<kKind>();
      for (int i = 0; i < points_per_element_; ++i) {
        const Eigen::Matrix<double, kDimension, 1> x =
            nodes * rule[i].vertex_value - nodes.col(0);
        for (int d = 0; d < kDimension; ++d) {
          polynomials.row[1 + d][PlaceOf(e, i)] = x(d);
        }
      }
    }
  }

  const MaterialPass& pass_;
  int points_per_element_;
  std::vector<Eigen::Index> elements_;
  std::vector<ElementPoint<kKind>> points_;
  PointMatrices gradients_ = {};
  std::optional<MeanDilatation> mean_;
};

// Calls visit(batch) for all elements of a pass.
template <ElementKind kKind, class Visitor>
void VisitBatches(const MaterialPass& pass, const Eigen::VectorXd& displacement,
                  const Visitor& visit) {
  for (std::size_t first = 0; first < pass.elements.size();) {
    const ElementBatch<kKind> batch(pass, first, displacement);
    visit(batch);
    first += batch.NumElements();
  }
}

template <ElementKind kKind>
void AddToNodes(const Mesh& mesh, Eigen::Index element,
                const NodeColumns<kKind>& forces, double* values) {
  constexpr int kDimension = kDimensionOf<kKind>;
  for (int i = 0; i < ElementSizes<kKind>::kNodes; ++i) {
    Eigen::Map<Eigen::Matrix<double, kDimension, 1>>(
        values + kDimension * Eigen::Index(mesh.elements(i, element))) +=
        forces.col(i);
  }
}

// Returns the forces of a matrix at each point of an element, such as a stress,
// on its nodes, as seen in its frame.
template <ElementKind kKind>
NodeColumns<kKind> NodeForces(const ElementPoint<kKind>& point,
                              const PointMatrices& matrices, int place) {
  constexpr int kDimension = kDimensionOf<kKind>;
  Eigen::Matrix<double, kDimension, kDimension> matrix;
  for (int j = 0; j < kDimension; ++j) {
    for (int i = 0; i < kDimension; ++i) {
      matrix(i, j) = point.volume * matrices.row[i + 3 * j][place];
    }
  }
  return matrix * point.gradient;
}

template <ElementKind kKind>
void AddStressColumns(const MaterialPass& pass,
                      const Eigen::VectorXd& displacement,
                      CrossStretch cross_stretch,
                      Eigen::Ref<Eigen::MatrixXd> columns) {
  VisitBatches<kKind>(pass, displacement, [&](const auto& batch) {
    std::vector<PointMatrices> stresses = cross_stretch == CrossStretch::kStays
                                              ? batch.Stresses()
                                              : batch.StressDerivatives();
    for (std::size_t k = 0; k < stresses.size(); ++k) {
      if (TakesMean<kKind>(pass)) {
        batch.Mean().ReplaceStresses(stresses[k]);
      }
      for (std::size_t e = 0; e < batch.NumElements(); ++e) {
        NodeColumns<kKind> forces = NodeColumns<kKind>::Zero();
        for (int i = 0; i < batch.PointsPerElement(); ++i) {
          forces += NodeForces<kKind>(batch.Point(e, i), stresses[k],
                                      batch.PlaceOf(e, i));
        }
        if (pass.HasFrames()) {
          forces =
              (FrameOfElement<kKind>(pass, batch.Element(e)) * forces).eval();
        }
        AddToNodes<kKind>(pass.mesh, batch.Element(e), forces,
                          columns.col(Eigen::Index(k)).data());
      }
    }
  });
}

// Calls visit(points, gradients, count) for all tetrahedra of a pass, in the
// form of Tet4Points or Tet10Points, with so many points.
template <class Points, class Visitor>
void VisitTetrahedra(const MaterialPass& pass,
                     const Eigen::VectorXd& displacement,
                     const Visitor& visit) {
  PointMatrices gradients;
  const std::size_t num_elements = pass.elements.size();
  for (std::size_t first = 0; first < num_elements;
       first += Points::kElements) {
    const int count =
        int(std::min<std::size_t>(Points::kElements, num_elements - first));
    const Points points(pass.mesh, pass.elements.data() + first, count);
    points.SetGradients(displacement.data(), gradients);
    visit(points, gradients, points.NumPoints());
  }
}

template <class Points>
void AddTetrahedraColumns(const MaterialPass& pass,
                          const Eigen::VectorXd& displacement,
                          Eigen::Ref<Eigen::MatrixXd> columns) {
  std::vector<PointMatrices> stresses(pass.law.NumModuli());
  VisitTetrahedra<Points>(
      pass, displacement,
      [&](const Points& points, const PointMatrices& gradients, int count) {
        pass.law.StressesAtPoints(gradients, GradientEntries::kAll, count,
                                  stresses.data());
        for (std::size_t k = 0; k < stresses.size(); ++k) {
          points.AddForces(stresses[k], columns.col(Eigen::Index(k)).data());
        }
      });
}

void AddTet4Blocks(const MaterialPass& pass,
                   const Eigen::VectorXd& displacement, const NodeGraph& graph,
                   Eigen::MatrixXd& blocks) {
  PointTangents tangents;
  VisitTetrahedra<Tet4Points>(
      pass, displacement,
      [&](const Tet4Points& points, const PointMatrices& gradients, int count) {
        pass.law.TangentsAtPoints(pass.moduli, gradients, GradientEntries::kAll,
                                  count, tangents, nullptr);
        points.AddBlocks(tangents, graph, blocks);
      });
}

void AddTet4Products(const MaterialPass& pass,
                     const Eigen::VectorXd& displacement,
                     const Eigen::MatrixXd& directions,
                     Eigen::MatrixXd& products) {
  PointTangents tangents;
  PointMatrices change;
  PointMatrices stresses;
  VisitTetrahedra<Tet4Points>(
      pass, displacement,
      [&](const Tet4Points& points, const PointMatrices& gradients, int count) {
        pass.law.TangentsAtPoints(pass.moduli, gradients, GradientEntries::kAll,
                                  count, tangents, nullptr);
        for (Eigen::Index column = 0; column < directions.cols(); ++column) {
          points.SetGradients(directions.col(column).data(), change);
          stresses = {};
          for (int a = 0; a < 9; ++a) {
            for (int b = 0; b < 9; ++b) {
              const double* const tangent = tangents.row[TangentRow(a, b)];
              for (int p = 0; p < count; ++p) {
                stresses.row[a][p] += tangent[p] * change.row[b][p];
              }
            }
          }
          points.AddForces(stresses, products.col(column).data());
        }
      });
}

// The entries of dP / dH in the plane of a planar mesh, or all of them; in
// plane stress at P_33 = 0.
template <ElementKind kKind>
auto TangentIn(const PointTangents& tangents, int point, SectionModel model) {
  constexpr int kDimension = kDimensionOf<kKind>;
  constexpr int kSize = kDimension * kDimension;
  const auto entry = [&](int a, int b) {
    return tangents.row[TangentRow(a, b)][point];
  };
  Eigen::Matrix<double, kSize, kSize> tangent;
  for (int column = 0; column < kSize; ++column) {
    const int b = column % kDimension + 3 * (column / kDimension);
    for (int row = 0; row < kSize; ++row) {
      const int a = row % kDimension + 3 * (row / kDimension);
      tangent(row, column) = entry(a, b);
      if (model == SectionModel::kPlaneStress) {
        tangent(row, column) -= entry(a, kCrossPlace) * entry(kCrossPlace, b) /
                                entry(kCrossPlace, kCrossPlace);
      }
    }
  }
  return tangent;
}

// The displacements of the nodes of an element, in the order of nodes.
template <ElementKind kKind>
constexpr int kElementDofs =
    ElementSizes<kKind>::kDimension* ElementSizes<kKind>::kNodes;

template <ElementKind kKind>
using ElementMatrix =
    Eigen::Matrix<double, kElementDofs<kKind>, kElementDofs<kKind>>;

// Adds volume grad(N_i) . A . grad(N_j) for all nodes.
template <ElementKind kKind, class Tangent>
void AddPointTangent(const ElementPoint<kKind>& point, const Tangent& tangent,
                     ElementMatrix<kKind>& matrix) {
  constexpr int kDimension = kDimensionOf<kKind>;
  constexpr int kNodes = ElementSizes<kKind>::kNodes;
  for (int j = 0; j < kNodes; ++j) {
    Eigen::Matrix<double, kDimension * kDimension, kDimension> of_column =
        point.volume * point.gradient(0, j) *
        tangent.template middleCols<kDimension>(0);
    for (int d = 1; d < kDimension; ++d) {
      of_column += point.volume * point.gradient(d, j) *
                   tangent.template middleCols<kDimension>(kDimension * d);
    }
    for (int i = j; i < kNodes; ++i) {
      auto block = matrix.template block<kDimension, kDimension>(
          kDimension * i, kDimension * j);
      for (int c = 0; c < kDimension; ++c) {
        block += point.gradient(c, i) *
                 of_column.template middleRows<kDimension>(kDimension * c);
      }
    }
  }
}

// Adds to the stiffness of an element what comes with the change of its
// smoothed dilatation.
template <ElementKind kKind>
void AddDilatation(const ElementBatch<kKind>& batch, std::size_t e,
                   const MeanDilatation::Curvature& curvature,
                   ElementMatrix<kKind>& matrix) {
  constexpr int kMostPolynomials = 4;
  using Column = Eigen::Matrix<double, kElementDofs<kKind>, 1>;
  const MeanDilatation& mean = batch.Mean();
  const int size = mean.NumPolynomials();
  // The derivatives of Theta_a with respect to the displacements of the nodes,
  // and the coupling forces of each dTheta_a.
  std::array<Column, kMostPolynomials> slopes;
  std::array<Column, kMostPolynomials> halves;
  std::fill_n(slopes.begin(), size, Column::Zero());
  std::fill_n(halves.begin(), size, Column::Zero());
  Eigen::Matrix4d dilatation = Eigen::Matrix4d::Zero();
  for (int i = 0; i < batch.PointsPerElement(); ++i) {
    const ElementPoint<kKind>& point = batch.Point(e, i);
    const int place = batch.PlaceOf(e, i);
    const NodeColumns<kKind> slope =
        NodeForces<kKind>(point, mean.Cofactors(), place);
    const NodeColumns<kKind> coupling =
        NodeForces<kKind>(point, curvature.coupling, place);
    for (int a = 0; a < size; ++a) {
      const double polynomial = mean.Polynomials().row[a][place];
      slopes[a] += polynomial * slope.reshaped();
      halves[a] += polynomial * coupling.reshaped();
      for (int b = 0; b < size; ++b) {
        dilatation(a, b) += point.volume * curvature.dilatation.row[0][place] *
                            polynomial * mean.Polynomials().row[b][place];
      }
    }
  }
  for (int a = 0; a < size; ++a) {
    for (int b = 0; b < size; ++b) {
      halves[a] += dilatation(a, b) / 2 * slopes[b];
    }
    for (int j = 0; j < kElementDofs<kKind>; ++j) {
      matrix.col(j) += halves[a](j) * slopes[a] + slopes[a](j) * halves[a];
    }
  }
}

// Rotates the lower triangle of an element stiffness from the frame of the
// material to the axes of the mesh.
template <ElementKind kKind, class Frame>
void TurnBlocks(const Frame& frame, ElementMatrix<kKind>& matrix) {
  constexpr int kDimension = kDimensionOf<kKind>;
  for (int j = 0; j < ElementSizes<kKind>::kNodes; ++j) {
    for (int i = j; i < ElementSizes<kKind>::kNodes; ++i) {
      auto block = matrix.template block<kDimension, kDimension>(
          kDimension * i, kDimension * j);
      block = (frame * block * frame.transpose()).eval();
    }
  }
}

// Calls visit(element, matrix) with the lower triangle of the stiffness of each
// element.
template <ElementKind kKind, class Visitor>
void VisitTangents(const MaterialPass& pass,
                   const Eigen::VectorXd& displacement, const Visitor& visit) {
  PointTangents tangents;
  PointMatrices stresses = {};
  MeanDilatation::Curvature curvature;
  VisitBatches<kKind>(pass, displacement, [&](const auto& batch) {
    batch.SetTangents(tangents, TakesMean<kKind>(pass) ? &stresses : nullptr);
    if (TakesMean<kKind>(pass)) {
      batch.Mean().SetCurvature(stresses, tangents, curvature);
    }
    const PointTangents& of_points =
        TakesMean<kKind>(pass) ? curvature.local : tangents;
    for (std::size_t e = 0; e < batch.NumElements(); ++e) {
      ElementMatrix<kKind> matrix = ElementMatrix<kKind>::Zero();
      for (int i = 0; i < batch.PointsPerElement(); ++i) {
        AddPointTangent<kKind>(batch.Point(e, i),
                               TangentIn<kKind>(of_points, batch.PlaceOf(e, i),
                                                pass.mesh.section.model),
                               matrix);
      }
      if (TakesMean<kKind>(pass)) {
        AddDilatation<kKind>(batch, e, curvature, matrix);
      }
      if (pass.HasFrames()) {
        TurnBlocks<kKind>(FrameOfElement<kKind>(pass, batch.Element(e)),
                          matrix);
      }
      visit(batch.Element(e), matrix);
    }
  });
}

template <ElementKind kKind>
void AddBlocks(const MaterialPass& pass, const Eigen::VectorXd& displacement,
               const NodeGraph& graph, Eigen::MatrixXd& blocks) {
  constexpr int kDimension = kDimensionOf<kKind>;
  VisitTangents<kKind>(
      pass, displacement,
      [&](Eigen::Index e, const ElementMatrix<kKind>& matrix) {
        const int* const nodes = pass.mesh.elements.col(e).data();
        for (int j = 0; j < ElementSizes<kKind>::kNodes; ++j) {
          for (int i = j; i < ElementSizes<kKind>::kNodes; ++i) {
            auto block = blocks.middleCols<kDimension>(
                kDimension * Eigen::Index(graph.element_pairs(
                                 NodeGraph::LocalPair(i, j), e)));
            const auto own = matrix.template block<kDimension, kDimension>(
                kDimension * i, kDimension * j);
            // The pair has the greater node first.
            if (nodes[i] >= nodes[j]) {
              block += own;
            } else {
              block += own.transpose();
            }
          }
        }
      });
}

template <ElementKind kKind>
void AddProducts(const MaterialPass& pass, const Eigen::VectorXd& displacement,
                 const Eigen::MatrixXd& directions, Eigen::MatrixXd& products) {
  VisitTangents<kKind>(
      pass, displacement,
      [&](Eigen::Index e, const ElementMatrix<kKind>& matrix) {
        for (Eigen::Index column = 0; column < directions.cols(); ++column) {
          const NodeColumns<kKind> v =
              GatherNodes<kKind>(pass.mesh, e, directions.col(column).data());
          NodeColumns<kKind> forces;
          forces.reshaped() =
              matrix.template selfadjointView<Eigen::Lower>() * v.reshaped();
          AddToNodes<kKind>(pass.mesh, e, forces, products.col(column).data());
        }
      });
}

template <ElementKind kKind>
VolumeRatio SmallestRatio(const Mesh& mesh,
                          const Eigen::VectorXd& displacement) {
  constexpr int kDimension = kDimensionOf<kKind>;
  VolumeRatio smallest = {std::numeric_limits<double>::infinity(), 0};
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    const NodeColumns<kKind> u =
        GatherNodes<kKind>(mesh, e, displacement.data());
    VisitPoints<kKind>(mesh, e, StiffnessRule<kKind>(),
                       [&](const auto& point, const auto&) {
                         Eigen::Matrix<double, kDimension, kDimension> f =
                             u * point.gradient.transpose();
                         f.diagonal().array() += 1;
                         const double ratio = f.determinant();
                         if (!(ratio >= smallest.value)) {
                           smallest = {ratio, e};
                         }
                       });
  }
  return smallest;
}

}  // namespace

VolumeRatio SmallestVolumeRatio(const Mesh& mesh,
                                const Eigen::VectorXd& displacement) {
  return VisitElementKind(mesh.kind, [&](auto kind) {
    return SmallestRatio<kind>(mesh, displacement);
  });
}

LargeStrainForces::LargeStrainForces(const Mesh& mesh,
                                     const std::vector<Material>& materials,
                                     Dilatation dilatation)
    : mesh_(mesh),
      parameters_(materials, mesh.section.model),
      frames_(materials, mesh.Dimension()),
      elements_of_material_(parameters_.NumMaterials()),
      dilatation_(dilatation) {
  for (std::size_t i = 0; i < parameters_.NumMaterials(); ++i) {
    const Law& law = parameters_.LawOf(i);
    if (law.ForLargeStrains() == nullptr) {
      throw std::invalid_argument(
          "the law " + std::string(law.Name()) +
          " is for small strains, but another material of the scene has a law "
          "of large strains; give all materials laws of large strains, such as "
          "corotated");
    }
  }
  const std::vector<int> material_of_element =
      MaterialOfElements(materials, mesh);
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    elements_of_material_[material_of_element[e]].push_back(e);
  }
}

template <class Function>
void LargeStrainForces::ForEachMaterial(const Eigen::VectorXd& moduli,
                                        const Function& function) const {
  for (std::size_t i = 0; i < elements_of_material_.size(); ++i) {
    const LargeStrainLaw& law = *parameters_.LawOf(i).ForLargeStrains();
    const MaterialPass pass = {
        mesh_,
        elements_of_material_[i],
        law,
        moduli.segment(parameters_.FirstModulus(i), law.NumModuli()),
        dilatation_,
        frames_,
        int(i)};
    VisitElementKind(mesh_.kind, [&](auto kind) { function(kind, pass, i); });
  }
}

template <class Adder>
Eigen::MatrixXd LargeStrainForces::SumOfColumns(const Eigen::VectorXd& moduli,
                                                const Adder& add) const {
  Eigen::MatrixXd columns =
      Eigen::MatrixXd::Zero(mesh_.NumDofs(), parameters_.NumModuli());
  ForEachMaterial(moduli, [&](auto kind, const MaterialPass& pass,
                              std::size_t i) {
    add(kind, pass,
        columns.middleCols(parameters_.FirstModulus(i), pass.law.NumModuli()));
  });
  return columns;
}

Eigen::MatrixXd LargeStrainForces::Columns(
    const Eigen::VectorXd& moduli, const Eigen::VectorXd& displacement) const {
  assert(displacement.size() == mesh_.NumDofs());
  return SumOfColumns(moduli, [&](auto kind, const MaterialPass& pass,
                                  auto columns) {
    if constexpr (kind == ElementKind::kTet4 || kind == ElementKind::kTet10) {
      using Points = std::conditional_t<kind == ElementKind::kTet4, Tet4Points,
                                        Tet10Points>;
      if (!pass.HasFrames()) {
        AddTetrahedraColumns<Points>(pass, displacement, columns);
        return;
      }
    }
    AddStressColumns<kind>(pass, displacement, CrossStretch::kStays, columns);
  });
}

Eigen::MatrixXd LargeStrainForces::ModuliDerivatives(
    const Eigen::VectorXd& moduli, const Eigen::VectorXd& displacement) const {
  if (mesh_.section.model != SectionModel::kPlaneStress) {
    return Columns(moduli, displacement);
  }
  return SumOfColumns(
      moduli, [&](auto kind, const MaterialPass& pass, auto columns) {
        if constexpr (kDimensionOf<kind> == 2) {
          AddStressColumns<kind>(pass, displacement, CrossStretch::kFollows,
                                 columns);
        }
      });
}

Eigen::MatrixXd LargeStrainForces::TangentBlocks(
    const Eigen::VectorXd& moduli, const Eigen::VectorXd& displacement,
    const NodeGraph& graph) const {
  Eigen::MatrixXd blocks = Eigen::MatrixXd::Zero(
      mesh_.Dimension(), mesh_.Dimension() * graph.NumPairs());
  ForEachMaterial(moduli,
                  [&](auto kind, const MaterialPass& pass, std::size_t) {
                    if constexpr (kind == ElementKind::kTet4) {
                      if (!pass.HasFrames()) {
                        AddTet4Blocks(pass, displacement, graph, blocks);
                        return;
                      }
                    }
                    AddBlocks<kind>(pass, displacement, graph, blocks);
                  });
  return blocks;
}

Eigen::MatrixXd LargeStrainForces::TangentProducts(
    const Eigen::VectorXd& moduli, const Eigen::VectorXd& displacement,
    const Eigen::MatrixXd& directions) const {
  Eigen::MatrixXd products =
      Eigen::MatrixXd::Zero(directions.rows(), directions.cols());
  ForEachMaterial(
      moduli, [&](auto kind, const MaterialPass& pass, std::size_t) {
        if constexpr (kind == ElementKind::kTet4) {
          if (!pass.HasFrames()) {
            AddTet4Products(pass, displacement, directions, products);
            return;
          }
        }
        AddProducts<kind>(pass, displacement, directions, products);
      });
  return products;
}

}  // namespace elastimate
