#include "elastimate/core/materials/law_check.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <set>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/materials/kelvin_law.h"
#include "elastimate/core/materials/stiffness_factors.h"
#include "elastimate/core/text/numbers.h"

namespace elastimate {
namespace {

constexpr double kLargestDifferenceDeviation = 1e-6;
constexpr double kLargestDeviation = 1e-9;
// At this step the error of a central difference, which is of the order of the
// square of the step, is about that of rounding.
constexpr double kStep = 1e-5;

double LargestEntry(const Eigen::MatrixXd& values) {
  return values.size() == 0 ? 0 : values.cwiseAbs().maxCoeff();
}

// The largest difference, relative to the largest entry of either; infinite
// where not all are finite.
double Deviation(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  if (!a.allFinite() || !b.allFinite()) {
    return std::numeric_limits<double>::infinity();
  }
  const double scale = std::max(LargestEntry(a), LargestEntry(b));
  return scale == 0 ? 0 : LargestEntry(a - b) / scale;
}

// Returns the derivatives of a function of a vector, one column for each
// component of the vector.
template <class Function>
Eigen::MatrixXd CentralDifferences(const Function& function,
                                   const Eigen::VectorXd& at) {
  Eigen::MatrixXd derivatives;
  for (Eigen::Index i = 0; i < at.size(); ++i) {
    const double step = kStep * (at(i) == 0 ? 1 : std::abs(at(i)));
    const Eigen::VectorXd change = step * Eigen::VectorXd::Unit(at.size(), i);
    const Eigen::VectorXd more = function(at + change);
    const Eigen::VectorXd less = function(at - change);
    if (i == 0) {
      derivatives.resize(more.size(), at.size());
    }
    derivatives.col(i) = (more - less) / (2 * step);
  }
  return derivatives;
}

// A gradient without symmetry.
Eigen::MatrixXd AnyGradient(Eigen::Index dimension) {
  return Eigen::MatrixXd::NullaryExpr(
      dimension, dimension, [](Eigen::Index i, Eigen::Index j) {
        return 0.1 * std::sin(1 + 2.3 * double(i) + 5.1 * double(j));
      });
}

// Returns parameters near the typical ones: ratios and stiffnesses are
// multiplied by factors that differ from one parameter to the next.
Eigen::VectorXd ParametersNearTypical(const Law& law) {
  const std::vector<LawParameter>& parameters = law.Parameters();
  return Eigen::VectorXd::NullaryExpr(
      Eigen::Index(parameters.size()), [&](Eigen::Index i) {
        return parameters[i].typical * (1 - 0.2 * std::abs(std::sin(i + 1.0)));
      });
}

Eigen::VectorXd TypicalValues(const Law& law) {
  Eigen::VectorXd typical(Eigen::Index(law.Parameters().size()));
  for (Eigen::Index i = 0; i < typical.size(); ++i) {
    typical(i) = law.Parameters()[i].typical;
  }
  return typical;
}

// Collects what is wrong with a law in one section.
class SectionCheck {
 public:
  SectionCheck(const Law& law, SectionModel model,
               std::vector<std::string>& sentences)
      : law_(law),
        model_(model),
        dimension_(model == SectionModel::kSolid ? 3 : 2),
        sentences_(sentences) {}

  void Run() {
    const Eigen::VectorXd typical = TypicalValues(law_);
    if (!CheckShapes(typical)) {
      return;
    }
    const std::size_t before = sentences_.size();
    CheckAt(typical, "the typical parameters");
    if (sentences_.size() == before) {
      CheckAt(ParametersNearTypical(law_), "parameters near the typical ones");
    }
  }

 private:
  void Say(const std::string& sentence) {
    sentences_.push_back("the law '" + std::string(law_.Name()) + "' in " +
                         std::string(SectionModelName(model_)) + ": " +
                         sentence);
  }

  // Says that two things differ where they do, or are not finite.
  void Compare(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b,
               double largest, const std::string& sentence) {
    const double deviation = Deviation(a, b);
    if (!(deviation <= largest)) {
      Say(sentence + " (they differ by " + Percent(deviation) + " at " +
          where_ + ")");
    }
  }

