#include "elastimate/estimators/material_fit/law_choice.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/algebra/node_sums.h"
#include "elastimate/core/materials/anisotropic_law.h"
#include "elastimate/core/materials/free_axis_law.h"
#include "elastimate/core/materials/isotropic_law.h"
#include "elastimate/core/materials/kelvin_law.h"
#include "elastimate/core/materials/material_frames.h"
#include "elastimate/core/materials/material_parameters.h"
#include "elastimate/core/materials/orthotropic_law.h"
#include "elastimate/core/materials/stiffness_factors.h"
#include "elastimate/core/materials/transversely_isotropic_law.h"
#include "elastimate/core/scene/observed_displacements.h"
#include "elastimate/core/scene/unknown_motion.h"
#include "elastimate/estimators/interface/axis_estimate.h"
#include "elastimate/estimators/interface/finding_sentences.h"
#include "elastimate/estimators/interface/free_parameters.h"
#include "elastimate/estimators/material_fit/material_fit.h"
#include "elastimate/estimators/material_fit/outliers.h"
#include "elastimate/estimators/misfit/displacement_misfit.h"

namespace elastimate {
namespace {

// Returns the W of W^T W = C^-1, where what is less certain than the rest of a
// covariance by rounding counts as known to that.
Eigen::MatrixXd WeightsOf(const Eigen::MatrixXd& covariance) {
  constexpr double kRounding = 1e-12;
  const SymmetricEigenDecomposition modes = DecomposeSymmetric(covariance);
  const Eigen::VectorXd variances =
      modes.values.cwiseMax(kRounding * modes.values.maxCoeff());
  return variances.cwiseSqrt().cwiseInverse().asDiagonal() *
         modes.vectors.transpose();
}

constexpr SectionModel kSolid = SectionModel::kSolid;
constexpr Eigen::Index kNumStiffnesses = 21;

// The stiffnesses of all materials in a fit of no symmetry, with W of their
// covariance, W^T W = C^-1.
struct MeasuredStiffness {
  Eigen::VectorXd stiffnesses;
  Eigen::MatrixXd weights;
};

// Makes each material of the scene, which has some, one of this law.
std::vector<Material> MaterialsOf(std::string_view law, std::size_t num_axes,
                                  const std::vector<Material>& materials) {
  std::vector<Material> of_law;
  for (const Material& material : materials) {
    of_law.push_back({std::string(law), material.regions, {}, {}});
    if (num_axes > 0 && material.axes.size() == num_axes) {
      of_law.back().axes = material.axes;
    }
  }
  return of_law;
}

// The laws that are compared, of the fewest parameters first.
std::vector<std::vector<Material>> Candidates(
    const std::vector<Material>& materials) {
  std::vector<Material> transverse =
      MaterialsOf(TransverselyIsotropicLaw::kName, 1, materials);
  for (Material& material : transverse) {
    if (material.axes.empty()) {
      material.law = FreeAxisLaw::kName;
    }
  }
  std::vector<std::vector<Material>> candidates = {
      MaterialsOf(IsotropicLaw::kName, 0, materials), transverse};
  const bool have_two_axes = std::all_of(
      materials.begin(), materials.end(),
      [](const Material& material) { return material.axes.size() == 2; });
  if (have_two_axes) {
    candidates.push_back(MaterialsOf(OrthotropicLaw::kName, 2, materials));
  }
  candidates.push_back(MaterialsOf(AnisotropicLaw::kName, 0, materials));
  return candidates;
}

// The stiffnesses of unit moduli of a law whose directions are the columns of
// the frame, in that of the scene: 21 x num_moduli.
Eigen::MatrixXd UnitsInScene(const Law& law, const Eigen::Matrix3d& frame) {
  Eigen::MatrixXd turn(9, 9);  // Of Q X Q^T from X, by columns.
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 3; ++j) {
      turn.block<3, 3>(3 * i, 3 * j) = frame(i, j) * frame;
    }
  }
  Eigen::MatrixXd units(kNumStiffnesses, law.NumModuli());
  for (int k = 0; k < law.NumModuli(); ++k) {
    const Eigen::MatrixXd stiffness =
        VoigtStiffness(turn *
                       law.Tangent(Eigen::VectorXd::Unit(law.NumModuli(), k),
                                   Eigen::MatrixXd::Zero(3, 3), kSolid) *
                       turn.transpose());
    Eigen::Index place = 0;
    for (Eigen::Index i = 0; i < 6; ++i) {
      for (Eigen::Index j = i; j < 6; ++j) {
        units(place++, k) = stiffness(i, j);
      }
    }
  }
  return units;
}

