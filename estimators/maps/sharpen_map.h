#ifndef ELASTIMATE_ESTIMATORS_MAPS_SHARPEN_MAP_H_
#define ELASTIMATE_ESTIMATORS_MAPS_SHARPEN_MAP_H_

#include "elastimate/estimators/maps/field_prior.h"
#include "elastimate/estimators/maps/map_problem.h"
#include "elastimate/estimators/maps/smooth_map.h"

namespace elastimate {

/// Sharpens a smooth map to one that is nearly constant between few jumps.  It
/// minimises, with sigma of the smooth map,
///
///   |r|^2 / (2 sigma^2) + alpha sum_f a_f ((j_f^2 + beta^2)^(1/2) - beta)
///
/// over the facets f of the area a_f, where j_f is the jump of ln E and
/// beta = 0.02.  Gauss-Newton steps solve
///
///   (S^T Pi S / sigma^2 + alpha R) delta = S^T Pi r / sigma^2 - alpha R m,
///   R = sum_f w_f (e_a - e_b)(e_a - e_b)^T,   w_f = a_f / (j_f^2 +
///   beta^2)^(1/2)
///
/// by conjugate gradients, preconditioned by alpha R and the leading modes of
/// the smooth map.  alpha is where the penalty is gamma of the smooth map
/// [Vogel & Oman, SIAM J. Sci. Comput. 17 (1996) 227].  Returns the sharpened
/// state, where the model is afterwards.  Precondition: the model is at the
/// smooth map.  Cost: a factorisation and some tens of solves in each of at
/// most 20 steps.
[[nodiscard]] MapState SharpenMap(const MapProblem& problem,
                                  const FieldPrior& prior,
                                  const SmoothMap& smooth);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MAPS_SHARPEN_MAP_H_
