#include "elastimate/io/report/series_table.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>

#include "elastimate/io/text/printable.h"

namespace elastimate {
namespace {

std::string Number(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? nlohmann::json(*value).dump() : "";
}

// Quotes the text where it needs quotation marks.
std::string Cell(const std::string& text) {
  if (text.find_first_of(",;\"\n\t ") == std::string::npos) {
    return text;
  }
  std::string quoted = "\"";
  for (const char character : text) {
    quoted += std::string(character == '"' ? 2 : 1, character);
  }
  return quoted + "\"";
}

std::string ColumnOf(const ParameterEstimate& parameter) {
  std::string name = parameter.name;
  for (const int region : parameter.regions) {
    name += "_" + std::to_string(region);
  }
  return name;
}

std::string Header(const std::vector<ParameterEstimate>& parameters) {
  std::string header = "frame,file,load,status";
  for (const ParameterEstimate& parameter : parameters) {
    const std::string name = ColumnOf(parameter);
    header += "," + name + "," + name + "_standard_error";
  }
  return header + ",noise_sd,outliers,findings,reason\n";
}

// Returns the cells from the status on, for as many parameters as the header
// has.
std::string Cells(const Estimate& estimate, std::size_t num_parameters) {
  std::string row(estimate.Has(FindingCode::kNotRun)
                      ? FindingCodeName(FindingCode::kNotRun)
                      : StatusName(estimate.status));
  for (std::size_t i = 0; i < num_parameters; ++i) {
    const bool is_there = i < estimate.parameters.size();
    row +=
        "," +
        Number(is_there ? std::optional(estimate.parameters[i].value)
                        : std::nullopt) +
        "," +
        Number(is_there ? estimate.parameters[i].standard_error : std::nullopt);
  }
  std::string codes;
  for (const Finding& finding : estimate.findings) {
    codes +=
        (codes.empty() ? "" : " ") + std::string(FindingCodeName(finding.code));
  }
  return row + "," + Number(estimate.noise_sd) + "," +
         std::to_string(estimate.outliers.size()) + "," + Cell(codes) + "," +
         Cell(Printable(estimate.message.empty()
                            ? estimate.why_no_standard_error
                            : estimate.message,
                        kLongestSentence)) +
         "\n";
}

}  // namespace

std::string SeriesTable(const FrameSeries& series,
                        const std::vector<FrameEstimate>& frames,
                        const Estimate& joint) {
  std::vector<ParameterEstimate> parameters = joint.parameters;
  for (const FrameEstimate& frame : frames) {
    if (parameters.empty()) {
      parameters = frame.estimate.parameters;
    }
  }
  std::string table = Header(parameters);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    table += std::to_string(i + 1) + "," +
             Cell(PrintablePath(series.files[i])) + "," +
             Number(series.Load(i)) + "," +
             Cells(frames[i].estimate, parameters.size());
  }
  return table + "joint,,," + Cells(joint, parameters.size());
}

}  // namespace elastimate
