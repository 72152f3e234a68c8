// The kernel times, and the studies behind the charts of benchmarks/README.md.

#include <gflags/gflags.h>
#include <glog/logging.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "apps/flag_parser.h"
#include "apps/linear_algebra.h"
#include "apps/progress.h"
#include "benchmarks/kernels.h"
#include "benchmarks/large_deformation_study.h"
#include "benchmarks/maps_study.h"
#include "benchmarks/materials_study.h"
#include "benchmarks/measurement_study.h"
#include "benchmarks/metadata.h"
#include "benchmarks/paper_study.h"
#include "benchmarks/scaling_study.h"
#include "benchmarks/solver_study.h"
#include "benchmarks/speed_accuracy_study.h"
#include "benchmarks/stability_study.h"
#include "benchmarks/study.h"
#include "benchmarks/unseen_study.h"
#include "elastimate/io/text/file_output.h"
#include "elastimate/petsc/start_petsc.h"

DEFINE_string(name, "", "the study, as listed below");
DEFINE_string(out, "", "existing folder for the CSV and JSON files");
DEFINE_bool(quick, false, "fewer trials, smaller meshes");

namespace elastimate {
namespace {

struct NamedStudy {
  const char* name;
  const char* summary;
  Study run;
};

constexpr NamedStudy kStudies[] = {
    {"paper", "the experiments of Becker & Teschner 2007, section 5",
     RunPaperStudy},
    {"speed_accuracy", "time against error of every estimator",
     RunSpeedAccuracyStudy},
    {"scaling", "time and memory against the number of tetrahedra",
     RunScalingStudy},
    {"solvers", "time and memory of the linear solvers", RunSolverStudy},
    {"stability", "where each estimator fails, and whether it says so",
     RunStabilityStudy},
    {"unseen", "whether error bars hold on shapes that nothing was built on",
     RunUnseenStudy},
    {"measurement", "what cameras, grips and load cells do to the estimate",
     RunMeasurementStudy},
    {"materials", "how well several materials are told apart, and how many",
     RunMaterialsStudy},
    {"large_deformation", "what bending and stretch do to the estimate",
     RunLargeDeformationStudy},
    {"maps", "how well the modulus of every element is found", RunMapsStudy},
};

const Program& Benchmark() {
  static const Program program = {
      "elastimate_benchmark",
      {{"study",
        "",
        "runs a study and writes its tables",
        {{"", {{"name"}, {"out"}, {"quick"}}}}},
       {"kernels",
        "",
        "times the kernels, prints the table and, with --out, writes it",
        {{"", {{"out"}, {"quick"}}}}}}};
  return program;
}

std::string Help() {
  std::ostringstream help;
  help << "elastimate_benchmark: the studies that compare the estimators, and "
          "the times of the kernels.\n"
       << CommandHelp(Benchmark(), FindCommand(Benchmark(), "study"))
       << CommandHelp(Benchmark(), FindCommand(Benchmark(), "kernels"))
       << "\nStudies:\n";
  for (const NamedStudy& study : kStudies) {
    help << "      " << study.name << "  " << study.summary << "\n";
  }
  help << "\nExit code: 0; 1 when the kernels are slower than the recorded "
          "bounds; 2 for\nwrong flags, or an output that cannot be written.\n";
  return help.str();
}

const NamedStudy& StudyFromFlags() {
  std::string names;
  for (const NamedStudy& study : kStudies) {
    if (study.name == FLAGS_name) {
      return study;
    }
    names += (names.empty() ? "" : ", ") + std::string(study.name);
  }
  throw std::invalid_argument(
      (IsGiven("name") ? AsGiven("name") + "; there is no such study"
                       : "study needs --name=STUDY") +
      "; the studies are " + names);
}

void WriteResult(const StudyResult& result,
                 const std::filesystem::path& metadata_file,
                 nlohmann::ordered_json metadata) {
  metadata["parameters"] = result.parameters;
  StagedFiles files;
  for (const Table& table : result.tables) {
    files.Add(metadata_file.parent_path() / (table.Name() + ".csv"),
              table.Csv());
    metadata["tables"].push_back(table.Name() + ".csv");
  }
  files.Add(metadata_file, metadata.dump(2) + "\n");
  files.Commit();
}

void RunStudy(const std::string& command) {
  const NamedStudy& study = StudyFromFlags();
  if (FLAGS_out.empty()) {
    throw std::invalid_argument("study needs --out=FOLDER");
  }
  const std::filesystem::path folder = FLAGS_out;
  const std::filesystem::path metadata_file =
      folder / (std::string(study.name) + ".json");
  CheckWritable(metadata_file);

  nlohmann::ordered_json metadata = DescribeRun(command);
  Progress progress(study.name);
  WriteResult(study.run(FLAGS_quick, progress), metadata_file, metadata);
}

// The table of comma-separated cells in columns, for people.
std::string Aligned(const std::string& csv) {
  std::vector<std::vector<std::string>> rows;
  std::vector<std::size_t> widths;
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);) {
    rows.emplace_back();
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) {
      const std::size_t column = rows.back().size();
      widths.resize(std::max(widths.size(), column + 1));
      widths[column] = std::max(widths[column], cell.size());
      rows.back().push_back(cell);
    }
  }
  std::ostringstream text;
  for (const std::vector<std::string>& row : rows) {
    for (std::size_t column = 0; column < row.size(); ++column) {
      text << std::left << std::setw(static_cast<int>(widths[column]) + 2)
           << row[column];
    }
    text << "\n";
  }
  return text.str();
}

