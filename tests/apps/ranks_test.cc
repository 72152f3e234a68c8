// Runs the program as several processes of MPI.

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "elastimate/core/solvers/multigrid.h"
#include "elastimate/io/scene/scene_reader.h"
#include "tests/program.h"

namespace elastimate::testing {
namespace {

class SolvesOfRanks : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    if (std::string(ELASTIMATE_MPIRUN).empty() || !HasMultigrid()) {
      GTEST_SKIP() << "there is no mpirun, or no PETSc";
    }
  }

  // Runs the program with these arguments as so many processes.
  ProgramRun RunOn(int num_ranks, const std::string& arguments) const {
    return RunRanks("-n " + std::to_string(num_ranks) +
                    " '" ELASTIMATE_PROGRAM "' " + arguments);
  }

  ProgramRun RunRanks(const std::string& arguments) const {
    const std::string command =
        "cd '" + folder_.string() +
        "' && OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 "
        "OMPI_MCA_mpi_yield_when_idle=1 OMP_NUM_THREADS=1 '" ELASTIMATE_MPIRUN
        "' --oversubscribe " +
        arguments + " >.output 2>.errors </dev/null";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1,
            ReadText(folder_ / ".output"), ReadText(folder_ / ".errors")};
  }

  nlohmann::json EstimateOn(int num_ranks, const std::string& arguments) const {
    const ProgramRun run =
        RunOn(num_ranks, "estimate " + arguments +
                             " --solver=multigrid --json=- --out=out.vtu");
    EXPECT_EQ(run.exit_code, 0) << arguments << "\n" << run.errors;
    return nlohmann::json::parse(run.output);
  }
};

// A suite of its own may run beside the other.
class EstimatesOfRanks : public SolvesOfRanks {};

TEST_F(EstimatesOfRanks, AreThoseOfOne) {
  Succeed("generate cuboid --cells=4,3,4 --out=block.vtu");
  const std::string simulate =
      "simulate block.vtu --youngs=1e8 --nu=0.3 --noise=0.01 ";
  Succeed(simulate + "--out=computed.vtu");
  Succeed(simulate + "--order=2 --out=measured.vtu");
  struct Fit {
    std::string arguments;
    double tolerance;
    std::vector<int> ranks;
  };
  // Fits with quadratic elements solve their systems to 1e-5.
  for (const Fit& fit :
       {Fit{"computed.vtu --estimator=reduced-fe", 1e-8, {2, 3, 4}},
        Fit{"computed.vtu --estimator=iterative-fe", 1e-8, {3}},
        Fit{"measured.vtu --estimator=auto", 1e-5, {2}}}) {
    const nlohmann::json of_one = EstimateOn(1, fit.arguments);
    EXPECT_EQ(of_one["work"]["ranks"], 1);
    for (const int num_ranks : fit.ranks) {
      SCOPED_TRACE(fit.arguments + " on " + std::to_string(num_ranks));
      const nlohmann::json report = EstimateOn(num_ranks, fit.arguments);
      EXPECT_EQ(report["work"]["ranks"], num_ranks);
      EXPECT_EQ(report["work"]["factorizations"], 0);
      for (const std::string name : {"youngs_modulus", "poisson_ratio"}) {
        const double expected = of_one[name].get<double>();
        EXPECT_NEAR(report[name].get<double>(), expected,
                    fit.tolerance * std::abs(expected))
            << name;
      }
    }
  }
}

TEST_F(SolvesOfRanks, SimulateWhatOneDoes) {
  for (const std::string shape :
       {"cuboid --cells=5,4,7", "organ --tetrahedra=600", "rectangle",
        "cuboid --elements=hex8"}) {
    Succeed("generate " + shape + " --out=body.vtu");
    for (const int num_ranks : {1, 3}) {
      const ProgramRun run = RunOn(num_ranks,
                                   "simulate body.vtu --youngs=1e5 --nu=0.3 "
                                   "--solver=multigrid --out=" +
                                       std::to_string(num_ranks) + ".vtu");

      ASSERT_EQ(run.exit_code, 0) << run.errors;
      EXPECT_EQ(run.errors.find("factorised"), std::string::npos) << run.errors;
    }
    const auto displacement = [&](const std::string& file) {
      return ReadScene({folder_ / file}, Measurement::kOptional)
          .scene.load_cases[0]
          .displacement;
    };
    EXPECT_TRUE(displacement("3.vtu").isApprox(displacement("1.vtu"), 1e-7))
        << shape;
  }
}

TEST_F(SolvesOfRanks, RefuseWithOneSentence) {
  const ProgramRun run = RunOn(3, "estimate none.vtu --out=out.vtu");
  EXPECT_EQ(run.exit_code, 2);
  const std::size_t place = run.errors.find("none.vtu");
  EXPECT_NE(place, std::string::npos) << run.errors;
  EXPECT_EQ(run.errors.find("none.vtu", place + 1), std::string::npos)
      << run.errors;
  EXPECT_TRUE(Files().empty());
}

