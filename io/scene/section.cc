#include "elastimate/io/scene/section.h"

#include <cmath>
#include <sstream>
#include <string>

#include "elastimate/core/text/numbers.h"
#include "elastimate/io/mesh/section_number.h"
#include "elastimate/io/text/input_error.h"

namespace elastimate {
namespace {

SectionChoice FieldData(const MeshFile& mesh) {
  SectionChoice choice;
  if (mesh.model) {
    for (std::size_t i = 0; i < kNumberedModels.size(); ++i) {
      if (*mesh.model == static_cast<double>(i)) {
        choice.model = kNumberedModels[i];
      }
    }
    if (!choice.model) {
      ThrowInputError(mesh.path, "the field data 'model' is " +
                                     NumberText(*mesh.model) +
                                     "; make it 0 for 3d, 1 for plane_stress "
                                     "or 2 for plane_strain");
    }
  }
  choice.thickness = mesh.thickness;
  return choice;
}

void CheckSolid(const MeshFile& mesh, const SectionChoice& choice) {
  const std::string solid =
      "the mesh is of " + mesh.Shapes() + ", which are solid, but ";
  if (choice.model && *choice.model != SectionModel::kSolid) {
    ThrowInputError(mesh.path,
                    solid + "the model is " +
                        std::string(SectionModelName(*choice.model)) +
                        "; leave it out, or give a mesh of the plane");
  }
  if (choice.thickness) {
    ThrowInputError(mesh.path, solid + "a thickness is given; leave it out");
  }
}

void CheckPlanar(const MeshFile& mesh, const SectionChoice& choice) {
  const std::string planar =
      "the mesh is of " + mesh.Shapes() + ", which are planar, but ";
  if (!choice.model || *choice.model == SectionModel::kSolid) {
    ThrowInputError(mesh.path,
                    (!choice.model && !mesh.why_no_model.empty()
                         ? mesh.why_no_model
                         : planar + (choice.model ? "the model is 3d"
                                                  : "no model is given")) +
                        "; give --model=plane_stress or --model=plane_strain, "
                        "or \"model\" in a scene.json");
  }
  if (!choice.thickness) {
    ThrowInputError(mesh.path,
                    planar +
                        "no thickness is given; give --thickness=X, or "
                        "\"thickness\" in a scene.json");
  }
  if (!(*choice.thickness > 0) || !std::isfinite(*choice.thickness)) {
    ThrowInputError(mesh.path,
                    "the thickness is not positive and finite; correct it");
  }
}

}  // namespace

std::optional<SectionModel> SectionModelOfName(std::string_view name) {
  for (const SectionModel model :
       {SectionModel::kSolid, SectionModel::kPlaneStrain,
        SectionModel::kPlaneStress}) {
    if (name == SectionModelName(model)) {
      return model;
    }
  }
  return std::nullopt;
}

SectionChoice Choose(const SectionChoice& given,
                     const SectionChoice& otherwise) {
  return {given.model ? given.model : otherwise.model,
          given.thickness ? given.thickness : otherwise.thickness};
}

Section SectionOf(const MeshFile& mesh, const SectionChoice& given) {
  const SectionChoice choice = Choose(given, FieldData(mesh));
  if (mesh.Dimension() == 3) {
    CheckSolid(mesh, choice);
    return {};
  }
  CheckPlanar(mesh, choice);
  return {*choice.model, *choice.thickness};
}

}  // namespace elastimate
