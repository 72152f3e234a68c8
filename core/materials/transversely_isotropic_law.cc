#include "elastimate/core/materials/transversely_isotropic_law.h"

#include <Eigen/LU>
#include <cmath>

#include "elastimate/core/laws/law_parameters.h"

namespace elastimate {
namespace {

const double kRootOfTwo = std::sqrt(2.0);

// The modes are e_LL, the dilation across the axis, the two shears across it,
// and the two shears along it.
std::vector<Eigen::MatrixXd> ModesOfAxis() {
  using Strains = Eigen::Matrix<double, 6, Eigen::Dynamic>;
  Strains dilation = Strains::Zero(6, 1);
  dilation(1) = dilation(2) = 1 / kRootOfTwo;
  Strains across = Strains::Zero(6, 2);
  across(1, 0) = 1 / kRootOfTwo;
  across(2, 0) = -1 / kRootOfTwo;
  across(3, 1) = 1;
  Strains along = Strains::Zero(6, 2);
  along(4, 0) = along(5, 1) = 1;
  return {Eigen::VectorXd::Unit(6, 0), dilation, across, along};
}

// Returns the compliance of e_LL and the dilation across the axis.
Eigen::Matrix2d DilationCompliance(const Eigen::VectorXd& p) {
  const double coupling = -kRootOfTwo * p(2) / p(0);
  return (Eigen::Matrix2d() << 1 / p(0), coupling, coupling, (1 - p(3)) / p(1))
      .finished();
}

Eigen::Vector3d HillModuli(const Eigen::Matrix2d& stiffness) {
  return {stiffness(0, 0), stiffness(0, 1) / kRootOfTwo, stiffness(1, 1) / 2};
}

}  // namespace

TransverselyIsotropicLaw::TransverselyIsotropicLaw()
    : KelvinLaw(
          SectionModel::kSolid,
          {Modulus("youngs_modulus_L", "E_L", 1),
           Modulus("youngs_modulus_T", "E_T", 1),
           DirectedPoissonRatio("poisson_ratio_LT", "nu_LT"),
           PoissonRatioInPlane("poisson_ratio_TT", "nu_TT"),
           Modulus("shear_modulus_LT", "G_LT", kTypicalShearModulus)},
          ModesOfAxis(),
          {{0, 0, 1}, {0, 1, kRootOfTwo}, {1, 1, 2}, {2, 2, 2}, {3, 3, 2}}) {}

std::string_view TransverselyIsotropicLaw::Description() const {
  return "alike in all directions T across its axis L, as with fibres along L";
}

Eigen::VectorXd TransverselyIsotropicLaw::Moduli(
    const Eigen::VectorXd& parameters, SectionModel /*model*/) const {
  const Eigen::Matrix2d stiffness = DilationCompliance(parameters).inverse();
  Eigen::VectorXd moduli(5);
  moduli << HillModuli(stiffness), parameters(1) / (2 * (1 + parameters(3))),
      parameters(4);
  return moduli;
}

Eigen::MatrixXd TransverselyIsotropicLaw::ModuliJacobian(
    const Eigen::VectorXd& parameters, SectionModel /*model*/) const {
  const double along = parameters(0);
  const double across = parameters(1);
  const double nu = parameters(3);
  const Eigen::Matrix2d compliance = DilationCompliance(parameters);
  const Eigen::Matrix2d stiffness = compliance.inverse();
  const auto column = [&](double s_00, double s_01, double s_11) {
    // d C = -C dS C.
    const Eigen::Matrix2d slope =
        (Eigen::Matrix2d() << s_00, s_01, s_01, s_11).finished();
    return HillModuli(-stiffness * slope * stiffness);
  };
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(5, 5);
  jacobian.block<3, 1>(0, 0) =
      column(-compliance(0, 0) / along, -compliance(0, 1) / along, 0);
  jacobian.block<3, 1>(0, 1) = column(0, 0, -compliance(1, 1) / across);
  jacobian.block<3, 1>(0, 2) = column(0, -kRootOfTwo / along, 0);
  jacobian.block<3, 1>(0, 3) = column(0, 0, -1 / across);
  jacobian(3, 1) = 1 / (2 * (1 + nu));
  jacobian(3, 3) = -across / (2 * (1 + nu) * (1 + nu));
  jacobian(4, 4) = 1;
  return jacobian;
}

Eigen::VectorXd TransverselyIsotropicLaw::ParametersOf(
    const Eigen::VectorXd& moduli, SectionModel /*model*/) const {
  Eigen::Matrix2d stiffness;
  stiffness << moduli(0), kRootOfTwo * moduli(1), kRootOfTwo * moduli(1),
      2 * moduli(2);
  const Eigen::Matrix2d compliance = stiffness.inverse();
  // These are (1 - nu_TT) / E_T and (1 + nu_TT) / E_T.
  const double dilation = compliance(1, 1);
  const double shear = 1 / (2 * moduli(3));
  Eigen::VectorXd parameters(5);
  parameters << 1 / compliance(0, 0), 2 / (dilation + shear),
      -compliance(0, 1) / (kRootOfTwo * compliance(0, 0)),
      (shear - dilation) / (shear + dilation), moduli(4);
  return parameters;
}

}  // namespace elastimate
