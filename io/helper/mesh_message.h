#ifndef ELASTIMATE_IO_HELPER_MESH_MESSAGE_H_
#define ELASTIMATE_IO_HELPER_MESH_MESSAGE_H_

#include <cstdio>
#include <string>
#include <string_view>

#include "elastimate/io/mesh/mesh_file.h"

namespace elastimate {

/// The message of a helper program (io/helper/mesh_program.h).
struct MeshMessage {
  enum class Kind {
    kNone,         ///< Nothing, or not all: the program did not end well.
    kMesh,         ///< `mesh`.
    kWrongInput,   ///< `sentence` is that of an std::invalid_argument.
    kFailure,      ///< `sentence` is that of an std::runtime_error.
    kOutOfMemory,  ///< It met its limit of memory, or that of the machine.
  };

  bool has_started = false;  ///< It came as far as to limit itself.
  /// It was given less memory than its own limit.
  bool is_short_of_memory = false;
  Kind kind = Kind::kNone;
  MeshFile mesh;  ///< Without its path and the nodes in use.
  std::string sentence;
};

/// The first part of a message, written before anything can go wrong.
void WriteStart(std::FILE* file, bool is_short_of_memory);

/// The second part: a mesh, or a sentence.  These write errors nowhere: a
/// message that is not whole is of Kind::kNone.
void WriteMesh(std::FILE* file, const MeshFile& mesh);
void WriteSentence(std::FILE* file, MeshMessage::Kind kind,
                   const std::string& sentence);

/// Returns what `bytes` say, whatever they are.  A message that is not whole,
/// or whose mesh is not one (sizes that disagree, nodes out of range), is of
/// Kind::kNone.
MeshMessage ParseMeshMessage(std::string_view bytes);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_HELPER_MESH_MESSAGE_H_