  bool HasShape(const Eigen::MatrixXd& result, Eigen::Index rows,
                Eigen::Index cols, const std::string& name) {
    const auto shape = [](Eigen::Index r, Eigen::Index c) {
      return std::to_string(r) + " x " + std::to_string(c);
    };
    if (result.rows() != rows || result.cols() != cols) {
      Say(name + " returns " + shape(result.rows(), result.cols()) +
          " numbers; it must return " + shape(rows, cols));
      return false;
    }
    if (!result.allFinite()) {
      Say(name + " returns numbers that are not finite at typical values");
      return false;
    }
    return true;
  }

  bool CheckShapes(const Eigen::VectorXd& parameters) {
    const Eigen::Index size = dimension_ * dimension_;
    const Eigen::Index num_moduli = law_.NumModuli();
    const Eigen::MatrixXd gradient = AnyGradient(dimension_);
    const Eigen::VectorXd moduli = law_.Moduli(parameters, model_);
    if (!HasShape(moduli, num_moduli, 1, "Moduli")) {
      return false;
    }
    bool are_right =
        HasShape(law_.Energies(gradient, model_), num_moduli, 1, "Energies");
    are_right &=
        HasShape(law_.Stresses(gradient, model_), size, num_moduli, "Stresses");
    are_right &=
        HasShape(law_.Tangent(moduli, gradient, model_), size, size, "Tangent");
    are_right &= HasShape(law_.ModuliJacobian(parameters, model_), num_moduli,
                          parameters.size(), "ModuliJacobian");
    are_right &= HasShape(law_.ParametersOf(moduli, model_), parameters.size(),
                          1, "ParametersOf");
    return are_right;
  }

  void CheckAt(const Eigen::VectorXd& parameters, const std::string& where) {
    where_ = where;
    const Eigen::VectorXd moduli = law_.Moduli(parameters, model_);
    CheckStress(moduli);
    CheckTangent(moduli);
    CheckChart(parameters, moduli);
    CheckBlocks(moduli);
  }

  void CheckStress(const Eigen::VectorXd& moduli) {
    const Eigen::MatrixXd gradient = AnyGradient(dimension_);
    const auto as_matrix = [this](const Eigen::VectorXd& h) {
      return Eigen::MatrixXd(h.reshaped(dimension_, dimension_));
    };
    const Eigen::MatrixXd stresses = law_.Stresses(gradient, model_);
    const Eigen::MatrixXd slopes = CentralDifferences(
        [&](const Eigen::VectorXd& h) {
          return law_.Energies(as_matrix(h), model_);
        },
        gradient.reshaped());
    for (Eigen::Index k = 0; k < stresses.cols(); ++k) {
      Compare(slopes.row(k).transpose(), stresses.col(k),
              kLargestDifferenceDeviation,
              "column " + std::to_string(k) +
                  " of Stresses is not the derivative of entry " +
                  std::to_string(k) + " of Energies by the gradient");
    }
    Compare(CentralDifferences(
                [&](const Eigen::VectorXd& h) {
                  return Eigen::VectorXd(law_.Stresses(as_matrix(h), model_) *
                                         moduli);
                },
                gradient.reshaped()),
            law_.Tangent(moduli, gradient, model_), kLargestDifferenceDeviation,
            "Tangent is not the derivative of the stress by the gradient");
    if (law_.ForLargeStrains() == nullptr) {
      Compare(law_.Stresses(2 * gradient, model_), 2 * stresses,
              kLargestDeviation,
              "the stress of twice the gradient is not twice the stress; make "
              "the stress linear in the gradient, or derive the law from "
              "LargeStrainLaw");
    } else {
      CheckObjectivity(gradient, stresses);
      const Eigen::MatrixXd tangent = law_.Tangent(moduli, gradient, model_);
      Compare(tangent, tangent.transpose(), kLargestDeviation,
              "Tangent is not symmetric");
    }
    const Eigen::MatrixXd rest = Eigen::MatrixXd::Zero(dimension_, dimension_);
    if (!law_.Stresses(rest, model_).isZero(0) ||
        !law_.Energies(rest, model_).isZero(0)) {
      Say("stress or energy is not zero where the gradient is zero");
    }
  }

