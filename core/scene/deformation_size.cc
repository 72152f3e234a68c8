#include "elastimate/core/scene/deformation_size.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/algebra/median.h"
#include "elastimate/core/mesh/nearest_points.h"

namespace elastimate {
namespace {

constexpr Eigen::Index kMostPoints = 4000;
constexpr Eigen::Index kVolumePoints = 1000;
constexpr int kLargestDegree = 4;
// So many observed values are needed for each coefficient of a polynomial, so
// that noise is smoothed.
constexpr Eigen::Index kValuesPerMonomial = 4;
// Points on a surface make the polynomials dependent.  Polynomials that are
// dependent to within this share, though not to within rounding, still amplify
// noise.
constexpr double kDependent = 1e-4;
constexpr double kVolumeShare = 0.95;
// So many neighbours for each dimension are compared with a value.
constexpr int kNeighbours = 4;
// Noise stays below this many times the differences among neighbours, and a
// kink of the displacement, too.
constexpr double kStray = 8;

double MedianOf(const Eigen::VectorXd& values) {
  return Median(std::vector<double>(values.begin(), values.end()));
}

// The observations of each component: positions, dimension x n, and values.
struct Observed {
  Eigen::MatrixXd positions;
  Eigen::VectorXd values;
};

Eigen::MatrixXd PositionsOfPoints(const Scene& scene,
                                  const LoadCase& load_case) {
  return Interpolate(scene.mesh, load_case.points.points, scene.mesh.nodes);
}

Observed ObservedComponent(const Scene& scene, const LoadCase& load_case,
                           const Eigen::MatrixXd& points, int component) {
  std::vector<Eigen::Index> nodes;
  for (Eigen::Index node = 0;
       load_case.displacement.size() != 0 && node < scene.mesh.NumNodes();
       ++node) {
    if (IsObserved(load_case, component, node)) {
      nodes.push_back(node);
    }
  }
  std::vector<Eigen::Index> others;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    if (!std::isnan(load_case.points.displacement(component, i))) {
      others.push_back(i);
    }
  }
  const auto num_nodes = Eigen::Index(nodes.size());
  const Eigen::Index all = num_nodes + Eigen::Index(others.size());
  const Eigen::Index stride = std::max<Eigen::Index>(1, all / kMostPoints);
  const Eigen::Index count = (all + stride - 1) / stride;
  Observed observed = {Eigen::MatrixXd(scene.mesh.Dimension(), count),
                       Eigen::VectorXd(count)};
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Index at = i * stride;
    if (at < num_nodes) {
      const Eigen::Index node = nodes[at];
      observed.positions.col(i) = scene.mesh.nodes.col(node);
      observed.values(i) = load_case.displacement(component, node);
    } else {
      const Eigen::Index point = others[at - num_nodes];
      observed.positions.col(i) = points.col(point);
      observed.values(i) = load_case.points.displacement(component, point);
    }
  }
  return observed;
}

// Returns the exponents of the monomials of degree <= `degree`.
std::vector<Eigen::Array3i> ExponentsUpTo(int degree, Eigen::Index dimension) {
  std::vector<Eigen::Array3i> exponents;
  for (int i = 0; i <= degree; ++i) {
    for (int j = 0; i + j <= degree; ++j) {
      for (int k = 0; k <= (dimension == 3 ? degree - i - j : 0); ++k) {
        exponents.emplace_back(i, j, k);
      }
    }
  }
  return exponents;
}

// Returns the product of the powers of the coordinates, without that of
// `left_out`.
Eigen::ArrayXd Powers(const Eigen::MatrixXd& x, const Eigen::Array3i& exponents,
                      Eigen::Index left_out) {
  Eigen::ArrayXd product = Eigen::ArrayXd::Ones(x.cols());
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    for (int power = 0; i != left_out && power < exponents(i); ++power) {
      product *= x.row(i).transpose().array();
    }
  }
  return product;
}

// Maps the box of the mesh to the cube from -1 to 1, so that slender bodies are
// well conditioned too.
struct Frame {
  explicit Frame(const Mesh& mesh)
      : middle((mesh.nodes.rowwise().maxCoeff() +
                mesh.nodes.rowwise().minCoeff()) /
               2),
        scale((mesh.nodes.rowwise().maxCoeff() -
               mesh.nodes.rowwise().minCoeff()) /
              2) {}
  Eigen::MatrixXd Coordinates(const Eigen::MatrixXd& positions) const {
    return (positions.colwise() - middle).array().colwise() / scale.array();
  }
  Eigen::VectorXd middle;
  Eigen::VectorXd scale;
};