// Returns the exit code.
int RunKernels(const std::string& command) {
  const std::filesystem::path metadata_file =
      std::filesystem::path(FLAGS_out) / "kernels.json";
  if (!FLAGS_out.empty()) {
    CheckWritable(metadata_file);
  }
  KernelTimes times;
  {
    const nlohmann::ordered_json metadata = DescribeRun(command);
    Progress progress("kernels");
    times = TimeKernels(FLAGS_quick, progress);
    if (!FLAGS_out.empty()) {
      WriteResult(times.result, metadata_file, metadata);
    }
  }
  std::cout << Aligned(times.result.tables[0].Csv()) << "\n";
  for (const std::string& ratio : times.ratios) {
    std::cout << ratio << "\n";
  }
  for (const std::string& regression : times.regressions) {
    std::cerr << "elastimate_benchmark: " << regression << "\n";
  }
  return times.regressions.empty() ? 0 : 1;
}

std::string Joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) {
    text += (text.empty() ? "" : " ") + word;
  }
  return text;
}

// Returns the exit code.
int Run(const std::vector<std::string>& words) {
  const std::vector<std::string> arguments(words.begin() + 1, words.end());
  if (arguments.empty()) {
    throw std::invalid_argument(
        "give a command; see elastimate_benchmark --help");
  }
  if (AsksForHelp(arguments)) {
    std::cout << Help();
    return 0;
  }
  const std::vector<std::string> others =
      ParseFlags(Benchmark(), FindCommand(Benchmark(), arguments[0]),
                 {arguments.begin() + 1, arguments.end()});
  if (!others.empty()) {
    throw std::invalid_argument(arguments[0] + " takes flags only; it got " +
                                Joined(others));
  }
  if (arguments[0] == "kernels") {
    return RunKernels(Joined(words));
  }
  RunStudy(Joined(words));
  return 0;
}

}  // namespace
}  // namespace elastimate

int main(int argc, char** argv) {
  elastimate::UseBlasKernelsOfProcessor(argv);
  // The status of an estimate says what Ceres would have warned of.
  FLAGS_minloglevel = google::GLOG_FATAL;
  FLAGS_logtostderr = true;
  google::InitGoogleLogging(argv[0]);
  elastimate::StartPetscWhenNeeded();
  try {
    return elastimate::Run({argv, argv + argc});
  } catch (const std::exception& error) {
    std::cerr << "elastimate_benchmark: " << error.what() << "\n";
  }
  return 2;
}
