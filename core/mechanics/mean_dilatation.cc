#include "elastimate/core/mechanics/mean_dilatation.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace elastimate {
namespace {

constexpr int kPoints = PointNumbers::kPoints;

// Polynomials and their products at the points of an element, without memory
// of the heap.
using Products = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic,
                               Eigen::ColMajor, 4, 4>;
using PolynomialsAtPoint =
    Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 4, 1>;

}  // namespace

MeanDilatation::Entries MeanDilatation::EntriesOf(int dimension) {
  return dimension == 3 ? Entries{9, 9, {0, 1, 2, 3, 4, 5, 6, 7, 8}}
                        : Entries{5, 4, {0, 1, 3, 4, 8}};
}

MeanDilatation::MeanDilatation(const ElementPoints& points,
                               const PointMatrices& gradients)
    : points_(points), entries_(EntriesOf(points.dimension)) {
  MakeOrthonormal();
  SetDeformation(gradients);
  // det(I + H) - 1 keeps its digits near rest.
  PointNumbers changes;
  const auto& h = gradients.row;
  for (int p = 0; p < kPoints; ++p) {
    const double trace = h[0][p] + h[4][p] + h[8][p];
    const double minors = h[0][p] * h[4][p] - h[1][p] * h[3][p] +
                          h[0][p] * h[8][p] - h[2][p] * h[6][p] +
                          h[4][p] * h[8][p] - h[5][p] * h[7][p];
    const double determinant =
        h[0][p] * (h[4][p] * h[8][p] - h[5][p] * h[7][p]) -
        h[3][p] * (h[1][p] * h[8][p] - h[2][p] * h[7][p]) +
        h[6][p] * (h[1][p] * h[5][p] - h[2][p] * h[4][p]);
    changes.row[0][p] = trace + minors + determinant;
    jacobian_.row[0][p] = 1 + changes.row[0][p];
  }
  const PointNumbers smoothed = Fit(changes);
  for (int p = 0; p < kPoints; ++p) {
    theta_.row[0][p] = 1 + smoothed.row[0][p];
    // s - 1 = r / (s^2 + s + 1) for s^3 = 1 + r.
    const double r =
        (smoothed.row[0][p] - changes.row[0][p]) / jacobian_.row[0][p];
    const double s = std::cbrt(1 + r);
    const double scale_change = r / (s * s + s + 1);
    scale_.row[0][p] = 1 + scale_change;
    for (int entry = 0; entry < 9; ++entry) {
      gradients_.row[entry][p] = scale_.row[0][p] * h[entry][p];
    }
    for (const int entry : {0, 4, 8}) {
      gradients_.row[entry][p] += scale_change;
    }
  }
}

void MeanDilatation::MakeOrthonormal() {
  const int size = points_.num_polynomials;
  auto& rows = points_.polynomials.row;
  if (size == 1) {
    // The constant alone needs no factor, which would take longer than all else
    // here.
    for (int first = 0; first < points_.num_points;
         first += points_.per_element) {
      double volume = 0;
      for (int p = first; p < first + points_.per_element; ++p) {
        volume += points_.volumes.row[0][p];
      }
      std::fill_n(rows[0] + first, points_.per_element, 1 / std::sqrt(volume));
    }
    return;
  }
  for (int first = 0; first < points_.num_points;
       first += points_.per_element) {
    Products products = Products::Zero(size, size);
    for (int p = first; p < first + points_.per_element; ++p) {
      for (int a = 0; a < size; ++a) {
        for (int b = 0; b <= a; ++b) {
          products(a, b) += points_.volumes.row[0][p] * rows[a][p] * rows[b][p];
        }
      }
    }
    const Eigen::LLT<Products> factor(products);
    for (int p = first; p < first + points_.per_element; ++p) {
      PolynomialsAtPoint values(size);
      for (int a = 0; a < size; ++a) {
        values(a) = rows[a][p];
      }
      factor.matrixL().solveInPlace(values);
      for (int a = 0; a < size; ++a) {
        rows[a][p] = values(a);
      }
    }
  }
}

void MeanDilatation::SetDeformation(const PointMatrices& gradients) {
  f_ = gradients;
  for (const int entry : {0, 4, 8}) {
    for (int p = 0; p < kPoints; ++p) {
      f_.row[entry][p] += 1;
    }
  }
  const auto& f = f_.row;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const int i1 = (i + 1) % 3;
      const int i2 = (i + 2) % 3;
      const int j1 = 3 * ((j + 1) % 3);
      const int j2 = 3 * ((j + 2) % 3);
      double* const cofactor = cofactors_.row[i + 3 * j];
      for (int p = 0; p < kPoints; ++p) {
        cofactor[p] =
            f[i1 + j1][p] * f[i2 + j2][p] - f[i1 + j2][p] * f[i2 + j1][p];
      }
    }
  }
}

PointNumbers MeanDilatation::Work(const PointMatrices& stresses) const {
  PointNumbers work = {};
  for (int n = 0; n < entries_.size; ++n) {
    const double* const stress = stresses.row[entries_.places[n]];
    const double* const f = f_.row[entries_.places[n]];
    for (int p = 0; p < kPoints; ++p) {
      work.row[0][p] += scale_.row[0][p] * stress[p] * f[p];
    }
  }
  return work;
}

PointNumbers MeanDilatation::Fit(const PointNumbers& values) const {
  PointNumbers fit = {};
  for (int a = 0; a < points_.num_polynomials; ++a) {
    const double* const polynomial = points_.polynomials.row[a];
    for (int first = 0; first < points_.num_points;
         first += points_.per_element) {
      double amount = 0;
      for (int p = first; p < first + points_.per_element; ++p) {
        amount += points_.volumes.row[0][p] * polynomial[p] * values.row[0][p];
      }
      for (int p = first; p < first + points_.per_element; ++p) {
        fit.row[0][p] += amount * polynomial[p];
      }
    }
  }
  return fit;
}

