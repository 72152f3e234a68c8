#ifndef ELASTIMATE_IO_REPORT_HTML_REPORT_H_
#define ELASTIMATE_IO_REPORT_HTML_REPORT_H_

#include <cstddef>
#include <optional>
#include <string>

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/io/report/scene_results.h"

namespace elastimate {

/// The texts that a page shows beside the specimen.
struct PageTexts {
  std::string title;    ///< Names the scene.
  std::string command;  ///< How the page was made.
  std::string report;   ///< That of JsonReport.
  std::string frames;   ///< That of SeriesTable; empty for other scenes.
  /// The number, from 1 on, of the frame that the scene and its results are of;
  /// empty for other scenes, and where no frame has results.
  std::optional<std::size_t> frame = {};
};

/// Returns the page without its data, a file of this package.  Throws
/// std::invalid_argument where the package was built without it.
[[nodiscard]] std::string ReadPage();

/// Returns `page` (ReadPage) with the data that it draws: the texts, and of the
/// scene and its results the outer surface (the elements of a planar mesh), in
/// single precision.  The page is one file of HTML that needs no other.
///
/// As many load cases are there as fit into a megabyte, at least one; of each,
/// 2000 measured points at most.  `scene` has the mesh of `results`, and
/// `estimate` is what they are of.  O(num_elements + num_points).
[[nodiscard]] std::string HtmlReport(const std::string& page,
                                     const Scene& scene,
                                     const Estimate& estimate,
                                     const SceneResults& results,
                                     const PageTexts& texts);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_REPORT_HTML_REPORT_H_
