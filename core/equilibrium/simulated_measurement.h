#ifndef ELASTIMATE_CORE_EQUILIBRIUM_SIMULATED_MEASUREMENT_H_
#define ELASTIMATE_CORE_EQUILIBRIUM_SIMULATED_MEASUREMENT_H_

#include <Eigen/Core>
#include <random>
#include <vector>

#include "elastimate/core/laws/elasticity.h"
#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// How the components of noise are distributed, each independently.
enum class NoiseLaw {
  kUniform,   ///< Uniform around zero, as in Becker & Teschner 2007.
  kGaussian,  ///< Normal.
};

/// Measures every load case without noise, in a scene that is of this one
/// material.  Throws as DisplacementsAt does.  One factorisation for each set
/// of held degrees of freedom.
void Measure(const IsotropicElasticity& elasticity, Scene& scene);

/// Measures as above with the materials of the scene, whose parameters stand
/// one behind the other (MaterialParameters).
void MeasureMaterials(const Eigen::VectorXd& parameters, Scene& scene);

/// Measures as above with quadratic tetrahedra on the mesh of linear ones
/// (QuadraticScene), and keeps the displacements of the vertices.
void MeasureInFinerWorld(const IsotropicElasticity& elasticity, Scene& scene);

/// Draws independent noise of mean zero, scaled to exactly this norm.
[[nodiscard]] Eigen::VectorXd DrawNoise(NoiseLaw law, Eigen::Index size,
                                        double norm,
                                        std::mt19937_64& generator);

/// Draws Gaussian noise of mean zero and this standard deviation in each
/// component at each of n positions (dimension x n), independent of the other
/// components: dimension x n.
///
/// With a correlation length X > 0 it is smooth: white noise on a lattice of
/// spacing X / 2, convolved with the kernel exp(-r^2 / X^2) and divided by the
/// root of the sum of the squared weights at each position.  That has the
/// correlation rho(d) = exp(-d^2 / (2 X^2)) at a distance d, to within 1e-5,
/// wherever the positions are.  With X = 0 it is independent at each position.
///
/// Throws std::invalid_argument, beginning with "correlation_length", where the
/// positions extend over so many lengths X (in the plane about 2000) that the
/// lattice would have more than 2e7 points.  O(n), with 17^dimension lattice
/// points for each position, and O(number of lattice points).
[[nodiscard]] Eigen::MatrixXd DrawNoiseAt(const Eigen::MatrixXd& positions,
                                          double standard_deviation,
                                          double correlation_length,
                                          std::mt19937_64& generator);

/// Draws gross errors for `share` of `candidates` (to the nearest number),
/// which are columns of dimension x n; all other columns are zero.  Each error
/// has a direction of its own, and a length of 20 to 100 standard deviations,
/// drawn uniformly.
[[nodiscard]] Eigen::MatrixXd DrawOutliers(std::vector<Eigen::Index> candidates,
                                           double share,
                                           double standard_deviation,
                                           int dimension, Eigen::Index n,
                                           std::mt19937_64& generator);

/// The errors that a measurement adds to the displacement; none by default.
struct MeasurementErrors {
  /// The norm of the noise over the norm of the displacement.
  double relative_noise = 0;
  NoiseLaw law = NoiseLaw::kUniform;
  /// The standard deviation of Gaussian noise [length], which replaces relative
  /// noise, and the length over which that noise is alike (DrawNoiseAt).
  double noise_sd = 0;
  double correlation_length = 0;
  /// The share of the points with gross errors (DrawOutliers), whose size is
  /// counted in standard deviations of the noise.  For relative noise that is
  /// its norm over the root of the number of components.
  double outliers = 0;
  /// The rigid motion of the camera or of the whole specimen: the translation,
  /// then the angle or rotation vector [rad] about the origin (MovedRigidly).
  /// Empty for none.
  Eigen::VectorXd rigid_motion;
};

/// Adds the errors to displacements at some positions, both dimension x n.
/// Held components (dimension x n) get no noise, and points with a held
/// component no gross error.  The rigid motion moves all points, before noise
/// and then outliers are added.  The noise is drawn first.  Throws as
/// DrawNoiseAt does.
void AddErrors(const MeasurementErrors& errors,
               const Eigen::MatrixXd& positions, const ComponentMask& held,
               std::mt19937_64& generator, Eigen::MatrixXd& displacement);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_EQUILIBRIUM_SIMULATED_MEASUREMENT_H_
