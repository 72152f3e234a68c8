#ifndef ELASTIMATE_BENCHMARKS_MACHINE_LIMITS_H_
#define ELASTIMATE_BENCHMARKS_MACHINE_LIMITS_H_

namespace elastimate {

/// What some threads of this machine reach, the best of several short runs: the
/// roofline that kernels are compared with [Williams et al. 2009].
struct MachineLimits {
  /// What a = b + s c reaches on arrays beyond the caches, 24 byte for each
  /// element (what is read before it is written is not counted) [byte/s].
  double memory_bandwidth;
  /// What independent fused multiply-adds of the widest vectors reach [1/s].
  double peak_flops;
};

/// Takes about a second.
MachineLimits MeasureMachineLimits(int num_threads);

}  // namespace elastimate

#endif  // ELASTIMATE_BENCHMARKS_MACHINE_LIMITS_H_
