#include "elastimate/io/report/html_report.h"

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include "elastimate/core/package/package_file.h"
#include "elastimate/io/report/page_specimen.h"

namespace elastimate {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kPageFile = "report.html";
constexpr const char* kPlaceOfData = "<!--data-->";
constexpr const char* kTitle = "<title>elastimate report</title>";

// Returns what the command line calls each parameter, and whether its errors
// are relative.
Json LabelsJson(const Estimate& estimate) {
  Json labels = Json::array();
  for (const ParameterEstimate& parameter : estimate.parameters) {
    labels.push_back({{"label", parameter.Label()},
                      {"is_relative", parameter.IsStiffness()}});
  }
  return labels;
}

// Returns the shear modulus that the data determine in place of E and nu; null
// where there is none.
Json ShearModulusJson(const Estimate& estimate) {
  return estimate.shear_modulus
             ? Json(
                   {{"value", estimate.shear_modulus->value},
                    {"standard_error", estimate.shear_modulus->standard_error}})
             : Json(nullptr);
}

// Returns JSON in which no text ends the element of HTML around it.
std::string WithinHtml(const Json& json) {
  std::string text;
  for (const char character : json.dump()) {
    text += character == '<' ? "\\u003c" : std::string(1, character);
  }
  return text;
}

// Returns text as HTML shows it.
std::string EscapedForHtml(const std::string& text) {
  const std::map<char, std::string> escapes = {
      {'<', "&lt;"}, {'>', "&gt;"}, {'&', "&amp;"}};
  std::string escaped;
  for (const char character : text) {
    const auto found = escapes.find(character);
    escaped +=
        found == escapes.end() ? std::string(1, character) : found->second;
  }
  return escaped;
}

void Replace(const std::string& place, const std::string& text,
             std::string& html) {
  if (const std::size_t found = html.find(place); found != std::string::npos) {
    html.replace(found, place.size(), text);
  }
}

}  // namespace

std::string ReadPage() {
  const std::string path = FindPackageFile(kPageFile);
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  if (text.str().find(kPlaceOfData) == std::string::npos) {
    throw std::invalid_argument(
        "this build has no page for reports; build elastimate with npm "
        "(ELASTIMATE_BUILD_PAGE=ON) where npm reaches its packages, or use "
        "estimate with --json and --out");
  }
  return text.str();
}

std::string HtmlReport(const std::string& page, const Scene& scene,
                       const Estimate& estimate, const SceneResults& results,
                       const PageTexts& texts) {
  const Json data = {
      {"title", texts.title},
      {"command", texts.command},
      {"report", Json::parse(texts.report)},
      {"labels", LabelsJson(estimate)},
      {"shear_modulus", ShearModulusJson(estimate)},
      {"frames", texts.frames.empty() ? Json(nullptr) : Json(texts.frames)},
      {"frame", texts.frame ? Json(*texts.frame) : Json(nullptr)},
      {"specimen", PageSpecimen(scene, estimate, results)}};
  std::string html = page;
  Replace(kTitle, "<title>" + EscapedForHtml(texts.title) + "</title>", html);
  Replace(kPlaceOfData, WithinHtml(data), html);
  return html;
}

}  // namespace elastimate
