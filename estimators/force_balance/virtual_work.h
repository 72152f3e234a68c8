#ifndef ELASTIMATE_ESTIMATORS_FORCE_BALANCE_VIRTUAL_WORK_H_
#define ELASTIMATE_ESTIMATORS_FORCE_BALANCE_VIRTUAL_WORK_H_

#include <Eigen/Core>
#include <optional>
#include <utility>
#include <vector>

#include "elastimate/core/materials/elasticity.h"
#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimator.h"
#include "elastimate/estimators/interface/evidence.h"
#include "elastimate/estimators/statistics/bounded_parameter.h"

namespace elastimate {

/// Virtual fields on a mesh, and how displacement noise enters their virtual
/// work: all that an estimate by virtual work needs of a mesh and its supports,
/// prepared once for any number of measurements.
///
/// The fields are the columns of V (num_free x k): an orthonormal basis of the
/// polynomials of degree <= d along each axis on the free degrees of freedom,
/// without those that supports or a small mesh make dependent, and without the
/// motions without strain that the supports leave free, whose internal work is
/// zero for every material.
///
/// Independent noise of standard deviation sigma in the free components of q
/// gives V^T (H + nu J) q the covariance sigma^2 G(nu), with
///
///   G(nu) = M^T M,   M(nu) = (H + nu J) V,
///
/// kept as the triangle of a QR factorisation of [H V, J V], since the
/// condition number of G is the square of that of M, which has no bound as nu
/// tends to -1 or 1/2.
class VirtualWork {
 public:
  /// Cost: one element pass of 3 (d + 1)(d + 2)(d + 3) / 6 columns (12, 30, 60;
  /// in two dimensions (d + 1)(d + 2))
  /// and the QR factorisation of twice as many; memory for about as many
  /// vectors over the nodes as one third of that number, and a block of fixed
  /// size.  Single-threaded, deterministic.
  /// Preconditions: a valid scene's mesh and supports; 1 <= degree <= 3.
  ///
  /// With windows (num_nodes x n) the fields are the products of each with the
  /// polynomials, n times as many, and there is no Scan.
  VirtualWork(const Mesh& mesh, const Supports& supports, int degree,
              const Eigen::MatrixXd& windows = {});

  /// What relates t to E.
  SectionModel Model() const { return section_model_; }

  /// k.
  Eigen::Index NumFields() const { return h_.cols(); }

  /// V in all rows, zero in the held ones: num_dofs x k [-].
  Eigen::MatrixXd Fields() const;

  /// V^T of the free rows of nodal forces, num_dofs x n: k x n.
  Eigen::MatrixXd Of(const Eigen::MatrixXd& nodal_forces) const;

  /// The largest share of the nodal forces (num_dofs x n) that is not in
  /// balance: |v.f| / (|v|.|f|) over the motions v without strain that the
  /// supports leave free.  Zero when there are none.
  double Imbalance(const Eigen::MatrixXd& nodal_forces) const;

  /// H V and J V, (2 k0) x k each, rotated to the rows of the triangle: their
  /// products with each other are those of H V and J V, k0 >= k.
  const Eigen::MatrixXd& H() const { return h_; }
  const Eigen::MatrixXd& J() const { return j_; }

  /// M(nu), in the same rows.
  Eigen::MatrixXd Stiffened(double poisson_ratio) const {
    return h_ + poisson_ratio * j_;
  }

  /// The upper triangle L^T of G(nu) = L L^T, k x k.
  struct NoiseFactor {
    double poisson_ratio;
    Eigen::MatrixXd upper;
  };
  /// Precondition: -1 < nu < 1/2.  O(k^3).
  NoiseFactor FactorNoise(double poisson_ratio) const;

  /// The factors at values of nu, ascending over the whole range, that are
  /// close enough together to find every minimum of an estimate between them.
  const std::vector<NoiseFactor>& Scan() const { return scan_; }

