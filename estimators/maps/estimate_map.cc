#include "elastimate/estimators/maps/estimate_map.h"

#include <algorithm>
#include <boost/pending/disjoint_sets.hpp>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "elastimate/core/laws/elasticity.h"
#include "elastimate/core/scene/finer_scene.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/core/text/numbers.h"
#include "elastimate/estimators/interface/finding_sentences.h"
#include "elastimate/estimators/maps/boundary_layer.h"
#include "elastimate/estimators/maps/field_prior.h"
#include "elastimate/estimators/maps/level_fit.h"
#include "elastimate/estimators/maps/map_errors.h"
#include "elastimate/estimators/maps/map_mesh_error.h"
#include "elastimate/estimators/maps/map_problem.h"
#include "elastimate/estimators/maps/region_map.h"
#include "elastimate/estimators/maps/sharpen_map.h"
#include "elastimate/estimators/maps/smooth_map.h"
#include "elastimate/estimators/misfit/displacement_misfit.h"

namespace elastimate {
namespace {

// ln B from which on a body is not homogeneous.
constexpr double kLeastEvidence = 3;
// The number of measurements over that of supported parameters below which the
// data do not tell noise from structure.
constexpr double kLeastRedundancy = 4;
// Structure of a measured body below this standard deviation of ln E may come
// from its mesh.
constexpr double kOfTheMesh = 0.05;
constexpr double kResolved = 3;
// Two moduli differ where ln E does by so many standard deviations.
constexpr double kToldApart = 2;
// The part of an element's modulus that the data tell, V_e / l_e^d, from which
// on smaller elements would show more.
constexpr double kResolvedElements = 0.5;
constexpr double kUsualPoissonRatio = 0.3;
// How far the square sum may be from its mean, in standard deviations.
constexpr double kMostMisfit = 5;
// nu of maps was off by twice what the linearised model says.
constexpr double kWideningOfPoissonRatio = 2;

// Returns the scene of one isotropic material.
Scene OfOneMaterial(Scene scene) {
  scene.materials.clear();
  scene.mesh.regions.resize(0);
  return scene;
}

bool HasAnyForce(const Scene& scene) {
  return !AssembleLoadCases(scene).isZero(0) ||
         std::any_of(scene.load_cases.begin(), scene.load_cases.end(),
                     [](const LoadCase& load_case) {
                       return !load_case.resultants.empty();
                     });
}

// Returns E of the displacements; empty where they oppose the loads.
std::optional<double> ScaleAtStart(const Scene& scene,
                                   const EstimatorOptions& options, double nu) {
  EstimatorOptions of_start;
  of_start.solver = options.solver;
  DisplacementMisfit misfit(scene, of_start);
  const double scale =
      IsotropicElasticity{1, nu}.StiffnessScale(scene.mesh.section.model);
  const std::optional<DisplacementMisfit::ScaleFit> fit =
      misfit.FitScale(Eigen::Vector2d(scale, nu * scale), Loss::kNone);
  return fit ? std::optional<double>(1 / fit->compliance) : std::nullopt;
}

double SpreadOfLog(const Eigen::VectorXd& log_moduli,
                   const Eigen::VectorXd& volumes) {
  const double mean = volumes.dot(log_moduli) / volumes.sum();
  return std::sqrt(volumes.dot((log_moduli.array() - mean).square().matrix()) /
                   volumes.sum());
}

// Returns the volume of the largest connected part of each region.
Eigen::VectorXd LargestParts(const std::vector<int>& region_of_element,
                             Eigen::Index num_regions,
                             const FieldPrior& prior) {
  boost::disjoint_sets_with_storage<> parts(region_of_element.size());
  for (std::size_t e = 0; e < region_of_element.size(); ++e) {
    parts.make_set(e);
  }
  for (const auto& sides : prior.Facets().elements.colwise()) {
    if (sides(1) >= 0 &&
        region_of_element[sides(0)] == region_of_element[sides(1)]) {
      parts.union_set(std::size_t(sides(0)), std::size_t(sides(1)));
    }
  }
  Eigen::VectorXd of_parts = Eigen::VectorXd::Zero(prior.NumElements());
  Eigen::VectorXd largest = Eigen::VectorXd::Zero(num_regions);
  for (std::size_t e = 0; e < region_of_element.size(); ++e) {
    double& volume = of_parts(Eigen::Index(parts.find_set(e)));
    volume += prior.Volumes()(Eigen::Index(e));
    largest(region_of_element[e]) =
        std::max(largest(region_of_element[e]), volume);
  }
  return largest;
}

// Returns the diameter of a disc or a ball.
double DiameterOf(double volume, int dimension) {
  constexpr double kPi = 3.14159265358979323846;
  return dimension == 2 ? std::sqrt(4 * volume / kPi)
                        : std::cbrt(6 * volume / kPi);
}

class MapBuilder {
 public:
  // `linear` has the linear elements that those of `scene` refine, or is null.
  // `trusts_noise` takes the noise that is given.
  MapBuilder(const Scene& scene, const Scene* linear,
             const EstimatorOptions& options, bool trusts_noise)
      : scene_(scene),
        prior_(std::make_unique<FieldPrior>(scene.mesh)),
        model_(scene, options.solver),
        problem_{model_, options.known_poisson_ratio,
                 trusts_noise ? GivenNoise() : std::nullopt} {
    if (linear != nullptr) {
      mesh_error_.emplace(*linear, options.solver, problem_);
    }
  }

