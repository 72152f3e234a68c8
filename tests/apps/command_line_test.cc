// Runs the built program as a user does.

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <iomanip>
#include <sstream>
#include <string>
#include <thread>
#include <utility>

#include "elastimate/core/scene/rigid_motion.h"
#include "elastimate/estimators/registry.h"
#include "elastimate/io/examples/example_scenes.h"
#include "elastimate/io/scene/scene_reader.h"
#include "tests/program.h"

namespace elastimate {
namespace {

using testing::ProgramRun;
using testing::ProgramTest;
using testing::ReadText;
using testing::WriteText;

class CommandLine : public ProgramTest {
 protected:
  /// cuboid.vtu, measured at E = 10 kPa, nu = 0.33: exact.vtu.
  void MakeExactScene() {
    Succeed("generate cuboid --out=cuboid.vtu");
    Succeed("simulate cuboid.vtu --youngs=1e4 --nu=0.33 --out=exact.vtu");
  }

  Scene Read(const std::string& file) const {
    return ReadScene({folder_ / file}, Measurement::kOptional).scene;
  }
};

// Tests of what the program refuses, and of what becomes of files and streams.
// They are suites of their own so that they may run side by side.
class CommandLineErrors : public CommandLine {};
class CommandLineOutputs : public CommandLine {};

// Every line has at most 100 characters, and there are at most `max_lines`.
void ExpectAScreen(const std::string& help, int max_lines) {
  std::istringstream lines(help);
  int num_lines = 0;
  for (std::string line; std::getline(lines, line); ++num_lines) {
    EXPECT_LE(line.size(), 100U) << line;
  }
  EXPECT_LE(num_lines, max_lines);
}

TEST_F(CommandLine, HelpNamesEveryCommand) {
  const std::string help = Succeed("--help").output;
  ExpectAScreen(help, 24);
  for (const std::string words :
       {"elastimate estimate SCENE...", "elastimate simulate SCENE",
        "elastimate generate SHAPE", "elastimate estimators", "COMMAND --help",
        "Exit code"}) {
    EXPECT_NE(help.find(words), std::string::npos) << words;
  }
  EXPECT_EQ(Succeed("help").output, help);
  EXPECT_EQ(Succeed("-h").output, help);
}

TEST_F(CommandLine, HelpOfACommandHasItsFlagsAlone) {
  const std::string help = Succeed("estimate --help").output;
  EXPECT_EQ(help.find("elastimate estimate SCENE..."), 0U);
  EXPECT_EQ(help.find("simulate SCENE"), std::string::npos);
  for (const std::string flag :
       {"--estimator ", "--nu_min ", "--youngs_max ", "--noise_sd ", "--loss ",
        "--json ", "--out "}) {
    EXPECT_NE(help.find("\n  " + flag), std::string::npos) << flag;
  }
  for (const std::string words : {"\nInput:\n", "\nMethod:\n", "\nOutput:\n"}) {
    EXPECT_NE(help.find(words), std::string::npos) << words;
  }
  EXPECT_EQ(help.find("--cells"), std::string::npos);
  EXPECT_EQ(Succeed("help estimate").output, help);
  EXPECT_EQ(Succeed("estimate scene.vtu --nu=0.3 -h").output, help);
  for (const std::string command : {"estimate", "simulate", "plan", "generate",
                                    "estimators", "materials"}) {
    ExpectAScreen(Succeed(command + " --help").output, 40);
  }
  Refuse("estimat --help", "unknown command 'estimat'");
  Refuse("help estimat", "unknown command 'estimat'");
}

TEST_F(CommandLine, VersionNamesTheBlasInUse) {
  const std::string version = Succeed("--version").output;
  EXPECT_EQ(version.find("elastimate 0."), 0U) << version;
  EXPECT_NE(version.find("BLAS: OpenBLAS"), std::string::npos) << version;
  EXPECT_NE(version.find("libopenblas"), std::string::npos) << version;
}

TEST_F(CommandLine, ListsTheEstimators) {
  const std::string list = Succeed("estimators").output;
  for (const std::string_view name : EstimatorNames()) {
    EXPECT_NE(list.find(std::string(name) + "\n"), std::string::npos) << list;
  }
  for (const std::string command : {"estimators", "materials"}) {
    std::istringstream lines(Succeed(command).output);
    for (std::string line; std::getline(lines, line);) {
      EXPECT_LE(line.size(), 80U) << line;
    }
  }
}

TEST_F(CommandLine, DoctorSaysWhatIsThere) {
  const std::string output = Succeed("doctor").output;
  for (const std::string part : {"version", "processors", "vector instructions",
                                 "BLAS", "multigrid of PETSc", "Gmsh"}) {
    EXPECT_THAT(output, ::testing::HasSubstr(part));
  }
  Refuse("doctor scene.vtu", "doctor takes no arguments");
}

TEST_F(CommandLine, CompletesCommandsFlagsAndNames) {
  testing::WriteText(folder_ / "complete.bash",
                     Succeed("completion bash").output +
                         "compopt() { :; }\n"
                         "COMP_WORDS=(elastimate \"$@\")\n"
                         "COMP_CWORD=$#\n"
                         "_elastimate\n"
                         "echo \"${COMPREPLY[@]}\"\n");
  testing::WriteText(folder_ / "mine.vtu", "");
  const auto completions = [&](const std::string& words) {
    const std::string command = "cd '" + folder_.string() +
                                "' && bash complete.bash " + words +
                                " > completed";
    EXPECT_EQ(std::system(command.c_str()), 0);
    return testing::ReadText(folder_ / "completed");
  };
  EXPECT_EQ(completions("sim"), "simulate\n");
  EXPECT_EQ(completions("estimate --est"), "--estimator=\n");
  EXPECT_EQ(completions("estimate --estimator = red"), "reduced-fe\n");
  EXPECT_EQ(completions("estimate --material = neo"), "neo_hookean\n");
  EXPECT_EQ(completions("estimate mi"), "mine.vtu\n");
  Refuse("completion", "completion takes the name of a shell");
}

TEST_F(CommandLine, GeneratesThePapersCuboid) {
  const ProgramRun run = Succeed("generate cuboid --out=cuboid.vtu");
  EXPECT_NE(run.output.find("250 tetrahedra"), std::string::npos) << run.output;
  const Scene scene = Read("cuboid.vtu");
  EXPECT_EQ(scene.mesh.NumElements(), 250);
  EXPECT_EQ(WhyNotHeld(scene.mesh, scene.supports), "");
}

TEST_F(CommandLine, GeneratesCuboidsOfAnySize) {
  Succeed(
      "generate cuboid --cells=2,3,4 --size=1,2,3 --force=1,0,-2 "
      "--out=cuboid.vtu");
  const Scene scene = Read("cuboid.vtu");
  EXPECT_EQ(scene.mesh.NumElements(), 5 * 2 * 3 * 4);
  EXPECT_EQ(scene.mesh.nodes.rowwise().maxCoeff(), Eigen::Vector3d(1, 2, 3));
}

TEST_F(CommandLine, GeneratesAnOrgan) {
  Succeed("generate organ --tetrahedra=600 --length=0.3 --out=organ.vtu");
  const Scene scene = Read("organ.vtu");
  EXPECT_NEAR(double(scene.mesh.NumElements()) / 600, 1, 0.05);
  const Eigen::Vector3d extent = scene.mesh.nodes.rowwise().maxCoeff() -
                                 scene.mesh.nodes.rowwise().minCoeff();
  EXPECT_NEAR(extent(0), 0.3, 0.003);
}

TEST_F(CommandLine, EveryEstimatorFindsWhatWasSimulated) {
  MakeExactScene();
  for (const std::string_view name : EstimatorNames()) {
    const nlohmann::json report =
        Succeed("estimate exact.vtu --json=- --estimator=" + std::string(name))
            .Json();
    EXPECT_EQ(report["estimator"], name);
    EXPECT_EQ(report["status"], "ok");
    EXPECT_EQ(report["usable"], true);
    EXPECT_NEAR(report["youngs_modulus"].get<double>() / 1e4, 1, 1e-6);
    EXPECT_NEAR(report["poisson_ratio"].get<double>(), 0.33, 1e-6);
  }
}

constexpr const char* kDocumentedKeys[] = {
    "/elastimate",
    "/estimator",
    "/status",
    "/usable",
    "/message",
    "/youngs_modulus",
    "/poisson_ratio",
    "/standard_error/youngs_modulus",
    "/standard_error/poisson_ratio",
    "/standard_error/shear_modulus",
    "/standard_error/bulk_compliance",
    "/correlation",
    "/poisson_ratio_interval",
    "/shear_modulus",
    "/bulk_modulus",
    "/bulk_compliance",
    "/noise_sd",
    "/mesh/kind",
    "/mesh/dimension",
    "/mesh/model",
    "/mesh/thickness",
    "/mesh/nodes",
    "/mesh/elements",
    "/mesh/tetrahedra",
    "/mesh/load_cases",
    "/mesh/order",
    "/loads",
    "/notices",
    "/residual/force_relative",
    "/residual/displacement_relative",
    "/error_budget/noise/youngs_modulus",
    "/error_budget/bias/poisson_ratio",
    "/error_budget/model/youngs_modulus",
    "/error_budget/outliers/youngs_modulus",
    "/error_budget/discretization/poisson_ratio",
    "/error_budget/curvature/poisson_ratio",
    "/error_budget/law/youngs_modulus",
    "/findings",
    "/diagnostics/identifiability_angle_deg",
    "/diagnostics/noise_attenuation",
    "/diagnostics/warnings",
    "/work/element_passes",
    "/work/factorizations",
    "/work/multigrid_set_ups",
    "/work/solves",
    "/work/iterations",
    "/work/ranks",
    "/options/solver",
    "/seconds/read",
    "/seconds/estimate",
    "/seconds/total"};

TEST_F(CommandLine, TheReportHasTheDocumentedKeys) {
  MakeExactScene();
  const nlohmann::json report =
      Succeed("estimate exact.vtu --json=- --estimator=iterative-fe").Json();
  for (const std::string key : kDocumentedKeys) {
    EXPECT_TRUE(report.contains(nlohmann::json::json_pointer(key))) << key;
  }
  EXPECT_EQ(report["mesh"]["tetrahedra"], 250);
  // iterative-fe has no force residual; it says so with a null.
  EXPECT_TRUE(report["residual"]["force_relative"].is_null());
  EXPECT_GT(report["diagnostics"]["identifiability_angle_deg"], 0);
  // mu = E / (2 (1 + nu)), kappa = E / (3 (1 - 2 nu)).
  EXPECT_NEAR(report["shear_modulus"], 1e4 / 2.66, 0.1);
  EXPECT_NEAR(report["bulk_modulus"], 1e4 / 1.02, 0.1);
}

TEST_F(CommandLine, NearOneHalfItGivesAnIntervalOfOneSide) {
  Succeed("generate cuboid --out=cuboid.vtu");
  Succeed(
      "simulate cuboid.vtu --youngs=1e4 --nu=0.4999 --noise=0.5 "
      "--noise_law=gaussian --seed=1 --out=soft.vtu");
  const std::string command = "estimate soft.vtu --estimator=reduced-fe";
  const nlohmann::json report = Succeed(command + " --json=-").Json();
  EXPECT_EQ(report["poisson_ratio_interval"][1], 0.5);
  EXPECT_LT(report["poisson_ratio_interval"][0], 0.4999);
  // Close to nu = 1/2 the data determine mu = E / (2 (1 + nu)) and 1 / kappa =
  // 3 (1 - 2 nu) / E.
  EXPECT_NEAR((report["shear_modulus"].get<double>() - 1e4 / 2.9998) /
                  report["standard_error"]["shear_modulus"].get<double>(),
              0, 4);
  EXPECT_NEAR((report["bulk_compliance"].get<double>() - 3 * 2e-4 / 1e4) /
                  report["standard_error"]["bulk_compliance"].get<double>(),
              0, 4);
  const std::string table = Succeed(command).output;
  for (const std::string words : {"95 % interval of nu", " to 0.5\n",
                                  "shear modulus mu", "1 / bulk modulus"}) {
    EXPECT_NE(table.find(words), std::string::npos) << table;
  }
}

// PETSc, which libelastimate_multigrid needs, takes longer to load than
// everything else.
TEST_F(CommandLine, LoadsNoModuleThatItDoesNotNeed) {
  MakeExactScene();
  const std::string loaded = (folder_ / "loaded").string();
  setenv("LD_DEBUG", "files", 1);
  setenv("LD_DEBUG_OUTPUT", loaded.c_str(), 1);
  Succeed("estimate exact.vtu");
  unsetenv("LD_DEBUG");
  unsetenv("LD_DEBUG_OUTPUT");
  std::string files;
  for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
    if (entry.path().string().rfind(loaded, 0) == 0) {
      files += ReadText(entry.path());
    }
  }
  EXPECT_NE(files.find("libvtk"), std::string::npos);
  EXPECT_EQ(files.find("libelastimate_multigrid"), std::string::npos);
}

TEST_F(CommandLine, PrintsATableForPeople) {
  MakeExactScene();
  const std::string table = Succeed("estimate exact.vtu").output;
  for (const std::string words : {"Young's modulus E", "10000", "+-", "0.33",
                                  "closed-form", "status", "ok"}) {
    EXPECT_NE(table.find(words), std::string::npos) << table;
  }
  EXPECT_THAT(table,
              ::testing::ContainsRegex(
                  "time +[0-9.e-]+ s to read the scene, [0-9.e-]+ s in all\n"));
}

TEST_F(CommandLine, ASceneThatIsNotUsableExitsWithOneAndStillReports) {
  Succeed("generate organ --out=organ.vtu");
  Succeed(
      "simulate organ.vtu --youngs=5e4 --nu=0.3 --noise=0.05 --seed=1 "
      "--out=noisy.vtu");
  const ProgramRun run = Run("estimate noisy.vtu --json=report.json");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_NE(run.output.find("NOT USABLE"), std::string::npos) << run.output;
  const nlohmann::json report =
      nlohmann::json::parse(ReadText(folder_ / "report.json"));
  EXPECT_EQ(report["usable"], false);
  EXPECT_NE(report["status"], "ok");
  EXPECT_TRUE(report["standard_error"]["youngs_modulus"].is_null());

  const nlohmann::json fit =
      Succeed("estimate noisy.vtu --json=- --estimator=iterative-fe").Json();
  EXPECT_NEAR((fit["youngs_modulus"].get<double>() - 5e4) /
                  fit["standard_error"]["youngs_modulus"].get<double>(),
              0, 4);
}

TEST_F(CommandLine, BoundsAndKnownValuesAreHonoured) {
  MakeExactScene();
  const nlohmann::json known =
      Succeed("estimate exact.vtu --nu=0.33 --json=-").Json();
  EXPECT_EQ(known["poisson_ratio"], 0.33);
  EXPECT_TRUE(known["standard_error"]["poisson_ratio"].is_null());
  EXPECT_EQ(known["options"]["nu"], 0.33);
  for (const std::string name : {"bounded", "iterative-fe"}) {
    const nlohmann::json bounded =
        Run("estimate exact.vtu --nu_max=0.3 --json=- --estimator=" + name)
            .Json();
    EXPECT_NEAR(bounded["poisson_ratio"].get<double>(), 0.3, 1e-9);
    EXPECT_EQ(bounded["diagnostics"]["active_bounds"],
              nlohmann::json({"nu_max"}));
    // The standard error is that of a fit without the bound, since the true nu
    // of 0.33 lies beyond the bound.
    EXPECT_GT(bounded["standard_error"]["poisson_ratio"].get<double>(), 0.01);
  }
}

TEST_F(CommandLine, SolvesByMultigridWhereAskedTo) {
  MakeExactScene();
  if (!HasMultigrid()) {
    Refuse("estimate exact.vtu --solver=multigrid", "built without PETSc");
    return;
  }
  const std::string simulate = "simulate exact.vtu --youngs=1e4 --nu=0.33 ";
  Succeed(simulate + "--solver=multigrid --out=multigrid.vtu");
  for (const std::string name : {"iterative-fe", "reduced-fe"}) {
    const std::string estimate = "estimate multigrid.vtu --estimator=" + name;
    const nlohmann::json report =
        Succeed(estimate + " --solver=multigrid --json=- --out=" + name +
                ".vtu")
            .Json();
    EXPECT_NEAR(report["youngs_modulus"].get<double>(), 1e4, 1);
    EXPECT_NEAR(report["poisson_ratio"].get<double>(), 0.33, 1e-4);
    EXPECT_EQ(report["work"]["factorizations"], 0);
    EXPECT_GE(report["work"]["multigrid_set_ups"], 1);
    EXPECT_GE(report["work"]["iterations"], 1);
    EXPECT_EQ(report["options"]["solver"], "multigrid");
    EXPECT_NE(Succeed(estimate + " --solver=multigrid")
                  .output.find(" multigrid set-up"),
              std::string::npos);
  }
}

TEST_F(CommandLine, NoiseHasTheNormThatWasAskedFor) {
  MakeExactScene();
  const Scene exact = Read("exact.vtu");
  for (const std::string law : {"uniform", "gaussian"}) {
    Succeed(
        "simulate cuboid.vtu --youngs=1e4 --nu=0.33 --noise=0.1 --seed=7 "
        "--out=noisy.vtu --noise_law=" +
        law);
    const Scene noisy = Read("noisy.vtu");
    const Eigen::MatrixXd noise =
        noisy.load_cases[0].displacement - exact.load_cases[0].displacement;
    EXPECT_NEAR(noise.norm() / exact.load_cases[0].displacement.norm(), 0.1,
                1e-12);
    const auto held = exact.supports.held;
    EXPECT_EQ(held.select(noise.array(), 0.0).matrix().norm(), 0);
    // The largest of 216 draws, in standard deviations, is below sqrt(3) for
    // the uniform law.  For a Gaussian it is above 2, but for a chance of 5e-5.
    const double largest =
        noise.cwiseAbs().maxCoeff() /
        std::sqrt(noise.squaredNorm() / double((!held).count()));
    EXPECT_EQ(law == "uniform", largest < 2) << law;
  }
  const std::string first = ReadText(folder_ / "noisy.vtu");
  Succeed(
      "simulate cuboid.vtu --youngs=1e4 --nu=0.33 --noise=0.1 --seed=7 "
      "--out=again.vtu --noise_law=gaussian");
  Succeed(
      "simulate cuboid.vtu --youngs=1e4 --nu=0.33 --noise=0.1 --seed=8 "
      "--out=other.vtu --noise_law=gaussian");
  EXPECT_EQ(Read("again.vtu").load_cases[0].displacement,
            Read("noisy.vtu").load_cases[0].displacement);
  EXPECT_NE(Read("other.vtu").load_cases[0].displacement,
            Read("noisy.vtu").load_cases[0].displacement);
}

TEST_F(CommandLine, SeveralFilesAreLoadCases) {
  const auto measure = [this](const std::string& force) {
    Succeed("generate cuboid --force=" + force + " --out=" + force + ".vtu");
    Succeed("simulate " + force + ".vtu --youngs=1e4 --nu=0.2 --out=m" + force +
            ".vtu");
  };
  measure("1,0,0");
  measure("0,0,-3");
  const nlohmann::json report =
      Succeed("estimate m1,0,0.vtu m0,0,-3.vtu --json=-").Json();
  EXPECT_EQ(report["mesh"]["load_cases"], 2);
  EXPECT_NEAR(report["poisson_ratio"].get<double>(), 0.2, 1e-9);
  Succeed("generate cuboid --cells=2,2,2 --out=small.vtu");
  Succeed("simulate small.vtu --youngs=1e4 --nu=0.2 --out=msmall.vtu");
  Refuse("estimate m1,0,0.vtu msmall.vtu", "msmall.vtu");
}

TEST_F(CommandLine, ReadsASceneThatIsWrittenOut) {
  Succeed("generate cuboid --out=cuboid.vtu");
  WriteText(folder_ / "scene.json", R"({
    "mesh": "cuboid.vtu",
    "supports": [{"nodes": {"box": [[-1, -1, -0.01], [2, 2, 0.01]]}}],
    "cases": [{"loads": [
      {"type": "traction", "value": [0, 0, -500],
       "surface": {"box": [[-1, -1, 0.39], [2, 2, 0.41]]}},
      {"type": "body_force", "value": [0, 0, -9810]}]}]
  })");
  Succeed("simulate scene.json --youngs=1e5 --nu=0.4 --out=measured.vtu");
  // The loads are 500 Pa on 1 m^2 and 9810 N/m^3 in 0.4 m^3.
  const Scene scene = Read("measured.vtu");
  EXPECT_NEAR(
      std::get<NodalForces>(scene.load_cases[0].loads[0]).force.row(2).sum(),
      -500 - 0.4 * 9810, 1e-9);
  const nlohmann::json report =
      Succeed("estimate measured.vtu --json=-").Json();
  EXPECT_NEAR(report["youngs_modulus"].get<double>() / 1e5, 1, 1e-9);
}

