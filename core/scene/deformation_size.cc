#include "elastimate/core/scene/deformation_size.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/algebra/median.h"
#include "elastimate/core/mesh/nearest_points.h"

namespace elastimate {
namespace {

constexpr std::size_t kMostPoints = 2000;
constexpr Eigen::Index kVolumePoints = 1000;
constexpr int kLargestDegree = 4;
// So many observed values are needed for each coefficient of a polynomial, so
// that noise is smoothed.
constexpr Eigen::Index kValuesPerMonomial = 4;
// An affine function amplifies noise least, so fewer values are enough. If it
// needed as many, specimens with few points would seem to have no strain.  With
// two values for each coefficient, as many residuals as coefficients are left,
// which tell the size of the noise.
constexpr Eigen::Index kValuesPerAffineMonomial = 2;
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

double MedianOf(const Eigen::ArrayXd& values) {
  return Median(std::vector<double>(values.begin(), values.end()));
}

// Displacements of components that were observed at the same places: positions,
// dimension x n, and values, n x num_components.
struct Observed {
  std::vector<int> components;
  Eigen::MatrixXd positions;
  Eigen::MatrixXd values;
};

// Returns where a component was observed, or a sample of it: numbers of nodes,
// and the number of nodes plus those of points.
std::vector<Eigen::Index> ObservedPlaces(const Mesh& mesh,
                                         const LoadCase& load_case,
                                         int component) {
  std::vector<Eigen::Index> places;
  for (Eigen::Index node = 0;
       load_case.displacement.size() != 0 && node < mesh.NumNodes(); ++node) {
    if (IsObserved(load_case, component, node)) {
      places.push_back(node);
    }
  }
  for (Eigen::Index i = 0; i < load_case.points.displacement.cols(); ++i) {
    if (!std::isnan(load_case.points.displacement(component, i))) {
      places.push_back(mesh.NumNodes() + i);
    }
  }
  const std::size_t stride =
      std::max<std::size_t>(1, places.size() / kMostPoints);
  std::size_t count = 0;
  for (std::size_t i = 0; i < places.size(); i += stride) {
    places[count++] = places[i];
  }
  places.resize(count);
  return places;
}

// Returns the observations, of components together whose places are alike, so
// that what depends on places only is computed once.
std::vector<Observed> ObservedValues(const Mesh& mesh,
                                     const LoadCase& load_case,
                                     const Eigen::MatrixXd& points) {
  std::map<std::vector<Eigen::Index>, std::vector<int>> components;
  for (int i = 0; i < mesh.Dimension(); ++i) {
    components[ObservedPlaces(mesh, load_case, i)].push_back(i);
  }
  std::vector<Observed> all;
  for (const auto& [places, alike] : components) {
    const auto count = Eigen::Index(places.size());
    Observed observed = {alike, Eigen::MatrixXd(mesh.Dimension(), count),
                         Eigen::MatrixXd(count, Eigen::Index(alike.size()))};
    for (Eigen::Index i = 0; i < count; ++i) {
      const bool is_node = places[i] < mesh.NumNodes();
      const Eigen::Index at = places[i] - (is_node ? 0 : mesh.NumNodes());
      observed.positions.col(i) = is_node ? mesh.nodes.col(at) : points.col(at);
      observed.values.row(i) =
          (is_node ? load_case.displacement : load_case.points.displacement)(
              alike, at);
    }
    all.push_back(std::move(observed));
  }
  return all;
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

// Returns the product of the powers of the coordinates.
Eigen::ArrayXd Powers(const Eigen::MatrixXd& x,
                      const Eigen::Array3i& exponents) {
  Eigen::ArrayXd product = Eigen::ArrayXd::Ones(x.cols());
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    for (int power = 0; power < exponents(i); ++power) {
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

// Returns the monomials of the coordinates at these positions, num_positions x
// num_monomials.
Eigen::MatrixXd MonomialsAt(const Frame& frame,
                            const std::vector<Eigen::Array3i>& exponents,
                            const Eigen::MatrixXd& positions) {
  const Eigen::MatrixXd x = frame.Coordinates(positions);
  Eigen::MatrixXd monomials(x.cols(), Eigen::Index(exponents.size()));
  for (Eigen::Index m = 0; m < monomials.cols(); ++m) {
    monomials.col(m) = Powers(x, exponents[m]);
  }
  return monomials;
}

// Returns the derivatives of the monomials by coordinate `j`, num_positions x
// num_monomials.
Eigen::MatrixXd SlopesAt(const Frame& frame,
                         const std::vector<Eigen::Array3i>& exponents,
                         Eigen::Index j, const Eigen::MatrixXd& positions) {
  const Eigen::MatrixXd x = frame.Coordinates(positions);
  Eigen::MatrixXd slopes =
      Eigen::MatrixXd::Zero(x.cols(), Eigen::Index(exponents.size()));
  for (Eigen::Index m = 0; m < slopes.cols(); ++m) {
    Eigen::Array3i lower = exponents[m];
    const int power = lower(j)--;
    if (power > 0) {
      slopes.col(m) = power / frame.scale(j) * Powers(x, lower);
    }
  }
  return slopes;
}

// Returns the monomials that so many values determine; none where the values
// are too few.
std::vector<Eigen::Array3i> MonomialsFor(Eigen::Index num_values,
                                         Eigen::Index dimension) {
  for (int degree = kLargestDegree; degree > 0; --degree) {
    std::vector<Eigen::Array3i> exponents = ExponentsUpTo(degree, dimension);
    const Eigen::Index needed =
        degree == 1 ? kValuesPerAffineMonomial : kValuesPerMonomial;
    if (needed * Eigen::Index(exponents.size()) <= num_values) {
      return exponents;
    }
  }
  return {};
}

// The gradients of the polynomials of least squares.
struct Gradients {
  // Dimension x num_points for each component; none where there are too few
  // values.
  std::vector<Eigen::MatrixXd> of_components;
  // What noise adds to the products of slopes along each pair of coordinates:
  // averaged over the points and summed over the components.
  Eigen::MatrixXd noise;
};

// Returns the covariance of coefficients of least squares for noise of variance
// 1.  Dependent monomials have coefficients of zero, and their rows and columns
// are zero.
Eigen::MatrixXd CovarianceOf(const Eigen::MatrixXd& coefficients,
                             const Eigen::MatrixXd& monomials) {
  std::vector<Eigen::Index> independent;
  for (Eigen::Index m = 0; m < monomials.cols(); ++m) {
    if (!coefficients.row(m).isZero(0)) {
      independent.push_back(m);
    }
  }
  Eigen::MatrixXd covariance =
      Eigen::MatrixXd::Zero(monomials.cols(), monomials.cols());
  if (independent.empty()) {
    return covariance;  // All displacements are zero.
  }
  const Eigen::MatrixXd columns = monomials(Eigen::all, independent);
  covariance(independent, independent) = Inverse(columns.transpose() * columns);
  return covariance;
}

// Returns the mean over all points of the products of slopes along each pair of
// coordinates that noise of variance 1 makes.
Eigen::MatrixXd MeanProducts(const std::vector<Eigen::MatrixXd>& slopes,
                             const Eigen::MatrixXd& covariance) {
  const auto dimension = Eigen::Index(slopes.size());
  Eigen::MatrixXd products(dimension, dimension);
  for (Eigen::Index j = 0; j < dimension; ++j) {
    const Eigen::MatrixXd weighted = slopes[j] * covariance;
    for (Eigen::Index k = 0; k < dimension; ++k) {
      products(j, k) = weighted.cwiseProduct(slopes[k]).sum() /
                       static_cast<double>(weighted.rows());
    }
  }
  return products;
}

Gradients GradientsAt(const Frame& frame, const Observed& observed,
                      const Eigen::MatrixXd& points) {
  const Eigen::Index dimension = points.rows();
  const Eigen::Index num_values = observed.values.rows();
  const std::vector<Eigen::Array3i> exponents =
      MonomialsFor(num_values, dimension);
  if (exponents.empty()) {
    return {};
  }
  const Eigen::MatrixXd monomials =
      MonomialsAt(frame, exponents, observed.positions);
  const Eigen::MatrixXd coefficients =
      SolveLeastSquares(monomials, observed.values, kDependent);
  std::vector<Eigen::MatrixXd> slopes;
  Gradients gradients;
  gradients.of_components.assign(
      observed.components.size(),
      Eigen::MatrixXd::Zero(dimension, points.cols()));
  for (Eigen::Index j = 0; j < dimension; ++j) {
    slopes.push_back(SlopesAt(frame, exponents, j, points));
    for (std::size_t i = 0; i < gradients.of_components.size(); ++i) {
      gradients.of_components[i].row(j) =
          (slopes[j] * coefficients.col(Eigen::Index(i))).transpose();
    }
  }
  const double noise =
      (observed.values - monomials * coefficients).squaredNorm() /
      static_cast<double>(num_values - monomials.cols());
  gradients.noise =
      noise * MeanProducts(slopes, CovarianceOf(coefficients, monomials));
  return gradients;
}

// Returns the values minus those of the affine function of least squares.
Eigen::MatrixXd WithoutAffinePart(const Frame& frame,
                                  const Observed& observed) {
  Eigen::MatrixXd affine(observed.values.rows(), observed.positions.rows() + 1);
  affine << Eigen::VectorXd::Ones(observed.values.rows()),
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

// Tells which values disagree with the values of their neighbours by far more
// than these do among themselves, as in the normalised median test of
// Westerweel & Scarano (Exp. Fluids 39 (2005) 1096).
Eigen::Array<bool, Eigen::Dynamic, 1> AreStray(
    const Eigen::VectorXd& values,
    const std::vector<std::vector<Eigen::Index>>& neighbours) {
  Eigen::ArrayXd difference(values.size());
  Eigen::ArrayXd spread(values.size());
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    const Eigen::VectorXd around = values(neighbours[i]);
    const double middle = MedianOf(around);
    difference(i) = std::abs(values(i) - middle);
    spread(i) = MedianOf((around.array() - middle).abs());
  }
  return difference > kStray * (spread + MedianOf(difference));
}

// Leaves out places with a gross error in a component, which would bend the
// polynomials.  A deformation, however local, is one of several neighbours.
Observed WithoutStrayValues(const Frame& frame, const Observed& observed) {
  const Eigen::Index num_places = observed.values.rows();
  if (num_places <= kNeighbours * observed.positions.rows()) {
    return observed;
  }
  const Eigen::MatrixXd rest = WithoutAffinePart(frame, observed);
  const auto neighbours = NeighboursOf(observed.positions);
  Eigen::Array<bool, Eigen::Dynamic, 1> is_stray =
      AreStray(rest.col(0), neighbours);
  for (Eigen::Index i = 1; i < rest.cols(); ++i) {
    is_stray = is_stray || AreStray(rest.col(i), neighbours);
  }
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < num_places; ++i) {
    if (!is_stray(i)) {
      kept.push_back(i);
    }
  }
  return {observed.components, observed.positions(Eigen::all, kept),
          observed.values(kept, Eigen::all)};
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

// How the observed places extend.
struct LeastDirection {
  // The direction along which they extend least.
  Eigen::Vector3d normal;
  // Whether they lie in a plane, and the body is thin along its normal.  The
  // inside of a block that is seen from above may do something else than its
  // face.
  bool is_of_thin_plane;
};

LeastDirection LeastDirectionOf(const std::vector<Observed>& all,
                                const Mesh& mesh) {
  constexpr double kFlat = 1e-4;  // Of the largest extent.
  constexpr double kThin = 0.15;  // Of the longer extent of the places.
  Eigen::Index count = 0;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Observed& observed : all) {
    count += observed.positions.cols();
    middle += observed.positions.rowwise().sum();
  }
  middle /= static_cast<double>(count);
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const Observed& observed : all) {
    const Eigen::MatrixXd arms = observed.positions.colwise() - middle;
    squares += arms * arms.transpose();
  }
  const SymmetricEigenDecomposition axes = DecomposeSymmetric(squares);
  const Eigen::Vector3d normal = axes.vectors.col(0);
  const auto extent_along = [](const Eigen::Vector3d& direction,
                               const Eigen::MatrixXd& places) {
    const Eigen::VectorXd at = places.transpose() * direction;
    return at.maxCoeff() - at.minCoeff();
  };
  double longest = 0;
  for (const Observed& observed : all) {
    longest = std::max(longest,
                       extent_along(axes.vectors.col(2), observed.positions));
  }
  return {normal, axes.values(0) < kFlat * kFlat * axes.values(2) &&
                      extent_along(normal, mesh.nodes) < kThin * longest};
}

// Takes the normal to stay a unit normal of the deformed plane.
Eigen::MatrixXd WithNormal(const Eigen::Vector3d& normal,
                           const Eigen::MatrixXd& f) {
  const Eigen::Vector3d first = normal.unitOrthogonal();
  const Eigen::Vector3d second = normal.cross(first);
  const Eigen::Vector3d deformed =
      Eigen::Vector3d(f * first).cross(Eigen::Vector3d(f * second));
  return f + (deformed.normalized() - f * normal) * normal.transpose();
}

// Completes the gradients along the direction in which the places extend least,
// where the places say nothing about this direction, or no more than noise
// would.
void CompleteAlongNormal(const LeastDirection& least,
                         const Eigen::Matrix3d& noise,
                         std::vector<Eigen::MatrixXd>& gradients) {
  constexpr double kSignificant = 3;  // Standard deviations.
  std::vector<Eigen::MatrixXd> completed;
  double square_sum = 0;
  for (const Eigen::MatrixXd& f : gradients) {
    completed.push_back(WithNormal(least.normal, f));
    square_sum += ((f - completed.back()) * least.normal).squaredNorm();
  }
  const double of_noise = least.normal.dot(noise * least.normal);
  if (least.is_of_thin_plane ||
      square_sum < kSignificant * kSignificant * of_noise *
                       static_cast<double>(gradients.size())) {
    gradients = completed;
  }
}

// Returns F at points of the volume; empty where too little was observed.
std::vector<Eigen::MatrixXd> DeformationGradients(const Scene& scene,
                                                  const LoadCase& load_case) {
  const int dimension = scene.mesh.Dimension();
  const Frame frame(scene.mesh);
  const Eigen::MatrixXd points =
      load_case.points.points.Size() == 0
          ? Eigen::MatrixXd(dimension, 0)
          : Interpolate(scene.mesh, load_case.points.points, scene.mesh.nodes);
  std::vector<Eigen::MatrixXd> gradients;
  Eigen::MatrixXd noise = Eigen::MatrixXd::Zero(dimension, dimension);
  Eigen::MatrixXd at;
  const std::vector<Observed> observed_values =
      ObservedValues(scene.mesh, load_case, points);
  for (const Observed& all : observed_values) {
    const Observed observed = WithoutStrayValues(frame, all);
    if (at.size() == 0) {
      at = PointsOfTheVolume(scene, load_case, points, observed);
      gradients.assign(static_cast<std::size_t>(at.cols()),
                       Eigen::MatrixXd::Identity(dimension, dimension));
    }
    const Gradients own = GradientsAt(frame, observed, at);
    if (own.of_components.empty()) {
      return {};
    }
    for (std::size_t c = 0; c < own.of_components.size(); ++c) {
      for (Eigen::Index i = 0; i < at.cols(); ++i) {
        gradients[i].row(observed.components[c]) +=
            own.of_components[c].col(i).transpose();
      }
    }
    noise += own.noise;
  }
  if (dimension == 3) {
    CompleteAlongNormal(LeastDirectionOf(observed_values, scene.mesh), noise,
                        gradients);
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
