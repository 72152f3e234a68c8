#ifndef ELASTIMATE_CORE_LARGE_STRAIN_CHARTS_H_
#define ELASTIMATE_CORE_LARGE_STRAIN_CHARTS_H_

#include <Eigen/Core>
#include <vector>

#include "elastimate/core/laws/law.h"

namespace elastimate {

/// The chart of laws whose moduli are Lamé's (mu, lambda), by Young's modulus
/// and Poisson's ratio of small strains.
struct LameChart {
  static const std::vector<LawParameter>& Parameters();
  static Eigen::Vector2d Moduli(const Eigen::VectorXd& parameters);
  static Eigen::Matrix2d ModuliJacobian(const Eigen::VectorXd& parameters);
  static Eigen::Vector2d ParametersOf(const Eigen::VectorXd& moduli);
};

/// Gives a law of two moduli (mu, lambda) that chart.
template <class Base>
class LameLaw : public Base {
 public:
  const std::vector<LawParameter>& Parameters() const override {
    return LameChart::Parameters();
  }
  int NumModuli() const override { return 2; }
  Eigen::VectorXd Moduli(const Eigen::VectorXd& parameters,
                         SectionModel /*model*/) const override {
    return LameChart::Moduli(parameters);
  }
  Eigen::MatrixXd ModuliJacobian(const Eigen::VectorXd& parameters,
                                 SectionModel /*model*/) const override {
    return LameChart::ModuliJacobian(parameters);
  }
  Eigen::VectorXd ParametersOf(const Eigen::VectorXd& moduli,
                               SectionModel /*model*/) const override {
    return LameChart::ParametersOf(moduli);
  }
};

/// Gives a law the chart whose parameters are its moduli.
template <class Base>
class OwnModuliLaw : public Base {
 public:
  int NumModuli() const override { return int(this->Parameters().size()); }
  Eigen::VectorXd Moduli(const Eigen::VectorXd& parameters,
                         SectionModel /*model*/) const override {
    return parameters;
  }
  Eigen::MatrixXd ModuliJacobian(const Eigen::VectorXd& parameters,
                                 SectionModel /*model*/) const override {
    return Eigen::MatrixXd::Identity(parameters.size(), parameters.size());
  }
  Eigen::VectorXd ParametersOf(const Eigen::VectorXd& moduli,
                               SectionModel /*model*/) const override {
    return moduli;
  }
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_LARGE_STRAIN_CHARTS_H_