TEST_F(CommandLineOutputs, WritesWhatParaViewShows) {
  MakeExactScene();
  for (const std::string name : {"closed-form", "iterative-fe"}) {
    Succeed("estimate exact.vtu --out=result.vtu --estimator=" + name);
    const std::string result = ReadText(folder_ / "result.vtu");
    for (const std::string array :
         {"displacement", "force", "fixed", "fitted_displacement",
          "displacement_residual", "reaction_force", "strain_energy_density"}) {
      EXPECT_NE(result.find("Name=\"" + array + "\""), std::string::npos)
          << array;
    }
    // The result can be estimated again, as a scene.
    EXPECT_NEAR(Succeed("estimate result.vtu --json=-")
                    .Json()["poisson_ratio"]
                    .get<double>(),
                0.33, 1e-9);
  }
}

TEST_F(CommandLineErrors, RefusesWrongFlags) {
  MakeExactScene();
  Refuse("", "no command is given");
  Refuse("''", "unknown command ''");
  Refuse("estmate exact.vtu", "unknown command 'estmate'");
  Refuse("--nu=0.3 estimate exact.vtu", "the command comes first");
  Refuse("estimate", "needs a scene file");
  Refuse("estimate ''", "an argument of estimate is empty");
  Refuse("estimate exact.vtu ''", "an argument of estimate is empty");
  Refuse("estimate exact.vtu --poisson=0.3", "unknown flag --poisson");
  Refuse("estimate exact.vtu --youngs=1",
         "elastimate: estimate takes no flag --youngs; see elastimate estimate "
         "--help");
  Refuse("estimate exact.vtu --estimator=magic",
         "unknown estimator 'magic'; the estimators are closed-form");
  for (const std::string order : {"0", "3", "-1"}) {
    Refuse("estimate exact.vtu --order=" + order,
           "--order=" + order + "; it must be 1 for linear elements or 2");
    Refuse("simulate exact.vtu --youngs=1 --nu=0 --out=a.vtu --order=" + order,
           "--order=" + order + "; it must be 1 for linear elements or 2");
  }
  Refuse("estimate exact.vtu --estimator=reduced-fe --refine=1",
         "computed with this mesh");
  Refuse("estimate exact.vtu --noise_sd=0",
         "--noise_sd=0; it must be positive");
  Refuse("estimate exact.vtu --threads=-1", "--threads=-1");
  Refuse("simulate exact.vtu --youngs=1 --nu=0.3 --out=x.vtu --seed=-1",
         "--seed needs an integer from 0 to");
  Refuse("estimators exact.vtu", "takes no arguments; it got exact.vtu");
}

