#ifndef ELASTIMATE_BENCHMARKS_STUDY_H_
#define ELASTIMATE_BENCHMARKS_STUDY_H_

#include <nlohmann/json.hpp>
#include <vector>

#include "apps/progress.h"
#include "benchmarks/table.h"

namespace elastimate {

/// What a study found.
struct StudyResult {
  std::vector<Table> tables;
  /// What was chosen and is in no column, seeds above all.
  nlohmann::ordered_json parameters;
};

/// A study: everything random has a fixed seed.  `is_quick` asks for fewer
/// trials, not for other ones; `progress` is told what it is at.
using Study = StudyResult (*)(bool is_quick, Progress& progress);

}  // namespace elastimate

#endif  // ELASTIMATE_BENCHMARKS_STUDY_H_
