#ifndef ELASTIMATE_CORE_MESH_AXIS_NAMES_H_
#define ELASTIMATE_CORE_MESH_AXIS_NAMES_H_

namespace elastimate {

// These are the names of the axes in messages.
inline constexpr const char* kAxisNames[3] = {"x", "y", "z"};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MESH_AXIS_NAMES_H_
