#ifndef ELASTIMATE_TESTS_IO_VTK_FILES_H_
#define ELASTIMATE_TESTS_IO_VTK_FILES_H_

#include <filesystem>
#include <string>
#include <vector>

#include "elastimate/core/scene/scene.h"
#include "elastimate/io/vtk/vtu_writer.h"

namespace elastimate {

/// Says which form a VTK file has, XML or legacy, and how its data are kept.
struct VtkEncoding {
  std::string name;
  bool is_legacy;
  enum class Data { kAscii, kBinary, kAppendedRaw, kAppendedBase64 } data;
  enum class Compression { kNone, kZlib, kLz4, kLzma } compression;
  bool is_64_bit;      ///< Header of the XML form.
  bool is_big_endian;  ///< Byte order of the XML form.
  int version;         ///< The version of the legacy form, e.g. 42.

  std::string Extension() const { return is_legacy ? ".vtk" : ".vtu"; }
};

/// Returns one encoding of every kind that VTK writes.
std::vector<VtkEncoding> AllVtkEncodings();

/// Returns a small scene with regions, prescribed displacements and two load
/// cases, of which the second is partly observed.
Scene TwoTetrahedra();

/// Writes mesh and fields through VTK's own writers.
void WriteEncoded(const std::filesystem::path& path, const Mesh& mesh,
                  const Fields& fields, const VtkEncoding& encoding);

}  // namespace elastimate

#endif  // ELASTIMATE_TESTS_IO_VTK_FILES_H_
