#include "elastimate/estimators/misfit/axis_rotation.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/algebra/node_sums.h"
#include "elastimate/core/mechanics/internal_forces.h"
#include "elastimate/estimators/interface/statistics.h"

namespace elastimate {
namespace {

// The rotation by an angle about axis `about` of the scene, in the plane about
// its normal.
Eigen::MatrixXd Rotation(Eigen::Index dimension, Eigen::Index about,
                         double angle) {
  if (dimension == 2) {
    return Eigen::Rotation2Dd(angle).toRotationMatrix();
  }
  return Eigen::AngleAxisd(angle, Eigen::Vector3d::Unit(about))
      .toRotationMatrix();
}

// A rotation of the axes of one material.
struct TurnedMaterial {
  std::size_t material;
  Eigen::Index about;
};

std::vector<TurnedMaterial> AllRotations(const Scene& scene) {
  std::vector<TurnedMaterial> all;
  const Eigen::Index num_rotations = scene.mesh.Dimension() == 3 ? 3 : 1;
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    for (Eigen::Index about = 0;
         about < num_rotations && !scene.materials[i].axes.empty(); ++about) {
      all.push_back({i, about});
    }
  }
  return all;
}

// f of these displacements where the axes of a material are turned.
Eigen::MatrixXd TurnedForces(const Scene& scene, const TurnedMaterial& turned,
                             double angle, const Eigen::VectorXd& moduli,
                             const Eigen::MatrixXd& displacement) {
  std::vector<Material> materials = scene.materials;
  for (Eigen::MatrixXd& axis : materials[turned.material].axes) {
    axis = Rotation(scene.mesh.Dimension(), turned.about, angle) * axis;
  }
  return InternalForces(scene.mesh, materials).Multiply(moduli, displacement);
}

// d rows / d w.
Eigen::MatrixXd RowsOfRotations(const Scene& scene,
                                const std::vector<TurnedMaterial>& all,
                                const Eigen::VectorXd& x,
                                DisplacementMisfit& misfit) {
  // The slope of a polynomial in cosines and sines is right to 1e-8 with this.
  constexpr double kStep = 1e-4;
  const Eigen::VectorXd moduli = misfit.Free().ModuliAt(x);
  const Eigen::MatrixXd& displacement = misfit.Model().Displacement();
  Eigen::MatrixXd rows(misfit.NumRows(), Eigen::Index(all.size()));
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Eigen::MatrixXd change =
        (TurnedForces(scene, all[i], kStep, moduli, displacement) -
         TurnedForces(scene, all[i], -kStep, moduli, displacement)) /
        (2 * kStep);
    rows.col(Eigen::Index(i)) =
        misfit.Observed().Restrict(-misfit.Model().SolveFor(change));
  }
  return rows;
}

// The pseudoinverse of the information about rotations, of which those that the
// variables make up for, or that change nothing, have none.
Eigen::MatrixXd InverseOfDetermined(const Eigen::MatrixXd& information,
                                    const Eigen::MatrixXd& of_rotations_alone,
                                    Eigen::Index& num_rotations) {
  constexpr double kNothing = 1e-6;
  const double scale = of_rotations_alone.diagonal().maxCoeff();
  const SymmetricEigenDecomposition modes = DecomposeSymmetric(information);
  Eigen::VectorXd inverse = Eigen::VectorXd::Zero(modes.values.size());
  num_rotations = 0;
  for (Eigen::Index i = 0; i < inverse.size(); ++i) {
    if (modes.values(i) > kNothing * scale) {
      inverse(i) = 1 / modes.values(i);
      ++num_rotations;
    }
  }
  return modes.vectors * inverse.asDiagonal() * modes.vectors.transpose();
}

}  // namespace

double AxisRotation::BeyondChance() const {
  const double explained = 3 * static_cast<double>(num_rotations);
  return chi_square > explained ? 1 - explained / chi_square : 0;
}

double AxisRotation::Probability() const {
  return ChiSquaredProbability(static_cast<double>(num_rotations),
                               std::max(chi_square, 0.0));
}

std::optional<AxisRotation> FindAxisRotation(
    const Scene& scene, const Eigen::VectorXd& x, const Eigen::VectorXd& rows,
    const Eigen::MatrixXd& sensitivities, const Eigen::MatrixXd& inverse,
    const std::optional<double>& given_variance, DisplacementMisfit& misfit) {
  const std::vector<TurnedMaterial> all = AllRotations(scene);
  if (all.empty() || misfit.HasLargeStrains() || misfit.NumAmounts() > 0 ||
      !misfit.Factorize(x)) {
    return std::nullopt;
  }
  const Eigen::MatrixXd of_rotations = RowsOfRotations(scene, all, x, misfit);
  const Eigen::MatrixXd change =
      -inverse * InnerProducts(sensitivities, of_rotations);
  const Eigen::MatrixXd free = of_rotations + sensitivities * change;
  AxisRotation found;
  const Eigen::MatrixXd covariance = InverseOfDetermined(
      InnerProducts(free, free), InnerProducts(of_rotations, of_rotations),
      found.num_rotations);
  if (found.num_rotations == 0) {
    return std::nullopt;
  }
  const Eigen::VectorXd gradient = InnerProducts(free, rows);
  const Eigen::VectorXd rotations = -covariance * gradient;
  const double gain = -gradient.dot(rotations);
  const auto redundancy = static_cast<double>(std::max<Eigen::Index>(
      rows.size() - sensitivities.cols() - found.num_rotations, 1));
  const double variance = given_variance.value_or(
      std::max(SquaredNorm(rows) - gain, 0.0) / redundancy);
  found.chi_square = variance > 0 ? gain / variance : 0;
  found.change = change * rotations;
  double least_likely = -1;
  const Eigen::Index of_one = scene.mesh.Dimension() == 3 ? 3 : 1;
  for (Eigen::Index first = 0; first < rotations.size(); first += of_one) {
    const double of_material =
        (free.middleCols(first, of_one) * rotations.segment(first, of_one))
            .squaredNorm();
    if (of_material > least_likely) {
      least_likely = of_material;
      found.angle = rotations.segment(first, of_one).norm();
      found.material = all[std::size_t(first)].material;
    }
  }
  return found;
}

}  // namespace elastimate