// Returns the units of all moduli of all materials.
Eigen::MatrixXd UnitsInScene(const std::vector<Material>& materials) {
  const MaterialParameters all(materials, kSolid);
  const MaterialFrames frames(materials, 3);
  Eigen::MatrixXd units = Eigen::MatrixXd::Zero(
      kNumStiffnesses * Eigen::Index(materials.size()), all.NumModuli());
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const Law& law = all.LawOf(i);
    units.block(kNumStiffnesses * Eigen::Index(i), all.FirstModulus(i),
                kNumStiffnesses, law.NumModuli()) =
        UnitsInScene(law, frames.Of<3>(int(i), 0));
  }
  return units;
}

bool ArePositiveDefinite(const Eigen::VectorXd& stiffnesses) {
  const AnisotropicLaw law;
  for (Eigen::Index first = 0; first < stiffnesses.size();
       first += kNumStiffnesses) {
    if (!IsStiffnessPositiveDefinite(
            law, stiffnesses.segment(first, kNumStiffnesses), kSolid)) {
      return false;
    }
  }
  return true;
}

// The least chi^2 of laws with free axes, from the nearest of each material on,
// by Gauss-Newton steps of all together.
double ChiSquareOfFreeAxes(const std::vector<Material>& materials,
                           const Eigen::MatrixXd& units,
                           const MeasuredStiffness& measured) {
  constexpr int kSteps = 30;
  constexpr int kHalvings = 8;
  const MaterialParameters all(materials, kSolid);
  const Eigen::MatrixXd weighted = measured.weights * units;
  const Eigen::VectorXd expected = measured.weights * measured.stiffnesses;
  const Eigen::MatrixXd covariance =
      Inverse(measured.weights.transpose() * measured.weights);
  Eigen::VectorXd p(all.NumParameters());
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const Eigen::Index first = kNumStiffnesses * Eigen::Index(i);
    const Eigen::VectorXd own =
        measured.stiffnesses.segment(first, kNumStiffnesses);
    const Eigen::MatrixXd weights = WeightsOf(
        covariance.block(first, first, kNumStiffnesses, kNumStiffnesses));
    const Law& law = all.LawOf(i);
    const Eigen::MatrixXd of_law = units.block(
        first, all.FirstModulus(i), kNumStiffnesses, law.NumModuli());
    p.segment(all.FirstParameter(i), Eigen::Index(law.Parameters().size())) =
        law.Name() == FreeAxisLaw::kName
            ? FreeAxisLaw().NearestParameters(own, weights)
            : law.ParametersOf(
                  SolveLeastSquares(weights * of_law, weights * own), kSolid);
  }
  const auto residual = [&](const Eigen::VectorXd& parameters) {
    return Eigen::VectorXd(expected - weighted * all.Moduli(parameters));
  };
  if (!p.allFinite()) {
    return std::numeric_limits<double>::infinity();
  }
  for (int i = 0; i < kSteps; ++i) {
    const Eigen::VectorXd r = residual(p);
    Eigen::VectorXd step =
        SolveLeastSquares(weighted * all.ModuliJacobian(p), r);
    int halvings = 0;
    while (!(residual(p + step).squaredNorm() < r.squaredNorm()) &&
           halvings++ < kHalvings) {
      step /= 2;
    }
    if (halvings > kHalvings) {
      break;
    }
    p += step;
  }
  return ArePositiveDefinite(units * all.Moduli(p))
             ? residual(p).squaredNorm()
             : std::numeric_limits<double>::infinity();
}

// Infinite where the nearest stiffness of these laws is not positive definite.
double ChiSquareOf(const std::vector<Material>& materials,
                   const MeasuredStiffness& measured) {
  const Eigen::MatrixXd units = UnitsInScene(materials);
  if (HasFreeAxis(materials)) {
    return ChiSquareOfFreeAxes(materials, units, measured);
  }
  const Eigen::VectorXd expected = measured.weights * measured.stiffnesses;
  const Eigen::MatrixXd weighted = measured.weights * units;
  const Eigen::VectorXd moduli = SolveLeastSquares(weighted, expected);
  return ArePositiveDefinite(units * moduli)
             ? (weighted * moduli - expected).squaredNorm()
             : std::numeric_limits<double>::infinity();
}

bool HasGivenNoise(const Scene& scene) {
  return ObservedDisplacements(scene).GivenNoise().has_value();
}

// Gives each load case the noise that the fit leaves of it.
Scene WithNoiseOfCases(const Scene& scene, const MaterialFit& fit) {
  Scene whitened = WithoutOutliers(scene, fit.estimate.outliers);
  const ObservedDisplacements observed(whitened);
  const auto num_fitted = static_cast<double>(
      MaterialParameters(scene.materials, kSolid).Free().size());
  const double share = std::max(1 - num_fitted / double(observed.Size()), 1e-3);
  for (Eigen::Index k = 0; k < observed.NumLoadCases(); ++k) {
    const Eigen::Index first = observed.CaseStart(k);
    const Eigen::Index count = observed.CaseStart(k + 1) - first;
    if (count > 0) {
      const double mean_square =
          SquaredNorm(fit.errors.residual.segment(first, count)) /
          double(count) / share;
      whitened.load_cases[k].noise_sd =
          std::max(std::sqrt(mean_square), kLeastNoise) * observed.Norm();
    }
  }
  return whitened;
}

