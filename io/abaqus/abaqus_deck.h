#ifndef ELASTIMATE_IO_ABAQUS_ABAQUS_DECK_H_
#define ELASTIMATE_IO_ABAQUS_ABAQUS_DECK_H_

#include <Eigen/Geometry>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "elastimate/io/abaqus/keyword_file.h"
#include "elastimate/io/mesh/numbered_mesh.h"

namespace elastimate {

/// A line of a set, or a number in it.
struct AbaqusEntry {
  /// The name of a set, "Part-1-1.Set-1" or "Part-1-1.12"; empty for numbers.
  std::string name;
  std::size_t first = 0;  ///< The numbers first, first + step, ..., last.
  std::size_t last = 0;
  std::size_t step = 1;
  std::string face;  ///< "S3" in a surface, in capital letters.
  /// The name is one of elements whose nodes make up a set.
  bool is_nodes_of_elements = false;
  std::size_t line = 0;
};

/// A set as a keyword of the file has it.  Several keywords may add to one set.
struct AbaqusSet {
  std::string name;
  NumberedSet::Members members;
  std::string instance;  ///< Of the part whose numbers it has.
  bool is_internal;      ///< One that Abaqus/CAE made for itself.
  std::vector<AbaqusEntry> entries;
  const KeywordBlock* block;
};

/// What stands in a part, or outside of parts.
struct AbaqusScope {
  NumberedMesh mesh;  ///< Without sets.
  std::vector<AbaqusSet> sets;
};

struct AbaqusInstance {
  std::string name;
  std::string part;
  Eigen::Affine3d placement = Eigen::Affine3d::Identity();
  const KeywordBlock* block = nullptr;
};

/// An Abaqus input file taken apart.
struct AbaqusDeck {
  AbaqusScope outside;  ///< Of parts: the assembly, or all of a flat file.
  /// The parts by their names in small letters.
  std::map<std::string, AbaqusScope> parts;
  std::vector<AbaqusInstance> instances;
  /// The thickness of planar elements is zero where no *SOLID SECTION says it.
  double thickness = 0;
  bool has_ties = false;  ///< Whether *TIE joins parts that share no nodes.
};

/// Takes the keywords apart that describe the mesh, and leaves others out.
/// Throws std::invalid_argument, naming the file and the line, for what cannot
/// be read, for keywords that generate nodes or elements, and where a part, an
/// instance or an assembly does not end.  `file` has to outlive the result.
AbaqusDeck ParseAbaqusDeck(const KeywordFile& file);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_ABAQUS_ABAQUS_DECK_H_
