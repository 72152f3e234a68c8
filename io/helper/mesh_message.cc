#include "elastimate/io/helper/mesh_message.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>
#include <vector>

namespace elastimate {
namespace {

using Kind = MeshMessage::Kind;

// The programs at either end are of one build on one machine: numbers are
// written as they are in memory.
constexpr std::string_view kBegin = "elastimate mesh";
constexpr std::string_view kEnd = "end of mesh";
constexpr std::size_t kMaxSentence = 4096;

class Writer {
 public:
  explicit Writer(std::FILE* file) : file_(file) {}
  ~Writer() { std::fflush(file_); }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  void Bytes(const void* bytes, std::size_t size) {
    if (size > 0) {  // Of nothing, the address may be null.
      std::fwrite(bytes, 1, size, file_);
    }
  }
  void Mark(std::string_view mark) { Bytes(mark.data(), mark.size()); }
  void Number(std::int64_t number) { Bytes(&number, sizeof number); }
  void Text(const std::string& text) {
    Number(static_cast<std::int64_t>(text.size()));
    Mark(text);
  }
  void Texts(const std::vector<std::string>& texts) {
    Number(static_cast<std::int64_t>(texts.size()));
    for (const std::string& text : texts) {
      Text(text);
    }
  }
  template <typename Matrix>
  void Entries(const Matrix& matrix) {
    Number(matrix.rows());
    Number(matrix.cols());
    Bytes(matrix.data(), matrix.size() * sizeof(*matrix.data()));
  }
  template <typename Value>
  void Values(const std::vector<Value>& values) {
    Number(static_cast<std::int64_t>(values.size()));
    Bytes(values.data(), values.size() * sizeof(Value));
  }
  void Arrays(const std::vector<FileArray>& arrays) {
    Number(static_cast<std::int64_t>(arrays.size()));
    for (const FileArray& array : arrays) {
      Text(array.name);
      Entries(array.values);
    }
  }

 private:
  std::FILE* file_;
};

/// Takes a message apart, until something is missing or wrong.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : rest_(bytes) {}

  bool IsGood() const { return is_good_; }
  void Require(bool condition) { is_good_ = is_good_ && condition; }

  void Bytes(void* to, std::size_t size) {
    Require(size <= rest_.size());
    if (is_good_ && size > 0) {
      std::memcpy(to, rest_.data(), size);
      rest_.remove_prefix(size);
    }
  }
  bool Mark(std::string_view mark) {
    const bool is_next = rest_.substr(0, mark.size()) == mark;
    rest_.remove_prefix(is_next ? mark.size() : 0);
    return is_next;
  }
  std::int64_t Number() {
    std::int64_t number = 0;
    Bytes(&number, sizeof number);
    return number;
  }
  /// The number of items that follow, of at least `size` bytes each.
  std::size_t Count(std::size_t size) {
    const std::int64_t count = Number();
    Require(count >= 0 && static_cast<std::uint64_t>(count) <=
                              rest_.size() / std::max<std::size_t>(size, 1));
    return is_good_ ? static_cast<std::size_t>(count) : 0;
  }
  std::string Text() {
    std::string text(Count(1), '\0');
    Bytes(text.data(), text.size());
    return text;
  }
  template <typename Matrix>
  void Entries(Matrix& matrix) {
    using Scalar = std::decay_t<decltype(*matrix.data())>;
    const std::int64_t rows = Number();
    Require(rows >= 0 && rows <= 1 << 20 &&
            (Matrix::RowsAtCompileTime == Eigen::Dynamic ||
             rows == Matrix::RowsAtCompileTime));
    const std::size_t columns = Count(is_good_ ? rows * sizeof(Scalar) : 1);
    if (is_good_) {
      matrix.resize(rows, static_cast<Eigen::Index>(columns));
      Bytes(matrix.data(), matrix.size() * sizeof(Scalar));
    }
  }
  template <typename Value>
  void Values(std::vector<Value>& values) {
    values.resize(Count(sizeof(Value)));
    Bytes(values.data(), values.size() * sizeof(Value));
  }
  /// Arrays of so many columns each.
  void Arrays(Eigen::Index columns, std::vector<FileArray>& arrays) {
    arrays.resize(Count(1));
    for (FileArray& array : arrays) {
      array.name = Text();
      Entries(array.values);
      Require(array.values.cols() == columns);
    }
  }

