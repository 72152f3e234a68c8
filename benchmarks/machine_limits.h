#ifndef ELASTIMATE_BENCHMARKS_MACHINE_LIMITS_H_
#define ELASTIMATE_BENCHMARKS_MACHINE_LIMITS_H_

namespace elastimate {

/// Holds what some threads of this machine reach in the best of several short
/// runs.  Kernels are compared with this roofline [Williams et al. 2009].
struct MachineLimits {
  /// This is the rate of a = b + s c on arrays beyond the caches [byte/s].  An
  /// element counts as 24 bytes; reading the line of a before it is written is
  /// not counted.
  double memory_bandwidth;
  /// This is the rate of independent fused multiply-adds of the widest vectors,
  /// each of which counts as two operations per lane [1/s].
  double peak_flops;
};

/// Takes about a second.
MachineLimits MeasureMachineLimits(int num_threads);

}  // namespace elastimate

#endif  // ELASTIMATE_BENCHMARKS_MACHINE_LIMITS_H_
