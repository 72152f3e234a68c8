#include "elastimate/estimators/force_balance/virtual_work.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/algebra/node_sums.h"
#include "elastimate/core/algebra/row_block_qr.h"
#include "elastimate/core/mechanics/stiffness_product.h"
#include "elastimate/core/scene/degrees_of_freedom.h"
#include "elastimate/estimators/force_balance/force_residual.h"
#include "elastimate/estimators/force_balance/monomials.h"
#include "elastimate/estimators/statistics/scalar_search.h"

namespace elastimate {
namespace {

// Relative to the largest, what is smaller is rounding: a motion without
// strain, the work of loads that do none.  What is not rounding is far larger.
constexpr double kRoundingOfWork = 1e-10;

// The sine of the angle between two vectors of virtual work below which
// rounding, not the data, decides.
constexpr double kCollinearWork = 1e-10;

// An orthonormal basis of the polynomials times each window on the nodes where
// `component` is free, zero elsewhere: num_nodes x m.
Eigen::MatrixXd OrthonormalPolynomials(const Mesh& mesh,
                                       const Supports& supports, int component,
                                       int degree,
                                       const Eigen::MatrixXd& windows) {
  std::vector<Eigen::Index> free_nodes;
  for (Eigen::Index node = 0; node < mesh.NumNodes(); ++node) {
    if (!supports.held(component, node)) {
      free_nodes.push_back(node);
    }
  }
  if (free_nodes.empty()) {
    return Eigen::MatrixXd(mesh.NumNodes(), 0);
  }
  const Eigen::MatrixXd monomials =
      Monomials(mesh.nodes(Eigen::all, free_nodes), degree);
  const Eigen::Index count = monomials.cols();
  Eigen::MatrixXd all(monomials.rows(), count * windows.cols());
  for (Eigen::Index i = 0; i < windows.cols(); ++i) {
    all.middleCols(count * i, count) =
        windows(free_nodes, i).asDiagonal() * monomials;
  }
  const Eigen::MatrixXd on_free_nodes =
      OrthonormalBasis(all, kDependentMonomial);
  Eigen::MatrixXd basis =
      Eigen::MatrixXd::Zero(mesh.NumNodes(), on_free_nodes.cols());
  basis(free_nodes, Eigen::all) = on_free_nodes;
  return basis;
}

// The elements around some nodes, as a mesh of its own.
struct Patch {
  Mesh mesh;
  /// The node in the whole mesh of each node of the patch.
  std::vector<Eigen::Index> nodes;
};

Patch ElementsAround(const Mesh& mesh, Eigen::Index first_node,
                     Eigen::Index end_node) {
  std::vector<Eigen::Index> elements;
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    const auto corners = mesh.elements.col(e).array();
    if ((corners >= first_node && corners < end_node).any()) {
      elements.push_back(e);
    }
  }
  Patch patch;
  patch.mesh.kind = mesh.kind;
  patch.mesh.section = mesh.section;
  patch.mesh.elements = mesh.elements(Eigen::all, elements);
  std::vector<int> place(mesh.NumNodes(), -1);
  for (int& corner : patch.mesh.elements.reshaped()) {
    if (place[corner] < 0) {
      place[corner] = static_cast<int>(patch.nodes.size());
      patch.nodes.push_back(corner);
    }
    corner = place[corner];
  }
  patch.mesh.nodes = mesh.nodes(Eigen::all, patch.nodes);
  return patch;
}

// k0.
Eigen::Index NumColumns(const std::vector<Eigen::MatrixXd>& polynomials) {
  Eigen::Index columns = 0;
  for (const Eigen::MatrixXd& of_component : polynomials) {
    columns += of_component.cols();
  }
  return columns;
}

// The rows of fields that are given by component, at some nodes:
// num_dofs x k0.
Eigen::MatrixXd RowsOf(const std::vector<Eigen::MatrixXd>& polynomials,
                       const std::vector<Eigen::Index>& nodes) {
  const Eigen::Index dimension = Eigen::Index(polynomials.size());
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(
      dimension * Eigen::Index(nodes.size()), NumColumns(polynomials));
  Eigen::Index column = 0;
  for (Eigen::Index i = 0; i < dimension; ++i) {
    const Eigen::Index count = polynomials[i].cols();
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      rows.row(dimension * Eigen::Index(n) + i).segment(column, count) =
          polynomials[i].row(nodes[n]);
    }
    column += count;
  }
  return rows;
}

