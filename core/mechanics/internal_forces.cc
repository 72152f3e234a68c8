#include "elastimate/core/mechanics/internal_forces.h"

#include <algorithm>
#include <cassert>
#include <stdexcept>
#include <string>
#include <utility>

#include "elastimate/core/materials/isotropic_law.h"
#include "elastimate/core/mechanics/law_products.h"

namespace elastimate {

InternalForces::InternalForces(const Mesh& mesh,
                               const std::vector<Material>& materials)
    : mesh_(mesh),
      parameters_(materials, mesh.section.model),
      material_of_element_(MaterialOfElements(materials, mesh)),
      frames_(materials, mesh.Dimension()),
      is_isotropic_(std::all_of(materials.begin(), materials.end(),
                                [](const Material& material) {
                                  return material.law == IsotropicLaw::kName;
                                })) {
  const std::string why = WhyNotSmallStrains(parameters_);
  if (!why.empty()) {
    throw std::invalid_argument(why);
  }
  if (parameters_.NumMaterials() > 1) {
    parts_ = SplitMesh(mesh, material_of_element_);
  }
  if (is_isotropic_) {
    stiffness_.emplace(parameters_.NumMaterials() > 1 ? parts_.mesh : mesh);
    if (parameters_.NumMaterials() > 1 && HasQuadraticPass(mesh.kind)) {
      stiffness_of_whole_.emplace(mesh);
    }
  }
}

std::vector<std::vector<Eigen::MatrixXd>> InternalForces::UnitTangents() const {
  const int dimension = mesh_.Dimension();
  const Eigen::MatrixXd rest = Eigen::MatrixXd::Zero(dimension, dimension);
  std::vector<std::vector<Eigen::MatrixXd>> tangents(
      parameters_.NumMaterials());
  for (std::size_t i = 0; i < tangents.size(); ++i) {
    const Law& law = parameters_.LawOf(i);
    for (int k = 0; k < law.NumModuli(); ++k) {
      tangents[i].push_back(
          law.Tangent(Eigen::VectorXd::Unit(law.NumModuli(), k), rest,
                      mesh_.section.model));
    }
  }
  return tangents;
}

std::vector<Eigen::MatrixXd> InternalForces::OfParts(
    const Eigen::MatrixXd& displacements) const {
  const bool is_split = parameters_.NumMaterials() > 1;
  const Eigen::MatrixXd gathered =
      is_split ? parts_.Gather(displacements) : Eigen::MatrixXd();
  const Eigen::MatrixXd& of_nodes = is_split ? gathered : displacements;
  std::vector<Eigen::MatrixXd> products;
  if (is_isotropic_) {
    StiffnessProducts isotropic;
    stiffness_->Multiply(of_nodes, isotropic);
    products.push_back(std::move(isotropic.h));
    products.push_back(std::move(isotropic.j));
    return products;
  }
  const std::vector<std::vector<Eigen::MatrixXd>> tangents = UnitTangents();
  std::size_t most_moduli = 0;
  for (const std::vector<Eigen::MatrixXd>& of_material : tangents) {
    most_moduli = std::max(most_moduli, of_material.size());
  }
  products.assign(most_moduli,
                  Eigen::MatrixXd::Zero(of_nodes.rows(), of_nodes.cols()));
  AddLawProducts(is_split ? parts_.mesh : mesh_, material_of_element_, frames_,
                 tangents, of_nodes, products);
  return products;
}

std::vector<Eigen::MatrixXd> InternalForces::Products(
    const Eigen::MatrixXd& displacements) const {
  assert(displacements.rows() == mesh_.NumDofs());
  std::vector<Eigen::MatrixXd> of_parts = OfParts(displacements);
  if (parameters_.NumMaterials() == 1) {
    return of_parts;
  }
  const Eigen::Index dimension = mesh_.Dimension();
  std::vector<Eigen::MatrixXd> products(
      parameters_.NumModuli(),
      Eigen::MatrixXd::Zero(mesh_.NumDofs(), displacements.cols()));
  for (std::size_t copy = 0; copy < parts_.node.size(); ++copy) {
    const std::size_t material = parts_.part[copy];
    for (Eigen::Index k = 0; k < parameters_.LawOf(material).NumModuli(); ++k) {
      products[parameters_.FirstModulus(material) + k].middleRows(
          dimension * Eigen::Index(parts_.node[copy]), dimension) =
          of_parts[k].middleRows(dimension * Eigen::Index(copy), dimension);
    }
  }
  return products;
}

Eigen::MatrixXd InternalForces::Columns(
    const Eigen::VectorXd& displacement) const {
  const std::vector<Eigen::MatrixXd> products = Products(displacement);
  Eigen::MatrixXd columns(mesh_.NumDofs(), parameters_.NumModuli());
  for (Eigen::Index k = 0; k < columns.cols(); ++k) {
    columns.col(k) = products[k];
  }
  return columns;
}

Eigen::MatrixXd InternalForces::Along(
    const Eigen::MatrixXd& directions,
    const Eigen::VectorXd& displacement) const {
  return directions.cols() == 1
             ? Multiply(directions.col(0), displacement)
             : Eigen::MatrixXd(Columns(displacement) * directions);
}

Eigen::Matrix2Xd InternalForces::ModuliOfElements(
    const Eigen::VectorXd& moduli) const {
  assert(is_isotropic_);
  Eigen::Matrix2Xd of_elements(2, mesh_.NumElements());
  for (Eigen::Index e = 0; e < mesh_.NumElements(); ++e) {
    of_elements.col(e) = moduli.segment<2>(
        parameters_.FirstModulus(std::size_t(material_of_element_[e])));
  }
  return of_elements;
}

Eigen::MatrixXd InternalForces::Multiply(
    const Eigen::VectorXd& moduli, const Eigen::MatrixXd& displacements) const {
  if (is_isotropic_ && HasQuadraticPass(mesh_.kind)) {
    return (stiffness_of_whole_ ? stiffness_of_whole_ : stiffness_)
        ->MultiplySum(ModuliOfElements(moduli), displacements);
  }
  Eigen::MatrixXd forces =
      Eigen::MatrixXd::Zero(displacements.rows(), displacements.cols());
  if (!is_isotropic_) {
    std::vector<std::vector<Eigen::MatrixXd>> tangents;
    for (Eigen::MatrixXd& tangent : Tangents(moduli)) {
      tangents.push_back({std::move(tangent)});
    }
    std::vector<Eigen::MatrixXd> sum = {std::move(forces)};
    AddLawProducts(mesh_, material_of_element_, frames_, tangents,
                   displacements, sum);
    return std::move(sum[0]);
  }
  const std::vector<Eigen::MatrixXd> products = OfParts(displacements);
  const Eigen::Index dimension = mesh_.Dimension();
  for (Eigen::Index k = 0; k < Eigen::Index(products.size()); ++k) {
    if (parameters_.NumMaterials() == 1) {
      forces += moduli(k) * products[k];
      continue;
    }
    for (std::size_t copy = 0; copy < parts_.node.size(); ++copy) {
      const std::size_t material = parts_.part[copy];
      if (k < parameters_.LawOf(material).NumModuli()) {
        forces.middleRows(dimension * Eigen::Index(parts_.node[copy]),
                          dimension) +=
            moduli(parameters_.FirstModulus(material) + k) *
            products[k].middleRows(dimension * Eigen::Index(copy), dimension);
      }
    }
  }
  return forces;
}

std::vector<Eigen::MatrixXd> InternalForces::Tangents(
    const Eigen::VectorXd& moduli) const {
  const Eigen::MatrixXd rest =
      Eigen::MatrixXd::Zero(mesh_.Dimension(), mesh_.Dimension());
  std::vector<Eigen::MatrixXd> tangents;
  for (std::size_t i = 0; i < parameters_.NumMaterials(); ++i) {
    const Law& law = parameters_.LawOf(i);
    tangents.push_back(law.Tangent(
        moduli.segment(parameters_.FirstModulus(i), law.NumModuli()), rest,
        mesh_.section.model));
  }
  return tangents;
}

Eigen::MatrixXd InternalForces::Blocks(const Eigen::VectorXd& moduli,
                                       const NodeGraph& graph) const {
  if (is_isotropic_) {
    return StiffnessBlocks(mesh_, graph, ModuliOfElements(moduli));
  }
  return StiffnessBlocks(mesh_, graph, material_of_element_, frames_,
                         Tangents(moduli));
}

Eigen::MatrixXd InternalForces::DiagonalBlocks(
    const Eigen::VectorXd& moduli) const {
  if (is_isotropic_) {
    return DiagonalStiffnessBlocks(mesh_, ModuliOfElements(moduli));
  }
  return DiagonalStiffnessBlocks(mesh_, material_of_element_, frames_,
                                 Tangents(moduli));
}

Eigen::VectorXd InternalForces::EnergyDensity(
    const Eigen::VectorXd& moduli, const Eigen::VectorXd& displacement) const {
  return LawEnergyDensity(mesh_, material_of_element_, frames_,
                          Tangents(moduli), displacement);
}

}  // namespace elastimate