TEST_F(CommandLineErrors, TakesWhatFollowsTwoDashesForFiles) {
  MakeExactScene();
  std::filesystem::copy_file(folder_ / "exact.vtu", folder_ / "-nu=0.1.vtu");
  std::filesystem::copy_file(folder_ / "exact.vtu", folder_ / "--help");
  EXPECT_EQ(Succeed("estimate --json=- -- -nu=0.1.vtu").Json()["usable"], true);
  EXPECT_EQ(Succeed("estimate --json=- exact.vtu --").Json()["usable"], true);
  EXPECT_EQ(Succeed("estimate exact.vtu --json=- --").Json()["usable"], true);
  Refuse("estimate -nu=0.1.vtu", "--nu needs a finite number");
  Refuse("estimate -- --help", "elastimate: --help: the file name does not");
  Refuse("estimate -- --", "elastimate: --: no such file");
  Refuse("estimate exact.vtu --nu --", "--nu needs a finite number");
  Refuse("estimate --", "needs a scene file");
  Refuse("-- estimate exact.vtu", "the command comes first");
  EXPECT_NE(Succeed("--help").output.find("After -- every argument"),
            std::string::npos);
}

TEST_F(CommandLineErrors, RefusesWrongValues) {
  MakeExactScene();
  for (const std::string value : {"abc", "nan", "inf", "1e999", "0.3x"}) {
    Refuse("estimate exact.vtu --nu=" + value,
           "--nu needs a finite number; it got " + value);
  }
  for (const std::string flag : {"--nu", "--nu=", "--nu ''"}) {
    Refuse("estimate exact.vtu " + flag,
           "--nu needs a finite number, as in --nu=VALUE");
  }
  Refuse("estimate exact.vtu --json",
         "--json needs a value, as in --json=VALUE");
  Refuse("estimate exact.vtu --json --out=result.vtu",
         "--json needs a value, as in --json=VALUE");
  Refuse("estimate exact.vtu --threads=99999999999",
         "--threads needs an integer up to 2147483647");
  Refuse("estimate exact.vtu --nu=0.3 --nu=0.2",
         "--nu is given twice, as 0.3 and as 0.2");
  Refuse("estimate exact.vtu --nu 0.3 --nu=-0.2",
         "--nu is given twice, as 0.3 and as -0.2");
  Succeed("estimate exact.vtu --nu=0.3 --nu 0.3");
  Succeed("simulate cuboid.vtu --youngs 1 --nu -0.2 --out a.vtu");
}

TEST_F(CommandLineErrors, RefusesWrongParametersByTheirFlags) {
  MakeExactScene();
  Refuse("estimate exact.vtu --nu=0.5",
         "--nu=0.5; it must be above -1 and below 0.5");
  Refuse("estimate exact.vtu --nu=-1",
         "--nu=-1; it must be above -1 and below 0.5");
  const std::string bounded = "estimate exact.vtu --estimator=bounded ";
  Refuse(bounded + "--nu=0.3 --nu_max=0.4",
         "--nu=0.3 says that Poisson's ratio is known, and --nu_max=0.4");
  Refuse(bounded + "--nu_min=0.4 --nu_max=0.2",
         "--nu_min=0.4 is not below --nu_max=0.2");
  Refuse(bounded + "--nu_min=-1.1", "--nu_min=-1.1; it must be from -1");
  Refuse(bounded + "--nu_min=0.5", "--nu_min=0.5; it must be from -1");
  Refuse(bounded + "--nu_max=0.6", "--nu_max=0.6; it must be from above");
  Refuse(bounded + "--nu_max=-1", "--nu_max=-1; it must be from above");
  Refuse(bounded + "--youngs_min=-1", "--youngs_min=-1; it must be positive");
  Refuse(bounded + "--youngs_max=0", "--youngs_max=0; it must be positive");
  Refuse(bounded + "--youngs_min=2 --youngs_max=1",
         "--youngs_min=2 is not below --youngs_max=1");
  Refuse("estimate exact.vtu --nu_max=0.4 --youngs_min=1",
         "--nu_max=0.4 --youngs_min=1: closed-form: it cannot keep bounds");
  Refuse("estimate exact.vtu --loss=huber",
         "--loss=huber: closed-form: it takes no loss function");
  Refuse("estimate exact.vtu --solver=gmres",
         "--solver=gmres; it must be automatic, cholesky or multigrid");
  Refuse("estimate exact.vtu --loss=tukey",
         "--loss=tukey; it must be none, huber or cauchy");
}

