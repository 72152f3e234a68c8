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

// The columns that depend on the estimates.
struct SeriesColumns {
  std::vector<ParameterEstimate> parameters;
  // Whether an estimate has a shear modulus that does not follow from E and nu.
  bool have_shear_modulus = false;
};

SeriesColumns SeriesColumnsOf(const std::vector<FrameEstimate>& frames,
                              const Estimate& joint) {
  SeriesColumns columns = {joint.parameters, joint.shear_modulus.has_value()};
  for (const FrameEstimate& frame : frames) {
    if (columns.parameters.empty()) {
      columns.parameters = frame.estimate.parameters;
    }
    columns.have_shear_modulus =
        columns.have_shear_modulus || frame.estimate.shear_modulus;
  }
  return columns;
}

std::string Header(const SeriesColumns& columns) {
  std::string header = "frame,file,load,status";
  const auto add = [&header](const std::string& name) {
    header += "," + name + "," + name + "_standard_error";
  };
  for (const ParameterEstimate& parameter : columns.parameters) {
    add(ColumnOf(parameter));
  }
  if (columns.have_shear_modulus) {
    add("shear_modulus");
  }
  return header + ",noise_sd,outliers,findings,reason\n";
}

std::string Pair(const std::optional<double>& value,
                 const std::optional<double>& error) {
  return "," + Number(value) + "," + Number(error);
}

// Returns the cells from the status on.
std::string Cells(const Estimate& estimate, const SeriesColumns& columns) {
  std::string row(estimate.Has(FindingCode::kNotRun)
                      ? FindingCodeName(FindingCode::kNotRun)
                      : StatusName(estimate.status));
  for (std::size_t i = 0; i < columns.parameters.size(); ++i) {
    row += i < estimate.parameters.size()
               ? Pair(estimate.parameters[i].value,
                      estimate.parameters[i].standard_error)
               : Pair(std::nullopt, std::nullopt);
  }
  if (columns.have_shear_modulus) {
    row += Pair(estimate.ShearModulus(), estimate.ShearModulusStandardError());
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
  const SeriesColumns columns = SeriesColumnsOf(frames, joint);
  std::string table = Header(columns);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    table += std::to_string(i + 1) + "," +
             Cell(PrintablePath(series.files[i])) + "," +
             Number(series.Load(i)) + "," + Cells(frames[i].estimate, columns);
  }
  return table + "joint,,," + Cells(joint, columns);
}

}  // namespace elastimate