// The noise counts as this part of the displacements at least: rounding, and
// where the descent ends, are no noise.
Eigen::MatrixXd CovarianceOf(const MaterialFit& fit, const Scene& scene,
                             const EstimatorOptions& options) {
  constexpr double kLeastPart = 1e-5;
  const FreeParameters free(scene, options);
  const Eigen::MatrixXd jacobian = free.ModuliJacobian(fit.errors.corrected);
  const ObservedDisplacements observed(scene);
  const double part = std::sqrt(fit.errors.variance * double(observed.Size())) /
                      Norm(observed.MeasuredWithoutTurn());
  const double factor = std::max(1.0, kLeastPart / part);
  return factor * factor * jacobian * fit.errors.total * jacobian.transpose();
}

}  // namespace

std::string WhyNoLawChoice(const Scene& scene,
                           const EstimatorOptions& options) {
  if (scene.mesh.section.model != kSolid) {
    return "laws can be compared in three dimensions only; name one by "
           "--material";
  }
  if (options.known_poisson_ratio || options.youngs_modulus.AreGiven() ||
      options.poisson_ratio.AreGiven() || options.loss != Loss::kNone) {
    return "laws are compared without a loss function and without known values "
           "or bounds of E and nu; leave these out, or name a law by "
           "--material";
  }
  for (const Material& material : scene.materials) {
    if (!material.known.empty() || !material.bounds.empty()) {
      return "laws are compared for materials without known parameters or "
             "bounds only; leave these out, or name a law by --material";
    }
    for (const Eigen::MatrixXd& axis : material.axes) {
      if (axis.cols() != 1) {
        return "laws are compared for axes that are the same in all elements "
               "only; give one direction, or name a law by --material";
      }
    }
  }
  return "";
}

ChosenLaw ChooseLaw(const Scene& scene, const EstimatorOptions& options) {
  ChosenLaw choice;
  choice.materials = scene.materials;
  const std::vector<Material> materials =
      scene.materials.empty() ? std::vector<Material>(1) : scene.materials;
  Scene any = scene;
  any.materials = MaterialsOf(AnisotropicLaw::kName, 0, materials);
  const Descent descent = HasUnknownMotion(scene) || HasSupportsOfCases(scene)
                              ? Descent::kFull
                              : Descent::kReduced;
  MaterialFit fit = FitMaterialsFrom(std::nullopt, any, options, descent);
  choice.work = fit.estimate.work;
  if (fit.errors.total.size() != 0 && scene.load_cases.size() > 1 &&
      !HasGivenNoise(scene)) {
    any = WithNoiseOfCases(any, fit);
    fit = FitMaterialsFrom(fit.Variables(), any, options, descent);
    choice.work = choice.work + fit.estimate.work;
  }
  if (fit.errors.total.size() == 0 || !fit.errors.corrected.allFinite()) {
    choice.why_not = fit.estimate.message;
    return choice;
  }
  const Eigen::MatrixXd covariance = CovarianceOf(fit, any, options);
  if (!covariance.allFinite()) {
    choice.why_not = "the errors of the fit are not known";
    return choice;
  }
  const MeasuredStiffness measured = {
      FreeParameters(any, options).ModuliAt(fit.errors.corrected),
      WeightsOf(covariance)};
  const double log_size = std::log(double(ObservedDisplacements(any).Size()));
  std::vector<std::pair<LawComparison, std::vector<Material>>> compared;
  for (const std::vector<Material>& candidate : Candidates(materials)) {
    const Eigen::Index num_parameters =
        MaterialParameters(candidate, kSolid).NumParameters();
    const double chi_square = ChiSquareOf(candidate, measured);
    compared.push_back({{candidate[0].law, num_parameters, chi_square,
                         chi_square + double(num_parameters) * log_size},
                        candidate});
  }
  std::stable_sort(compared.begin(), compared.end(),
                   [](const auto& a, const auto& b) {
                     return a.first.criterion < b.first.criterion;
                   });
  choice.materials = compared[0].second;
  const double least = compared[0].first.criterion;
  for (auto& [law, candidate] : compared) {
    law.criterion -= least;
    choice.laws.push_back(law);
  }
  return choice;
}

void EnterLawChoice(const ChosenLaw& choice, Estimate& estimate) {
  // This is twice the logarithm of a ratio of probabilities of 20, which is
  // evidence.
  constexpr double kEvidence = 6;
  estimate.laws = choice.laws;
  estimate.work = estimate.work + choice.work;
  if (choice.laws.size() > 1 && choice.laws[1].criterion < kEvidence) {
    estimate.Add(LawsFitAlike(choice.laws[0].law, choice.laws[1].law,
                              choice.laws[1].criterion));
  }
}

}  // namespace elastimate
