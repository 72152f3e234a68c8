#ifndef ELASTIMATE_TESTS_ANISOTROPY_H_
#define ELASTIMATE_TESTS_ANISOTROPY_H_

#include <Eigen/Core>

#include "elastimate/core/materials/law.h"

namespace elastimate::testing {

/// The stiffness of a law with these parameters in its own frame, in the
/// notation of Voigt (11, 22, 33, 23, 13, 12, or 11, 22, 12): from the textbook
/// compliance of its engineering constants, of "anisotropic" the parameters
/// themselves.  Shares no code with the library.
Eigen::MatrixXd TextbookStiffnessOf(const Law& law,
                                    const Eigen::VectorXd& parameters);

/// A stiffness of Voigt seen from outside of its frame, whose directions are
/// columns: c_ijkl = Q_ia Q_jb Q_kc Q_ld c_abcd.
Eigen::MatrixXd SeenFromOutside(const Eigen::MatrixXd& stiffness,
                                const Eigen::MatrixXd& frame);

/// Typical parameters of a law in this unit of pressure, each changed by
/// another share of itself.
Eigen::VectorXd UnlikeTypical(const Law& law, double unit);

/// Constants of transversely_isotropic that is three times as stiff along its
/// axis.
Eigen::VectorXd ConstantsOfFibres();

/// A rotation by other angles for each seed: dimension x dimension.
Eigen::MatrixXd RandomFrame(Eigen::Index dimension, unsigned seed);

}  // namespace elastimate::testing

#endif  // ELASTIMATE_TESTS_ANISOTROPY_H_
