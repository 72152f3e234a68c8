#include "elastimate/core/equilibrium/simulated_measurement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "elastimate/core/algebra/node_sums.h"
#include "elastimate/core/equilibrium/equilibrium.h"
#include "elastimate/core/scene/degrees_of_freedom.h"
#include "elastimate/core/scene/quadratic_scene.h"
#include "elastimate/core/scene/rigid_motion.h"

namespace elastimate {
namespace {

// The length of an outlier in standard deviations of the noise.
constexpr double kSmallestOutlier = 20;
constexpr double kLargestOutlier = 100;

// So many lattice points on either side of a position count; the kernel is
// below 5e-6 beyond.
constexpr int kReach = 8;
constexpr int kStencil = 2 * kReach + 1;
constexpr double kMostLatticePoints = 2e7;

Eigen::MatrixXd DrawGaussian(Eigen::Index rows, Eigen::Index cols,
                             std::mt19937_64& generator) {
  std::normal_distribution<double> gaussian;
  Eigen::MatrixXd values(rows, cols);
  for (double& value : values.reshaped()) {
    value = gaussian(generator);
  }
  return values;
}

// Points around some positions, at a spacing of half of a correlation length,
// between which noise is interpolated by its kernel.
class NoiseLattice {
 public:
  NoiseLattice(const Eigen::MatrixXd& positions, double correlation_length)
      : scaled_((positions.colwise() - positions.rowwise().minCoeff()) *
                (2 / correlation_length)) {
    const Eigen::ArrayXd counts =
        scaled_.rowwise().maxCoeff().array().floor() + kStencil + 1;
    if (!(counts.prod() <= kMostLatticePoints)) {
      std::ostringstream message;
      message << "correlation_length=" << correlation_length
              << " is too short for the extent of what is measured; make it "
                 "longer, or leave it out for independent noise";
      throw std::invalid_argument(message.str());
    }
    for (Eigen::Index axis = 0; axis < counts.size(); ++axis) {
      counts_[axis] = static_cast<Eigen::Index>(counts(axis));
    }
  }

  // Draws noise of one component, of standard deviation 1.
  Eigen::RowVectorXd Draw(std::mt19937_64& generator) const {
    const Eigen::VectorXd white =
        DrawGaussian(counts_[0] * counts_[1] * counts_[2], 1, generator);
    Eigen::RowVectorXd noise(scaled_.cols());
    for (Eigen::Index i = 0; i < noise.size(); ++i) {
      noise(i) = At(white, scaled_.col(i));
    }
    return noise;
  }

 private:
  double At(const Eigen::VectorXd& white,
            const Eigen::Ref<const Eigen::VectorXd>& x) const {
    std::array<Eigen::Index, 3> first = {0, 0, 0};
    std::array<Eigen::VectorXd, 3> weights;
    double squares = 1;
    for (int axis = 0; axis < 3; ++axis) {
      if (axis >= x.size()) {
        weights[axis] = Eigen::VectorXd::Ones(1);
        continue;
      }
      const double cell = std::floor(x(axis));
      first[axis] = static_cast<Eigen::Index>(cell);
      // The distances r from x to the lattice points from `kReach` cells before
      // x on, in cells of X / 2.
      const Eigen::ArrayXd r =
          Eigen::ArrayXd::LinSpaced(kStencil, -kReach, kReach) -
          (x(axis) - cell);
      weights[axis] = (-r.square() / 4).exp();
      squares *= weights[axis].squaredNorm();
    }
    double sum = 0;
    for (Eigen::Index k = 0; k < weights[2].size(); ++k) {
      for (Eigen::Index j = 0; j < weights[1].size(); ++j) {
        const Eigen::Index row =
            counts_[0] * (first[1] + j + counts_[1] * (first[2] + k));
        sum += weights[2](k) * weights[1](j) *
               weights[0].dot(white.segment(row + first[0], kStencil));
      }
    }
    return sum / std::sqrt(squares);
  }

