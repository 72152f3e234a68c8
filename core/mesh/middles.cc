#include "elastimate/core/mesh/middles.h"

#include <algorithm>
#include <iterator>
#include <numeric>

namespace elastimate {
namespace {

void Gather(const Mesh& mesh, Eigen::Index element,
            const std::vector<int>& places, std::vector<int>& nodes) {
  nodes.clear();
  for (const int place : places) {
    nodes.push_back(mesh.elements(place, element));
  }
}

}  // namespace

Middles::Key Middles::KeyOf(const std::vector<int>& vertices) {
  Key key;
  key.fill(kNone);
  std::copy(vertices.begin(), vertices.end(), key.begin());
  std::sort(key.begin(), key.end());
  return key;
}

Middles::Middles(const Mesh& mesh) : start_(mesh.NumNodes() + 1, 0) {
  const auto& places = mesh.Topology().middles;
  // The middle of a hexahedron, the last one, is in no other element.
  const bool has_own = places.back().size() > Key().size();
  const std::size_t num_shared = places.size() - (has_own ? 1 : 0);
  std::vector<int> nodes;
  const auto visit = [&](const auto& visitor) {
    for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
      for (std::size_t i = 0; i < num_shared; ++i) {
        Gather(mesh, e, places[i], nodes);
        visitor(KeyOf(nodes), e, Eigen::Index(i));
      }
    }
  };
  // The keys of each lowest vertex, which are few, are sorted by themselves.
  visit([&](const Key& key, Eigen::Index, Eigen::Index) {
    ++start_[key[0] + 1];
  });
  std::partial_sum(start_.begin(), start_.end(), start_.begin());
  std::vector<Eigen::Index> end(start_.begin(), start_.end() - 1);
  std::vector<Key> repeated(start_.back());
  visit([&](const Key& key, Eigen::Index, Eigen::Index) {
    repeated[end[key[0]]++] = key;
  });
  for (Eigen::Index node = 0; node < mesh.NumNodes(); ++node) {
    const auto first = repeated.begin() + start_[node];
    const auto last = repeated.begin() + start_[node + 1];
    start_[node] = Eigen::Index(keys_.size());
    std::sort(first, last);
    std::unique_copy(first, last, std::back_inserter(keys_));
  }
  start_.back() = Eigen::Index(keys_.size());
  for (const Key& key : keys_) {
    nodes.assign(key.begin(), std::find(key.begin(), key.end(), kNone));
    vertices_.Add(nodes);
  }
  of_elements_.resize(Eigen::Index(places.size()), mesh.NumElements());
  visit([&](const Key& key, Eigen::Index e, Eigen::Index i) {
    of_elements_(i, e) = static_cast<int>(Find(key));
  });
  for (Eigen::Index e = 0; has_own && e < mesh.NumElements(); ++e) {
    of_elements_(of_elements_.rows() - 1, e) = static_cast<int>(Size());
    vertices_.Add(mesh.elements.col(e));
  }
}

Eigen::Index Middles::Find(const Key& key) const {
  const auto first = keys_.begin() + start_[key[0]];
  const auto last = keys_.begin() + start_[key[0] + 1];
  const auto found = std::lower_bound(first, last, key);
  return found == last || *found != key ? -1 : found - keys_.begin();
}

Eigen::Index Middles::Find(const std::vector<int>& vertices) const {
  return Find(KeyOf(vertices));
}

}  // namespace elastimate
