#ifndef ELASTIMATE_APPS_NUMBER_LIST_H_
#define ELASTIMATE_APPS_NUMBER_LIST_H_

#include <Eigen/Core>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "apps/flag_parser.h"

namespace elastimate {

/// Returns what stands between the commas of a list.
inline std::vector<std::string> WordsOf(const std::string& list) {
  std::vector<std::string> words;
  std::istringstream stream(list);
  for (std::string word; std::getline(stream, word, ',');) {
    words.push_back(word);
  }
  return words;
}

/// Returns the value of a flag as `count` numbers (as many as `Vector` has,
/// where that is fixed), separated by commas; `kind` names them, such as
/// "finite numbers".  Throws std::invalid_argument, naming the flag, for
/// anything else.
template <typename Vector>
Vector NumberList(const std::string& flag, const std::string& value,
                  const std::string& kind,
                  Eigen::Index count = Vector::SizeAtCompileTime) {
  std::istringstream text(value);
  Vector numbers(count);
  bool is_read = true;
  for (Eigen::Index i = 0; i < count; ++i) {
    char comma = ',';
    is_read = is_read && (i == 0 || bool(text >> comma)) && comma == ',' &&
              bool(text >> numbers(i));
  }
  if (!is_read || text.peek() != std::istringstream::traits_type::eof()) {
    const std::string words[] = {"one", "two", "three", "four", "five", "six"};
    std::string example = "1";
    for (Eigen::Index i = 2; i <= count; ++i) {
      example += "," + std::to_string(i);
    }
    throw std::invalid_argument(AsGiven(flag) + "; it needs " +
                                words[count - 1] + " " + kind + ", as in --" +
                                flag + "=" + example);
  }
  return numbers;
}

}  // namespace elastimate

#endif  // ELASTIMATE_APPS_NUMBER_LIST_H_
