#include "elastimate/io/scene/scene_nodes.h"

#include <algorithm>
#include <iomanip>
#include <iterator>
#include <sstream>
#include <utility>
#include <variant>

#include "elastimate/core/text/numbers.h"

namespace elastimate {
namespace {

/// Tells how many middle nodes were put into the middle, and how far; empty
/// where none was.
std::string MovedNodesNotice(const MeshFile& mesh) {
  if (mesh.moved.empty()) {
    return "";
  }
  double farthest = 0;
  for (const auto& [node, in_file] : mesh.moved) {
    farthest = std::max(farthest, (mesh.nodes.col(node) - in_file).norm());
  }
  const bool is_one = mesh.moved.size() == 1;
  std::ostringstream sentence;
  sentence << mesh.moved.size()
           << (is_one ? " mid-edge node lies" : " mid-edge nodes lie")
           << " beside the middle of "
           << (is_one ? "its straight edge" : "their straight edges")
           << ", by up to " << std::setprecision(2) << farthest
           << ", as rounded positions do; " << (is_one ? "it was" : "they were")
           << " put into the middle";
  return sentence.str();
}

}  // namespace

SceneNodes::SceneNodes(const MeshFile& file, const Mesh& mesh)
    : position_(file.used.size(), -1) {
  std::vector<char> is_middle(file.used.size(), 0);
  const ElementTopology& topology = mesh.Topology();
  for (const int node :
       mesh.elements.bottomRows(topology.num_nodes - topology.num_vertices)
           .reshaped()) {
    is_middle[node] = 1;
  }
  for (const char wanted : {0, 1}) {
    for (Eigen::Index node = 0; node < file.used.size(); ++node) {
      if (file.used[node] && is_middle[node] == wanted) {
        position_[node] = static_cast<int>(kept_.size());
        kept_.push_back(node);
      }
    }
  }
  const auto num_not_kept = Eigen::Index(position_.size() - kept_.size());
  num_dropped_ = num_not_kept + file.num_nodes_left_out;
  are_those_of_file_ =
      num_not_kept == 0 && std::is_sorted(kept_.begin(), kept_.end());
}

std::vector<int> SceneNodes::FileOrder() const {
  if (std::is_sorted(kept_.begin(), kept_.end())) {
    return {};
  }
  std::vector<int> order;
  std::copy_if(position_.begin(), position_.end(), std::back_inserter(order),
               [](int position) { return position >= 0; });
  return order;
}

Scene SceneNodes::Filter(Scene scene) const {
  if (are_those_of_file_) {
    return scene;
  }
  KeepColumns(scene.mesh.nodes);
  Renumber(scene.mesh.elements);
  FilterSupports(scene.supports);
  for (LoadCase& load_case : scene.load_cases) {
    FilterLoadCase(load_case);
  }
  return scene;
}

FileLines SceneNodes::Filter(const FileLines& all) const {
  FileLines lines = {all.file, {}};
  for (const Eigen::Index node : kept_) {
    lines.lines.push_back(all.lines[node]);
  }
  return lines;
}

FrameSeries SceneNodes::Filter(FrameSeries frames) const {
  if (!are_those_of_file_) {
    frames.read = [nodes = *this, read = frames.read](std::size_t i) {
      LoadCase load_case = read(i);
      nodes.FilterLoadCase(load_case);
      return load_case;
    };
  }
  return frames;
}

NumberedNodes SceneNodes::Numbered(const MeshFile& mesh) const {
  NumberedNodes nodes = {mesh.path, ProgramOf(mesh), {}};
  for (const Eigen::Index node : kept_) {
    nodes.numbers.push_back(mesh.node_numbers.empty()
                                ? std::size_t(node)
                                : mesh.node_numbers[node]);
  }
  return nodes;
}

std::vector<std::string> SceneNodes::Notices(const MeshFile& mesh) const {
  std::vector<std::string> notices = mesh.notices;
  if (const std::string moved = MovedNodesNotice(mesh); !moved.empty()) {
    notices.push_back(moved);
  }
  if (num_dropped_ > 0) {
    notices.push_back(
        Counted(std::size_t(num_dropped_), "point") + " that no " +
        mesh.Shape() +
        (num_dropped_ == 1 ? " uses is left out" : " uses are left out"));
  }
  return notices;
}

void SceneNodes::FilterLoadCase(LoadCase& load_case) const {
  KeepColumns(load_case.displacement);
  KeepColumns(load_case.observed);
  if (load_case.supports) {
    FilterSupports(*load_case.supports);
  }
  for (Resultant& resultant : load_case.resultants) {
    Renumber(resultant.nodes);
  }
  for (Load& load : load_case.loads) {
    std::visit([this](auto& kind) { FilterLoad(kind); }, load);
  }
}

void SceneNodes::FilterSupports(Supports& supports) const {
  KeepColumns(supports.held);
  KeepColumns(supports.displacement);
  KeepColumns(supports.unknown);
  KeepColumns(supports.delimited);
  for (RigidFace& face : supports.rigid_faces) {
    Renumber(face.nodes);
  }
}

void SceneNodes::Renumber(Eigen::MatrixXi& nodes) const {
  nodes = nodes.unaryExpr([this](int node) { return position_[node]; });
}

void SceneNodes::Renumber(std::vector<int>& nodes) const {
  std::vector<int> kept;
  for (const int node : nodes) {
    if (position_[node] >= 0) {
      kept.push_back(position_[node]);
    }
  }
  nodes = kept;
}

}  // namespace elastimate