TEST_F(CommandLineErrors, RefusesWrongSimulations) {
  Succeed("generate cuboid --out=cuboid.vtu");
  Refuse("simulate cuboid.vtu --youngs=1 --nu=0.3", "give --out");
  Refuse("simulate cuboid.vtu --youngs=1 --out=a.vtu", "--nu=NU");
  Refuse("simulate cuboid.vtu --youngs=0 --nu=0.3 --out=a.vtu",
         "--youngs=0; it must be positive");
  Refuse("simulate cuboid.vtu --youngs=1 --nu=0.5 --out=a.vtu",
         "--nu=0.5; it must be above -1 and below 0.5");
  Refuse("simulate cuboid.vtu --youngs=1 --nu=0.3 --noise=-1 --out=a.vtu",
         "--noise=-1; it must not be negative");
  Refuse("simulate cuboid.vtu --youngs=1 --nu=0.3 --noise_law=x --out=a.vtu",
         "uniform or gaussian");
  Refuse("simulate cuboid.vtu --youngs=1 --nu=0.3 --solver=x --out=a.vtu",
         "--solver=x; it must be automatic, cholesky or multigrid");
  Refuse("simulate --youngs=1 --nu=0.3 --out=a.vtu",
         "one scene file; it got none");
  Refuse("simulate a.vtu b.vtu --youngs=1 --nu=0.3 --out=c.vtu",
         "one scene file; it got a.vtu b.vtu");
  Refuse("simulate cuboid.vtu --youngs=1 --nu=0.49999999999999994 --out=a.vtu",
         "cuboid.vtu: ");
}

TEST_F(CommandLineErrors, RefusesWrongGeometriesByTheirFlags) {
  Refuse("generate sphere --out=a.vtu",
         "cuboid, organ, plate or rectangle; it got sphere");
  Refuse("generate --out=a.vtu",
         "one geometry, cuboid, organ, plate or rectangle; it got none");
  Refuse("generate cuboid", "give --out");
  const std::string cuboid = "generate cuboid --out=a.vtu ";
  Refuse(cuboid + "--tetrahedra=9", "takes no flag --tetrahedra");
  for (const std::string cells :
       {"1,1", "1.5,2,2", "1,2,3,", "99999999999,1,1", "a,b,c", "1,2,3x"}) {
    const std::string flag = "--cells=" + cells;
    Refuse(cuboid + flag, flag + "; it needs three integers");
  }
  Refuse(cuboid + "--cells=0,1,1", "--cells=0,1,1; each must be at least 1");
  Refuse(cuboid + "--cells=1000,1000,1000",
         "--cells=1000,1000,1000; the product must be at most");
  Refuse(cuboid + "--size=1e400,1,1", "it needs three finite numbers");
  Refuse(cuboid + "--size=1e200,1,1", "--size=1e+200,1,1; each must be from");
  Refuse(cuboid + "--size=1,1e-9,1", "--size=1,1e-09,1; a cell");
  Refuse(cuboid + "--force=nan,0,0", "it needs three finite numbers");
  Refuse(cuboid + "--force=0,0,inf", "it needs three finite numbers");
  Refuse(cuboid + "--force=1e60,0,0",
         "--force=1e+60,0,0; the largest must be from 1e-50 to 1e+50");
  Succeed(cuboid + "--force=0,0,0");
  const std::string organ = "generate organ --out=a.vtu ";
  Refuse(organ + "--cells=1,1,1", "takes no flag --cells");
  Refuse(organ + "--tetrahedra=1", "--tetrahedra=1; it must be from 200");
  Refuse(organ + "--tetrahedra=1e3", "--tetrahedra needs an integer");
  Refuse(organ + "--length=1e-200", "--length=1e-200; it must be from 1e-50");
  Refuse(organ + "--length=1e200", "--length=1e+200; it must be from 1e-50");
  Refuse(organ + "--length=0", "--length=0; it must be from 1e-50");
  Refuse(organ + "--force=1,2", "--force=1,2; it needs three finite numbers");
}

TEST_F(CommandLineOutputs, SaysWhenStandardOutputIsLost) {
  MakeExactScene();
  for (const std::string arguments :
       {"--help", "help", "--version", "estimators", "estimate exact.vtu",
        "estimate exact.vtu --json=-",
        "estimate exact.vtu --json=report.json --out=result.vtu",
        "generate cuboid --out=result.vtu"}) {
    Refuse(arguments,
           "standard output cannot be written (No space left on device)",
           ">/dev/full");
    Refuse(arguments, "standard output cannot be written (Bad file descriptor)",
           ">&-");
  }
  // `simulate` prints nothing here, so a closed standard output is no error.
  EXPECT_EQ(
      Run("simulate cuboid.vtu --youngs=1 --nu=0 --out=a.vtu", ">&-").exit_code,
      0);
  EXPECT_EQ(Read("a.vtu").mesh.NumElements(), 250);
}

TEST_F(CommandLineOutputs, EndsQuietlyWhereTheReaderOfStandardOutputIsGone) {
  MakeExactScene();
  ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  for (const std::string arguments :
       {"--help", "estimate --help", "estimate exact.vtu",
        "estimate exact.vtu --json=- --out=result.vtu"}) {
    const auto before = Files();
    // The shell's descriptor 3 lets the pipe open for writing; then it closes.
    // `exec` lets the test see how the program ended.
    const int status = std::system(("cd '" + folder_.string() +
                                    "' && exec '" ELASTIMATE_PROGRAM "' " +
                                    arguments + " 2>.errors 3<>pipe >pipe 3<&-")
                                       .c_str());
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGPIPE)
        << arguments << ": " << status;
    EXPECT_EQ(ReadText(folder_ / ".errors"), "") << arguments;
    EXPECT_EQ(Files(), before);
  }
}

TEST_F(CommandLineOutputs, WorksWithClosedStandardStreams) {
  MakeExactScene();
  EXPECT_EQ(Run("estimate exact.vtu --json=report.json --out=result.vtu",
                ">.output <&- 2>&-")
                .exit_code,
            0);
  EXPECT_EQ(nlohmann::json::parse(ReadText(folder_ / "report.json"))["usable"],
            true);
  EXPECT_EQ(Read("result.vtu").mesh.NumElements(), 250);
}

TEST_F(CommandLineOutputs, NeverOverwritesAnInput) {
  MakeExactScene();
  std::filesystem::create_directory(folder_ / "folder");
  std::filesystem::create_symlink("../exact.vtu",
                                  folder_ / "folder" / "link.vtu");
  for (const std::string name :
       {"exact.vtu", "./exact.vtu", "folder/../exact.vtu", "folder/link.vtu"}) {
    Refuse("estimate exact.vtu --out=" + name,
           "--out=" + name + " would overwrite the input exact.vtu");
    Refuse("estimate cuboid.vtu exact.vtu --json=" + name,
           "--json=" + name + " would overwrite the input exact.vtu");
    Refuse("simulate exact.vtu --youngs=1 --nu=0 --out=" + name,
           "would overwrite the input exact.vtu");
  }
  Refuse("estimate folder/link.vtu --out=exact.vtu",
         "would overwrite the input folder/link.vtu");
  WriteText(folder_ / "folder" / "scene.json",
            R"({"mesh": "../cuboid.vtu", "supports": [], "cases": []})");
  Refuse("estimate folder/scene.json --json=folder/scene.json",
         "would overwrite the input folder/scene.json");
  Refuse("simulate folder/scene.json --youngs=1 --nu=0 --out=cuboid.vtu",
         "would overwrite the input folder/../cuboid.vtu");
}

TEST_F(CommandLineErrors, RefusesTwoOutputsInOnePlace) {
  MakeExactScene();
  std::filesystem::create_symlink("result.vtu", folder_ / "link.json");
  for (const std::string json : {"result.vtu", "./result.vtu", "link.json"}) {
    Refuse("estimate exact.vtu --out=result.vtu --json=" + json,
           "--json=" + json + " and --out=result.vtu name the same file");
  }
  std::filesystem::create_symlink("/dev/stdout", folder_ / "link.vtu");
  Refuse("estimate exact.vtu --json=- --out=link.vtu",
         "--out=link.vtu is where standard output goes");
  Refuse("estimate exact.vtu --json=/dev/stdout",
         "--json=/dev/stdout is where standard output goes; choose another "
         "file, or --json=-");
  Refuse("estimate exact.vtu --json=.output",
         "--json=.output is where standard output goes");
  Succeed("estimate exact.vtu --json=/dev/null");
  EXPECT_EQ(Run("estimate exact.vtu --json=/dev/null", ">/dev/null").exit_code,
            0);
}

