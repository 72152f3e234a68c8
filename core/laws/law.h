#ifndef ELASTIMATE_CORE_LAWS_LAW_H_
#define ELASTIMATE_CORE_LAWS_LAW_H_

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "elastimate/core/mesh/mesh.h"

namespace elastimate {

class LargeStrainLaw;

/// A parameter of a law, under the name that people know.
struct LawParameter {
  std::string_view name;    ///< Such as "youngs_modulus".
  std::string_view symbol;  ///< Such as "E".
  /// Whether it is a stiffness [pressure], positive without an upper limit,
  /// which is fitted as a logarithm; else it is a ratio [1].
  bool is_modulus;
  /// The closed range that fits search.
  double lower;
  double upper;
  /// A common value, where fits start.  A stiffness may have any unit here.
  double typical;
  /// This marks a stiffness that is no modulus because it may have either sign.
  /// It is measured in units of the geometric mean of two moduli, whose places
  /// among the parameters stand here.  In a law with BlockEntries it is off the
  /// diagonal, these are the diagonal stiffnesses in its row and in its column,
  /// and it is smaller than their mean.
  std::optional<std::array<int, 2>> beside = std::nullopt;
};

/// Places a modulus theta in the stiffness S on the modes of a material: S(row,
/// column) = factor theta, row <= column.  S has a block for each set of modes
/// that are not independent, and is positive definite when the stiffness is.
struct BlockEntry {
  int row;
  int column;
  double factor;
};

/// A law of elasticity gives the stress at a point, linear in its moduli theta,
///
///   P(H; theta) = sum_k theta_k P_k(H),   H = grad u (dimension x dimension,
///   H_ij = du_i / dx_j),
///
/// with P_k = dW_k / dH for energy densities W_k.  Its chart is the map
/// theta(p) from parameters p that people know.
///
/// CONTRIBUTING.md says how to add one, to the library or to a program of its
/// own (RegisterLaw).  CheckLaw tells what is wrong with it.  Its moduli are
/// free to choose: small strains make the estimation linear in them.
///
/// A law whose material is not alike in all directions speaks in the frame of
/// that material: its directions 1, 2 and 3 are those of the axes
/// (MaterialFrames).
///
/// Matrices over H have dimension^2 rows or columns, H in the order of its
/// columns; a law of large strains takes H of the solid in every section
/// (LargeStrainLaw).  All functions are pure.
class Law {
 public:
  virtual ~Law() = default;

  /// Such as "isotropic".
  virtual std::string_view Name() const = 0;
  /// One line for people.
  virtual std::string_view Description() const = 0;
  /// The parameters p of its chart.
  virtual const std::vector<LawParameter>& Parameters() const = 0;
  /// Returns the length of theta.
  virtual int NumModuli() const = 0;
  /// Tells whether the law covers such a section.
  virtual bool Takes(SectionModel model) const = 0;

  /// Returns this law if it describes deformations of any size, or null if it
  /// describes small strains only.
  virtual const LargeStrainLaw* ForLargeStrains() const { return nullptr; }

  /// Returns how many axes its material has.
  virtual int NumAxes() const { return 0; }
  /// Tells whether the material takes the axes of the scene where none are
  /// given.
  virtual bool HasAxesOfScene() const { return NumAxes() == 0; }
  /// Returns one entry for each modulus, by which fits keep the stiffness
  /// positive definite (stiffness_factors.h); none for laws that are fitted by
  /// their parameters.
  virtual const std::vector<BlockEntry>& BlockEntries() const {
    static const std::vector<BlockEntry> none;
    return none;
  }

  /// Returns W_k(H), one for each modulus [1].
  virtual Eigen::VectorXd Energies(const Eigen::MatrixXd& gradient,
                                   SectionModel model) const = 0;
  /// Returns P_k(H) as columns, dimension^2 x num_moduli [1].
  virtual Eigen::MatrixXd Stresses(const Eigen::MatrixXd& gradient,
                                   SectionModel model) const = 0;
  /// Returns dP / dH for these moduli, dimension^2 x dimension^2 [pressure]; it
  /// is constant for small strains.
  virtual Eigen::MatrixXd Tangent(const Eigen::VectorXd& moduli,
                                  const Eigen::MatrixXd& gradient,
                                  SectionModel model) const = 0;

  /// Returns theta(p) by plain formulas, which accept any numbers.
  virtual Eigen::VectorXd Moduli(const Eigen::VectorXd& parameters,
                                 SectionModel model) const = 0;
  /// Returns d theta / d p, num_moduli x num_parameters.
  virtual Eigen::MatrixXd ModuliJacobian(const Eigen::VectorXd& parameters,
                                         SectionModel model) const = 0;
  /// Returns the p of theta(p).
  virtual Eigen::VectorXd ParametersOf(const Eigen::VectorXd& moduli,
                                       SectionModel model) const = 0;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_LAWS_LAW_H_