  MapEstimate Build(const std::optional<double>& start) {
    map_.element_order = scene_.mesh.Order();
    map_.is_scale_known = start.has_value();
    const std::vector<int> whole(std::size_t(prior_->NumElements()), 0);
    const std::optional<LevelFit> homogeneous =
        FitLevels(problem_, whole,
                  Eigen::VectorXd::Constant(1, std::log(start.value_or(1))),
                  problem_.known_poisson_ratio.value_or(kUsualPoissonRatio));
    if (!homogeneous) {
      return Failed(SingularStiffness());
    }
    of_mesh_ = mesh_error_ ? mesh_error_->SquareSum(*homogeneous) : 0;
    const SmoothMap smooth = FitSmooth(*homogeneous);
    // A field that explains less than one material does supports nothing.
    const bool is_supported = smooth.log_evidence > 0;
    map_.supported_parameters = is_supported ? smooth.effective_number : 0;
    map_.resolution_length =
        is_supported
            ? ResolutionLengths(problem_, *prior_, smooth)
            : Eigen::VectorXd::Constant(prior_->NumElements(), prior_->Size());
    const MapState sharpened = SharpenMap(problem_, *prior_, smooth);
    const std::vector<RegionMap> regions =
        FitRegions(problem_, *prior_, sharpened, *homogeneous);
    map_.field_log_evidence = smooth.log_evidence;
    map_.region_log_evidence =
        regions.empty() ? 0 : regions.front().log_evidence;
    const bool are_regions =
        !regions.empty() && map_.region_log_evidence >= map_.field_log_evidence;
    const double best =
        are_regions ? map_.region_log_evidence : map_.field_log_evidence;
    const double explained =
        homogeneous->square_sum -
        (are_regions ? regions.front().fit.square_sum : smooth.square_sum);
    const bool is_of_mesh = best >= kLeastEvidence && explained <= of_mesh_;
    if (is_of_mesh) {
      map_.findings.push_back(
          StructureWithinMeshError(std::sqrt(explained), std::sqrt(of_mesh_)));
    }
    if (best < kLeastEvidence || is_of_mesh) {
      const double variance = problem_.Variance(
          homogeneous->square_sum,
          double(model_.NumIndependentRows() - homogeneous->unknowns.Rank()));
      EnterRegions(whole, *homogeneous, variance,
                   variance * homogeneous->unknowns.InverseGram(),
                   MeshCovariance(whole, *homogeneous));
    } else if (are_regions) {
      map_.verdict = MapVerdict::kRegions;
      EnterRegionsThatAreToldApart(regions);
    } else {
      map_.verdict = MapVerdict::kField;
      EnterField(smooth);
      if (!smooth.has_converged) {
        return Failed(SearchFailed("the smooth map did not settle"));
      }
    }
    map_.status = Status::kOk;
    map_.displacement_residual = model_.RelativeResidual();
    map_.fitted_displacement = model_.FittedDisplacement();
    map_.cameras = model_.Cameras();
    Judge();
    EnterWork();
    return map_;
  }

 private:
  void EnterWork() {
    map_.work = model_.WorkDone();
    if (mesh_error_) {
      map_.work = map_.work + mesh_error_->WorkDone();
    }
  }

  std::optional<double> GivenNoise() const {
    const ObservedDisplacements& observed = model_.Observed();
    return observed.GivenNoise() ? std::optional<double>(1 / observed.Norm())
                                 : std::nullopt;
  }

