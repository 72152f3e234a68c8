#include "apps/material_curve.h"

#include <charconv>
#include <iomanip>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "apps/flags.h"
#include "apps/outputs.h"
#include "elastimate/core/large_strain/homogeneous_deformation.h"
#include "elastimate/core/materials/laws.h"
#include "elastimate/core/text/numbers.h"
#include "elastimate/io/text/file_output.h"
#include "elastimate/io/text/printable.h"

namespace elastimate {
namespace {

constexpr char kExample[] =
    "--curve=neo_hookean,youngs_modulus=1e4,poisson_ratio=0.45";

[[noreturn]] void FailCurve(const std::string& sentence) {
  throw std::invalid_argument("--curve=" + Printable(FLAGS_curve) + sentence);
}

struct NamedMaterial {
  const Law* law;
  Eigen::VectorXd parameters;
};

std::map<std::string, double> ReadValues(std::istringstream& text) {
  std::map<std::string, double> values;
  for (std::string item; std::getline(text, item, ',');) {
    const std::size_t equals = item.find('=');
    double value = 0;
    const char* const begin = item.data() + equals + 1;
    const char* const end = item.data() + item.size();
    if (equals == std::string::npos ||
        std::from_chars(begin, end, value).ptr != end || begin == end) {
      FailCurve("; after the law, each part must be NAME=NUMBER, as in " +
                std::string(kExample));
    }
    if (!values.emplace(item.substr(0, equals), value).second) {
      FailCurve(" gives " + Printable(item.substr(0, equals)) +
                " twice; give it once");
    }
  }
  return values;
}

NamedMaterial ReadCurveFlag() {
  std::istringstream text(FLAGS_curve);
  std::string name;
  std::getline(text, name, ',');
  const Law* const law = FindLaw(name, SectionModel::kSolid);
  if (law == nullptr) {
    FailCurve("; the first part must be a law of three dimensions, one of " +
              LawNames(SectionModel::kSolid));
  }
  const std::map<std::string, double> values = ReadValues(text);
  try {
    return {law, ParametersByName(*law, values)};
  } catch (const std::invalid_argument& error) {
    FailCurve("; " + Printable(error.what()));
  }
}

struct CurveTable {
  std::vector<double> stretches;
  /// The states of each mode at each stretch.
  std::vector<std::vector<std::optional<HomogeneousState>>> states;
};

CurveTable Drive(const NamedMaterial& material) {
  CurveTable table;
  for (int tenths = 5; tenths <= 30; ++tenths) {
    table.stretches.push_back(tenths / 10.0);
  }
  const Eigen::VectorXd moduli =
      material.law->Moduli(material.parameters, SectionModel::kSolid);
  for (const DeformationMode mode : kAllDeformationModes) {
    table.states.push_back(
        DeformHomogeneously(*material.law, moduli, mode, table.stretches));
  }
  return table;
}

std::string CurveForPeople(const CurveTable& table) {
  constexpr int kWidth = 13;
  std::ostringstream text;
  text << "stretch";
  for (const DeformationMode mode : kAllDeformationModes) {
    text << std::setw(kWidth) << DeformationModeName(mode);
  }
  text << "\n";
  for (std::size_t i = 0; i < table.stretches.size(); ++i) {
    text << std::left << std::setw(7) << NumberText(table.stretches[i])
         << std::right;
    for (const auto& states : table.states) {
      text << std::setw(kWidth)
           << (states[i] ? NumberText(states[i]->stress) : "-");
    }
    text << "\n";
  }
  return text.str();
}

std::string CurveAsCsv(const CurveTable& table) {
  std::ostringstream text;
  text << std::setprecision(17) << "stretch";
  for (const DeformationMode mode : kAllDeformationModes) {
    text << "," << DeformationModeName(mode);
  }
  text << "\n";
  for (std::size_t i = 0; i < table.stretches.size(); ++i) {
    text << NumberText(table.stretches[i]);
    for (const auto& states : table.states) {
      text << ",";
      if (states[i]) {
        text << states[i]->stress;
      }
    }
    text << "\n";
  }
  return text.str();
}

}  // namespace

void WriteMaterialCurve() {
  CheckOutputFlags({}, OutFormats::kTable);
  const CurveTable table = Drive(ReadCurveFlag());
  if (FLAGS_out.empty()) {
    WriteStandardOutput(CurveForPeople(table));
  } else {
    WriteWholeFile(FLAGS_out, CurveAsCsv(table));
  }
}

}  // namespace elastimate
