#ifndef ELASTIMATE_IO_REPORT_PARAMETERS_FILE_H_
#define ELASTIMATE_IO_REPORT_PARAMETERS_FILE_H_

#include <Eigen/Core>
#include <filesystem>

#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// Reads the parameters of the materials of a scene, in the order of
/// MaterialParameters, from a JSON file with a list "parameters" of objects
/// with "name", "region" (null or absent for one material of the whole mesh, an
/// id, or a list of ids) and "value", as reports have them.  Other keys are
/// ignored.
///
/// Throws std::invalid_argument with one sentence, naming the file and the
/// entry, for what is no parameter of a material of the scene, is given twice,
/// out of the range of its law, or missing.
[[nodiscard]] Eigen::VectorXd ReadParameters(const std::filesystem::path& path,
                                             const Scene& scene);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_REPORT_PARAMETERS_FILE_H_
