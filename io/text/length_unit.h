#ifndef ELASTIMATE_IO_TEXT_LENGTH_UNIT_H_
#define ELASTIMATE_IO_TEXT_LENGTH_UNIT_H_

#include <optional>
#include <string_view>

namespace elastimate {

/// A unit of length, or the pixel of a camera.
struct LengthUnit {
  const char* name;   ///< As messages call it.
  double nanometres;  ///< Zero of a pixel.

  bool IsPixel() const { return nanometres == 0; }
  /// Tells whether it is a unit of displacements rather than of specimens:
  /// pixel, nm, um.
  bool IsSmall() const { return nanometres <= 1e3; }
};

/// Lists the units for messages.
constexpr char kLengthUnits[] = "m, cm, mm, um, nm, in";

/// Returns the unit of that name or symbol, in small or capital letters;
/// nothing where it is neither one of kLengthUnits nor a pixel.
std::optional<LengthUnit> LengthUnitOf(std::string_view name);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_TEXT_LENGTH_UNIT_H_
