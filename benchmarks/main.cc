// The studies behind the charts of benchmarks/README.md.

#include <gflags/gflags.h>
#include <glog/logging.h>

#include <exception>
#include <filesystem>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "apps/flag_parser.h"
#include "apps/progress.h"
#include "benchmarks/metadata.h"
#include "benchmarks/paper_study.h"
#include "benchmarks/scaling_study.h"
#include "benchmarks/speed_accuracy_study.h"
#include "benchmarks/stability_study.h"
#include "benchmarks/study.h"
#include "elastimate/io/file_output.h"

DEFINE_string(name, "", "the study, as listed below");
DEFINE_string(out, "", "existing folder for the CSV and JSON files");
DEFINE_bool(quick, false, "fewer trials");

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
    {"stability", "where each estimator fails, and whether it says so",
     RunStabilityStudy},
};

const Program& Benchmark() {
  static const Program program = {"elastimate_benchmark",
                                  {{"study",
                                    "",
                                    "runs a study and writes its tables",
                                    {"name", "out", "quick"}}}};
  return program;
}

std::string Help() {
  std::ostringstream help;
  help << "elastimate_benchmark: the studies that compare the estimators.\n"
       << CommandsHelp(Benchmark()) << "\nStudies:\n";
  for (const NamedStudy& study : kStudies) {
    help << "      " << study.name << "  " << study.summary << "\n";
  }
  help << "\nExit code: 0, or 2 for wrong flags, or an output that cannot be "
          "written.\n";
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
  const StudyResult result = study.run(FLAGS_quick, progress);
  metadata["parameters"] = result.parameters;
  StagedFiles files;
  for (const Table& table : result.tables) {
    files.Add(folder / (table.Name() + ".csv"), table.Csv());
    metadata["tables"].push_back(table.Name() + ".csv");
  }
  files.Add(metadata_file, metadata.dump(2) + "\n");
  files.Commit();
}

std::string Joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) {
    text += (text.empty() ? "" : " ") + word;
  }
  return text;
}

void Run(const std::vector<std::string>& words) {
  const std::vector<std::string> arguments(words.begin() + 1, words.end());
  if (arguments.empty()) {
    throw std::invalid_argument(
        "give a command; see elastimate_benchmark --help");
  }
  if (AsksForHelp(arguments)) {
    std::cout << Help();
    return;
  }
  const std::vector<std::string> others =
      ParseFlags(Benchmark(), FindCommand(Benchmark(), arguments[0]),
                 {arguments.begin() + 1, arguments.end()});
  if (!others.empty()) {
    throw std::invalid_argument("study takes flags only; it got " +
                                Joined(others));
  }
  RunStudy(Joined(words));
}

}  // namespace
}  // namespace elastimate

int main(int argc, char** argv) {
  // The status of an estimate says what Ceres would have warned of.
  FLAGS_minloglevel = google::GLOG_FATAL;
  FLAGS_logtostderr = true;
  google::InitGoogleLogging(argv[0]);
  try {
    elastimate::Run({argv, argv + argc});
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "elastimate_benchmark: " << error.what() << "\n";
  }
  return 2;
}
