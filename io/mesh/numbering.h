#ifndef ELASTIMATE_IO_MESH_NUMBERING_H_
#define ELASTIMATE_IO_MESH_NUMBERING_H_

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

namespace elastimate {

/// Returns the permutation that sorts `values`.
inline std::vector<std::size_t> SortingOrder(
    const std::vector<std::size_t>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return values[a] < values[b];
  });
  return order;
}

/// The position of each number of a file in an ascending list of them.
class Numbering {
 public:
  explicit Numbering(std::vector<std::size_t> numbers)
      : numbers_(std::move(numbers)),
        has_no_gap_(std::adjacent_find(numbers_.begin(), numbers_.end(),
                                       [](std::size_t a, std::size_t b) {
                                         return b != a + 1;
                                       }) == numbers_.end()) {}

  /// Returns -1 when `number` is not in the list.
  int Find(std::size_t number) const {
    // Most files number without a gap.
    if (has_no_gap_ && !numbers_.empty()) {
      return number < numbers_.front() || number > numbers_.back()
                 ? -1
                 : static_cast<int>(number - numbers_.front());
    }
    const auto found =
        std::lower_bound(numbers_.begin(), numbers_.end(), number);
    return found == numbers_.end() || *found != number
               ? -1
               : static_cast<int>(found - numbers_.begin());
  }
  const std::vector<std::size_t>& Numbers() const { return numbers_; }

 private:
  std::vector<std::size_t> numbers_;
  bool has_no_gap_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_IO_MESH_NUMBERING_H_
