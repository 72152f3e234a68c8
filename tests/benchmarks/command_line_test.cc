// Runs the built benchmark program with wrong arguments.

#include <gtest/gtest.h>

#include <string>

#include "tests/program.h"

namespace elastimate {
namespace {

class BenchmarkCommandLine : public testing::ProgramTest {};

TEST_F(BenchmarkCommandLine, HelpNamesCommandFlagsAndStudies) {
  const std::string help = Succeed("--help").output;
  for (const std::string words :
       {"elastimate_benchmark study", "elastimate_benchmark kernels", "--name",
        "--out", "--quick", "paper"}) {
    EXPECT_NE(help.find(words), std::string::npos) << words;
  }
}

TEST_F(BenchmarkCommandLine, RefusesWrongArguments) {
  Refuse("", "give a command");
  Refuse("studies", "unknown command 'studies'");
  Refuse("study --out=.", "study needs --name=STUDY; the studies are paper");
  Refuse("study --name=papers --out=.",
         "--name=papers; there is no such study; the studies are paper");
  Refuse("study --name=paper", "study needs --out=FOLDER");
  Refuse("study --name=paper --out=. quick", "it got quick");
  Refuse("study --name=paper --out=. --quick=fast",
         "--quick needs true or false; it got fast");
  Refuse("study --name=paper --out=. --fast", "unknown flag --fast");
}

TEST_F(BenchmarkCommandLine, RefusesWrongArgumentsOfKernels) {
  Refuse("kernels quick", "kernels takes flags only; it got quick");
  Refuse("kernels --name=paper", "--name");
  Refuse("kernels --out=nowhere", "make the folder first");
}

TEST_F(BenchmarkCommandLine, RefusesAFolderThatCannotBeWritten) {
  Refuse("study --name=paper --out=nowhere", "make the folder first");
  testing::WriteText(folder_ / "file", "");
  Refuse("study --name=paper --out=file", "make the folder first");
}

}  // namespace
}  // namespace elastimate
