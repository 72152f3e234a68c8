#ifndef ELASTIMATE_IO_DIC_MARGIN_H_
#define ELASTIMATE_IO_DIC_MARGIN_H_

#include <optional>
#include <string>
#include <vector>

#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// Allows for the margin of a specimen beyond its measured points, whose mesh
/// is that of a scene.  A margin m at free edges of the total length L around
/// an area A adds m L / A to the cross section, on the average over the
/// specimen: the thickness grows by that share.  Where no margin is given, half
/// the mean length of free edges of elements is the standard deviation of one,
/// and m L / A becomes that of the thickness (Section::thickness_relative_sd).
/// Where one is given, half a spacing is added at the steps that a slanted or
/// curved edge makes in a grid of points, which lie up to a spacing inside of
/// it, and the standard deviation is that of these alone.
/// Edges that a support holds end there by choice, and have no margin.
/// Precondition: a valid planar scene.  O(num_elements log num_elements).
void AllowForMargin(std::optional<double> margin, Scene& scene,
                    std::vector<std::string>& notices);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_DIC_MARGIN_H_