// The triangle of a QR factorisation of the free rows of [H V, J V], by patches
// of the mesh, so that memory does not grow with the mesh times the fields.
Eigen::MatrixXd StiffenedTriangle(
    const Mesh& mesh, const Supports& supports,
    const std::vector<Eigen::MatrixXd>& polynomials) {
  constexpr Eigen::Index kNodesPerPatch = 8192;
  const Eigen::Index columns = NumColumns(polynomials);
  RowBlockQr qr(2 * columns);
  for (Eigen::Index first = 0; first < mesh.NumNodes();
       first += kNodesPerPatch) {
    const Eigen::Index end = std::min(first + kNodesPerPatch, mesh.NumNodes());
    const Patch patch = ElementsAround(mesh, first, end);
    const StiffnessProducts products =
        MultiplyStiffnessBasis(patch.mesh, RowsOf(polynomials, patch.nodes));
    for (std::size_t n = 0; n < patch.nodes.size(); ++n) {
      const Eigen::Index node = patch.nodes[n];
      for (int i = 0; i < mesh.Dimension(); ++i) {
        if (node >= first && node < end && !supports.held(i, node)) {
          const Eigen::Index row = mesh.Dimension() * Eigen::Index(n) + i;
          qr.NextRow() << products.h.row(row), products.j.row(row);
        }
      }
    }
  }
  return qr.Triangle();
}

// The rows of one of `dimension` components, num_nodes x n, of num_dofs x n.
Eigen::MatrixXd ComponentRows(const Eigen::MatrixXd& all, std::size_t component,
                              std::size_t dimension) {
  return all(Eigen::seq(component, Eigen::last, dimension), Eigen::all);
}

}  // namespace

VirtualWork::VirtualWork(const Mesh& mesh, const Supports& supports, int degree,
                         const Eigen::MatrixXd& windows)
    : section_model_(mesh.section.model) {
  assert(degree >= 1 && degree <= 3);
  const bool has_windows = windows.cols() > 0;
  const Eigen::MatrixXd all_windows =
      has_windows ? windows : Eigen::MatrixXd::Ones(mesh.NumNodes(), 1);
  for (int i = 0; i < mesh.Dimension(); ++i) {
    polynomials_.push_back(
        OrthonormalPolynomials(mesh, supports, i, degree, all_windows));
  }
  const Eigen::MatrixXd triangle =
      StiffenedTriangle(mesh, supports, polynomials_);
  const Eigen::Index columns = triangle.cols() / 2;
  // H alone is the stiffness of nu = 0, so that what it does not resist is a
  // motion without strain.
  const SingularValueDecomposition svd =
      DecomposeSingularValues(triangle.topLeftCorner(columns, columns));
  const Eigen::Index rank =
      (svd.values.array() > kRoundingOfWork * svd.values(0)).count();
  fields_ = svd.v.leftCols(rank);
  free_motions_ = svd.v.rightCols(columns - rank);
  h_ = triangle.leftCols(columns) * fields_;
  j_ = triangle.rightCols(columns) * fields_;

  if (has_windows) {
    return;
  }
  // Half a step changes the stiffness by 19 %.
  constexpr Eigen::Index kScanPoints = 64;
  scan_.reserve(kScanPoints);
  for (const double nu : EvenPoissonRatios(kSmallestPoissonRatio,
                                           kLargestPoissonRatio, kScanPoints)) {
    scan_.push_back(FactorNoise(nu));
  }
}

Eigen::MatrixXd VirtualWork::Fields() const {
  std::vector<Eigen::Index> all(polynomials_[0].rows());
  for (std::size_t node = 0; node < all.size(); ++node) {
    all[node] = Eigen::Index(node);
  }
  return RowsOf(polynomials_, all) * fields_;
}

Eigen::MatrixXd VirtualWork::Of(const Eigen::MatrixXd& nodal_forces) const {
  Eigen::MatrixXd work(fields_.rows(), nodal_forces.cols());
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < polynomials_.size(); ++i) {
    const Eigen::Index count = polynomials_[i].cols();
    work.middleRows(row, count) = InnerProducts(
        polynomials_[i], ComponentRows(nodal_forces, i, polynomials_.size()));
    row += count;
  }
  return fields_.transpose() * work;
}

double VirtualWork::Imbalance(const Eigen::MatrixXd& nodal_forces) const {
  if (free_motions_.cols() == 0) {
    return 0;
  }
  Eigen::MatrixXd work =
      Eigen::MatrixXd::Zero(free_motions_.cols(), nodal_forces.cols());
  Eigen::MatrixXd absolute_work = work;
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < polynomials_.size(); ++i) {
    const Eigen::Index count = polynomials_[i].cols();
    const Eigen::MatrixXd motions =
        polynomials_[i] * free_motions_.middleRows(row, count);
    const Eigen::MatrixXd forces =
        ComponentRows(nodal_forces, i, polynomials_.size());
    work += InnerProducts(motions, forces);
    absolute_work += InnerProducts(motions.cwiseAbs(), forces.cwiseAbs());
    row += count;
  }
  return (absolute_work.array() > 0)
      .select(work.array().abs() / absolute_work.array(), 0)
      .maxCoeff();
}