TEST_F(CommandLineOutputs, WritesAllOutputsOrNone) {
  MakeExactScene();
  Refuse("estimate exact.vtu --out=result.vtu --json=/dev/full",
         "/dev/full: cannot be written (No space left on device)");
  WriteText(folder_ / "result.vtu", "old");
  Refuse("estimate exact.vtu --out=result.vtu --json=/dev/full",
         "/dev/full: cannot be written");
  rlimit before = {};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small = {4000, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  Refuse("estimate exact.vtu --json=report.json --out=result.vtu",
         "result.vtu: cannot be written (File too large)");
  setrlimit(RLIMIT_FSIZE, &before);
  Refuse("estimate exact.vtu --json=report.json --out=no/result.vtu",
         "no/result.vtu: there is no folder");
}

TEST_F(CommandLineOutputs, WritesWholeFilesUnderADeviceFolderToo) {
  if (access("/dev/shm", W_OK) != 0) {
    GTEST_SKIP() << "no writable folder /dev/shm";
  }
  MakeExactScene();
  const std::string name = "/dev/shm/" + folder_.filename().string() + ".vtu";
  Succeed("estimate exact.vtu --out=" + name);
  const std::string once = ReadText(name);
  Succeed("estimate exact.vtu --out=" + name);
  EXPECT_EQ(ReadText(name), once);
  Succeed("estimate exact.vtu --json=" + name);
  EXPECT_EQ(nlohmann::json::parse(ReadText(name))["usable"], true);
  std::filesystem::remove(name);
}

TEST_F(CommandLineErrors, RefusesToWriteToAnOpenFile) {
  MakeExactScene();
  const std::string says = "this is the number of an open file, which could be";
  std::filesystem::create_symlink("/dev/fd/3", folder_ / "link.vtu");
  WriteText(folder_ / "open.json", "what was there");
  for (const std::string flag :
       {"--json=/dev/fd/3", "--json=/proc/self/fd/3", "--out=link.vtu"}) {
    Refuse("estimate exact.vtu " + flag, says, ">.output 3>>open.json");
  }
  Refuse("estimate exact.vtu --json=/dev/fd/987", says);
  Refuse("estimate exact.vtu --json=/dev/stderr",
         "--json=/dev/stderr is where standard error goes");
  Refuse("estimate exact.vtu --json=.errors",
         "--json=.errors is where standard error goes");
  Refuse("estimate exact.vtu --json=/dev/fd/3 --out=link.vtu", "same file",
         ">.output 3>/dev/null");
  // A shell makes such a pipe of >(command).
  EXPECT_EQ(Run("estimate exact.vtu --json=/dev/fd/3 3>&1 >/dev/null",
                "| cat >.output")
                .Json()["usable"],
            true);
}

TEST_F(CommandLineOutputs, WritesVtuFilesOnly) {
  MakeExactScene();
  for (const std::string command :
       {"estimate exact.vtu", "simulate cuboid.vtu --youngs=1 --nu=0",
        "generate cuboid", "generate organ"}) {
    for (const std::string name : {"out", "out.vtk", "vtu", "/dev/stdout"}) {
      const std::string flag = " --out=" + name;
      Refuse(command + flag, flag + "; the name must end in .vtu");
    }
  }
  Succeed("estimate exact.vtu --out=RESULT.VTU");
}

TEST_F(CommandLine, PrintsTheNoticesOfTheReader) {
  WriteText(folder_ / "points.vtk",
            "# vtk DataFile Version 3.0\n"
            "a point too many\n"
            "ASCII\n"
            "DATASET UNSTRUCTURED_GRID\n"
            "POINTS 5 double\n"
            "0 0 0  1 0 0  0 1 0  0 0 1  9 9 9\n"
            "CELLS 1 5\n"
            "4 0 1 2 3\n"
            "CELL_TYPES 1\n"
            "10\n"
            "POINT_DATA 5\n"
            "SCALARS fixed int 1\n"
            "LOOKUP_TABLE default\n"
            "1 1 1 0 0\n"
            "VECTORS force double\n"
            "0 0 0  0 0 0  0 0 0  1 0 1  0 0 0\n");
  const std::string notice =
      "elastimate: notice: points.vtk: 1 point that no tetrahedron uses is "
      "left out\n";
  EXPECT_EQ(
      Succeed("simulate points.vtk --youngs=1 --nu=0.25 --out=a.vtu").errors,
      notice);
  WriteText(folder_ / "points.vtk", ReadText(folder_ / "points.vtk") +
                                        "VECTORS displacement double\n"
                                        "0 0 0  0 0 0  0 0 0  1 0 1  0 0 0\n");
  EXPECT_EQ(Run("estimate points.vtk").errors, notice);
  // A run that ends with an error prints the error alone, without notices.
  Refuse("estimate points.vtk --nu_max=0.3", "cannot keep bounds");
}

TEST_F(CommandLine, OrdinaryOutcomesAreSilentOnStandardError) {
  MakeExactScene();
  for (const std::string flags :
       {"--estimator=bounded --youngs_min=1e300",
        "--estimator=bounded --youngs_max=1e-300",
        "--estimator=iterative-fe --youngs_min=1e300",
        "--estimator=iterative-fe --youngs_max=1e-300",
        "--estimator=iterative-fe --nu=0.4999999999999999"}) {
    const ProgramRun run = Run("estimate exact.vtu " + flags);
    EXPECT_NE(run.exit_code, 2) << flags;
    EXPECT_EQ(run.errors, "") << flags;
  }
}

TEST_F(CommandLine, HelpStatesTheDefaultsOfTheExampleScenes) {
  const std::string help = Succeed("generate --help").output;
  const auto text = [](const auto& triple) {
    std::ostringstream stream;
    stream << triple[0] << "," << triple[1] << "," << triple[2];
    return stream.str();
  };
  const CuboidOptions cuboid;
  const OrganOptions organ;
  const PlateOptions plate;
  const std::string size = std::to_string(int(plate.size.x())) + "," +
                           std::to_string(int(plate.size.y()));
  EXPECT_EQ(plate.hole, 2.5);
  for (const std::string& words :
       {"(default " + text(cuboid.cells) + ")",
        "(default " + text(cuboid.size) + ")",
        "per free node: cuboid " + text(cuboid.force) + ", organ " +
            text(organ.force) + "; in all: plate " +
            std::to_string(int(plate.force)),
        "(default " + std::to_string(organ.tetrahedra) + ")",
        std::string("(default 0.2)"), std::string("(default 2.5)"),
        "plate, one number: " + std::to_string(plate.cells) + " (",
        "plate, x,y: " + size + " ("}) {
    EXPECT_NE(help.find(words), std::string::npos) << words;
  }
  Succeed("generate cuboid --out=cuboid.vtu");
  EXPECT_EQ(Read("cuboid.vtu").mesh.nodes, CuboidScene(cuboid).mesh.nodes);
}

TEST_F(CommandLineErrors, SaysWhenNumbersLeaveDoublePrecision) {
  Succeed("generate cuboid --out=cuboid.vtu");
  const auto write_scene = [this](const std::string& displacement,
                                  const std::string& force) {
    std::string rows = "ux,uy,uz\n";
    for (Eigen::Index node = 0; node < Read("cuboid.vtu").mesh.NumNodes();
         ++node) {
      rows += "0,0," + displacement + "\n";
    }
    WriteText(folder_ / "u.csv", rows);
    WriteText(folder_ / "scene.json",
              R"({"mesh": "cuboid.vtu",
                  "supports": [{"nodes": {"box": [[-1, -1, 0], [2, 2, 0]]}}],
                  "cases": [{"displacement": {"file": "u.csv"}, "loads": [
                    {"type": "nodal_force", "nodes": "free",
                     "value": [0, 0, )" +
                  force + "]}]}]}");
  };
  for (const std::string value : {"1e-300", "1e+300"}) {
    write_scene(value, "1");
    Refuse("estimate scene.json",
           "scene.json: the measured displacement of load case 1 has the "
           "magnitude " +
               value);
    write_scene("1", value);
    Refuse("estimate scene.json",
           "scene.json: the force in load 1 of load case 1 has the magnitude " +
               value);
  }
  Refuse("simulate cuboid.vtu --youngs=1e-307 --nu=0 --out=a.vtu",
         "cuboid.vtu: the simulated displacement has the magnitude inf");
}

TEST_F(CommandLineErrors, RefusesWrongFilesByName) {
  MakeExactScene();
  Refuse("estimate nothing.vtu", "nothing.vtu");
  Refuse("estimate .", ".: this is a folder");
  Refuse("estimate cuboid.vtu", "displacement");
  WriteText(folder_ / "empty.vtu", "");
  Refuse("estimate empty.vtu", "empty.vtu");
  WriteText(folder_ / "text.vtu", "no VTK file at all");
  Refuse("estimate text.vtu", "text.vtu");
  const std::string whole = ReadText(folder_ / "exact.vtu");
  WriteText(folder_ / "cut.vtu", whole.substr(0, whole.size() / 2));
  Refuse("estimate cut.vtu --json=report.json --out=out.vtu", "cut.vtu");
  WriteText(folder_ / "scene.json", R"({"mesh": "cuboid.vtu", "loads": []})");
  Refuse("estimate scene.json", "loads");
  Refuse("estimate exact.vtu --json=no/such/folder/report.json",
         "no/such/folder");
  Refuse("estimate exact.vtu --out=no/such/folder/out.vtu", "no/such/folder");
  Refuse("generate cuboid --out=exact.vtu/out.vtu", "exact.vtu/out.vtu");
}

TEST_F(CommandLineErrors, NeedsSupportsForAFiniteElementFitOnly) {
  Succeed("generate cuboid --out=cuboid.vtu");
  WriteText(folder_ / "scene.json", R"({
    "mesh": "cuboid.vtu", "supports": [],
    "cases": [{"loads": [{"type": "nodal_force", "value": [0, 0, 1],
                          "nodes": "all"}]}]
  })");
  Refuse("simulate scene.json --youngs=1 --nu=0.3 --out=a.vtu",
         "without strain");
}

// ---------------------------------------------------------------------------
// Text of others in messages.

TEST_F(CommandLineErrors, QuotesOnlyWhatIsFitToPrint) {
  MakeExactScene();
  const std::string longest(2000, 'a');
  const std::string cut = std::string(37, 'a') + "..." + std::string(20, 'a');
  const std::string control = "$(printf 'a\\033[2J\\nb\\377')";
  const std::string shown = "a\\x1b[2J\\nb\\xff";
  for (const auto& [text, quoted] :
       {std::pair(longest, cut), std::pair("\"" + control + "\"", shown)}) {
    Refuse(text + " exact.vtu", "unknown command '" + quoted + "'");
    Refuse("estimate exact.vtu --" + text, "unknown flag --" + quoted + ";");
    Refuse("estimate exact.vtu --nu=" + text, "it got " + quoted + "\n");
    Refuse("estimate exact.vtu --loss=" + text, "--loss=" + quoted + ";");
    Refuse("estimate exact.vtu --solver=" + text, "--solver=" + quoted + ";");
    Refuse("estimate exact.vtu --estimator=" + text,
           "unknown estimator '" + quoted + "'");
    Refuse(
        "simulate cuboid.vtu --youngs=1 --nu=0 --out=a.vtu --noise_law=" + text,
        "--noise_law=" + quoted + ";");
    Refuse("generate " + text + " --out=a.vtu", "it got " + quoted + "\n");
    Refuse("generate cuboid --out=a.vtu --cells=" + text,
           "--cells=" + quoted + ";");
    Refuse("estimators " + text, "it got " + quoted + "\n");
  }
  Refuse("estimate \"" + control + ".vtu\"", shown + ".vtu: ");
  Refuse("estimate exact.vtu --json=\"" + control + "/r.json\"",
         shown + "/r.json: ");
  Refuse("estimate exact.vtu --out=\"" + control + "\"", "--out=" + shown);
  Refuse("estimate " + longest + ".vtu", std::string(157, 'a') + "...");
  Refuse("estimate Prüfkörper.vtu", "elastimate: Prüfkörper.vtu: no such file");
  const std::string name = "\"$(printf 'n\\033[2J.vtu')\"";
  Succeed("generate cuboid --out=" + name);
  const std::string says = "n\\x1b[2J.vtu";
  Refuse("estimate " + name,
         "elastimate: " + says + ": the point array 'displacement' is missing");
  Refuse("estimate exact.vtu " + name, "elastimate: " + says + ": ");
  Refuse("simulate " + name + " --youngs=1 --nu=0 --out=" + name,
         "--out=" + says + " would overwrite the input " + says);
}

// ---------------------------------------------------------------------------
// Signals.

class Signals : public CommandLine {
 protected:
  /// Sends the signal while the program has written one output and waits for a
  /// reader of the other one.  Returns the status that the program ends with.
  int Interrupt(int signal_number, void (*disposition)(int) = SIG_DFL) {
    const pid_t child = fork();
    if (child == 0) {
      std::signal(signal_number, disposition);
      const int null = open("/dev/null", O_RDWR);
      dup2(null, STDIN_FILENO);
      dup2(null, STDOUT_FILENO);
      dup2(null, STDERR_FILENO);
      if (chdir(folder_.c_str()) == 0) {
        execl(ELASTIMATE_PROGRAM, ELASTIMATE_PROGRAM, "estimate", "exact.vtu",
              "--out=result.vtu", "--json=pipe", nullptr);
      }
      _exit(99);
    }
    // The program opens the pipe only after the .part file is complete, so the
    // signal comes while that file is there.
    for (int i = 0; i < 3000 && NumParts() == 0; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    EXPECT_EQ(NumParts(), 1);
    kill(child, signal_number);
    if (disposition == SIG_IGN) {
      ReadText(folder_ / "pipe");
    }
    int status = 0;
    waitpid(child, &status, 0);
    return status;
  }

  std::ptrdiff_t NumParts() const {
    const std::filesystem::directory_iterator entries(folder_);
    return std::count_if(begin(entries), end(entries), [](const auto& entry) {
      return entry.path().extension() == ".part";
    });
  }
};

TEST_F(Signals, LeaveNoPartOfAnOutput) {
  MakeExactScene();
  WriteText(folder_ / "result.vtu", "old");
  ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  for (const int signal_number : {SIGHUP, SIGINT, SIGQUIT, SIGTERM}) {
    const int status = Interrupt(signal_number);
    EXPECT_TRUE(WIFSIGNALED(status)) << signal_number;
    EXPECT_EQ(WTERMSIG(status), signal_number);
    EXPECT_EQ(NumParts(), 0);
    EXPECT_EQ(ReadText(folder_ / "result.vtu"), "old");
  }
}

// nohup starts a program with SIGHUP ignored, and it has to stay ignored.
TEST_F(Signals, StayIgnoredWhereTheCallerSaysSo) {
  MakeExactScene();
  ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  const int status = Interrupt(SIGHUP, SIG_IGN);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
  EXPECT_EQ(NumParts(), 0);
  EXPECT_EQ(Read("result.vtu").mesh.NumElements(), 250);
}

// ---------------------------------------------------------------------------
// Loads.

/// A block under the total force F on its top of area A, which slides on three
/// of its sides: u = (F / (A E)) (-nu x, -nu y, z).
class Loads : public CommandLine {
 protected:
  static constexpr double kForce = -5;

  /// scene.json with these loads, and the displacement of E = 100 kPa and
  /// nu = 0.3.
  void WriteScene(const std::string& cells, const std::string& loads) const {
    Succeed("generate cuboid --size=2,3,0.4 --out=block.vtu --cells=" + cells);
    const double strain = kForce / (2 * 3 * 1e5);
    std::ostringstream rows;
    rows << std::setprecision(17) << "ux,uy,uz\n";
    const Mesh mesh = Read("block.vtu").mesh;
    for (Eigen::Index node = 0; node < mesh.NumNodes(); ++node) {
      const Eigen::Vector3d x = mesh.nodes.col(node);
      rows << -0.3 * strain * x(0) << "," << -0.3 * strain * x(1) << ","
           << strain * x(2) << "\n";
    }
    WriteText(folder_ / "u.csv", rows.str());
    WriteText(folder_ / "scene.json", R"({
      "mesh": "block.vtu",
      "supports": [
        {"nodes": {"box": [[-1, -1, 0], [9, 9, 0]]}, "components": "z"},
        {"nodes": {"box": [[0, -1, -1], [0, 9, 9]]}, "components": "x"},
        {"nodes": {"box": [[-1, 0, -1], [9, 0, 9]]}, "components": "y"}],
      "cases": [{"displacement": {"file": "u.csv"}, "loads": [)" +
                                          loads + "]}]}");
  }

  static std::string OnTop(const std::string& type, const std::string& value,
                           const std::string& where = "surface") {
    return R"({"type": ")" + type + R"(", "value": )" + value + R"(, ")" +
           where + R"(": {"box": [[-1, -1, 0.39], [9, 9, 0.41]]}})";
  }
};

TEST_F(Loads, ATotalForceGivesYoungsModulusOnAnyMesh) {
  for (const std::string cells : {"1,1,1", "3,2,2", "6,7,3"}) {
    WriteScene(cells, OnTop("force", "[0, 0, -5]"));
    for (const std::string flags :
         {"--estimator=closed-form", "--estimator=reduced-fe",
          "--estimator=reduced-fe --order=2"}) {
      SCOPED_TRACE(cells + " " + flags);
      const nlohmann::json report =
          Succeed("estimate scene.json --json=- " + flags).Json();
      EXPECT_NEAR(report["youngs_modulus"].get<double>() / 1e5, 1, 1e-6);
      EXPECT_NEAR(report["poisson_ratio"].get<double>(), 0.3, 1e-6);
      ASSERT_EQ(report["loads"].size(), 1);
      ASSERT_EQ(report["loads"][0].size(), 1);
      const nlohmann::json& load = report["loads"][0][0];
      EXPECT_EQ(load["type"], "force");
      EXPECT_EQ(load["resultant"], nlohmann::json({0., 0., -5.}));
      EXPECT_NEAR(load["area"].get<double>(), 6, 1e-12);
      EXPECT_TRUE(report["notices"].empty());
    }
  }
}

TEST_F(Loads, ANodalForceThatIsMeantAsATotalIsNoted) {
  WriteScene("3,2,2", OnTop("nodal_force", "[0, 0, -5]", "nodes"));
  const ProgramRun run = Run("estimate scene.json --json=-");
  const nlohmann::json report = run.Json();
  EXPECT_EQ(report["loads"], nlohmann::json::parse(R"([[{"type": "nodal_force",
                                        "resultant": [0, 0, -60],
                                        "area": null}]])"));
  ASSERT_EQ(report["notices"].size(), 1);
  const std::string notice = report["notices"][0];
  EXPECT_EQ(run.errors, "elastimate: notice: " + notice + "\n");
  EXPECT_NE(notice.find("[0, 0, -5] on each of 12 nodes, [0, 0, -60] in total"),
            std::string::npos)
      << notice;
}

TEST_F(Loads, AreInTheTable) {
  WriteScene("3,2,2", OnTop("force", "[0, 0, -5]") + "," +
                          OnTop("traction", "[0, 0.5, 0]") + "," +
                          OnTop("pressure", "0.25") + "," +
                          R"({"type": "body_force", "value": [0, 0, -10]})");
  const auto table = [this] { return Run("estimate scene.json").output; };
  for (const std::string line :
       {"load                  force, resultant (0, 0, -5) on an area of 6\n",
        "load                  traction, resultant (0, 3, 0) on an area of 6\n",
        "load                  pressure, resultant (0, 0, -1.5) on an area of "
        "6\n",
        "load                  body_force, resultant (0, 0, -24)\n"}) {
    EXPECT_NE(table().find(line), std::string::npos) << table();
  }
  std::string many = OnTop("force", "[0, 0, -5]");
  for (int i = 0; i < 5; ++i) {
    many += "," + OnTop("force", "[1, 0, 0]");
  }
  WriteScene("3,2,2", many);
  EXPECT_NE(table().find("load                  6 loads, resultant (5, 0, -5)"),
            std::string::npos)
      << table();
}

TEST_F(Loads, OfNodalForcesFromAFileAreOneEntryForEachCase) {
  Succeed("generate cuboid --force=0,0,-30 --out=a.vtu");
  Succeed("generate cuboid --force=2,0,0 --out=b.vtu");
  Succeed("simulate a.vtu --youngs=1e4 --nu=0.3 --out=ma.vtu");
  Succeed("simulate b.vtu --youngs=1e4 --nu=0.3 --out=mb.vtu");
  const nlohmann::json loads =
      Succeed("estimate ma.vtu mb.vtu --json=-").Json()["loads"];
  // The force acts on each of the 6 x 6 x 2 free nodes.
  EXPECT_EQ(loads, nlohmann::json::parse(
                       R"([[{"type": "nodal_force", "resultant": [0, 0, -2160],
                "area": null}],
              [{"type": "nodal_force", "resultant": [144, 0, 0],
                "area": null}]])"));
  const std::string table = Succeed("estimate ma.vtu mb.vtu").output;
  for (const std::string line :
       {"load case 1           nodal_force, resultant (0, 0, -2160)\n",
        "load case 2           nodal_force, resultant (144, 0, 0)\n"}) {
    EXPECT_NE(table.find(line), std::string::npos) << table;
  }
}

