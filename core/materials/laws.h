#ifndef ELASTIMATE_CORE_MATERIALS_LAWS_H_
#define ELASTIMATE_CORE_MATERIALS_LAWS_H_

#include <Eigen/Core>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "elastimate/core/laws/law.h"

namespace elastimate {

/// Returns every law, in the order in which people see them: those of the
/// library, then those of RegisterLaw.  Two of one name take different
/// sections.  The laws stay where they are until the program ends.  May be
/// called from several threads at once.
[[nodiscard]] std::vector<const Law*> Laws();

/// Adds a law of the calling program, which materials can name from then on
/// (Material::law):
///
///   RegisterLaw(std::make_shared<MyLaw>());
///
/// Throws std::invalid_argument, and adds nothing, when the pointer is null,
/// when CheckLaw finds something wrong, which the sentence says, or when there
/// is a law of that name for a section that this one takes.  The cost is that
/// of CheckLaw.  May be called from several threads at once.
void RegisterLaw(std::shared_ptr<const Law> law);

/// "isotropic, ...", for messages; only laws that take the section, if it is
/// given.
[[nodiscard]] std::string LawNames(
    std::optional<SectionModel> model = std::nullopt);

/// What is wrong with the value of a parameter of a law: "must be positive and
/// finite"; empty when nothing is.
[[nodiscard]] std::string WhyOutOfRange(const LawParameter& parameter,
                                        double value);

/// The parameters of a law in its order, from their values by name.  Throws
/// std::invalid_argument when one is missing, is none of the law's, or is out
/// of range.
[[nodiscard]] Eigen::VectorXd ParametersByName(
    const Law& law, std::map<std::string, double> values);

/// The law of this name that takes the section; null when there is none.
/// Without a section, the first law of this name, which has all parameters that
/// another of that name has.
[[nodiscard]] const Law* FindLaw(
    std::string_view name, std::optional<SectionModel> model = std::nullopt);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MATERIALS_LAWS_H_