VirtualWork::NoiseFactor VirtualWork::FactorNoise(double poisson_ratio) const {
  return {poisson_ratio, TriangularFactor(Stiffened(poisson_ratio))};
}

Eigen::Matrix2d VirtualWorkInformation::Bread(double noise_variance) const {
  Eigen::Matrix2d bread = score;
  bread(0, 0) -= noise_variance * noise_share;
  return bread;
}

VirtualWorkBalance::VirtualWorkBalance(const VirtualWork& work,
                                       const Scene& scene)
    : work_(work) {
  const DegreesOfFreedom dofs(scene.supports);
  const auto [q, f] = WeightLoadCases(scene);
  const StiffnessProducts products = MultiplyStiffnessBasis(scene.mesh, q);
  internal_h_ = work.Of(products.h);
  internal_j_ = work.Of(products.j);
  external_ = work.Of(f);
  displacement_norm_ = Norm(dofs.Restrict(q));
  loads_do_work_ = external_.norm() > kRoundingOfWork * Norm(dofs.Restrict(f));
}

std::optional<FreeDirection> VirtualWorkBalance::CollinearDirection() const {
  // Collinear at one nu is collinear at all.
  constexpr double kAnyPoissonRatio = 0.25;
  const VirtualWork::NoiseFactor noise = work_.FactorNoise(kAnyPoissonRatio);
  const auto lower = noise.upper.transpose().triangularView<Eigen::Lower>();
  const Eigen::MatrixXd b = lower.solve(internal_j_);
  const Eigen::MatrixXd f = lower.solve(external_);
  const double slope = b.cwiseProduct(f).sum() / f.squaredNorm();
  if ((b - slope * f).norm() > kCollinearWork * b.norm()) {
    return std::nullopt;
  }
  const double t = Evaluate(noise, Bounds{}).free_compliance_scale;
  const SectionModel model = work_.Model();
  return FreeDirection{
      IsotropicElasticity::FromComplianceScale(t, kAnyPoissonRatio, model),
      {LogYoungsModulusSlope(kAnyPoissonRatio, model) - slope / t, 1}};
}

VirtualWorkFit VirtualWorkBalance::Evaluate(
    const VirtualWork::NoiseFactor& noise, const Bounds& youngs_modulus) const {
  const double nu = noise.poisson_ratio;
  const auto upper = noise.upper.triangularView<Eigen::Upper>();
  const auto lower = noise.upper.transpose().triangularView<Eigen::Lower>();
  const Eigen::MatrixXd z_a = lower.solve(internal_h_ + nu * internal_j_);
  const Eigen::MatrixXd z_f = lower.solve(external_);

  VirtualWorkFit fit;
  fit.poisson_ratio = nu;
  fit.free_compliance_scale = z_a.cwiseProduct(z_f).sum() / z_f.squaredNorm();
  fit.compliance_scale = std::max(0.0, fit.free_compliance_scale);
  fit.youngs_modulus_bound = Side::kNone;
  const double factor = ComplianceFactor(nu, work_.Model());  // E t.
  const auto hold = [&](double bound, Side side) {
    fit.compliance_scale = factor / bound;
    fit.youngs_modulus_bound = side;
    return ComplianceFactorSlope(nu, work_.Model()) / bound;
  };
  double scale_slope = 0;
  if (youngs_modulus.upper &&
      fit.compliance_scale < factor / *youngs_modulus.upper) {
    scale_slope = hold(*youngs_modulus.upper, Side::kUpper);
  } else if (youngs_modulus.lower &&
             fit.compliance_scale > factor / *youngs_modulus.lower) {
    scale_slope = hold(*youngs_modulus.lower, Side::kLower);
  }
  const Eigen::MatrixXd z_r = z_a - fit.compliance_scale * z_f;
  fit.square_sum = z_r.squaredNorm();
  fit.multipliers = upper.solve(z_r);
  // d(r^T G^-1 r) = 2 lambda.dr - lambda^T dG lambda, with
  // lambda^T dG lambda = 2 (J V lambda).(M lambda) dnu.
  const Eigen::MatrixXd correction = work_.Stiffened(nu) * fit.multipliers;
  fit.slope =
      2 * (fit.multipliers.cwiseProduct(internal_j_).sum() -
           (work_.J() * fit.multipliers).cwiseProduct(correction).sum() -
           scale_slope * fit.multipliers.cwiseProduct(external_).sum());
  return fit;
}

VirtualWorkFit VirtualWorkBalance::FitAt(double poisson_ratio,
                                         const Bounds& youngs_modulus) const {
  return Evaluate(work_.FactorNoise(poisson_ratio), youngs_modulus);
}

