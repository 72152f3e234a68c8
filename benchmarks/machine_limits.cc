#include "benchmarks/machine_limits.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include "elastimate/estimators/interface/stopwatch.h"

// The rest of this file is compiled once for each kind of processor.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "benchmarks/machine_limits.cc"
#include <hwy/foreach_target.h>
// This header has to follow foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace elastimate {
namespace HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

// Returns the number of operations; `result` keeps them from being left out.
double MultiplyAdd(std::ptrdiff_t repetitions, double* result) {
  const hn::CappedTag<double, 8> d;
  // Ten independent sums hide the latency: 4 cycles times two operations per
  // cycle need at least eight.
  auto v0 = hn::Set(d, result[0]);
  auto v1 = v0, v2 = v0, v3 = v0, v4 = v0, v5 = v0, v6 = v0, v7 = v0, v8 = v0,
       v9 = v0;
  const auto factor = hn::Set(d, 0.5);
  for (std::ptrdiff_t i = 0; i < repetitions; ++i) {
    v0 = hn::MulAdd(v0, factor, factor);
    v1 = hn::MulAdd(v1, factor, factor);
    v2 = hn::MulAdd(v2, factor, factor);
    v3 = hn::MulAdd(v3, factor, factor);
    v4 = hn::MulAdd(v4, factor, factor);
    v5 = hn::MulAdd(v5, factor, factor);
    v6 = hn::MulAdd(v6, factor, factor);
    v7 = hn::MulAdd(v7, factor, factor);
    v8 = hn::MulAdd(v8, factor, factor);
    v9 = hn::MulAdd(v9, factor, factor);
  }
  const auto low = hn::Add(hn::Add(hn::Add(v0, v1), hn::Add(v2, v3)), v4);
  const auto high = hn::Add(hn::Add(hn::Add(v5, v6), hn::Add(v7, v8)), v9);
  result[0] = hn::GetLane(hn::SumOfLanes(d, hn::Add(low, high)));
  return 2.0 * 10 * static_cast<double>(repetitions * hn::Lanes(d));
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace elastimate
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace elastimate {
namespace {

HWY_EXPORT(MultiplyAdd);

constexpr int kRuns = 10;

// Returns the time of the fastest run [s].
template <class Work>
double ShortestTime(const Work& work) {
  double shortest = std::numeric_limits<double>::infinity();
  for (int run = 0; run < kRuns; ++run) {
    Stopwatch stopwatch;
    work();
    shortest = std::min(shortest, stopwatch.Lap());
  }
  return shortest;
}

double MemoryBandwidth(int num_threads) {
  constexpr std::ptrdiff_t kSize = std::ptrdiff_t{1} << 23;
  std::vector<double> a(kSize, 0);
  const std::vector<double> b(kSize, 1);
  const std::vector<double> c(kSize, 2);
  const double time = ShortestTime([&] {
#pragma omp parallel for num_threads(num_threads) schedule(static)
    for (std::ptrdiff_t i = 0; i < kSize; ++i) {
      a[i] = b[i] + 0.5 * c[i];
    }
  });
  return 3 * sizeof(double) * static_cast<double>(kSize) / time;
}

double PeakFlops(int num_threads) {
  constexpr std::ptrdiff_t kRepetitions = 1000000;
  const auto multiply_add = HWY_DYNAMIC_DISPATCH(MultiplyAdd);
  double operations = 0;
  double sum = 0;
  const double time = ShortestTime([&] {
    operations = 0;
#pragma omp parallel for num_threads(num_threads) reduction(+ : operations, sum)
    for (int thread = 0; thread < num_threads; ++thread) {
      double result = thread;
      operations += multiply_add(kRepetitions, &result);
      sum += result;
    }
  });
  return sum > 0 ? operations / time : 0;
}

}  // namespace

MachineLimits MeasureMachineLimits(int num_threads) {
  return {MemoryBandwidth(num_threads), PeakFlops(num_threads)};
}

}  // namespace elastimate
#endif
