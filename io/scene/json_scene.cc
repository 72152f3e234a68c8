#include "elastimate/io/scene/json_scene.h"

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "elastimate/io/dic/margin.h"
#include "elastimate/io/dic/measured_mesh.h"
#include "elastimate/io/scene/file_scene.h"
#include "elastimate/io/scene/frames.h"
#include "elastimate/io/scene/json_loads.h"
#include "elastimate/io/scene/json_materials.h"
#include "elastimate/io/scene/json_measurement.h"
#include "elastimate/io/scene/json_supports.h"
#include "elastimate/io/scene/mesh_reader.h"
#include "elastimate/io/scene/node_field.h"
#include "elastimate/io/scene/origin.h"
#include "elastimate/io/scene/section.h"
#include "elastimate/io/text/json_value.h"
#include "elastimate/io/text/printable.h"

namespace elastimate {
namespace {

MeshFile ReadNamedMesh(const JsonValue& name, PointGaps& gaps,
                       std::vector<std::string>& notices) {
  if (name.IsObject()) {
    return ReadMeasuredMesh(name, gaps, notices);
  }
  const std::filesystem::path path = ResolvePath(name);
  if (FileExtension(path) == ".json") {
    name.Fail("is '" + Printable(name.String()) +
              "', which is a scene; name a mesh file (" + kMeshExtensions +
              ")");
  }
  return ReadMeshFile(path);
}

/// Reads the keys `model` and `thickness`.
SectionChoice ReadSection(const JsonValue& document) {
  SectionChoice choice;
  if (document.Has("model")) {
    const JsonValue model = document.At("model");
    const std::string name = model.String();
    choice.model = SectionModelOfName(name);
    if (!choice.model) {
      model.Fail("is \"" + Printable(name) + "\"; make it " + kSectionModels);
    }
  }
  if (document.Has("thickness")) {
    choice.thickness = document.At("thickness").Number();
    if (!(*choice.thickness > 0)) {
      document.At("thickness").Fail("must be positive");
    }
  }
  return choice;
}

bool ReadIsRigidMotionFree(const JsonValue& document) {
  if (!document.Has("rigid_motion")) {
    return false;
  }
  const JsonValue value = document.At("rigid_motion");
  if (value.String() != "free") {
    value.Fail("is \"" + Printable(value.String()) +
               "\"; make it \"free\", or leave it out");
  }
  return true;
}

// Reads the origin of the displacements.  Without the key, the origin that the
// mesh file states holds for displacements that are its arrays.
Origin ReadOrigin(const JsonValue& document, Origin of_mesh) {
  if (!document.Has("origin")) {
    const std::vector<JsonValue> cases = document.At("cases").Items();
    const bool are_arrays =
        !document.Has("frames") &&
        std::all_of(cases.begin(), cases.end(), [](const JsonValue& value) {
          return value.Has("displacement") &&
                 value.At("displacement").IsObject() &&
                 value.At("displacement").Has("array");
        });
    return are_arrays ? of_mesh : Origin::kMeasured;
  }
  const JsonValue value = document.At("origin");
  const std::optional<Origin> origin = OriginOfName(value.String());
  if (!origin) {
    value.Fail("is \"" + Printable(value.String()) + "\"; make it " + kOrigins);
  }
  return *origin;
}

LoadCase ReadLoadCase(const JsonValue& value, const LoadContext& of_scene,
                      MeasurementReader& reader, bool is_mesh_measured,
                      Measurement measurement, std::vector<FileLines>& lines) {
  value.CheckKeys(
      {"displacement", "loads", "noise_sd", "observed", "supports"});
  LoadCase load_case;
  LoadContext context = of_scene;
  if (value.Has("supports")) {
    load_case.supports = ReadSupports(value, context.mesh);
    context.SetSupports(&*load_case.supports);
  }
  ReadLoads(value.At("loads"), context, load_case);
  if (value.Has("noise_sd")) {
    load_case.noise_sd = value.At("noise_sd").Number();
    if (!(*load_case.noise_sd > 0)) {
      value.At("noise_sd").Fail("must be positive");
    }
  }
  if (value.Has("observed")) {
    load_case.observed =
        ReadObserved(value.At("observed"), context.mesh, context.free);
  }
  if (!value.Has("displacement") && is_mesh_measured) {
    load_case.displacement =
        *FindArray(context.mesh.node_arrays, "displacement");
    const ComponentMask measured = !load_case.displacement.array().isNaN();
    if (load_case.observed.size() != 0) {
      load_case.observed = load_case.observed && measured;
    } else {
      load_case.observed = measured;
    }
    ClearUnobserved(load_case);
    lines.push_back({context.mesh.path, context.mesh.node_lines});
  } else if (value.Has("displacement") ||
             measurement == Measurement::kRequired) {
    lines = reader.Read(value.At("displacement"), load_case, context.notices);
  }
  return load_case;
}

/// Allows for the margin of a mesh that was made of measured points, which may
/// end within the specimen.
void AllowForMarginOf(const JsonValue& mesh, FileScene& file_scene) {
  if (!mesh.IsObject()) {
    return;
  }
  std::optional<double> margin;
  if (mesh.Has("margin")) {
    margin = mesh.At("margin").Number();
    if (!(*margin >= 0)) {
      mesh.At("margin").Fail("is negative; give 0 or a length");
    }
    const Eigen::MatrixXd& nodes = file_scene.scene.mesh.nodes;
    if (*margin >
        (nodes.rowwise().maxCoeff() - nodes.rowwise().minCoeff()).minCoeff()) {
      mesh.At("margin").Fail(
          "is larger than the mesh of the points; give it in their unit");
    }
  }
  AllowForMargin(margin, file_scene.scene, file_scene.notices);
}

/// Returns the object that has the supports of the scene: the document or,
/// where each load case has its own, the first load case.
const JsonValue& OwnerOfSupports(const JsonValue& document,
                                 const std::vector<JsonValue>& cases) {
  const auto has_own = [](const JsonValue& value) {
    return value.Has("supports");
  };
  if (document.Has("supports") ||
      std::none_of(cases.begin(), cases.end(), has_own)) {
    return document;
  }
  for (const JsonValue& value : cases) {
    if (!has_own(value)) {
      value.Fail(
          "has no \"supports\" of its own, and the scene has none for all load "
          "cases; give one of the two");
    }
  }
  return cases[0];
}

}  // namespace

FileScene ReadJsonScene(const std::filesystem::path& path,
                        Measurement measurement, const SceneChoices& choices) {
  const nlohmann::json parsed = ParseJsonFile(path);
  return ReadJsonScene(JsonValue(path, parsed), measurement, choices);
}

FileScene ReadJsonScene(const JsonValue& document, Measurement measurement,
                        const SceneChoices& choices) {
  document.CheckKeys({"model", "thickness", "mesh", "regions", "materials",
                      "supports", "rigid_motion", "origin", "cases", "frames"});
  const SectionChoice choice = Choose(choices.section, ReadSection(document));
  FileScene file_scene;
  file_scene.gaps.is_filled = choices.filled_gaps;
  file_scene.mesh =
      ReadNamedMesh(document.At("mesh"), file_scene.gaps, file_scene.notices);
  ChooseRegions(document, file_scene.mesh);
  const MeshFile& mesh = file_scene.mesh;
  file_scene.scene.mesh =
      SceneMesh(mesh, SectionOf(mesh, choice), mesh.elements);
  file_scene.scene.origin = ReadOrigin(document, mesh.origin);
  file_scene.scene.materials = ReadMaterials(document, mesh);
  file_scene.axis_arrays = AxisArrays(document, mesh);
  const std::vector<JsonValue> cases = document.At("cases").Items();
  if (cases.empty()) {
    document.At("cases").Fail("is empty; give at least one load case");
  }
  file_scene.scene.supports =
      ReadSupports(OwnerOfSupports(document, cases), mesh);
  file_scene.scene.is_rigid_motion_free = ReadIsRigidMotionFree(document);
  const LoadContext context(mesh, file_scene.scene.mesh,
                            file_scene.scene.supports, file_scene.notices);
  MeasurementReader reader(mesh, file_scene.scene.mesh);
  const bool has_frames = document.Has("frames");
  for (const JsonValue& load_case : cases) {
    file_scene.scene.load_cases.push_back(
        ReadLoadCase(load_case, context, reader, document.At("mesh").IsObject(),
                     has_frames ? Measurement::kOptional : measurement,
                     file_scene.measured_lines.emplace_back()));
  }
  AllowForMarginOf(document.At("mesh"), file_scene);
  if (has_frames) {
    file_scene.frames = ReadFrames(document, file_scene);
  }
  return file_scene;
}

}  // namespace elastimate
