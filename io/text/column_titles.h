#ifndef ELASTIMATE_IO_TEXT_COLUMN_TITLES_H_
#define ELASTIMATE_IO_TEXT_COLUMN_TITLES_H_

#include <cstddef>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace elastimate {

/// The title of a column, which may have a unit: "X [mm]", "x (mm)", "x / mm",
/// "x_mm".  A unit in square brackets may be any, another one has to be one of
/// LengthUnitOf.
struct ColumnTitle {
  std::string text;  ///< The whole title.
  std::string name;  ///< Without the unit.
  std::string unit;  ///< Empty without one.

  explicit ColumnTitle(std::string_view title);
};

/// Returns small letters without spaces, underscores, hyphens, dots and
/// brackets: "Displacement_X" becomes "displacementx".
std::string PlainName(std::string_view name);

/// The titles of a table, in which columns are found by their names.
class ColumnTitles {
 public:
  ColumnTitles() = default;
  /// O(size of the texts).
  explicit ColumnTitles(const std::vector<std::string>& texts);

  std::size_t Size() const { return titles_.size(); }
  const ColumnTitle& operator[](std::size_t column) const {
    return titles_[column];
  }

  /// Returns the columns of which `title` is the whole title.  Where there is
  /// none, it returns those whose titles are the same but for a unit, which
  /// only one of the two has.
  std::vector<std::size_t> Find(std::string_view title) const;
  /// Returns what Find returns.  Where it finds none, titles are compared by
  /// PlainName, under the same condition for units.
  std::vector<std::size_t> FindAlike(std::string_view title) const;

  /// Returns "x, y [mm], ...", for messages.
  std::string List() const;

 private:
  using Places = std::unordered_map<std::string, std::vector<std::size_t>>;

  std::vector<std::size_t> Fitting(const Places& places, const std::string& key,
                                   const ColumnTitle& title) const;

  std::vector<ColumnTitle> titles_;
  Places of_texts_;
  Places of_names_;
  Places of_plain_names_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_IO_TEXT_COLUMN_TITLES_H_
