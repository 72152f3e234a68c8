#ifndef ELASTIMATE_APPS_MATERIAL_CURVE_H_
#define ELASTIMATE_APPS_MATERIAL_CURVE_H_

namespace elastimate {

/// Prints, or writes to --out, the stress of the material that --curve names in
/// homogeneous deformations of many stretches.  Throws std::invalid_argument
/// when a flag is wrong.
void WriteMaterialCurve();

}  // namespace elastimate

#endif  // ELASTIMATE_APPS_MATERIAL_CURVE_H_