  // Fits a smooth field with the length of the greater evidence.
  SmoothMap FitSmooth(const LevelFit& homogeneous) {
    SmoothMap map = FitSmoothMap(problem_, *prior_, homogeneous);
    if (map.log_evidence < kLeastEvidence) {
      return map;
    }
    auto gradual =
        std::make_unique<FieldPrior>(scene_.mesh, FieldPrior::kGradient);
    if (LogEvidenceByModes(problem_, *gradual, *prior_, map) <=
        LogEvidenceByModes(problem_, *prior_, *prior_, map)) {
      return map;
    }
    ReturnTo(homogeneous.state,
             problem_.Variance(homogeneous.square_sum,
                               double(model_.NumIndependentRows() -
                                      homogeneous.unknowns.Rank())));
    SmoothMap of_gradual = FitSmoothMap(problem_, *gradual, homogeneous);
    if (of_gradual.log_evidence > map.log_evidence) {
      prior_ = std::move(gradual);
      return of_gradual;
    }
    ReturnTo(map.state, map.variance);
    return map;
  }

  // Moves the model to where it was solved before.
  void ReturnTo(const MapState& state, double variance) {
    static_cast<void>(model_.MoveTo(state.log_moduli, state.poisson_ratio,
                                    std::sqrt(variance)));
  }

  MapEstimate Failed(const Finding& finding) {
    map_.status = StatusOf(finding.code);
    map_.findings.push_back(finding);
    EnterWork();
    return map_;
  }

  // Moves the model to the map.
  void EnterNoise(const MapState& state, double variance) {
    ReturnTo(state, variance);
    // Rows are weighted by a noise that is given.
    const ObservedDisplacements& observed = model_.Observed();
    map_.noise_sd = std::sqrt(variance) * observed.Norm() *
                    observed.GivenNoise().value_or(1);
  }

  // Enters the means with their covariance as (ln E, LogStiffnessRatio).
  void EnterMeans(const MapState& state, const Eigen::Matrix2d& covariance) {
    const double nu = state.poisson_ratio;
    map_.mean_youngs_modulus = std::exp(
        prior_->Volumes().dot(state.log_moduli) / prior_->Volumes().sum());
    map_.poisson_ratio = nu;
    map_.covariance = OfParameters(state, covariance);
  }

  // Returns the covariance of (E, nu) for that of (ln E, LogStiffnessRatio).
  Eigen::Matrix2d OfParameters(const MapState& state,
                               const Eigen::Matrix2d& covariance) const {
    const double nu = state.poisson_ratio;
    const Eigen::Vector2d slopes(map_.mean_youngs_modulus,
                                 PoissonRatioSlope(nu));
    return slopes.asDiagonal() * covariance * slopes.asDiagonal();
  }

  // Returns the regions of these values of ln E with their standard errors.
  std::vector<MapRegion> RegionsOf(
      const std::vector<int>& region_of_element, const Eigen::VectorXd& levels,
      const Eigen::VectorXd& standard_errors) const {
    const Eigen::Index n = levels.size();
    Eigen::VectorXd volumes = Eigen::VectorXd::Zero(n);
    Eigen::VectorXd lengths = Eigen::VectorXd::Zero(n);
    for (Eigen::Index e = 0; e < prior_->NumElements(); ++e) {
      const double volume = prior_->Volumes()(e);
      volumes(region_of_element[e]) += volume;
      lengths(region_of_element[e]) += volume * map_.resolution_length(e);
    }
    const Eigen::VectorXd largest = LargestParts(region_of_element, n, *prior_);
    std::vector<MapRegion> regions;
    for (Eigen::Index i = 0; i < n; ++i) {
      const double modulus = std::exp(levels(i));
      const double diameter = DiameterOf(largest(i), prior_->Dimension());
      regions.push_back(
          {modulus, modulus * standard_errors(i),
           scene_.mesh.section.thickness * volumes(i), diameter,
           n == 1 || diameter * volumes(i) >= kResolved * lengths(i)});
    }
    return regions;
  }

  Eigen::MatrixXd MeshCovariance(const std::vector<int>& region_of_element,
                                 const LevelFit& fit) {
    const Eigen::Index size = fit.levels.size() + 1;
    return mesh_error_
               ? mesh_error_->CovarianceOf(*prior_, region_of_element, fit)
               : Eigen::MatrixXd::Zero(size, size);
  }

