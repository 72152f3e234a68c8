#ifndef ELASTIMATE_BENCHMARKS_TABLE_H_
#define ELASTIMATE_BENCHMARKS_TABLE_H_

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace elastimate {

/// A cell of a table.  NaN, which stands for "unknown", leaves it empty.
using Value = std::variant<std::string, double, std::int64_t>;

/// A tidy table: one row for each trial or aggregate, units in the header, as
/// in "displacement_deviation [1]".
class Table {
 public:
  /// `name` is that of its file, without ".csv".
  Table(std::string name, const std::vector<std::string>& columns);

  const std::string& Name() const { return name_; }

  /// Adds the row that `cells` and then `more_cells` make.  Throws
  /// std::logic_error unless there is one for each column, and none contains a
  /// comma, a quote or a line break.
  void AddRow(const std::vector<Value>& cells,
              const std::vector<Value>& more_cells = {});

  /// Header and rows, separated by commas; numbers with seven digits.
  const std::string& Csv() const { return csv_; }

 private:
  std::string name_;
  std::size_t num_columns_;
  std::string csv_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_BENCHMARKS_TABLE_H_
