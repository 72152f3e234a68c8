#include "elastimate/core/mechanics/follower_pressure.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <variant>

#include "elastimate/core/mesh/shape_functions.h"
#include "elastimate/core/scene/loads.h"

namespace elastimate {
namespace {

Eigen::Matrix3d CrossProductBy(const Eigen::Vector3d& a) {
  Eigen::Matrix3d matrix;
  matrix << 0, -a(2), a(1), a(2), 0, -a(0), -a(1), a(0), 0;
  return matrix;
}

// Returns the matrix that turns the tangent of an edge in the plane into its
// area vector, for a thickness of 1.
Eigen::Matrix2d OutwardTurn() {
  return (Eigen::Matrix2d() << 0, 1, -1, 0).finished();
}

Eigen::VectorXd AreaVector(const Eigen::MatrixXd& tangents, double thickness) {
  if (tangents.rows() == 2) {
    return thickness * OutwardTurn() * tangents;
  }
  const Eigen::Vector3d first = tangents.col(0);
  const Eigen::Vector3d second = tangents.col(1);
  return first.cross(second);
}

}  // namespace

FollowerPressure::FollowerPressure(const Mesh& mesh,
                                   const std::vector<Load>& loads)
    : mesh_(mesh), points_(PointsOfFacets(mesh)) {
  for (const Load& load : loads) {
    if (Follows(load)) {
      pressures_.push_back(std::get<Pressure>(load));
    }
  }
}

std::vector<FollowerPressure::FacetPoint> FollowerPressure::PointsOfFacets(
    const Mesh& mesh) {
  std::vector<FacetPoint> points;
  const auto take = [&](const auto& rule) {
    for (const auto& at : rule) {
      points.push_back({at.value, at.gradient, at.weight});
    }
  };
  const bool is_linear = mesh.Order() == 1;
  switch (mesh.Topology().NumVerticesOfFace()) {
    case 3:
      if (is_linear) {
        take(IntegrationRule<ElementKind::kTri3>());
      } else {
        // A facet that was flat is curved when it is deformed.
        take(IntegrationRule<ElementKind::kCurvedTri6>());
      }
      break;
    case 4:
      if (is_linear) {
        take(IntegrationRule<ElementKind::kQuad4>());
      } else {
        take(IntegrationRule<ElementKind::kQuad9>());
      }
      break;
    default:
      // Two Gauss points of the interval from -1 to 1 are exact for cubics.
      for (const double t : {-std::sqrt(1.0 / 3), std::sqrt(1.0 / 3)}) {
        if (is_linear) {
          points.push_back({Eigen::Vector2d((1 - t) / 2, (1 + t) / 2),
                            Eigen::RowVector2d(-0.5, 0.5), 1});
        } else {
          points.push_back(
              {Eigen::Vector3d(t * (t - 1) / 2, t * (t + 1) / 2, 1 - t * t),
               Eigen::RowVector3d(t - 0.5, t + 0.5, -2 * t), 1});
        }
      }
  }
  return points;
}

Eigen::MatrixXd FollowerPressure::Positions(
    const Eigen::Ref<const Eigen::VectorXi>& facet,
    const Eigen::VectorXd& displacement) const {
  const int dimension = mesh_.Dimension();
  Eigen::MatrixXd positions(dimension, facet.size());
  for (Eigen::Index i = 0; i < facet.size(); ++i) {
    positions.col(i) =
        mesh_.nodes.col(facet(i)) +
        displacement.segment(dimension * Eigen::Index(facet(i)), dimension);
  }
  return positions;
}

Eigen::VectorXd FollowerPressure::Forces(
    const Eigen::VectorXd& displacement) const {
  const int dimension = mesh_.Dimension();
  Eigen::VectorXd forces = Eigen::VectorXd::Zero(displacement.size());
  for (const Pressure& load : pressures_) {
    for (const auto& facet : load.facets.colwise()) {
      const Eigen::MatrixXd positions = Positions(facet, displacement);
      for (const FacetPoint& point : points_) {
        const Eigen::VectorXd push =
            -load.pressure * point.weight *
            AreaVector(positions * point.gradient.transpose(),
                       mesh_.section.thickness);
        for (Eigen::Index i = 0; i < facet.size(); ++i) {
          forces.segment(dimension * Eigen::Index(facet(i)), dimension) +=
              point.value(i) * push;
        }
      }
    }
  }
  return forces;
}

Eigen::MatrixXd FollowerPressure::FacetTangent(
    const Eigen::MatrixXd& positions) const {
  const Eigen::Index d = positions.rows();
  const Eigen::Index num_nodes = positions.cols();
  Eigen::MatrixXd tangent = Eigen::MatrixXd::Zero(d * num_nodes, d * num_nodes);
  for (const FacetPoint& point : points_) {
    // The area vector changes by turn_1 dt_1 + turn_2 dt_2 for changes dt of
    // the tangents.
    const Eigen::MatrixXd tangents = positions * point.gradient.transpose();
    std::vector<Eigen::MatrixXd> turns;
    if (d == 2) {
      turns.emplace_back(mesh_.section.thickness * OutwardTurn());
    } else {
      turns.emplace_back(-CrossProductBy(tangents.col(1)));
      turns.emplace_back(CrossProductBy(tangents.col(0)));
    }
    for (Eigen::Index j = 0; j < num_nodes; ++j) {
      Eigen::MatrixXd of_node = Eigen::MatrixXd::Zero(d, d);
      for (Eigen::Index k = 0; k < d - 1; ++k) {
        of_node += point.weight * point.gradient(k, j) * turns[k];
      }
      for (Eigen::Index i = 0; i < num_nodes; ++i) {
        tangent.block(d * i, d * j, d, d) += point.value(i) * of_node;
      }
    }
  }
  return tangent;
}

void FollowerPressure::AddSymmetricBlocks(const Eigen::VectorXd& displacement,
                                          double factor, const NodeGraph& graph,
                                          Eigen::MatrixXd& blocks) const {
  const int d = mesh_.Dimension();
  for (const Pressure& load : pressures_) {
    for (const auto& facet : load.facets.colwise()) {
      Eigen::MatrixXd tangent = FacetTangent(Positions(facet, displacement));
      tangent = (-load.pressure * factor / 2 * (tangent + tangent.transpose()))
                    .eval();
      for (Eigen::Index j = 0; j < facet.size(); ++j) {
        const auto first = graph.row.begin() + graph.start[facet(j)];
        const auto last = graph.row.begin() + graph.start[facet(j) + 1];
        for (Eigen::Index i = 0; i < facet.size(); ++i) {
          if (facet(i) >= facet(j)) {
            const Eigen::Index pair =
                std::lower_bound(first, last, facet(i)) - graph.row.begin();
            blocks.middleCols(d * pair, d) += tangent.block(d * i, d * j, d, d);
          }
        }
      }
    }
  }
}

}  // namespace elastimate
