#ifndef ELASTIMATE_IO_SCENE_ORIGIN_H_
#define ELASTIMATE_IO_SCENE_ORIGIN_H_

#include <optional>
#include <string_view>

#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// The names of origins, for sentences.
inline constexpr const char* kOrigins = "\"measured\" or \"computed\"";

/// "measured" or "computed".
std::string_view NameOf(Origin origin);
/// The origin of such a name; empty for other names.
std::optional<Origin> OriginOfName(std::string_view name);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_SCENE_ORIGIN_H_
