#include "elastimate/io/scene/frames.h"

#include <fnmatch.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <pugixml.hpp>
#include <string>
#include <system_error>
#include <utility>

#include "elastimate/core/scene/loads.h"
#include "elastimate/io/dic/measured_mesh.h"
#include "elastimate/io/points/table_options.h"
#include "elastimate/io/scene/json_loads.h"
#include "elastimate/io/scene/json_measurement.h"
#include "elastimate/io/scene/load_record.h"
#include "elastimate/io/scene/mesh_reader.h"
#include "elastimate/io/text/input_error.h"
#include "elastimate/io/text/input_file.h"
#include "elastimate/io/text/natural_order.h"
#include "elastimate/io/text/printable.h"

namespace elastimate {
namespace {

namespace fs = std::filesystem;

bool IsPattern(const std::string& name) {
  return name.find_first_of("*?") != std::string::npos;
}

bool IsVtkFile(const std::string& name) {
  const std::string extension = FileExtension(name);
  return extension == ".vtu" || extension == ".pvtu" || extension == ".vtk";
}

// Returns the names of the files of a series of ParaView (.pvd), relative to
// the scene, in the order of their times.
std::vector<std::string> FilesOfSeries(const JsonValue& value) {
  const fs::path series = value.String();
  const fs::path path = value.File().parent_path() / series;
  CheckReadable(path);
  pugi::xml_document document;
  if (const auto parsed = document.load_file(path.c_str()); !parsed) {
    ThrowDamagedFile(path, parsed.description());
  }
  std::vector<std::pair<double, std::string>> files;
  for (const pugi::xml_node& set :
       document.child("VTKFile").child("Collection").children("DataSet")) {
    files.emplace_back(
        set.attribute("timestep").as_double(),
        (series.parent_path() / set.attribute("file").value()).string());
  }
  if (files.empty()) {
    ThrowDamagedFile(path, "it names no data sets");
  }
  std::stable_sort(
      files.begin(), files.end(),
      [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::string> names;
  names.reserve(files.size());
  for (auto& [time, name] : files) {
    names.push_back(std::move(name));
  }
  return names;
}

// Returns the names of the files of a pattern, relative to the scene as the
// pattern is.
std::vector<std::string> FindFiles(const JsonValue& value) {
  const fs::path pattern = value.String();
  const fs::path folder = value.File().parent_path() / pattern.parent_path();
  std::vector<std::string> names;
  std::error_code error;
  for (const fs::directory_entry& entry :
       fs::directory_iterator(folder.empty() ? "." : folder, error)) {
    const std::string name = entry.path().filename().string();
    if (fnmatch(pattern.filename().c_str(), name.c_str(), FNM_PERIOD) == 0) {
      names.push_back((pattern.parent_path() / name).string());
    }
  }
  SortByNumbers(names);
  if (names.empty()) {
    value.Fail("is \"" + Printable(value.String()) +
               "\", which matches no file; correct the pattern");
  }
  return names;
}

std::vector<std::string> FrameNames(const JsonValue& files) {
  if (files.IsString() && FileExtension(files.String()) == ".pvd") {
    return FilesOfSeries(files);
  }
  if (files.IsString()) {
    return IsPattern(files.String()) ? FindFiles(files)
                                     : std::vector{files.String()};
  }
  std::vector<std::string> names;
  for (const JsonValue& file : files.Items()) {
    names.push_back(file.String());
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i].empty() ||
        std::find(names.begin(), names.begin() + std::ptrdiff_t(i), names[i]) !=
            names.begin() + std::ptrdiff_t(i)) {
      files.Items()[i].Fail(
          "is empty or was named before; name each frame once");
    }
  }
  if (names.empty()) {
    files.Fail("is empty; name the files of the frames");
  }
  return names;
}

double RelativeError(const JsonValue& value) {
  const double error = value.Number();
  if (!(error >= 0)) {
    value.Fail("must not be negative");
  }
  return error;
}

// Returns, for each resultant, the standard deviation over the size of its
// force where it is given in this way.
std::vector<std::optional<double>> RelativeErrors(const JsonValue& load_case) {
  std::vector<std::optional<double>> errors;
  for (const JsonValue& load : load_case.At("loads").Items()) {
    if (IsResultant(load)) {
      errors.push_back(load.Has("relative_sd")
                           ? std::optional(load.At("relative_sd").Number())
                           : std::nullopt);
    }
  }
  return errors;
}

// Reads the frames.  It keeps what it needs of the document, which need not
// outlive it.
struct FrameReader {
  fs::path scene_file;
  MeshFile mesh;
  Mesh scene_mesh;
  LoadCase loads;  // Of the scene, without a measurement.
  std::vector<std::optional<double>> relative_errors;
  std::optional<TableOptions> camera;
  nlohmann::json displacement;  // As of the load case, but for the file.
  std::string file_key;         // "points" or "file".
  std::vector<std::string> names;
  std::vector<double> factors;
  std::optional<MeasurementReader> reader;

