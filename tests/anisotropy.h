#ifndef ELASTIMATE_TESTS_ANISOTROPY_H_
#define ELASTIMATE_TESTS_ANISOTROPY_H_

#include <Eigen/Core>

#include "elastimate/core/laws/law.h"

namespace elastimate::testing {

/// Returns the stiffness of a law with these parameters in its own frame, in
/// the notation of Voigt (11, 22, 33, 23, 13, 12, or 11, 22, 12).  It is the
/// inverse of the textbook compliance of engineering constants; "anisotropic"
/// has its entries as parameters.  Shares no code with the library.
Eigen::MatrixXd TextbookStiffnessOf(const Law& law,
                                    const Eigen::VectorXd& parameters);

/// Returns a stiffness of Voigt as seen from outside of its frame, whose
/// directions are columns: c_ijkl = Q_ia Q_jb Q_kc Q_ld c_abcd.
Eigen::MatrixXd SeenFromOutside(const Eigen::MatrixXd& stiffness,
                                const Eigen::MatrixXd& frame);

/// Returns typical parameters of a law in this unit of pressure.  Each is
/// changed by another share of itself, so that no two are alike.
Eigen::VectorXd UnlikeTypical(const Law& law, double unit);

/// Returns constants of transversely_isotropic that is three times as stiff
/// along its axis.
Eigen::VectorXd ConstantsOfFibres();

/// Returns a rotation, dimension x dimension.  Each seed has other angles.
Eigen::MatrixXd RandomFrame(Eigen::Index dimension, unsigned seed);

}  // namespace elastimate::testing

#endif  // ELASTIMATE_TESTS_ANISOTROPY_H_
