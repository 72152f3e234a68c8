// Uses what the libraries load or start: the program that runs Gmsh, the one
// that reads legacy VTK files, and multigrid where it was built.
//
//   user_program FOLDER SCENE.vtu [multigrid]

#include <elastimate/core/solvers/multigrid.h>
#include <elastimate/estimators/registry.h>
#include <elastimate/io/scene/scene_reader.h>
#include <elastimate/petsc/start_petsc.h>

#include <filesystem>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>

namespace {

using elastimate::Measurement;

void Require(bool condition, const std::string& what) {
  if (!condition) {
    throw std::runtime_error("not so: " + what);
  }
}

std::filesystem::path Write(const std::filesystem::path& path,
                            const std::string& content) {
  std::ofstream(path) << content;
  return path;
}

void ReadGmshMesh(const std::filesystem::path& folder) {
  Write(folder / "one.msh",
        "$NOD\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$ENDNOD\n"
        "$ELM\n1\n1 4 1 1 4 1 2 3 4\n$ENDELM\n");
  const auto path = Write(folder / "one.json",
                          R"({"mesh": "one.msh",
          "supports": [{"nodes": {"ids": [0, 1, 2]}}],
          "cases": [{"loads": [{"type": "body_force", "value": [0, 0, 1]}]}]})");
  const elastimate::Scene scene =
      elastimate::ReadScene({path}, Measurement::kOptional).scene;
  Require(scene.mesh.NumElements() == 1, "the .msh file has one tetrahedron");
}

void CatchErrors(const std::filesystem::path& folder) {
  for (const std::string name : {"bad.msh", "bad.vtk", "bad.vtu"}) {
    const auto path = Write(folder / name, "damaged\n");
    try {
      elastimate::ReadScene({path}, Measurement::kOptional);
      Require(false, name + " is refused");
    } catch (const std::invalid_argument& error) {
      Require(std::string(error.what()).find(name) != std::string::npos,
              "the error names " + name);
    }
  }
}

elastimate::Estimate EstimateByMultigrid(const std::filesystem::path& path) {
  const elastimate::Scene scene =
      elastimate::ReadScene({path}, Measurement::kRequired).scene;
  elastimate::EstimatorOptions options;
  options.solver = elastimate::SolverKind::kMultigrid;
  return elastimate::MakeEstimator("reduced-fe")->Run(scene, options);
}

void RefuseMultigridWhereNothingStartsPetsc(const std::filesystem::path& path) {
  try {
    EstimateByMultigrid(path);
    Require(false, "multigrid is refused");
  } catch (const std::invalid_argument& error) {
    Require(std::string(error.what()).find("has not started PETSc") !=
                std::string::npos,
            "the error says that PETSc has not been started");
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    Require(argc > 2, "a folder and a scene are given");
    ReadGmshMesh(argv[1]);
    CatchErrors(argv[1]);
    if (argc > 3) {
      RefuseMultigridWhereNothingStartsPetsc(argv[2]);
      elastimate::StartPetscWhenNeeded();
      Require(elastimate::HasMultigrid(), elastimate::WhyNoMultigrid());
      Require(EstimateByMultigrid(argv[2]).IsUsable(),
              "the estimate by multigrid is usable");
    }
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
  return 0;
}
