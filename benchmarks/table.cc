#include "benchmarks/table.h"

#include <cmath>
#include <iomanip>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace elastimate {
namespace {

struct Text {
  std::string operator()(const std::string& text) const {
    if (text.find_first_of(",\"\r\n") != std::string::npos) {
      throw std::logic_error("a cell that needs quotes: " + text);
    }
    return text;
  }
  std::string operator()(double number) const {
    std::ostringstream text;
    text << std::setprecision(7) << number;
    return std::isnan(number) ? "" : text.str();
  }
  std::string operator()(std::int64_t number) const {
    return std::to_string(number);
  }
};

}  // namespace

Table::Table(std::string name, const std::vector<std::string>& columns)
    : name_(std::move(name)), num_columns_(columns.size()) {
  AddRow({columns.begin(), columns.end()});
}

void Table::AddRow(const std::vector<Value>& cells,
                   const std::vector<Value>& more_cells) {
  if (cells.size() + more_cells.size() != num_columns_) {
    throw std::logic_error("a row of table " + name_ +
                           " has not one cell for each column");
  }
  std::string separator;
  for (const std::vector<Value>* part : {&cells, &more_cells}) {
    for (const Value& cell : *part) {
      csv_ += separator + std::visit(Text(), cell);
      separator = ",";
    }
  }
  csv_ += "\n";
}

}  // namespace elastimate
