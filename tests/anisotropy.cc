#include "tests/anisotropy.h"

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "tests/dense_reference.h"

namespace elastimate::testing {
namespace {

std::vector<std::array<int, 2>> PairsOfVoigt(Eigen::Index size) {
  return size == 6 ? std::vector<std::array<int, 2>>{{0, 0}, {1, 1}, {2, 2},
                                                     {1, 2}, {0, 2}, {0, 1}}
                   : std::vector<std::array<int, 2>>{{0, 0}, {1, 1}, {0, 1}};
}

// The parameters p are E_1, E_2, E_3, nu_12, nu_13, nu_23, G_12, G_13, G_23.
Eigen::MatrixXd OrthotropicCompliance(const Eigen::VectorXd& p) {
  Eigen::MatrixXd s = Eigen::MatrixXd::Zero(6, 6);
  s(0, 0) = 1 / p(0);
  s(1, 1) = 1 / p(1);
  s(2, 2) = 1 / p(2);
  s(0, 1) = s(1, 0) = -p(3) / p(0);
  s(0, 2) = s(2, 0) = -p(4) / p(0);
  s(1, 2) = s(2, 1) = -p(5) / p(1);
  s(3, 3) = 1 / p(8);
  s(4, 4) = 1 / p(7);
  s(5, 5) = 1 / p(6);
  return s;
}

}  // namespace

Eigen::MatrixXd TextbookStiffnessOf(const Law& law, const Eigen::VectorXd& p) {
  if (law.Name() == "anisotropic") {
    Eigen::MatrixXd stiffness(6, 6);
    int k = 0;
    for (int i = 0; i < 6; ++i) {
      for (int j = i; j < 6; ++j) {
        stiffness(i, j) = stiffness(j, i) = p(k++);
      }
    }
    return stiffness;
  }
  if (law.Name() == "transversely_isotropic") {
    Eigen::VectorXd orthotropic(9);
    orthotropic << p(0), p(1), p(1), p(2), p(2), p(3), p(4), p(4),
        p(1) / (2 * (1 + p(3)));
    return InvertDensely(OrthotropicCompliance(orthotropic));
  }
  if (p.size() == 9) {
    return InvertDensely(OrthotropicCompliance(p));
  }
  // The plane stress stiffness is Q_11 = E_1 / (1 - nu_12 nu_21), with nu_21 =
  // nu_12 E_2 / E_1.
  const double scale = 1 / (1 - p(2) * p(2) * p(1) / p(0));
  Eigen::MatrixXd reduced = Eigen::MatrixXd::Zero(3, 3);
  reduced(0, 0) = scale * p(0);
  reduced(1, 1) = scale * p(1);
  reduced(0, 1) = reduced(1, 0) = scale * p(2) * p(1);
  reduced(2, 2) = p(3);
  return reduced;
}

Eigen::MatrixXd SeenFromOutside(const Eigen::MatrixXd& stiffness,
                                const Eigen::MatrixXd& frame) {
  const auto pairs = PairsOfVoigt(stiffness.rows());
  const Eigen::Index d = frame.rows();
  Eigen::MatrixXi voigt(d, d);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    voigt(pairs[i][0], pairs[i][1]) = int(i);
    voigt(pairs[i][1], pairs[i][0]) = int(i);
  }
  Eigen::MatrixXd seen =
      Eigen::MatrixXd::Zero(stiffness.rows(), stiffness.cols());
  for (Eigen::Index row = 0; row < seen.rows(); ++row) {
    for (Eigen::Index column = 0; column < seen.cols(); ++column) {
      const auto [i, j] = pairs[row];
      const auto [k, l] = pairs[column];
      for (Eigen::Index a = 0; a < d; ++a) {
        for (Eigen::Index b = 0; b < d; ++b) {
          for (Eigen::Index m = 0; m < d; ++m) {
            for (Eigen::Index n = 0; n < d; ++n) {
              seen(row, column) += frame(i, a) * frame(j, b) * frame(k, m) *
                                   frame(l, n) *
                                   stiffness(voigt(a, b), voigt(m, n));
            }
          }
        }
      }
    }
  }
  return seen;
}

Eigen::VectorXd UnlikeTypical(const Law& law, double unit) {
  const std::vector<LawParameter>& all = law.Parameters();
  Eigen::VectorXd parameters(Eigen::Index(all.size()));
  for (Eigen::Index i = 0; i < parameters.size(); ++i) {
    const LawParameter& parameter = all[i];
    const double share = 0.15 * double((7 * i) % 5 - 2);
    const double scale = parameter.is_modulus || parameter.beside ? unit : 1;
    parameters(i) = scale * parameter.typical * (1 + share);
    if (parameter.beside && parameter.typical == 0) {
      parameters(i) = scale * 0.1 * share;
    }
  }
  return parameters;
}

Eigen::VectorXd ConstantsOfFibres() {
  Eigen::VectorXd constants(5);
  constants << 9e4, 3e4, 0.32, 0.4, 1.5e4;
  return constants;
}

Eigen::MatrixXd RandomFrame(Eigen::Index dimension, unsigned seed) {
  const double angle = 0.7 + 1.3 * seed;
  if (dimension == 2) {
    return Eigen::Rotation2Dd(angle).toRotationMatrix();
  }
  return (Eigen::AngleAxisd(angle, Eigen::Vector3d(1, 2, 3).normalized()) *
          Eigen::AngleAxisd(2 * angle,
                            Eigen::Vector3d(-1, 1, 0.3).normalized()))
      .toRotationMatrix();
}

}  // namespace elastimate::testing