VirtualWorkFit VirtualWorkBalance::Refine(const VirtualWorkFit& falling,
                                          const VirtualWorkFit& rising,
                                          const Bounds& youngs_modulus) const {
  constexpr double kTolerance = 1e-13;
  const auto fit_at = [&](double log_ratio) {
    return FitAt(PoissonRatioOfLogStiffnessRatio(log_ratio), youngs_modulus);
  };
  return fit_at(ZeroBetween(
      [&](double log_ratio) { return fit_at(log_ratio).slope; },
      LogStiffnessRatio(falling.poisson_ratio), falling.slope,
      LogStiffnessRatio(rising.poisson_ratio), rising.slope, kTolerance));
}

VirtualWorkFit VirtualWorkBalance::Minimize(
    const Bounds& poisson_ratio, const Bounds& youngs_modulus) const {
  std::vector<VirtualWorkFit> fits = {
      FitAt(*poisson_ratio.lower, youngs_modulus)};
  for (const VirtualWork::NoiseFactor& noise : work_.Scan()) {
    if (noise.poisson_ratio > *poisson_ratio.lower &&
        noise.poisson_ratio < *poisson_ratio.upper) {
      fits.push_back(Evaluate(noise, youngs_modulus));
    }
  }
  fits.push_back(FitAt(*poisson_ratio.upper, youngs_modulus));

  VirtualWorkFit best = fits.front().square_sum < fits.back().square_sum
                            ? fits.front()
                            : fits.back();
  for (std::size_t i = 0; i + 1 < fits.size(); ++i) {
    if (fits[i].slope < 0 && fits[i + 1].slope >= 0) {
      VirtualWorkFit minimum = Refine(fits[i], fits[i + 1], youngs_modulus);
      if (minimum.square_sum < best.square_sum) {
        best = std::move(minimum);
      }
    }
  }
  return best;
}

std::pair<VirtualWorkFit, VirtualWorkFit> VirtualWorkBalance::ProfileEnds(
    const VirtualWorkFit& best, double excess) const {
  const auto is_inside = [&](const VirtualWorkFit& fit) {
    return fit.square_sum <= best.square_sum + excess;
  };
  // Along the scan from `noise` on, away from the best fit.
  const auto end_along = [&](auto noise, auto scan_end) {
    constexpr int kHalvings = 12;
    VirtualWorkFit inside = best;
    for (; noise != scan_end; ++noise) {
      VirtualWorkFit fit = Evaluate(*noise, Bounds{});
      if (!is_inside(fit)) {
        break;
      }
      inside = std::move(fit);
    }
    if (noise == scan_end) {
      return inside;
    }
    // The fit there is kept, for another would cost a factorisation.
    LastInside(
        [&](double nu) {
          VirtualWorkFit fit = FitAt(nu, Bounds{});
          if (!is_inside(fit)) {
            return false;
          }
          inside = std::move(fit);
          return true;
        },
        inside.poisson_ratio, noise->poisson_ratio, kHalvings);
    return inside;
  };
  const std::vector<VirtualWork::NoiseFactor>& scan = work_.Scan();
  const double nu = best.poisson_ratio;
  return {end_along(std::find_if(scan.rbegin(), scan.rend(),
                                 [&](const auto& noise) {
                                   return noise.poisson_ratio < nu;
                                 }),
                    scan.rend()),
          end_along(std::find_if(scan.begin(), scan.end(),
                                 [&](const auto& noise) {
                                   return noise.poisson_ratio > nu;
                                 }),
                    scan.end())};
}

VirtualWorkInformation VirtualWorkBalance::InformationAt(
    const VirtualWorkFit& fit) const {
  const VirtualWork::NoiseFactor noise = work_.FactorNoise(fit.poisson_ratio);
  const auto lower = noise.upper.transpose().triangularView<Eigen::Lower>();
  const Eigen::MatrixXd stiffened = work_.Stiffened(fit.poisson_ratio);
  const Eigen::MatrixXd cross = InnerProducts(work_.J(), stiffened);
  const Eigen::MatrixXd z_b =
      lower.solve(internal_j_ - cross * fit.multipliers);
  const Eigen::MatrixXd z_f = lower.solve(external_);
  VirtualWorkInformation information;
  information.score(0, 0) = z_b.squaredNorm();
  information.score(1, 1) = z_f.squaredNorm();
  information.score(0, 1) = -z_b.cwiseProduct(z_f).sum();
  information.score(1, 0) = information.score(0, 1);
  // The noise of b that M does not span: ||(I - M (M^T M)^-1 M^T) J V L^-T||^2.
  const Eigen::MatrixXd all = lower.solve(work_.J().transpose());
  const Eigen::MatrixXd spanned =
      lower.solve(Eigen::MatrixXd(lower.solve(cross).transpose()));
  information.noise_share = static_cast<double>(internal_j_.cols()) *
                            (all.squaredNorm() - spanned.squaredNorm());
  return information;
}

}  // namespace elastimate
