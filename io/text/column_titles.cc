#include "elastimate/io/text/column_titles.h"

#include <cctype>
#include <optional>

#include "elastimate/io/text/length_unit.h"
#include "elastimate/io/text/printable.h"
#include "elastimate/io/text/trimmed.h"

namespace elastimate {
namespace {

// Returns the part of a title that is its unit, with what sets it off.
struct UnitPlace {
  std::size_t begin;
  std::size_t end;
  std::string_view unit;
};

std::optional<UnitPlace> InBrackets(std::string_view title, char open,
                                    char close) {
  const std::size_t begin = title.find(open);
  const std::size_t end = title.find(close, begin);
  if (begin == std::string_view::npos || end == std::string_view::npos) {
    return std::nullopt;
  }
  return UnitPlace{begin, end + 1,
                   Trimmed(title.substr(begin + 1, end - begin - 1))};
}

// These are titles like "x / mm", "x, mm", "x_mm", "x mm".
std::optional<UnitPlace> AtTheEnd(std::string_view title) {
  const std::size_t begin = title.find_last_of("/,_ ");
  if (begin == std::string_view::npos || begin == 0) {
    return std::nullopt;
  }
  const std::string_view unit = Trimmed(title.substr(begin + 1));
  const bool is_set_off = title.find_last_of("/,") != std::string_view::npos;
  // These units are words or letters of names as well.
  const bool may_be_word = unit == "in" || (unit == "m" && title[begin] == ' ');
  if (!LengthUnitOf(unit) || (may_be_word && !is_set_off)) {
    return std::nullopt;
  }
  return UnitPlace{title.find_last_not_of("/,_ ", begin) + 1, title.size(),
                   unit};
}

std::optional<UnitPlace> PlaceOfUnit(std::string_view title) {
  if (const auto place = InBrackets(title, '[', ']')) {
    return place;
  }
  if (const auto place = InBrackets(title, '(', ')');
      place && LengthUnitOf(place->unit)) {
    return place;
  }
  return AtTheEnd(title);
}

bool MayHaveSameUnit(const std::string& a, const std::string& b) {
  const std::optional<LengthUnit> unit_a = LengthUnitOf(a);
  const std::optional<LengthUnit> unit_b = LengthUnitOf(b);
  return a.empty() || b.empty() || a == b ||
         (unit_a && unit_b && unit_a->nanometres == unit_b->nanometres);
}

}  // namespace

ColumnTitle::ColumnTitle(std::string_view title) : text(title), name(title) {
  if (const std::optional<UnitPlace> place = PlaceOfUnit(title)) {
    unit = place->unit;
    name = Trimmed(std::string(Trimmed(title.substr(0, place->begin)))
                       .append(title.substr(place->end)));
  }
}

std::string PlainName(std::string_view name) {
  std::string plain;
  for (const char c : name) {
    const bool is_mark =
        std::string_view(" _-.:()\t").find(c) != std::string_view::npos;
    // A hyphen in front is a sign.
    if (!is_mark || (c == '-' && plain.empty())) {
      plain += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
  }
  return plain;
}

ColumnTitles::ColumnTitles(const std::vector<std::string>& texts) {
  for (const std::string& text : texts) {
    const std::size_t column = titles_.size();
    const ColumnTitle& title = titles_.emplace_back(text);
    of_texts_[title.text].push_back(column);
    of_names_[title.name].push_back(column);
    of_plain_names_[PlainName(title.name)].push_back(column);
  }
}

std::vector<std::size_t> ColumnTitles::Fitting(const Places& places,
                                               const std::string& key,
                                               const ColumnTitle& title) const {
  std::vector<std::size_t> fitting;
  const auto found = places.find(key);
  if (found != places.end()) {
    for (const std::size_t column : found->second) {
      if (MayHaveSameUnit(titles_[column].unit, title.unit)) {
        fitting.push_back(column);
      }
    }
  }
  return fitting;
}

std::vector<std::size_t> ColumnTitles::Find(std::string_view title) const {
  const auto whole = of_texts_.find(std::string(title));
  if (whole != of_texts_.end()) {
    return whole->second;
  }
  const ColumnTitle split(title);
  return Fitting(of_names_, split.name, split);
}

std::vector<std::size_t> ColumnTitles::FindAlike(std::string_view title) const {
  std::vector<std::size_t> found = Find(title);
  if (found.empty()) {
    const ColumnTitle split(title);
    found = Fitting(of_plain_names_, PlainName(split.name), split);
  }
  return found;
}

std::string ColumnTitles::List() const {
  std::string list;
  for (const ColumnTitle& title : titles_) {
    list += (list.empty() ? "" : ", ") + Printable(title.text);
    if (list.size() > kLongestSentence) {
      break;
    }
  }
  return list;
}

}  // namespace elastimate
