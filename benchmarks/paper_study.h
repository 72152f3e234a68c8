#ifndef ELASTIMATE_BENCHMARKS_PAPER_STUDY_H_
#define ELASTIMATE_BENCHMARKS_PAPER_STUDY_H_

#include "apps/progress.h"
#include "benchmarks/study.h"

namespace elastimate {

/// The five experiments of Becker & Teschner 2007, sections 5.1 to 5.5
/// (figures 3 to 7), with the paper's method beside reduced-fe and the
/// Cramer-Rao bound:
///
///   paper_noise               noise of increasing magnitude; with it,
///                             paper_noise_prediction: what theory says
///   paper_spatial_noise       many noises of one magnitude
///   paper_measurements        1 to 20 measurements of one force
///   paper_forces              1 to 20 different forces
///   paper_organ               an organ, nu <= 0.3
///   paper_cuboid_choice       how the first depends on what the paper does
///                             not state: the cuboid's shape and supports
///   paper_findings            what the paper states against what is found
///
/// All noise is uniform.
StudyResult RunPaperStudy(bool is_quick, Progress& progress);

}  // namespace elastimate

#endif  // ELASTIMATE_BENCHMARKS_PAPER_STUDY_H_
