#include "elastimate/io/text/natural_order.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <map>
#include <string_view>
#include <tuple>
#include <utility>

namespace elastimate {
namespace {

bool IsDigit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}
bool IsLetter(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0;
}

/// A number 0.DIGITS times a power of ten, exactly, or text.
struct NamePart {
  bool is_text = false;
  int sign = 0;
  long long power = 0;
  std::string digits;    ///< Without zeros at both ends; the text of a text.
  std::string decimals;  ///< As they are written.

  bool operator<(const NamePart& other) const {
    if (is_text || other.is_text || sign != other.sign) {
      return std::tie(is_text, sign, digits) <
             std::tie(other.is_text, other.sign, other.digits);
    }
    const auto size = std::tie(power, digits);
    const auto other_size = std::tie(other.power, other.digits);
    return sign < 0 ? other_size < size : size < other_size;
  }
};

NamePart NumberPart(bool is_negative, std::string_view integer,
                    std::string_view decimals, long long exponent) {
  NamePart part;
  part.decimals = decimals;
  part.digits = std::string(integer).append(decimals);
  const std::size_t first =
      std::min(part.digits.find_first_not_of('0'), part.digits.size());
  part.digits.erase(0, first);
  part.digits.erase(part.digits.find_last_not_of('0') + 1);
  if (!part.digits.empty()) {
    part.sign = is_negative ? -1 : 1;
    part.power = static_cast<long long>(integer.size()) -
                 static_cast<long long>(first) + exponent;
  }
  return part;
}

/// Cuts a name into texts and numbers.
class NameReader {
 public:
  NameReader(std::string_view name, bool has_decimals)
      : name_(name), has_decimals_(has_decimals) {}

  std::vector<NamePart> Parts() {
    std::vector<NamePart> parts;
    while (place_ < name_.size()) {
      const bool is_negative = IsMinus();
      if (!is_negative && !IsDigit(name_[place_])) {
        if (parts.empty() || !parts.back().is_text) {
          parts.push_back({true, 0, 0, "", ""});
        }
        parts.back().digits += name_[place_++];
        continue;
      }
      place_ += is_negative ? 1 : 0;
      parts.push_back(Number(is_negative));
    }
    return parts;
  }

  /// Returns how many points the number with the most points has.
  int MostPoints() {
    int most = 0;
    for (place_ = 0; place_ < name_.size(); ++place_) {
      if (IsDigit(name_[place_])) {
        Digits();
        int points = 0;
        for (; IsPoint(); ++points) {
          ++place_;
          Digits();
        }
        most = std::max(most, points);
      }
    }
    return most;
  }

 private:
  char At(std::size_t place) const {
    return place < name_.size() ? name_[place] : '\0';
  }

  bool IsMinus() const {
    const char before = place_ == 0 ? ' ' : name_[place_ - 1];
    return name_[place_] == '-' && IsDigit(At(place_ + 1)) &&
           !IsDigit(before) && !IsLetter(before) && before != '-';
  }

  bool IsPoint() const {
    return (At(place_) == '.' || At(place_) == ',') && IsDigit(At(place_ + 1));
  }

  std::string_view Digits() {
    const std::size_t begin = place_;
    while (IsDigit(At(place_))) {
      ++place_;
    }
    return name_.substr(begin, place_ - begin);
  }

  NamePart Number(bool is_negative) {
    const bool is_behind_letter =
        !is_negative && place_ > 0 && IsLetter(name_[place_ - 1]);
    const std::string_view integer = Digits();
    std::string_view decimals;
    if (has_decimals_ && IsPoint()) {
      ++place_;
      decimals = Digits();
    }
    return NumberPart(is_negative, integer, decimals,
                      is_behind_letter ? 0 : Exponent());
  }

  // Returns zero where there is no exponent.
  long long Exponent() {
    const bool has_sign = At(place_ + 1) == '-' || At(place_ + 1) == '+';
    const std::size_t begin = place_ + (has_sign ? 2 : 1);
    constexpr std::size_t kMostDigits = 3;
    std::size_t end = begin;
    while (IsDigit(At(end))) {
      ++end;
    }
    if (std::tolower(static_cast<unsigned char>(At(place_))) != 'e' ||
        end == begin || end - begin > kMostDigits) {
      return 0;
    }
    place_ = end;
    const long long size =
        std::stoll(std::string(name_.substr(begin, end - begin)));
    return name_[begin - 1] == '-' ? -size : size;
  }

  std::string_view name_;
  bool has_decimals_;
  std::size_t place_ = 0;
};

using NamedParts = std::pair<std::vector<NamePart>, std::string>;

std::vector<NamedParts> SortedParts(const std::vector<std::string>& names,
                                    bool has_decimals) {
  std::vector<NamedParts> sorted;
  sorted.reserve(names.size());
  for (const std::string& name : names) {
    sorted.emplace_back(NameReader(name, has_decimals).Parts(), name);
  }
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

// Tells whether numbers with a point are two integers.  They are where one has
// two points, and where one ends in a zero that a shorter one in its place does
// not have, as 1.10 beside 1.9.
bool HasCounters(const std::vector<std::string>& names) {
  const std::vector<NamedParts> all = SortedParts(names, true);
  std::map<std::size_t, std::size_t> fewest;
  for (const auto& [parts, name] : all) {
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (const std::size_t size = parts[i].decimals.size(); size > 0) {
        const auto place = fewest.emplace(i, size).first;
        place->second = std::min(place->second, size);
      }
    }
  }
  return std::any_of(all.begin(), all.end(), [&](const NamedParts& one) {
    for (std::size_t i = 0; i < one.first.size(); ++i) {
      const std::string& decimals = one.first[i].decimals;
      if (decimals.size() > 1 && decimals.back() == '0' &&
          decimals.size() > fewest[i]) {
        return true;
      }
    }
    return NameReader(one.second, true).MostPoints() > 1;
  });
}

}  // namespace

void SortByNumbers(std::vector<std::string>& names) {
  const std::vector<NamedParts> sorted =
      SortedParts(names, !HasCounters(names));
  for (std::size_t i = 0; i < names.size(); ++i) {
    names[i] = sorted[i].second;
  }
}

}  // namespace elastimate
