#ifndef ELASTIMATE_BENCHMARKS_PAPER_FINDINGS_H_
#define ELASTIMATE_BENCHMARKS_PAPER_FINDINGS_H_

#include <vector>

#include "benchmarks/table.h"
#include "benchmarks/trial.h"

namespace elastimate {

/// A trial, and what was varied: a deviation of the displacement, or a number
/// of measurements or forces.
struct PaperTrial {
  double setting;
  Trial trial;
};

using PaperTrials = std::vector<PaperTrial>;

/// What the paper states against what the trials of its experiments show.
Table PaperFindings(const PaperTrials& noise, const PaperTrials& measurements,
                    const PaperTrials& forces, const PaperTrials& organ);

}  // namespace elastimate

#endif  // ELASTIMATE_BENCHMARKS_PAPER_FINDINGS_H_