// Returns the gradient of the polynomial of least squares, dimension x
// num_points; empty where there are too few values.
Eigen::MatrixXd GradientAt(const Frame& frame, const Observed& observed,
                           const Eigen::MatrixXd& points) {
  const Eigen::Index dimension = points.rows();
  int degree = kLargestDegree;
  std::vector<Eigen::Array3i> exponents = ExponentsUpTo(degree, dimension);
  while (degree > 0 && kValuesPerMonomial * Eigen::Index(exponents.size()) >
                           observed.values.size()) {
    exponents = ExponentsUpTo(--degree, dimension);
  }
  if (degree == 0) {
    return {};
  }
  const auto num_monomials = Eigen::Index(exponents.size());
  const Eigen::MatrixXd x = frame.Coordinates(observed.positions);
  Eigen::MatrixXd monomials(x.cols(), num_monomials);
  for (Eigen::Index m = 0; m < num_monomials; ++m) {
    monomials.col(m) = Powers(x, exponents[m], -1);
  }
  const Eigen::VectorXd coefficients =
      SolveLeastSquares(monomials, observed.values, kDependent);
  const Eigen::MatrixXd at = frame.Coordinates(points);
  Eigen::MatrixXd gradient = Eigen::MatrixXd::Zero(dimension, points.cols());
  for (Eigen::Index m = 0; m < num_monomials; ++m) {
    const Eigen::Array3i& powers = exponents[m];
    for (Eigen::Index j = 0; j < dimension; ++j) {
      if (powers(j) > 0) {
        const Eigen::ArrayXd along =
            powers(j) * at.row(j).transpose().array().pow(powers(j) - 1);
        gradient.row(j) +=
            (coefficients(m) / frame.scale(j) * along * Powers(at, powers, j))
                .matrix()
                .transpose();
      }
    }
  }
  return gradient;
}

// Returns the values minus those of the affine function of least squares.
Eigen::VectorXd WithoutAffinePart(const Frame& frame,
                                  const Observed& observed) {
  Eigen::MatrixXd affine(observed.values.size(), observed.positions.rows() + 1);
  affine << Eigen::VectorXd::Ones(observed.values.size()),
      frame.Coordinates(observed.positions).transpose();
  return observed.values -
         affine * SolveLeastSquares(affine, observed.values, kDependent);
}

std::vector<std::vector<Eigen::Index>> NeighboursOf(
    const Eigen::MatrixXd& positions) {
  std::vector<std::vector<Eigen::Index>> neighbours(positions.cols());
  for (const auto& [a, b] :
       NearestPairs(positions, kNeighbours * int(positions.rows()))) {
    neighbours[a].push_back(b);
    neighbours[b].push_back(a);
  }
  return neighbours;
}

// Leaves out values that disagree with the values of their neighbours by far
// more than these do among themselves, as in the normalised median test of
// Westerweel & Scarano (Exp. Fluids 39 (2005) 1096): gross errors, each of
// which would bend the polynomials.  A deformation, however local, is one of
// several neighbours.
Observed WithoutStrayValues(const Frame& frame, const Observed& observed) {
  const Eigen::Index num_values = observed.values.size();
  if (num_values <= kNeighbours * observed.positions.rows()) {
    return observed;
  }
  const Eigen::VectorXd rest = WithoutAffinePart(frame, observed);
  const auto neighbours = NeighboursOf(observed.positions);
  Eigen::VectorXd difference(num_values);
  Eigen::VectorXd spread(num_values);
  for (Eigen::Index i = 0; i < num_values; ++i) {
    const Eigen::VectorXd around = rest(neighbours[i]);
    const double middle = MedianOf(around);
    difference(i) = std::abs(rest(i) - middle);
    spread(i) = MedianOf((around.array() - middle).abs());
  }
  const double usual = MedianOf(difference);
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < num_values; ++i) {
    if (difference(i) <= kStray * (spread(i) + usual)) {
      kept.push_back(i);
    }
  }
  return {observed.positions(Eigen::all, kept), observed.values(kept)};
}

struct Polar {
  Eigen::MatrixXd rotation;
  Eigen::VectorXd stretches;
};

// Decomposes F = R U.
Polar DecomposePolar(const Eigen::MatrixXd& f) {
  const SymmetricEigenDecomposition squares =
      DecomposeSymmetric(f.transpose() * f);
  const Eigen::VectorXd stretches = squares.values.cwiseMax(1e-20).cwiseSqrt();
  return {f * squares.vectors * stretches.cwiseInverse().asDiagonal() *
              squares.vectors.transpose(),
          stretches};
}