// ---------------------------------------------------------------------------
// Quadratic elements.

/// Scenes of elements that are no linear tetrahedra.
class ElementKinds : public CommandLine {
 protected:
  void ExpectFound(const std::string& scene, const std::string& flags,
                   const nlohmann::json& mesh) const {
    const nlohmann::json report =
        Succeed("estimate " + scene + " --json=- " + flags).Json();
    EXPECT_NEAR(report["youngs_modulus"].get<double>() / 7e10, 1, 1e-6);
    EXPECT_NEAR(report["poisson_ratio"].get<double>(), 0.33, 1e-6);
    for (const auto& [key, value] : mesh.items()) {
      EXPECT_EQ(report["mesh"][key], value) << key;
    }
  }
};

TEST_F(ElementKinds, AreGeneratedSimulatedAndEstimatedWithoutFurtherFlags) {
  EXPECT_EQ(Succeed("generate rectangle --out=g.vtu").output,
            "105 nodes, 80 quadrilaterals\n");
  Succeed("simulate g.vtu --youngs=7e10 --nu=0.33 --out=m.vtu");
  for (const std::string name : {"closed-form", "reduced-fe", "auto"}) {
    ExpectFound("m.vtu", "--estimator=" + name,
                {{"kind", "quad4"},
                 {"dimension", 2},
                 {"model", "plane_stress"},
                 {"thickness", 0.001},
                 {"nodes", 105},
                 {"elements", 80}});
  }
  EXPECT_FALSE(
      Succeed("estimate m.vtu --json=-").Json()["mesh"].contains("tetrahedra"));
  Succeed(
      "generate rectangle --elements=tri3 --cells=6,3 --size=2,1 --force=0,5 "
      "--model=plane_strain --thickness=0.5 --out=g.vtu");
  Succeed("simulate g.vtu --youngs=7e10 --nu=0.33 --out=m.vtu");
  ExpectFound(
      "m.vtu", "",
      {{"kind", "tri3"}, {"model", "plane_strain"}, {"thickness", 0.5}});
  EXPECT_EQ(Succeed("generate cuboid --elements=hex8 --out=g.vtu").output,
            "108 nodes, 50 hexahedra\n");
  EXPECT_EQ(
      Succeed("generate cuboid --elements=hex8 --cells=1,1,1 --out=one.vtu")
          .output,
      "8 nodes, 1 hexahedron\n");
  Succeed("simulate g.vtu --youngs=7e10 --nu=0.33 --out=m.vtu");
  ExpectFound("m.vtu", "--model=3d",
              {{"kind", "hex8"}, {"model", "3d"}, {"thickness", nullptr}});
}

