#include "elastimate/core/scene/spread_loads.h"

#include <functional>
#include <utility>
#include <variant>

#include "elastimate/core/mesh/facets.h"
#include "elastimate/core/scene/loads.h"

namespace elastimate {
namespace {

using NodeMask = Eigen::Array<bool, Eigen::Dynamic, 1>;

NodeMask LoadedNodes(const NodalForces& load) {
  return (load.force.array() != 0).colwise().any().transpose();
}

NodeMask IsInside(const Mesh& mesh, const Eigen::MatrixXi& surface) {
  NodeMask is_inside = NodeMask::Constant(mesh.NumNodes(), true);
  for (const int node : surface.reshaped()) {
    is_inside(node) = false;
  }
  return is_inside;
}

// Returns the cells of which all nodes are loaded.
std::vector<Eigen::Index> LoadedCells(const Eigen::MatrixXi& cells,
                                      const NodeMask& is_loaded) {
  std::vector<Eigen::Index> loaded;
  for (Eigen::Index i = 0; i < cells.cols(); ++i) {
    if (is_loaded(cells.col(i)).all()) {
      loaded.push_back(i);
    }
  }
  return loaded;
}

// The facets or elements over which a force is spread.
struct Cells {
  Eigen::MatrixXi nodes;  ///< nodes_per_cell x num_cells.
  /// Returns the load of these densities, dimension x num_cells.
  std::function<Load(const Eigen::MatrixXd&)> load;
  bool are_facets;
};

Cells CellsOf(const Mesh& mesh, const Eigen::MatrixXi& surface,
              const NodeMask& is_held, const NodeMask& is_loaded) {
  if ((is_loaded || is_held).all() ||
      (is_loaded && IsInside(mesh, surface)).any()) {
    const std::vector<Eigen::Index> loaded =
        LoadedCells(mesh.elements, is_loaded);
    return {mesh.elements(Eigen::all, loaded),
            [&mesh, loaded](const Eigen::MatrixXd& densities) {
              BodyForce load{
                  Eigen::MatrixXd::Zero(mesh.Dimension(), mesh.NumElements())};
              load.force_density(Eigen::all, loaded) = densities;
              return load;
            },
            false};
  }
  const Eigen::MatrixXi facets =
      surface(Eigen::all, LoadedCells(surface, is_loaded));
  return {facets,
          [facets](const Eigen::MatrixXd& densities) {
            return Traction{facets, densities};
          },
          true};
}

// Returns, for each cell, the mean over its nodes.
Eigen::RowVectorXd MeansOf(const Eigen::MatrixXi& cells,
                           const Eigen::VectorXd& of_nodes) {
  Eigen::RowVectorXd means(cells.cols());
  for (Eigen::Index i = 0; i < cells.cols(); ++i) {
    means(i) = of_nodes(cells.col(i)).mean();
  }
  return means;
}

// The densities in cells that stand for nodal forces, and the forces that are
// left.
struct Spread {
  Eigen::MatrixXd densities;  ///< dimension x num_cells.
  Eigen::MatrixXd rest;       ///< dimension x num_nodes.
};

// Moves the part of `rest` along the directions, one for each cell, into
// densities.
void TakeAlong(const Mesh& mesh, const Cells& cells,
               const Eigen::MatrixXd& directions, Spread& spread) {
  constexpr int kSweeps = 3;
  const auto assemble = [&](const Eigen::MatrixXd& densities) {
    return AssembleLoads(mesh, {cells.load(densities)});
  };
  const Eigen::MatrixXd unit = assemble(directions);
  const Eigen::MatrixXd force = spread.rest;
  Eigen::VectorXd of_nodes = Eigen::VectorXd::Zero(mesh.NumNodes());
  Eigen::MatrixXd densities;
  // Where directions cancel, forces say nothing about them.
  const double least = 1e-6 * unit.colwise().squaredNorm().maxCoeff();
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (Eigen::Index i = 0; i < of_nodes.size(); ++i) {
      const double size = unit.col(i).squaredNorm();
      if (size > least) {
        of_nodes(i) += spread.rest.col(i).dot(unit.col(i)) / size;
      }
    }
    densities = directions * MeansOf(cells.nodes, of_nodes).asDiagonal();
    spread.rest = force - assemble(densities);
  }
  spread.densities += densities;
}

Spread NothingOf(const Cells& cells, const Eigen::MatrixXd& force) {
  return {Eigen::MatrixXd::Zero(force.rows(), cells.nodes.cols()), force};
}

Spread AsVectors(const Mesh& mesh, const Cells& cells,
                 const Eigen::MatrixXd& force) {
  Spread spread = NothingOf(cells, force);
  for (Eigen::Index i = 0; i < force.rows(); ++i) {
    Eigen::MatrixXd directions =
        Eigen::MatrixXd::Zero(force.rows(), cells.nodes.cols());
    directions.row(i).setOnes();
    TakeAlong(mesh, cells, directions, spread);
  }
  return spread;
}

Spread AsPressure(const Mesh& mesh, const Cells& cells,
                  const Eigen::MatrixXd& force) {
  Spread spread = NothingOf(cells, force);
  TakeAlong(mesh, cells, UnitNormals(mesh, cells.nodes), spread);
  return spread;
}

std::vector<Load> SpreadOf(const Mesh& mesh, const Eigen::MatrixXi& surface,
                           const NodeMask& is_held, const NodalForces& load) {
  const Cells cells = CellsOf(mesh, surface, is_held, LoadedNodes(load));
  if (cells.nodes.cols() == 0) {
    return {load};
  }
  Spread spread = AsVectors(mesh, cells, load.force);
  if (cells.are_facets) {
    Spread as_pressure = AsPressure(mesh, cells, load.force);
    if (as_pressure.rest.norm() < spread.rest.norm()) {
      spread = std::move(as_pressure);
    }
  }
  constexpr double kRounding = 1e-12;
  if (spread.rest.norm() <= kRounding * load.force.norm()) {
    return {cells.load(spread.densities)};
  }
  return {cells.load(spread.densities), NodalForces{spread.rest}};
}

}  // namespace

std::vector<Load> SpreadLoads(const Mesh& mesh, const Eigen::MatrixXi& surface,
                              const ComponentMask& held,
                              const std::vector<Load>& loads) {
  const NodeMask is_held = held.colwise().all().transpose();
  std::vector<Load> spread;
  for (const Load& load : loads) {
    if (const auto* const nodal = std::get_if<NodalForces>(&load)) {
      for (Load& part : SpreadOf(mesh, surface, is_held, *nodal)) {
        spread.push_back(std::move(part));
      }
    } else {
      spread.push_back(load);
    }
  }
  return spread;
}

}  // namespace elastimate
