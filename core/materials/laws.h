#ifndef ELASTIMATE_CORE_MATERIALS_LAWS_H_
#define ELASTIMATE_CORE_MATERIALS_LAWS_H_

#include <string>
#include <string_view>
#include <vector>

#include "elastimate/core/materials/law.h"

namespace elastimate {

/// Every law, in the order in which people see them.  Two of one name take
/// different sections.
const std::vector<const Law*>& Laws();

/// "isotropic, ...", for messages; of those that take the section.
std::string LawNames();
std::string LawNames(SectionModel model);

/// What is wrong with the value of a parameter of a law: "must be positive and
/// finite"; empty when nothing is.
std::string WhyOutOfRange(const LawParameter& parameter, double value);

/// The first law of this name, which has all parameters that another of that
/// name has; null when there is none.
const Law* FindLaw(std::string_view name);

/// The law of this name that takes the section; null when there is none.
const Law* FindLaw(std::string_view name, SectionModel model);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MATERIALS_LAWS_H_