PointNumbers MeanDilatation::Pressures(const PointNumbers& work) const {
  PointNumbers values;
  for (int p = 0; p < kPoints; ++p) {
    values.row[0][p] = work.row[0][p] / (3 * theta_.row[0][p]);
  }
  return Fit(values);
}

void MeanDilatation::ReplaceStresses(PointMatrices& stresses) const {
  const PointNumbers work = Work(stresses);
  PointNumbers pressures = Pressures(work);
  for (int p = 0; p < kPoints; ++p) {
    pressures.row[0][p] -= work.row[0][p] / (3 * jacobian_.row[0][p]);
  }
  for (int n = 0; n < entries_.in_plane; ++n) {
    double* const stress = stresses.row[entries_.places[n]];
    const double* const cofactor = cofactors_.row[entries_.places[n]];
    for (int p = 0; p < kPoints; ++p) {
      stress[p] =
          scale_.row[0][p] * stress[p] + pressures.row[0][p] * cofactor[p];
    }
  }
}

MeanDilatation::StretchedTangent MeanDilatation::Stretch(
    const PointMatrices& stresses, const PointTangents& tangents) const {
  StretchedTangent stretch;
  stretch.pulled = {};
  stretch.of_stretch = {};
  for (int n = 0; n < entries_.size; ++n) {
    const int a = entries_.places[n];
    double* const pulled = stretch.pulled.row[a];
    for (int m = 0; m < entries_.size; ++m) {
      const int b = entries_.places[m];
      const double* const tangent = tangents.row[TangentRow(a, b)];
      for (int p = 0; p < kPoints; ++p) {
        pulled[p] += tangent[p] * f_.row[b][p];
      }
    }
    for (int p = 0; p < kPoints; ++p) {
      const double s = scale_.row[0][p];
      const double stretched = s * s * pulled[p];
      stretch.of_stretch.row[0][p] += f_.row[a][p] * stretched;
      pulled[p] = stretched + s * stresses.row[a][p];
      stretch.g.row[a][p] = cofactors_.row[a][p] / jacobian_.row[0][p];
    }
  }
  return stretch;
}

void MeanDilatation::SetCurvature(const PointMatrices& stresses,
                                  const PointTangents& tangents,
                                  Curvature& curvature) const {
  // With sigma = dTheta / (3 Theta) - F^-T : dF / 3,
  //
  //   dFbar = s (dF + sigma F),
  //   Pbar : d2Fbar = pi (sigma^2 + dsigma) + 2 s sigma Pbar : dF,
  //   dsigma = (d2Theta / Theta - (dTheta / Theta)^2
  //             + tr(F^-1 dF F^-1 dF)) / 3,
  //
  // and the sum of v pi d2Theta / (3 Theta) over the points is that of v p d2J.
  // The tangent T acts on dF - F (F^-T : dF) / 3, which adds outer products of
  // G = F^-T and s^2 T F to s^2 T.
  const PointNumbers work = Work(stresses);
  const PointNumbers pressures = Pressures(work);
  const StretchedTangent stretched = Stretch(stresses, tangents);
  const PointMatrices& g = stretched.g;
  const PointMatrices& pulled = stretched.pulled;
  PointNumbers twist;      // The factor of tr(F^-1 dF F^-1 dF).
  PointNumbers of_g;       // The factor of the outer product of G.
  PointNumbers sum_third;  // (F : s^2 T F + pi) / 3.
  PointNumbers per_theta;  // 1 / (3 Theta).
  for (int p = 0; p < kPoints; ++p) {
    const double sum = stretched.of_stretch.row[0][p] + work.row[0][p];
    const double theta = theta_.row[0][p];
    const double of_volume = pressures.row[0][p] * jacobian_.row[0][p];
    twist.row[0][p] = work.row[0][p] / 3 - of_volume;
    of_g.row[0][p] = (sum / 9 + of_volume) / 2;
    sum_third.row[0][p] = sum / 3;
    per_theta.row[0][p] = 1 / (3 * theta);
    curvature.dilatation.row[0][p] =
        (sum / 9 - work.row[0][p] / 3) / (theta * theta);
  }
  PointMatrices beside;  // The outer product with G, and its transpose.
  for (int n = 0; n < entries_.in_plane; ++n) {
    const int a = entries_.places[n];
    for (int p = 0; p < kPoints; ++p) {
      beside.row[a][p] = of_g.row[0][p] * g.row[a][p] - pulled.row[a][p] / 3;
      curvature.coupling.row[a][p] =
          (pulled.row[a][p] - sum_third.row[0][p] * g.row[a][p]) *
          per_theta.row[0][p];
    }
  }
  for (int n = 0; n < entries_.in_plane; ++n) {
    const int a = entries_.places[n];
    for (int m = 0; m <= n; ++m) {
      const int b = entries_.places[m];
      const double* const ga = g.row[a];
      const double* const gb = g.row[b];
      const double* const cross_a = g.row[a % 3 + 3 * (b / 3)];
      const double* const cross_b = g.row[b % 3 + 3 * (a / 3)];
      const double* const tangent = tangents.row[TangentRow(a, b)];
      double* const local = curvature.local.row[TangentRow(a, b)];
      for (int p = 0; p < kPoints; ++p) {
        const double s = scale_.row[0][p];
        local[p] = s * s * tangent[p] + beside.row[a][p] * gb[p] +
                   ga[p] * beside.row[b][p] +
                   twist.row[0][p] * cross_a[p] * cross_b[p];
      }
    }
  }
}

}  // namespace elastimate
