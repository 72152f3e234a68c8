#ifndef ELASTIMATE_PYTHON_PYTHON_LAW_H_
#define ELASTIMATE_PYTHON_PYTHON_LAW_H_

#include <pybind11/pybind11.h>

#include <string>
#include <vector>

#include "elastimate/core/laws/law.h"

namespace elastimate {

/// A parameter that a law of Python names.
struct PythonLawParameter {
  std::string name;
  std::string symbol;
  bool is_modulus;
  double lower;
  double upper;
  double typical;
};

/// A law of small strains whose functions are methods of an object of Python
/// (elastimate.Law).  Each call takes the lock of the interpreter, so that
/// threads which hold it must not wait for this law.
class PythonLaw : public Law {
 public:
  PythonLaw(const pybind11::object& object, std::string name,
            std::string description, std::vector<PythonLawParameter> parameters,
            int num_moduli, std::vector<SectionModel> sections);

  std::string_view Name() const override { return name_; }
  std::string_view Description() const override { return description_; }
  const std::vector<LawParameter>& Parameters() const override {
    return parameters_;
  }
  int NumModuli() const override { return num_moduli_; }
  bool Takes(SectionModel model) const override;

  Eigen::VectorXd Energies(const Eigen::MatrixXd& gradient,
                           SectionModel model) const override;
  Eigen::MatrixXd Stresses(const Eigen::MatrixXd& gradient,
                           SectionModel model) const override;
  Eigen::MatrixXd Tangent(const Eigen::VectorXd& moduli,
                          const Eigen::MatrixXd& gradient,
                          SectionModel model) const override;
  Eigen::VectorXd Moduli(const Eigen::VectorXd& parameters,
                         SectionModel model) const override;
  Eigen::MatrixXd ModuliJacobian(const Eigen::VectorXd& parameters,
                                 SectionModel model) const override;
  Eigen::VectorXd ParametersOf(const Eigen::VectorXd& moduli,
                               SectionModel model) const override;

 private:
  /// A registered law lasts until the program ends, when there may be no
  /// interpreter any more, so the object is never released.
  pybind11::handle object_;
  std::string name_;
  std::string description_;
  std::vector<PythonLawParameter> names_;
  std::vector<LawParameter> parameters_;  ///< Refer to `names_`.
  int num_moduli_;
  std::vector<SectionModel> sections_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_PYTHON_PYTHON_LAW_H_
