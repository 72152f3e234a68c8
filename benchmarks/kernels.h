#ifndef ELASTIMATE_BENCHMARKS_KERNELS_H_
#define ELASTIMATE_BENCHMARKS_KERNELS_H_

#include <string>
#include <vector>

#include "apps/progress.h"
#include "benchmarks/study.h"

namespace elastimate {

/// Holds the times of the kernels.
struct KernelTimes {
  StudyResult result;
  /// Each line compares two of the times of this run.
  std::vector<std::string> ratios;
  /// Each line names a recorded bound that this run missed.
  std::vector<std::string> regressions;
};

/// Times the element pass (naive, scalar, vector; natural, random and reordered
/// numbering; one and eight columns; one and two threads), assembly and the
/// closed form on cubes of 10 000 to a million tetrahedra, beside the memory
/// bandwidth and the peak flops of the same run; and the passes of the other
/// element kinds beside the textbook's; and the forces and tangents of large
/// strains beside those of small ones.  `is_quick` stops at 100 000.
KernelTimes TimeKernels(bool is_quick, Progress& progress);

}  // namespace elastimate

#endif  // ELASTIMATE_BENCHMARKS_KERNELS_H_