  // Enters the best regions.  The evidence does not know what the elements may
  // miss.  Where that hides whether two of three regions differ, the middle one
  // is a boundary if its modulus may be that of either side, and else the best
  // two regions are entered.
  void EnterRegionsThatAreToldApart(const std::vector<RegionMap>& maps) {
    const RegionMap& best = maps.front();
    const Eigen::VectorXd& levels = best.fit.levels;
    const Eigen::MatrixXd of_mesh =
        MeshCovariance(best.region_of_element, best.fit);
    bool differs_from_first = true;
    bool differs_from_last = true;
    bool has_boundary = false;
    if (levels.size() == 3) {
      const Eigen::MatrixXd covariance = best.covariance + of_mesh;
      differs_from_first = AreToldApart(levels, covariance, 0, 1);
      differs_from_last = AreToldApart(levels, covariance, 1, 2);
      has_boundary = IsBoundaryLayer(scene_.mesh, prior_->Volumes(),
                                     best.region_of_element, levels) ||
                     (!differs_from_first && !differs_from_last &&
                      AreToldApart(levels, covariance, 0, 2));
    }
    const bool are_materials =
        has_boundary || (differs_from_first && differs_from_last);
    if (!are_materials && maps.size() > 1) {
      const RegionMap& two = maps.back();
      EnterRegions(two.region_of_element, two.fit, two.variance, two.covariance,
                   MeshCovariance(two.region_of_element, two.fit));
      return;
    }
    EnterRegions(best.region_of_element, best.fit, best.variance,
                 best.covariance, of_mesh);
    if (has_boundary) {
      map_.boundary = map_.regions[1];
      map_.regions.erase(map_.regions.begin() + 1);
      for (int& region : map_.region_of_element) {
        region = region == 1 ? -1 : region / 2;
      }
    }
  }

  static bool AreToldApart(const Eigen::VectorXd& levels,
                           const Eigen::MatrixXd& covariance, Eigen::Index i,
                           Eigen::Index j) {
    const double variance =
        covariance(i, i) + covariance(j, j) - 2 * covariance(i, j);
    return std::abs(levels(i) - levels(j)) > kToldApart * std::sqrt(variance);
  }

  void EnterRegions(const std::vector<int>& region_of_element,
                    const LevelFit& fit, double variance,
                    Eigen::MatrixXd covariance,
                    const Eigen::MatrixXd& of_mesh) {
    covariance += of_mesh;
    const Eigen::Index n = fit.levels.size();
    const std::vector<MapRegion> regions = RegionsOf(
        region_of_element, fit.levels, covariance.diagonal().cwiseSqrt());
    Eigen::VectorXd volumes(n);
    Eigen::VectorXd errors(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      volumes(i) = regions[i].volume;
      errors(i) = regions[i].standard_error;
    }
    map_.youngs_modulus = fit.state.log_moduli.array().exp();
    map_.youngs_modulus_standard_error = errors(region_of_element);
    // The mean of ln E and nu are linear in the levels and the last unknown.
    Eigen::MatrixXd means = Eigen::MatrixXd::Zero(2, n + 1);
    means.row(0).head(n) = volumes.transpose() / volumes.sum();
    means(1, n) = n == 1 ? 1 : kWideningOfPoissonRatio;
    EnterMeans(fit.state, means * covariance * means.transpose());
    map_.mesh_covariance =
        OfParameters(fit.state, means * of_mesh * means.transpose());
    EnterNoise(fit.state, variance);
    map_.region_of_element = region_of_element;
    map_.regions = regions;
  }

  void EnterField(const SmoothMap& smooth) {
    EnterNoise(smooth.state, smooth.variance);
    const MapErrors errors = DescribeMap(problem_, *prior_, smooth);
    Eigen::ArrayXd variances = errors.log_modulus_sd.array().square();
    const Eigen::Vector2d widening(1, kWideningOfPoissonRatio);
    Eigen::Matrix2d covariance = widening.asDiagonal() *
                                 errors.covariance_of_means *
                                 widening.asDiagonal();
    Eigen::Matrix2d of_mesh = Eigen::Matrix2d::Zero();
    if (mesh_error_) {
      const MapChanges error = mesh_error_->ErrorOf(*prior_, smooth);
      variances += error.log_moduli.col(0).array().square();
      const Eigen::Vector2d of_means = widening.cwiseProduct(
          Eigen::Vector2d(prior_->Volumes().dot(error.log_moduli.col(0)) /
                              prior_->Volumes().sum(),
                          error.log_stiffness_ratio(0)));
      of_mesh = of_means * of_means.transpose();
      covariance += of_mesh;
    }
    map_.youngs_modulus = smooth.state.log_moduli.array().exp();
    map_.youngs_modulus_standard_error =
        map_.youngs_modulus.array() * variances.sqrt();
    EnterMeans(smooth.state, covariance);
    map_.mesh_covariance = OfParameters(smooth.state, of_mesh);
  }