  void CheckObjectivity(const Eigen::Matrix3d& gradient,
                        const Eigen::MatrixXd& stresses) {
    const Eigen::Matrix3d rotation =
        Eigen::AngleAxisd(1, Eigen::Vector3d(1, 2, 3).normalized())
            .toRotationMatrix();
    const Eigen::Matrix3d identity = Eigen::Matrix3d::Identity();
    const Eigen::MatrixXd turned =
        law_.Stresses(rotation * (identity + gradient) - identity, model_);
    for (Eigen::Index k = 0; k < stresses.cols(); ++k) {
      Compare(turned.col(k),
              (rotation * stresses.col(k).reshaped(3, 3)).reshaped(),
              kLargestDeviation,
              "the stress of a turned deformation is not the turned stress in "
              "column " +
                  std::to_string(k) + " of Stresses");
    }
  }

  void CheckTangent(const Eigen::VectorXd& moduli) {
    const Eigen::MatrixXd tangent = law_.Tangent(
        moduli, Eigen::MatrixXd::Zero(dimension_, dimension_), model_);
    Compare(tangent, tangent.transpose(), kLargestDeviation,
            "Tangent is not symmetric");
    // These are orthonormal symmetric gradients, as columns.
    const Eigen::MatrixXd strains =
        KelvinStrainOfGradient(dimension_).transpose();
    const Eigen::VectorXd eigenvalues =
        DecomposeSymmetric(strains.transpose() *
                           (tangent + tangent.transpose()) * strains / 2)
            .values;
    if (!(eigenvalues(0) > kLargestDeviation * LargestEntry(tangent))) {
      Say("the stiffness is not positive definite at " + where_ +
          ": its eigenvalues on strains range from " +
          NumberText(eigenvalues(0)) + " to " +
          NumberText(eigenvalues(eigenvalues.size() - 1)));
    }
    Compare(tangent * strains * strains.transpose(), tangent, kLargestDeviation,
            "Tangent resists rotations, which are gradients of H = -H^T");
  }

  // Returns the units in which the sizes of the parameters are measured.
  Eigen::VectorXd UnitsOf(const Eigen::VectorXd& parameters) const {
    return Eigen::VectorXd::NullaryExpr(parameters.size(), [&](Eigen::Index i) {
      const LawParameter& parameter = law_.Parameters()[i];
      if (parameter.beside) {
        const auto [row, column] = *parameter.beside;
        return std::sqrt(parameters(row) * parameters(column));
      }
      return parameter.is_modulus ? parameters(i) : 1.0;
    });
  }

  void CheckChart(const Eigen::VectorXd& parameters,
                  const Eigen::VectorXd& moduli) {
    // Moduli are compared in units of the parameters, since pressures and
    // ratios differ in size.
    const Eigen::VectorXd units = UnitsOf(parameters);
    Compare(
        CentralDifferences(
            [&](const Eigen::VectorXd& p) { return law_.Moduli(p, model_); },
            parameters) *
            units.asDiagonal(),
        law_.ModuliJacobian(parameters, model_) * units.asDiagonal(),
        kLargestDifferenceDeviation,
        "ModuliJacobian is not the derivative of Moduli by the parameters");
    Compare(law_.ParametersOf(moduli, model_).cwiseQuotient(units),
            parameters.cwiseQuotient(units), kLargestDeviation,
            "ParametersOf(Moduli(p)) is not p");
    constexpr double kFactor = 1e3;
    Eigen::VectorXd scaled = parameters;
    for (Eigen::Index i = 0; i < scaled.size(); ++i) {
      const LawParameter& parameter = law_.Parameters()[i];
      if (parameter.is_modulus || parameter.beside) {
        scaled(i) *= kFactor;
      }
    }
    Compare(law_.Moduli(scaled, model_), kFactor * moduli, kLargestDeviation,
            "in another unit of pressure the moduli are those of another "
            "material: Moduli must be proportional to the stiffnesses among "
            "the parameters");
  }

