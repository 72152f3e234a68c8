#ifndef ELASTIMATE_BENCHMARKS_MAPS_STUDY_H_
#define ELASTIMATE_BENCHMARKS_MAPS_STUDY_H_

#include "apps/progress.h"
#include "benchmarks/study.h"

namespace elastimate {

/// How well a map of Young's modulus is found, on unit squares in plane strain
/// that were computed by the elements of the fit:
///
///   maps_stages       the error of each stage against the noise, for an
///                     inclusion and a gradient
///   maps_contrast     which part of the contrast of an inclusion a smooth map
///                     shows, against its diameter
///   maps_time         time against the number of supported parameters
///
/// An error is |m - m_true| / |m_true| of m = ln E, both without their means.
/// Moduli of the local stage that are negative count by their magnitude.
StudyResult RunMapsStudy(bool is_quick, Progress& progress);

}  // namespace elastimate

#endif  // ELASTIMATE_BENCHMARKS_MAPS_STUDY_H_