  // Says what the numbers of the map mean.
  void Judge() {
    const double num_rows = double(model_.NumIndependentRows());
    if (!problem_.noise && map_.verdict == MapVerdict::kField &&
        num_rows < kLeastRedundancy * map_.supported_parameters) {
      map_.findings.push_back(NoiseNeeded(num_rows, map_.supported_parameters));
    }
    const double freedom = num_rows - (map_.verdict == MapVerdict::kField
                                           ? map_.supported_parameters
                                           : double(map_.regions.size()) +
                                                 (map_.boundary ? 1 : 0));
    if (problem_.noise && freedom > 0) {
      const double ratio = (model_.Residual().squaredNorm() - of_mesh_) /
                           (problem_.Variance(0, 1) * freedom);
      if (ratio > 1 + kMostMisfit * std::sqrt(2 / freedom)) {
        map_.findings.push_back(Misfit(std::sqrt(ratio)));
      }
    }
    const double spread =
        SpreadOfLog(map_.youngs_modulus.array().log(), prior_->Volumes());
    if (scene_.origin == Origin::kMeasured && !mesh_error_ &&
        map_.verdict != MapVerdict::kHomogeneous && spread < kOfTheMesh) {
      map_.findings.push_back(MayBeTheMesh(spread));
    }
    JudgeResolution();
  }

  // Names the regions that are not resolved, and what limits the resolution
  // there: the elements, where a map tells most of them apart.
  void JudgeResolution() {
    std::vector<std::string> widths;
    bool is_by_elements = true;
    for (std::size_t i = 0; i < map_.regions.size(); ++i) {
      if (map_.regions[i].is_resolved) {
        continue;
      }
      widths.push_back("region " + std::to_string(i + 1) + " (" +
                       TwoDigits(map_.regions[i].diameter) + " wide)");
      double volume = 0;
      double resolved = 0;
      for (Eigen::Index e = 0; e < prior_->NumElements(); ++e) {
        if (map_.region_of_element[e] == int(i)) {
          volume += prior_->Volumes()(e);
          resolved += std::pow(prior_->Volumes()(e), 2) /
                      std::pow(map_.resolution_length(e), prior_->Dimension());
        }
      }
      is_by_elements = is_by_elements && resolved > kResolvedElements * volume;
    }
    if (!widths.empty()) {
      map_.findings.push_back(NotResolved(widths, is_by_elements));
    }
  }

  const Scene& scene_;
  std::unique_ptr<FieldPrior> prior_;
  FieldSensitivity model_;
  MapProblem problem_;
  std::optional<MapMeshError> mesh_error_;
  // How much of the square sum is within what the elements may miss.
  double of_mesh_ = 0;
  MapEstimate map_;
};

}  // namespace

MapEstimate EstimateMap(const Scene& scene, const EstimatorOptions& options) {
  const Scene given = OfOneMaterial(scene);
  const bool is_raised =
      scene.origin == Origin::kMeasured && scene.mesh.Order() == 1;
  const Scene modelled = is_raised ? FinerScene(given) : given;
  std::optional<double> start;
  if (HasAnyForce(modelled)) {
    start =
        ScaleAtStart(modelled, options,
                     options.known_poisson_ratio.value_or(kUsualPoissonRatio));
    if (!start) {
      MapEstimate map;
      const Finding finding = DisplacementsOpposeLoads();
      map.status = StatusOf(finding.code);
      map.findings = {finding};
      return map;
    }
  }
  const Scene* const linear = is_raised ? &given : nullptr;
  MapEstimate map = MapBuilder(modelled, linear, options, true).Build(start);
  const auto misfit = std::find_if(
      map.findings.begin(), map.findings.end(), [](const Finding& finding) {
        return finding.code == FindingCode::kMisfit;
      });
  if (misfit == map.findings.end()) {
    return map;
  }
  // What is left beside the noise would pass for structure, so it counts as
  // noise.
  MapEstimate other = MapBuilder(modelled, linear, options, false).Build(start);
  other.findings.insert(other.findings.begin(), *misfit);
  other.work = map.work + other.work;
  return other;
}

}  // namespace elastimate