  void CheckBlocks(const Eigen::VectorXd& moduli) {
    const std::vector<BlockEntry>& entries = law_.BlockEntries();
    if (entries.empty()) {
      return;
    }
    if (Eigen::Index(entries.size()) != moduli.size()) {
      Say("BlockEntries has " + std::to_string(entries.size()) +
          " entries; it must have one for each of the " +
          std::to_string(moduli.size()) + " moduli, or none");
      return;
    }
    for (const BlockEntry& entry : entries) {
      if (entry.row < 0 || entry.row > entry.column) {
        Say("BlockEntries has an entry in row " + std::to_string(entry.row) +
            " and column " + std::to_string(entry.column) +
            "; it must have 0 <= row <= column");
        return;
      }
    }
    const Eigen::MatrixXd stiffness = BlocksOfModuli(entries, moduli);
    const double smallest = DecomposeSymmetric(stiffness).values(0);
    if (!(smallest > kLargestDeviation * LargestEntry(stiffness))) {
      Say("the matrix of BlockEntries is not positive definite at " + where_ +
          ": its smallest eigenvalue is " + NumberText(smallest));
    }
  }

  const Law& law_;
  SectionModel model_;
  Eigen::Index dimension_;
  std::vector<std::string>& sentences_;
  std::string where_;
};

// Checks what a law declares, without evaluating it.
std::vector<std::string> CheckDeclaration(const Law& law) {
  std::vector<std::string> sentences;
  const std::string subject = "the law '" + std::string(law.Name()) + "' ";
  const auto say = [&](const std::string& predicate) {
    sentences.push_back(subject + predicate);
  };
  if (law.Name().empty()) {
    say("has no name; return one from Name()");
  }
  if (law.NumModuli() < 1 || law.Parameters().empty()) {
    say("has no moduli or no parameters; it needs one of each at least");
  }
  if (std::none_of(std::begin(kAllSectionModels), std::end(kAllSectionModels),
                   [&](SectionModel model) { return law.Takes(model); })) {
    say("takes no section; return true from Takes() for one at least");
  }
  std::set<std::string_view> names;
  const int num_parameters = int(law.Parameters().size());
  for (const LawParameter& parameter : law.Parameters()) {
    const std::string name(parameter.name);
    if (name.empty() || parameter.symbol.empty()) {
      say("has a parameter without a name or a symbol");
    } else if (!names.insert(parameter.name).second) {
      say("has two parameters named '" + name + "'");
    }
    if (!(parameter.lower < parameter.typical &&
          parameter.typical < parameter.upper)) {
      say("has a typical value of '" + name + "', " +
          NumberText(parameter.typical) +
          ", that is not within its range, which is " +
          NumberText(parameter.lower) + " to " + NumberText(parameter.upper));
    }
    if (parameter.is_modulus && !(parameter.lower > 0)) {
      say("has a modulus '" + name + "' whose lower end is " +
          NumberText(parameter.lower) + "; it must be positive");
    }
    if (parameter.beside &&
        std::any_of(parameter.beside->begin(), parameter.beside->end(),
                    [&](int place) {
                      return place < 0 || place >= num_parameters ||
                             !law.Parameters()[place].is_modulus;
                    })) {
      say("has a stiffness '" + name +
          "' off the diagonal that is not beside two moduli; give the places "
          "of these among the parameters");
    }
  }
  return sentences;
}

}  // namespace

std::vector<std::string> CheckLaw(const Law& law) {
  std::vector<std::string> sentences = CheckDeclaration(law);
  if (!sentences.empty()) {
    return sentences;
  }
  for (const SectionModel model : kAllSectionModels) {
    // The section changes nothing of a law of large strains.
    if (law.Takes(model) &&
        (law.ForLargeStrains() == nullptr || model == SectionModel::kSolid)) {
      SectionCheck(law, model, sentences).Run();
    }
  }
  return sentences;
}

}  // namespace elastimate
