#ifndef ELASTIMATE_BENCHMARKS_PROCESSOR_TIME_H_
#define ELASTIMATE_BENCHMARKS_PROCESSOR_TIME_H_

namespace elastimate {

/// Seconds that all threads of this process have computed.  With one BLAS
/// thread a difference is the time that the work takes on an idle machine; on a
/// busy one the clock on the wall shows the other programs too.
double ProcessorSeconds();

}  // namespace elastimate

#endif  // ELASTIMATE_BENCHMARKS_PROCESSOR_TIME_H_