  Eigen::MatrixXd scaled_;  // Positions in units of the spacing.
  std::array<Eigen::Index, 3> counts_ = {1, 1, 1};
};

std::vector<Eigen::Index> FreePoints(const ComponentMask& held) {
  std::vector<Eigen::Index> points;
  for (Eigen::Index point = 0; point < held.cols(); ++point) {
    if (!held.col(point).any()) {
      points.push_back(point);
    }
  }
  return points;
}

// Sets the displacements of all load cases, which stand side by side.
void SetDisplacements(const Eigen::MatrixXd& displacements, Scene& scene) {
  for (std::size_t k = 0; k < scene.load_cases.size(); ++k) {
    scene.load_cases[k].displacement =
        displacements.col(Eigen::Index(k))
            .reshaped(scene.mesh.Dimension(), scene.mesh.NumNodes());
  }
  scene.origin = Origin::kComputed;
}

}  // namespace

void Measure(const IsotropicElasticity& elasticity, Scene& scene) {
  Scene uniform = scene;
  uniform.materials.clear();
  SetDisplacements(DisplacementsAt(uniform, elasticity.Parameters()), scene);
}

void MeasureMaterials(const Eigen::VectorXd& parameters, Scene& scene) {
  SetDisplacements(DisplacementsAt(scene, parameters), scene);
}

void MeasureInFinerWorld(const IsotropicElasticity& elasticity, Scene& scene) {
  Scene quadratic = QuadraticScene(scene);
  Measure(elasticity, quadratic);
  for (std::size_t k = 0; k < scene.load_cases.size(); ++k) {
    scene.load_cases[k].displacement =
        quadratic.load_cases[k].displacement.leftCols(scene.mesh.NumNodes());
  }
  scene.origin = Origin::kMeasured;
}

Eigen::VectorXd DrawNoise(NoiseLaw law, Eigen::Index size, double norm,
                          std::mt19937_64& generator) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::normal_distribution<double> gaussian;
  Eigen::VectorXd noise(size);
  for (double& value : noise) {
    value =
        law == NoiseLaw::kUniform ? uniform(generator) : gaussian(generator);
  }
  return norm / Norm(noise) * noise;
}

Eigen::MatrixXd DrawNoiseAt(const Eigen::MatrixXd& positions,
                            double standard_deviation,
                            double correlation_length,
                            std::mt19937_64& generator) {
  if (!(correlation_length > 0)) {
    return standard_deviation *
           DrawGaussian(positions.rows(), positions.cols(), generator);
  }
  const NoiseLattice lattice(positions, correlation_length);
  Eigen::MatrixXd noise(positions.rows(), positions.cols());
  for (Eigen::Index component = 0; component < noise.rows(); ++component) {
    noise.row(component) = standard_deviation * lattice.Draw(generator);
  }
  return noise;
}

Eigen::MatrixXd DrawOutliers(std::vector<Eigen::Index> candidates, double share,
                             double standard_deviation, int dimension,
                             Eigen::Index n, std::mt19937_64& generator) {
  std::shuffle(candidates.begin(), candidates.end(), generator);
  candidates.resize(std::lround(share * double(candidates.size())));
  std::uniform_real_distribution<double> size(kSmallestOutlier,
                                              kLargestOutlier);
  Eigen::MatrixXd errors = Eigen::MatrixXd::Zero(dimension, n);
  for (const Eigen::Index point : candidates) {
    errors.col(point) = size(generator) * standard_deviation *
                        DrawGaussian(dimension, 1, generator).normalized();
  }
  return errors;
}

void AddErrors(const MeasurementErrors& errors,
               const Eigen::MatrixXd& positions, const ComponentMask& held,
               std::mt19937_64& generator, Eigen::MatrixXd& displacement) {
  const DegreesOfFreedom dofs({held, {}});
  double standard_deviation = errors.noise_sd;
  const double norm =
      errors.relative_noise * Norm(dofs.Restrict(displacement.reshaped()));
  if (errors.rigid_motion.size() > 0) {
    displacement =
        MovedRigidly(positions + displacement, errors.rigid_motion) - positions;
  }
  if (errors.relative_noise > 0) {
    standard_deviation = norm / std::sqrt(double(dofs.NumFree()));
    displacement.reshaped() +=
        dofs.Extend(DrawNoise(errors.law, dofs.NumFree(), norm, generator));
  } else if (errors.noise_sd > 0) {
    const Eigen::MatrixXd noise = DrawNoiseAt(
        positions, errors.noise_sd, errors.correlation_length, generator);
    displacement += (!held).select(noise.array(), 0.0).matrix();
  }
  if (errors.outliers > 0) {
    displacement +=
        DrawOutliers(FreePoints(held), errors.outliers, standard_deviation,
                     int(positions.rows()), positions.cols(), generator);
  }
}

}  // namespace elastimate