 private:
  std::string_view rest_;
  bool is_good_ = true;
};

template <typename Nodes>
bool AreInRange(const Nodes& nodes, Eigen::Index num_nodes) {
  return nodes.size() == 0 ||
         (nodes.minCoeff() >= 0 && nodes.maxCoeff() < num_nodes);
}

void ReadGroups(Reader& reader, MeshFile& mesh) {
  mesh.groups.resize(reader.Count(1));
  for (PhysicalGroup& group : mesh.groups) {
    group.dimension = static_cast<int>(reader.Number());
    group.number = static_cast<int>(reader.Number());
    group.name = reader.Text();
    reader.Values(group.nodes);
    reader.Entries(group.facets);
    reader.Require(
        AreInRange(Eigen::Map<const Eigen::VectorXi>(group.nodes.data(),
                                                     group.nodes.size()),
                   mesh.nodes.cols()) &&
        (group.facets.rows() == mesh.Topology().NumVerticesOfFace() ||
         group.facets.size() == 0) &&
        AreInRange(group.facets, mesh.nodes.cols()));
  }
}

void ReadAdded(Reader& reader, MeshFile& mesh) {
  mesh.added.resize(reader.Count(1));
  reader.Require(Eigen::Index(mesh.added.size()) <= mesh.nodes.cols());
  for (AddedNode& added : mesh.added) {
    reader.Values(added.around);
    reader.Values(added.weights);
    reader.Require(
        added.weights.size() == added.around.size() &&
        AreInRange(Eigen::Map<const Eigen::VectorXi>(
                       added.around.data(), Eigen::Index(added.around.size())),
                   mesh.nodes.cols()));
  }
}

ElementKind ReadKind(Reader& reader) {
  const std::int64_t kind = reader.Number();
  const bool is_known =
      kind >= 0 && kind < static_cast<std::int64_t>(kElementKinds.size());
  reader.Require(is_known);
  return is_known ? kElementKinds[kind] : ElementKind::kTet4;
}

void ReadMesh(Reader& reader, MeshFile& mesh) {
  reader.Entries(mesh.nodes);
  mesh.kind = ReadKind(reader);
  reader.Entries(mesh.elements);
  reader.Require((mesh.elements.rows() == mesh.Topology().num_nodes ||
                  mesh.elements.size() == 0) &&
                 AreInRange(mesh.elements, mesh.nodes.cols()));
  reader.Arrays(mesh.nodes.cols(), mesh.node_arrays);
  reader.Arrays(mesh.elements.cols(), mesh.element_arrays);
  if (reader.Number() != 0) {
    reader.Bytes(&mesh.model.emplace(), sizeof(double));
  }
  if (reader.Number() != 0) {
    reader.Bytes(&mesh.thickness.emplace(), sizeof(double));
  }
  const std::int64_t origin = reader.Number();
  reader.Require(origin >= 0 && origin <= 2);
  mesh.origin = static_cast<Origin>(origin);
  ReadGroups(reader, mesh);
  mesh.are_regions_groups = reader.Number() != 0;
  mesh.why_no_regions = reader.Text();
  mesh.has_other_cells = reader.Number() != 0;
  mesh.is_vtk = reader.Number() != 0;
  reader.Values(mesh.node_numbers);
  reader.Values(mesh.element_numbers);
  mesh.is_cut = reader.Number() != 0;
  ReadAdded(reader, mesh);
  mesh.num_nodes_left_out = reader.Number();
  reader.Require((mesh.node_numbers.empty() ||
                  mesh.node_numbers.size() ==
                      static_cast<std::size_t>(mesh.nodes.cols())) &&
                 (mesh.element_numbers.empty() ||
                  mesh.element_numbers.size() ==
                      static_cast<std::size_t>(mesh.elements.cols())) &&
                 mesh.num_nodes_left_out >= 0);
  mesh.notices.resize(reader.Count(1));
  for (std::string& notice : mesh.notices) {
    notice = reader.Text();
  }
}

}  // namespace

void WriteStart(std::FILE* file, bool is_short_of_memory) {
  Writer writer(file);
  writer.Mark(kBegin);
  writer.Number(is_short_of_memory ? 1 : 0);
}

void WriteMesh(std::FILE* file, const MeshFile& mesh) {
  Writer writer(file);
  writer.Number(static_cast<int>(Kind::kMesh));
  writer.Entries(mesh.nodes);
  writer.Number(static_cast<int>(mesh.kind));
  writer.Entries(mesh.elements);
  writer.Arrays(mesh.node_arrays);
  writer.Arrays(mesh.element_arrays);
  writer.Number(mesh.model ? 1 : 0);
  if (mesh.model) {
    writer.Bytes(&*mesh.model, sizeof(double));
  }
  writer.Number(mesh.thickness ? 1 : 0);
  if (mesh.thickness) {
    writer.Bytes(&*mesh.thickness, sizeof(double));
  }
  writer.Number(static_cast<int>(mesh.origin));
  writer.Number(static_cast<std::int64_t>(mesh.groups.size()));
  for (const PhysicalGroup& group : mesh.groups) {
    writer.Number(group.dimension);
    writer.Number(group.number);
    writer.Text(group.name);
    writer.Values(group.nodes);
    writer.Entries(group.facets);
  }
  writer.Number(mesh.are_regions_groups ? 1 : 0);
  writer.Text(mesh.why_no_regions);
  writer.Number(mesh.has_other_cells ? 1 : 0);
  writer.Number(mesh.is_vtk ? 1 : 0);
  writer.Values(mesh.node_numbers);
  writer.Values(mesh.element_numbers);
  writer.Number(mesh.is_cut ? 1 : 0);
  writer.Number(static_cast<std::int64_t>(mesh.added.size()));
  for (const AddedNode& added : mesh.added) {
    writer.Values(added.around);
    writer.Values(added.weights);
  }
  writer.Number(mesh.num_nodes_left_out);
  writer.Texts(mesh.notices);
  writer.Mark(kEnd);
}

void WriteSentence(std::FILE* file, Kind kind, const std::string& sentence) {
  Writer writer(file);
  writer.Number(static_cast<int>(kind));
  writer.Text(sentence.substr(0, kMaxSentence));
  writer.Mark(kEnd);
}

MeshMessage ParseMeshMessage(std::string_view bytes) {
  Reader reader(bytes);
  MeshMessage message;
  message.has_started = reader.Mark(kBegin);
  if (!message.has_started) {
    return message;
  }
  message.is_short_of_memory = reader.Number() != 0;
  const std::int64_t kind = reader.Number();
  if (kind == static_cast<int>(Kind::kMesh)) {
    ReadMesh(reader, message.mesh);
  } else {
    message.sentence = reader.Text();
    reader.Require(kind > static_cast<int>(Kind::kMesh) &&
                   kind <= static_cast<int>(Kind::kOutOfMemory) &&
                   message.sentence.size() <= kMaxSentence);
  }
  reader.Require(reader.Mark(kEnd));
  if (reader.IsGood()) {
    message.kind = static_cast<Kind>(kind);
  }
  return message;
}

}  // namespace elastimate
