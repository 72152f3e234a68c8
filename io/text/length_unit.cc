#include "elastimate/io/text/length_unit.h"

#include <cctype>
#include <string>

namespace elastimate {
namespace {

constexpr LengthUnit kMetre = {"m", 1e9};
constexpr LengthUnit kCentimetre = {"cm", 1e7};
constexpr LengthUnit kMillimetre = {"mm", 1e6};
constexpr LengthUnit kMicrometre = {"um", 1e3};
constexpr LengthUnit kNanometre = {"nm", 1};
constexpr LengthUnit kInch = {"in", 2.54e7};
constexpr LengthUnit kPixel = {"pixel", 0};

struct UnitName {
  const char* name;
  LengthUnit unit;
};

// The sign of micro may be a character of its own, the Greek letter, or a byte
// of Latin-1.
constexpr UnitName kUnitNames[] = {
    {"m", kMetre},
    {"meter", kMetre},
    {"metre", kMetre},
    {"cm", kCentimetre},
    {"centimeter", kCentimetre},
    {"centimetre", kCentimetre},
    {"mm", kMillimetre},
    {"millimeter", kMillimetre},
    {"millimetre", kMillimetre},
    {"um", kMicrometre},
    {"\xC2\xB5m", kMicrometre},
    {"\xCE\xBCm", kMicrometre},
    {"\xB5m", kMicrometre},
    {"micron", kMicrometre},
    {"micrometer", kMicrometre},
    {"micrometre", kMicrometre},
    {"nm", kNanometre},
    {"nanometer", kNanometre},
    {"nanometre", kNanometre},
    {"in", kInch},
    {"inch", kInch},
    {"inches", kInch},
    {"px", kPixel},
    {"pix", kPixel},
    {"pixel", kPixel},
};

}  // namespace

std::optional<LengthUnit> LengthUnitOf(std::string_view name) {
  std::string small;
  for (const char c : name) {
    small += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  for (const UnitName& known : kUnitNames) {
    const std::string one = known.name;
    // Words may be in the plural.
    if (small == one || (one.size() > 4 && small == one + "s")) {
      return known.unit;
    }
  }
  return std::nullopt;
}

}  // namespace elastimate
