#ifndef ELASTIMATE_CORE_MATERIALS_LAWS_H_
#define ELASTIMATE_CORE_MATERIALS_LAWS_H_

#include <string>
#include <string_view>
#include <vector>

#include "elastimate/core/materials/law.h"

namespace elastimate {

/// Every law, in the order in which people see them.
const std::vector<const Law*>& Laws();

/// "isotropic, ...", for messages.
std::string LawNames();

/// What is wrong with the value of a parameter of a law: "must be positive and
/// finite"; empty when nothing is.
std::string WhyOutOfRange(const LawParameter& parameter, double value);

/// The law of this name; null when there is none.
const Law* FindLaw(std::string_view name);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MATERIALS_LAWS_H_