 private:
  SectionModel section_model_;
  /// For each component V of its rows before the rotation, num_nodes x m each,
  /// zero in the held rows.
  std::vector<Eigen::MatrixXd> polynomials_;
  /// From the polynomials (k0) to the fields (k0 x k), and to the free motions.
  Eigen::MatrixXd fields_;
  Eigen::MatrixXd free_motions_;
  Eigen::MatrixXd h_;
  Eigen::MatrixXd j_;
  std::vector<NoiseFactor> scan_;
};

/// A minimum of the balance of virtual work.
struct VirtualWorkFit {
  double poisson_ratio;
  /// t, within the bounds on E, and not below zero.
  double compliance_scale;
  /// t without any bounds.
  double free_compliance_scale;
  /// The bound that E lies on.
  Side youngs_modulus_bound;
  /// ||e||^2 of the smallest correction e of the displacements that brings the
  /// virtual work of all fields into balance.
  double square_sum;
  /// d square_sum / d nu.
  double slope;
  /// lambda = G^-1 V^T (a + nu b - t f), k x num_load_cases.
  Eigen::MatrixXd multipliers;
};

/// What a fit knows about (nu, t): with D = [b', -V^T f], where b' is V^T J q
/// of the corrected displacements, their score has the covariance
/// sigma^2 D^T G^-1 D; and the expectation of its derivative, the bread of the
/// sandwich, is that without the noise that is left in b'.
struct VirtualWorkInformation {
  Eigen::Matrix2d score;  ///< D^T G^-1 D.
  double noise_share;     ///< score(0, 0) contains sigma^2 times this.

  /// The expectation of the derivative of the score.
  Eigen::Matrix2d Bread(double noise_variance) const;
};

/// The balance of virtual work V^T (a + nu b - t f) = 0, with a = H q, b = J q,
/// of the measured displacements of a scene.  Its continuously updated weighted
/// least squares [Avril & Pierron 2007 for the weights; Newey & Windmeijer,
/// Econometrica 77 (2009) 687 for the statistics] are
///
///   S(nu) = min over t of r^T G(nu)^-1 r,   r = V^T (a + nu b - t f),
///
/// which is the square sum of the smallest correction e of the displacements
/// for which V^T ((H + nu J)(q - e) - t f) = 0.  For independent noise the
/// expectation of S for any nu and t is that without noise plus sigma^2 k, so
/// that noise does not move its minimum: the expectation of dS/dnu at the true
/// nu is zero.
///
/// Load cases are weighted by 1 / noise_sd when it is known, so that the noise
/// of the weighted displacements has standard deviation 1.
class VirtualWorkBalance {
 public:
  /// One element pass of one column per load case.  `work` must outlive this
  /// object.  Preconditions: what Estimator::Run checks, and every free
  /// component is observed; `scene` has the mesh and supports of `work`.
  VirtualWorkBalance(const VirtualWork& work, const Scene& scene);

  /// What relates t to E.
  SectionModel Model() const { return work_.Model(); }

  /// k times the number of load cases.
  Eigen::Index NumEquations() const { return internal_h_.size(); }

  /// Norm of the displacements on the free degrees of freedom, of which the
  /// square sum of a fit is a correction.
  double DisplacementNorm() const { return displacement_norm_; }

  /// Whether the loads do work on the fields at all, beyond rounding.
  bool LoadsDoWork() const { return loads_do_work_; }

  /// What is not determined where rounding decides on nu because a change of nu
  /// acts on the balance as a change of t does; empty where the data decide.
  /// Precondition: LoadsDoWork.
  std::optional<FreeDirection> CollinearDirection() const;

  /// The fit at a known nu.  Precondition: LoadsDoWork.  O(k^3).
  VirtualWorkFit FitAt(double poisson_ratio,
                       const Bounds& youngs_modulus) const;

  /// The global minimum of S over the closed range of nu, whose ends must be
  /// given and within (-1, 1/2), with E within its bounds.
  /// Precondition: LoadsDoWork.
  VirtualWorkFit Minimize(const Bounds& poisson_ratio,
                          const Bounds& youngs_modulus) const;

  /// The fits, without bounds on E, at the ends of the interval of nu around
  /// that of `best` in which S exceeds its own by no more than `excess`; at
  /// the limits of the range where it never does.
  std::pair<VirtualWorkFit, VirtualWorkFit> ProfileEnds(
      const VirtualWorkFit& best, double excess) const;

  VirtualWorkInformation InformationAt(const VirtualWorkFit& fit) const;

 private:
  VirtualWorkFit Evaluate(const VirtualWork::NoiseFactor& noise,
                          const Bounds& youngs_modulus) const;
  /// The minimum between two fits, of which S falls at the first and rises at
  /// the second.
  VirtualWorkFit Refine(const VirtualWorkFit& falling,
                        const VirtualWorkFit& rising,
                        const Bounds& youngs_modulus) const;

  const VirtualWork& work_;
  /// V^T a, V^T b and V^T f, k x num_load_cases each.
  Eigen::MatrixXd internal_h_;
  Eigen::MatrixXd internal_j_;
  Eigen::MatrixXd external_;
  double displacement_norm_;
  bool loads_do_work_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_FORCE_BALANCE_VIRTUAL_WORK_H_