  LoadCase Read(std::size_t i) {
    LoadCase frame = loads;
    Multiply(factors.empty() ? 1 : factors[i], frame);
    if (camera) {
      ReadMeasuredFrame(scene_file.parent_path() / names[i], *camera,
                        mesh.nodes.topRows(2), frame);
      return frame;
    }
    if (!reader) {
      reader.emplace(mesh, scene_mesh);
    }
    nlohmann::json of_frame = displacement;
    if (IsVtkFile(names[i])) {
      ReadArrays(scene_file.parent_path() / names[i]);
    } else {
      of_frame.erase("array");
      of_frame[file_key] = names[i];
    }
    std::vector<std::string> notices;
    reader->Read(JsonValue(scene_file, of_frame, "frames"), frame, notices);
    return frame;
  }

  // Takes the point arrays of a file of the same mesh.
  void ReadArrays(const fs::path& path) {
    constexpr double kSameLength = 1e-6;  // Of the largest coordinate.
    MeshFile file = ReadMeshFile(path);
    const bool is_same = file.nodes.cols() == mesh.nodes.cols() &&
                         (file.nodes - mesh.nodes).cwiseAbs().maxCoeff() <=
                             kSameLength * mesh.nodes.cwiseAbs().maxCoeff();
    if (!is_same) {
      ThrowInputError(path,
                      "its points are not those of the mesh of the scene; give "
                      "files that differ in their arrays only");
    }
    mesh.path = path;
    mesh.node_arrays = std::move(file.node_arrays);
  }

  void Multiply(double factor, LoadCase& frame) const {
    if (!(std::isfinite(factor) && factor != 0)) {
      throw std::invalid_argument(
          std::isnan(factor)
              ? "the load record has no number for this frame"
              : "the load of this frame is " +
                    std::string(factor == 0 ? "zero" : "not finite") +
                    ", so that it gives no estimate");
    }
    for (Load& load : frame.loads) {
      load = Scaled(load, factor);
    }
    for (std::size_t i = 0; i < frame.resultants.size(); ++i) {
      frame.resultants[i].force *= factor;
      frame.resultants[i].noise_sd *= relative_errors[i] ? std::abs(factor) : 1;
    }
  }
};

}  // namespace

FrameSeries ReadFrames(const JsonValue& document, const FileScene& file_scene) {
  const JsonValue frames = document.At("frames");
  frames.CheckKeys({"files", "load_record"});
  const std::vector<JsonValue> cases = document.At("cases").Items();
  if (cases.size() != 1) {
    frames.Fail("need exactly one load case, but \"cases\" has " +
                std::to_string(cases.size()) +
                "; make a scene of each load case");
  }
  const auto reader = std::make_shared<FrameReader>();
  reader->scene_file = document.File();
  reader->mesh = file_scene.mesh;
  reader->scene_mesh = file_scene.scene.mesh;
  reader->loads = file_scene.scene.load_cases[0];
  reader->loads.displacement.resize(0, 0);
  reader->loads.points = {};
  reader->relative_errors = RelativeErrors(cases[0]);
  reader->names = FrameNames(frames.At("files"));
  if (document.At("mesh").IsObject()) {
    reader->camera = ReadTableOptions(document.At("mesh"), 2);
  }
  reader->displacement = nlohmann::json::object();
  reader->file_key = "points";
  if (cases[0].Has("displacement")) {
    const JsonValue displacement = cases[0].At("displacement");
    for (const std::string key : {"nodes", "file", "points"}) {
      if (displacement.Has(key)) {
        reader->file_key = key;
      }
    }
    reader->displacement = displacement.Json();
  }
  FrameSeries series;
  for (const std::string& name : reader->names) {
    series.files.push_back(document.File().parent_path() / name);
  }
  for (const std::optional<double>& error : reader->relative_errors) {
    series.load_error = {
        std::max(series.load_error.relative, error.value_or(0)), true};
  }
  if (frames.Has("load_record")) {
    const JsonValue record = frames.At("load_record");
    series.loads = ReadLoadRecord(record, reader->names);
    if (record.Has("relative_sd")) {
      series.load_error = {RelativeError(record.At("relative_sd")), false};
    }
  }
  reader->factors = series.loads;
  series.read = [reader](std::size_t i) { return reader->Read(i); };
  return series;
}

}  // namespace elastimate