TEST_F(SolvesOfRanks, EndWhereOneIsLost) {
  Succeed("generate cuboid --out=block.vtu");
  const ProgramRun run =
      RunRanks("-n 1 '" ELASTIMATE_PROGRAM
               "' simulate block.vtu --youngs=1e5 --nu=0.3 --solver=multigrid "
               "--out=out.vtu : -n 1 false");
  EXPECT_NE(run.exit_code, 0);
  EXPECT_EQ(Files().count((folder_ / "out.vtu").string()), 0U);
}

// Nine frames of a body under one load, of which the last one cannot be read.
class SeriesOfRanks : public SolvesOfRanks {
 protected:
  void SetUp() override {
    SolvesOfRanks::SetUp();
    if (IsSkipped()) {
      return;
    }
    Succeed("generate cuboid --cells=3,3,4 --size=3,3,4 --out=body.vtu");
    WriteScene("scene", "");
    for (int i = 1; i <= 8; ++i) {
      Succeed(
          "simulate scene.json --youngs=1000 --nu=0.3 --noise_sd=1e-4 "
          "--points=100 --seed=" +
          std::to_string(i) + " --out=frame_" + std::to_string(i) + ".csv");
    }
    WriteText(folder_ / "frame_9.csv", "x,y,z,ux,uy,uz\n1,2,3,abc,4,5\n");
    WriteScene("scene", R"(, "frames": {"files": "frame_*.csv"})");
    WriteScene("fewer", R"(, "frames": {"files": ["frame_1.csv"]})");
  }

  void WriteScene(const std::string& name, const std::string& frames) const {
    WriteText(folder_ / (name + ".json"), R"({
  "mesh": "body.vtu", "origin": "computed",
  "supports": [ {"nodes": {"box": [[-1, -1, -0.1], [4, 4, 0.1]]}} ],
  "cases": [
    { "loads": [ {"type": "force", "value": [10, 0, -20],
                  "surface": {"box": [[-1, -1, 3.9], [4, 4, 4.1]]}} ] } ])" +
                                              frames + "}");
  }

  // Returns the report, without what differs from run to run, and the table.
  std::pair<nlohmann::json, std::string> FramesOn(
      int num_ranks, const std::string& flags) const {
    const ProgramRun run = RunOn(
        num_ranks, "estimate scene.json --series=series.csv --json=- " + flags);
    EXPECT_EQ(run.exit_code, 0) << run.errors;
    nlohmann::json report = nlohmann::json::parse(run.output);
    EXPECT_EQ(report["work"]["ranks"], num_ranks);
    EXPECT_EQ(report["series"]["used"], 8);
    report["work"].erase("ranks");
    report.erase("seconds");
    return {report, ReadText(folder_ / "series.csv")};
  }

  // Has rank 1 run with other arguments than rank 0.
  void RefuseOther(const std::string& arguments,
                   const std::string& sentence) const {
    SCOPED_TRACE(arguments);
    const auto before = Files();
    const ProgramRun run =
        RunRanks("-n 1 '" ELASTIMATE_PROGRAM
                 "' estimate scene.json --estimator=reduced-fe --series=a.csv "
                 ": -n 1 '" ELASTIMATE_PROGRAM "' " +
                 arguments);
    EXPECT_EQ(run.exit_code, 2) << run.errors;
    EXPECT_NE(run.errors.find("elastimate: rank 1: " + sentence),
              std::string::npos)
        << run.errors;
    EXPECT_EQ(Files(), before);
  }
};

TEST_F(SeriesOfRanks, IsThatOfOne) {
  for (const std::string flags :
       {"--estimator=iterative-fe",
        "--estimator=auto --solver=multigrid --loss=huber"}) {
    const auto [report, table] = FramesOn(1, flags);
    EXPECT_NE(table.find("\n9,frame_9.csv,1.0,not_run,"), std::string::npos)
        << table;
    for (const int num_ranks : {2, 3, 4}) {
      SCOPED_TRACE(flags + " on " + std::to_string(num_ranks));
      const auto [report_of_ranks, table_of_ranks] = FramesOn(num_ranks, flags);
      EXPECT_EQ(table_of_ranks, table);
      EXPECT_EQ(report_of_ranks, report);
    }
  }
}

TEST_F(SeriesOfRanks, IsRefusedWithOneSentence) {
  const auto before = Files();
  const ProgramRun run =
      RunOn(2, "estimate scene.json --estimator=virtual-fields --series=a.csv");
  EXPECT_EQ(run.exit_code, 2);
  const std::string place = "frame_1.csv: virtual-fields: ";
  EXPECT_EQ(run.errors.find(place), run.errors.rfind(place)) << run.errors;
  EXPECT_NE(run.errors.find(place), std::string::npos) << run.errors;
  EXPECT_EQ(Files(), before);
}

TEST_F(SeriesOfRanks, EndsWhereOneHasOtherFiles) {
  RefuseOther("estimate none.json", "none.json: ");
  RefuseOther("estimate fewer.json --estimator=reduced-fe",
              "the number of frames is not that of");
  // Neither writes anything.
  RefuseOther("check fewer.json", "this rank does not estimate frames");
  WriteScene("single", "");
  RefuseOther("estimate single.json --estimator=reduced-fe --json=b.json", "");
}

}  // namespace
}  // namespace elastimate::testing