double AngleOf(const Eigen::MatrixXd& rotation) {
  const double cosine =
      rotation.rows() == 2 ? rotation.trace() / 2 : (rotation.trace() - 1) / 2;
  return std::acos(std::clamp(cosine, -1.0, 1.0));
}

Eigen::MatrixXd PointsOfTheVolume(const Scene& scene, const LoadCase& load_case,
                                  const Eigen::MatrixXd& points,
                                  const Observed& observed) {
  if (points.size() != 0 || load_case.observed.size() != 0) {
    return observed.positions;
  }
  std::mt19937_64 generator(1);
  return Interpolate(scene.mesh,
                     DrawPoints(scene.mesh, kVolumePoints, generator),
                     scene.mesh.nodes);
}

// Returns F at points of the volume; empty where too little was observed.
std::vector<Eigen::MatrixXd> DeformationGradients(const Scene& scene,
                                                  const LoadCase& load_case) {
  const int dimension = scene.mesh.Dimension();
  const Frame frame(scene.mesh);
  const Eigen::MatrixXd points = load_case.points.points.Size() == 0
                                     ? Eigen::MatrixXd(dimension, 0)
                                     : PositionsOfPoints(scene, load_case);
  std::vector<Eigen::MatrixXd> gradients;
  Eigen::MatrixXd at;
  for (int component = 0; component < dimension; ++component) {
    const Observed observed = WithoutStrayValues(
        frame, ObservedComponent(scene, load_case, points, component));
    if (component == 0) {
      at = PointsOfTheVolume(scene, load_case, points, observed);
      gradients.assign(static_cast<std::size_t>(at.cols()),
                       Eigen::MatrixXd::Identity(dimension, dimension));
    }
    const Eigen::MatrixXd gradient = GradientAt(frame, observed, at);
    if (gradient.size() == 0) {
      return {};
    }
    for (Eigen::Index i = 0; i < at.cols(); ++i) {
      gradients[i].row(component) += gradient.col(i).transpose();
    }
  }
  return gradients;
}

// Returns the value below which a share of the values stays.
double Quantile(double share, std::vector<double> values) {
  const auto place =
      values.begin() +
      std::ptrdiff_t(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

// Returns the factor of DeformationSize::volume_change at a point.
double VolumeChangeOf(const Eigen::MatrixXd& f) {
  const double ratio = f.determinant();
  if (ratio >= 1) {
    return f.rows() == 3 ? ratio : 1;
  }
  return ratio > 0 ? 1 / ratio : std::numeric_limits<double>::infinity();
}

DeformationSize SizeOf(const std::vector<Eigen::MatrixXd>& gradients,
                       bool is_rigid_motion_free) {
  if (gradients.empty()) {
    return {};
  }
  const Eigen::Index dimension = gradients[0].rows();
  Eigen::MatrixXd frame = Eigen::MatrixXd::Zero(dimension, dimension);
  for (const Eigen::MatrixXd& f : gradients) {
    frame += f / static_cast<double>(gradients.size());
  }
  frame =
      is_rigid_motion_free
          ? DecomposePolar(frame).rotation
          : Eigen::MatrixXd(Eigen::MatrixXd::Identity(dimension, dimension));
  double square_sum = 0;
  std::vector<double> angles;
  std::vector<double> changes;
  for (const Eigen::MatrixXd& f : gradients) {
    const Polar polar = DecomposePolar(frame.transpose() * f);
    square_sum += (polar.stretches.array() - 1).square().maxCoeff();
    angles.push_back(AngleOf(polar.rotation));
    changes.push_back(VolumeChangeOf(f));
  }
  return {std::sqrt(square_sum / static_cast<double>(gradients.size())),
          Quantile(kVolumeShare, angles), Quantile(kVolumeShare, changes)};
}

}  // namespace

DeformationSize MeasureDeformation(const Scene& scene) {
  DeformationSize size;
  for (std::size_t k = 0; k < scene.load_cases.size(); ++k) {
    const LoadCase& load_case = scene.load_cases[k];
    const bool is_free = scene.is_rigid_motion_free ||
                         !SupportsOf(scene, Eigen::Index(k)).held.any();
    const DeformationSize of_case =
        SizeOf(DeformationGradients(scene, load_case), is_free);
    size.strain = std::max(size.strain, of_case.strain);
    size.rotation = std::max(size.rotation, of_case.rotation);
    size.volume_change = std::max(size.volume_change, of_case.volume_change);
  }
  return size;
}

}  // namespace elastimate