TEST_F(ElementKinds, TakeTheSectionOfTheFlags) {
  Succeed("generate rectangle --out=g.vtu");
  Succeed(
      "simulate g.vtu --youngs=7e10 --nu=0.33 --thickness=0.002 "
      "--model=plane_strain --out=m.vtu");
  ExpectFound("m.vtu", "", {{"model", "plane_strain"}, {"thickness", 0.002}});
  // With twice the thickness, half the stiffness explains the same forces.
  const nlohmann::json report =
      Succeed("estimate m.vtu --thickness=0.004 --json=-").Json();
  EXPECT_NEAR(report["youngs_modulus"].get<double>() / 3.5e10, 1, 1e-6);
}

TEST_F(ElementKinds, AreInTheTable) {
  Succeed("generate rectangle --out=g.vtu");
  Succeed("simulate g.vtu --youngs=7e10 --nu=0.33 --out=m.vtu");
  EXPECT_THAT(Succeed("estimate m.vtu").output,
              ::testing::AllOf(
                  ::testing::HasSubstr("105 nodes, 80 quadrilaterals"),
                  ::testing::HasSubstr("plane stress, thickness 0.001\n"),
                  ::testing::HasSubstr("nodal_force, resultant (1000, 0)\n")));
}

TEST_F(ElementKinds, AreModelledWithQuadraticOnes) {
  for (const auto& [linear, quadratic] :
       {std::pair<std::string, std::string>("tri3", "tri6"),
        {"quad4", "quad9"}}) {
    Succeed("generate rectangle --elements=" + linear + " --out=g.vtu");
    Succeed("simulate g.vtu --order=2 --youngs=7e10 --nu=0.33 --out=m.vtu");
    ExpectFound("m.vtu", "--order=2 --origin=computed --estimator=iterative-fe",
                {{"kind", quadratic}, {"order", 2}});
  }
}

// The file has two quadratic triangles, which make a square of edges 2.  Its
// mid-edge nodes come before its vertices.
TEST_F(ElementKinds, OfQuadraticFilesStayQuadratic) {
  WriteText(folder_ / "mesh.vtk",
            "# vtk DataFile Version 3.0\nsquare\nASCII\n"
            "DATASET UNSTRUCTURED_GRID\nPOINTS 9 double\n"
            "1 0 0  2 1 0  1 1 0  1 2 0  0 1 0  0 0 0  2 0 0  2 2 0  0 2 0\n"
            "CELLS 2 14\n6 5 6 7 0 1 2\n6 5 7 8 2 3 4\nCELL_TYPES 2\n22 22\n");
  WriteText(folder_ / "scene.json", R"({"mesh": "mesh.vtk",
    "model": "plane_stress", "thickness": 0.1,
    "supports": [{"nodes": {"box": [[0, 0], [0, 2]]}}],
    "cases": [{"loads": [{"type": "traction", "value": [3e8, 1e8],
               "surface": {"box": [[2, 0], [2, 2]]}}]}]})");
  Succeed("simulate scene.json --youngs=7e10 --nu=0.33 --out=m.vtu");
  for (const std::string name :
       {"closed-form", "virtual-fields", "reduced-fe"}) {
    ExpectFound("m.vtu", "--out=r.vtu --origin=computed --estimator=" + name,
                {{"kind", "tri6"}, {"order", 2}, {"nodes", 4}});
  }
  ExpectFound("m.vtu", "--order=2 --origin=computed", {{"kind", "tri6"}});
  Refuse("estimate m.vtu --order=1",
         "--order=1: m.vtu has quadratic triangles; leave the flag out, or "
         "give a linear mesh");
  // A result keeps the order of the points of the file, in which the nodes 4, 5
  // and 8 are held.
  WriteText(folder_ / "array.json", R"({"mesh": "r.vtu", "supports": [],
    "cases": [{"displacement": {"array": "reaction_force"},
               "observed": {"ids": [4, 5, 8]}, "loads": []}]})");
  const LoadCase reactions = Read("array.json").load_cases[0];
  EXPECT_NEAR(reactions.displacement.row(0).sum(), -3e8 * 2 * 0.1, 1);
  EXPECT_NEAR(reactions.displacement.row(1).sum(), -1e8 * 2 * 0.1, 1);
  for (Eigen::Index node = 0; node < 9; ++node) {
    EXPECT_EQ(reactions.displacement.col(node).isZero(0),
              !reactions.observed(0, node));
  }
}

TEST_F(ElementKinds, RefuseWrongFlags) {
  Succeed("generate rectangle --out=g.vtu");
  Succeed("generate cuboid --out=c.vtu");
  const std::string simulate = " --youngs=1 --nu=0.3 --out=m.vtu ";
  Refuse("simulate g.vtu --model=2d" + simulate,
         "--model=2d; it must be 3d, plane_stress or plane_strain");
  Refuse("simulate g.vtu --thickness=0" + simulate,
         "--thickness=0; it must be positive");
  Refuse("simulate g.vtu --model=3d" + simulate,
         "g.vtu: the mesh is of quadrilaterals, which are planar, but the "
         "model is 3d");
  Refuse("simulate c.vtu --model=plane_stress" + simulate,
         "c.vtu: the mesh is of tetrahedra, which are solid, but the model is "
         "plane_stress; leave it out");
  Refuse("estimate c.vtu --thickness=1",
         "c.vtu: the mesh is of tetrahedra, which are solid, but a thickness "
         "is given; leave it out");
  const std::string rectangle = "generate rectangle --out=a.vtu ";
  Refuse(rectangle + "--elements=tet4",
         "--elements=tet4; a rectangle is made of");
  Refuse(rectangle + "--elements=tri",
         "--elements=tri; it must be tet4, hex8,");
  Refuse(rectangle + "--cells=1,2,3", "it needs two integers below 2^31, as");
  Refuse(rectangle + "--cells=0,3", "--cells=0,3; each must be at least 1");
  Refuse(rectangle + "--force=1e60,0", "--force=1e+60,0; the largest must be");
  Refuse(rectangle + "--model=3d", "--model=3d; a rectangle is in plane_");
  Refuse(rectangle + "--thickness=1e60", "--thickness=1e+60; it must be from");
  Refuse(rectangle + "--length=1", "generate rectangle takes no flag --length");
  Refuse("generate cuboid --elements=quad4 --out=a.vtu",
         "--elements=quad4; a cuboid is made of tet4 or hex8");
  Refuse("generate cuboid --thickness=1 --out=a.vtu",
         "generate cuboid takes no flag --thickness");
  Refuse("generate organ --elements=tet4 --out=a.vtu",
         "generate organ takes no flag --elements");
}

class QuadraticElements : public CommandLine {
 protected:
  /// Writes scene.json: cuboid.vtu with a traction and a body force, or
  /// `measured` and its displacement where that is given.
  void WriteScene(const std::string& measured) const {
    WriteText(folder_ / "scene.json",
              R"({
      "mesh": ")" +
                  (measured.empty() ? "cuboid.vtu" : measured) +
                  R"(",
      "supports": [{"nodes": {"box": [[-1, -1, -0.01], [2, 2, 0.01]]}}],
      "cases": [{)" +
                  (measured.empty()
                       ? ""
                       : R"("displacement": {"array": "displacement"},)") +
                  R"("loads": [
        {"type": "traction", "value": [100, 0, -500],
         "surface": {"box": [[-1, -1, 0.39], [2, 2, 0.41]]}},
        {"type": "body_force", "value": [0, 0, -9810]}]}]
    })");
  }

  /// Makes cuboid.vtu and, measured at E = 100 kPa, nu = 0.3 with quadratic
  /// elements and `flags`, measured.vtu, which scene.json then takes.
  void MakeMeasuredScene(const std::string& flags = "") const {
    Succeed("generate cuboid --cells=3,3,2 --out=cuboid.vtu");
    WriteScene("");
    Succeed(
        "simulate scene.json --youngs=1e5 --nu=0.3 --order=2 --out=measured.vtu"
        " " +
        flags);
    WriteScene("measured.vtu");
  }

  /// Reads an array of a result by a scene that names it as its displacement.
  Eigen::MatrixXd Array(const std::string& file,
                        const std::string& array) const {
    WriteText(folder_ / "array.json", R"({
      "mesh": ")" + file + R"(", "supports": [],
      "cases": [{"displacement": {"array": ")" +
                                          array + R"("}, "loads": []}]})");
    return Read("array.json").load_cases[0].displacement;
  }
};

TEST_F(QuadraticElements, RecoverWhatTheyMeasured) {
  MakeMeasuredScene();
  const nlohmann::json report =
      Succeed(
          "estimate scene.json --estimator=iterative-fe --order=2 --json=- "
          "--origin=computed")
          .Json();
  // An iterative estimator stops short of rounding.
  EXPECT_NEAR(report["youngs_modulus"].get<double>() / 1e5, 1, 1e-6);
  EXPECT_NEAR(report["poisson_ratio"].get<double>(), 0.3, 1e-6);
  EXPECT_EQ(report["mesh"]["order"], 2);
  EXPECT_EQ(report["mesh"]["nodes"], 4 * 4 * 3);
  EXPECT_EQ(report["mesh"]["tetrahedra"], 5 * 3 * 3 * 2);
  // A measurement is fitted with quadratic elements even without --order=2.
  const nlohmann::json measured =
      Succeed("estimate scene.json --estimator=iterative-fe --json=-").Json();
  EXPECT_EQ(measured["mesh"]["order"], 2);
  EXPECT_NEAR(measured["youngs_modulus"].get<double>(), 1e5,
              3 * measured["standard_error"]["youngs_modulus"].get<double>());
  EXPECT_GT(measured["diagnostics"]["discretization_error"].get<double>(), 0);
}

TEST_F(QuadraticElements, AreSaidInTheTable) {
  MakeMeasuredScene();
  const std::string table =
      Succeed("estimate scene.json --estimator=iterative-fe --order=2").output;
  EXPECT_NE(table.find("48 nodes, 90 quadratic tetrahedra"), std::string::npos)
      << table;
}

TEST_F(QuadraticElements, WriteTheLinearMesh) {
  MakeMeasuredScene();
  const Scene scene = Read("cuboid.vtu");
  const Scene measured = Read("measured.vtu");
  EXPECT_EQ(measured.mesh.nodes, scene.mesh.nodes);
  EXPECT_EQ(measured.mesh.elements, scene.mesh.elements);
  Succeed(
      "estimate scene.json --estimator=iterative-fe --order=2 "
      "--origin=computed --out=result.vtu");
  EXPECT_EQ(Read("result.vtu").mesh.elements, scene.mesh.elements);
  const Eigen::MatrixXd& displacement = measured.load_cases[0].displacement;
  EXPECT_LT((Array("result.vtu", "fitted_displacement") - displacement).norm(),
            1e-7 * displacement.norm());
  EXPECT_LT(Array("result.vtu", "displacement_residual").norm(),
            1e-7 * displacement.norm());
}

// The loads are 500 and 100 Pa on 1 m^2 and 9810 N/m^3 in 0.4 m^3.  The moments
// are about the origin.
TEST_F(QuadraticElements, ReactionsBalanceTheLoads) {
  MakeMeasuredScene();
  Succeed(
      "estimate scene.json --estimator=iterative-fe --order=2 "
      "--origin=computed --out=result.vtu");
  const Scene scene = Read("cuboid.vtu");
  const Eigen::MatrixXd reaction = Array("result.vtu", "reaction_force");
  const Eigen::Vector3d traction(100, 0, -500);
  const Eigen::Vector3d weight(0, 0, -0.4 * 9810);
  EXPECT_LT((reaction.rowwise().sum() + traction + weight).norm(), 1e-6);
  Eigen::Vector3d moment = Eigen::Vector3d(0.5, 0.5, 0.4).cross(traction) +
                           Eigen::Vector3d(0.5, 0.5, 0.2).cross(weight);
  for (Eigen::Index node = 0; node < reaction.cols(); ++node) {
    const Eigen::Vector3d x = scene.mesh.nodes.col(node);
    const Eigen::Vector3d force = reaction.col(node);
    moment += x.cross(force);
    EXPECT_TRUE(x(2) == 0 || force.isZero(0));
  }
  EXPECT_LT(moment.norm(), 1e-6);
}

TEST_F(QuadraticElements, NoiseIsRelativeToTheVertices) {
  MakeMeasuredScene();
  const Eigen::MatrixXd exact = Read("measured.vtu").load_cases[0].displacement;
  MakeMeasuredScene("--noise=0.1 --seed=7");
  const Eigen::MatrixXd noise =
      Read("measured.vtu").load_cases[0].displacement - exact;
  EXPECT_NEAR(noise.norm() / exact.norm(), 0.1, 1e-12);
}

TEST_F(QuadraticElements, NoticeWhatNodalForcesMean) {
  MakeExactScene();
  const std::string notice =
      "notice: with --order=2, nodal forces on all nodes of a face";
  // The notice appears whether the estimate is usable or not.
  const auto has_notice = [&](const std::string& arguments) {
    return Run(arguments).errors.find(notice) != std::string::npos;
  };
  EXPECT_TRUE(
      has_notice("estimate exact.vtu --estimator=iterative-fe --order=2"));
  EXPECT_FALSE(
      has_notice("estimate exact.vtu --estimator=iterative-fe --order=1"));
  EXPECT_TRUE(has_notice(
      "simulate cuboid.vtu --youngs=1 --nu=0 --order=2 --out=a.vtu"));
  WriteScene("exact.vtu");
  EXPECT_FALSE(
      has_notice("estimate scene.json --estimator=iterative-fe --order=2"));
}

// The file has nodal forces where the scene had a traction.
TEST_F(QuadraticElements, NoticeWhatBecomesOfOtherLoads) {
  Succeed("generate cuboid --out=cuboid.vtu");
  WriteScene("");
  const ProgramRun run = Succeed(
      "simulate scene.json --youngs=1 --nu=0 --order=2 --out=measured.vtu");
  EXPECT_NE(run.errors.find("notice: measured.vtu holds the loads as nodal "
                            "forces of linear elements"),
            std::string::npos)
      << run.errors;
  EXPECT_EQ(Succeed("simulate scene.json --youngs=1 --nu=0 --out=a.vtu").errors,
            "");
}

TEST_F(QuadraticElements, AreRefusedByEstimatorsThatCannot) {
  MakeMeasuredScene();
  for (const std::string name : {"closed-form", "bounded"}) {
    Refuse("estimate scene.json --order=2 --estimator=" + name,
           "elastimate: --order=2: " + name + ": the force residual");
    Refuse("estimate scene.json --order=2 --estimator=" + name,
           "not measured; use --estimator=reduced-fe");
  }
  Refuse("estimate scene.json --order=2 --nu_min=0.1",
         "--nu_min=0.1: closed-form: it cannot keep bounds");
}

}  // namespace
}  // namespace elastimate
