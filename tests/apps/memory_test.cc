// Tests of the program where it may take little memory (ulimit -v).

#include "tests/program.h"

namespace elastimate::testing {
namespace {

class LittleMemory : public ProgramTest {
 protected:
  /// Runs the program with a limit of its address space.
  ProgramRun RunWithin(int megabytes, const std::string& arguments) const {
    const std::string command =
        "cd '" + folder_.string() + "' && ulimit -c 0 && ulimit -v " +
        std::to_string(1000 * megabytes) + " && timeout 300 '" +
        ELASTIMATE_PROGRAM "' " + arguments + " >.output 2>.errors </dev/null";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1,
            ReadText(folder_ / ".output"), ReadText(folder_ / ".errors")};
  }
};

TEST_F(LittleMemory, EndsWithASentenceOrWithTheResult) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the sanitizer takes terabytes of address space";
#endif
  Succeed("generate cuboid --out=cuboid.vtu");
  Succeed("simulate cuboid.vtu --youngs=1e4 --nu=0.33 --out=exact.vtu");
  int num_refused = 0;
  int num_done = 0;
  for (int megabytes = 20; megabytes <= 420; megabytes += 25) {
    // With too little memory the libraries cannot be loaded, or abort while
    // they are.  No line of the program has run then, so there is nothing to
    // test.
    if (RunWithin(megabytes, "--version").exit_code != 0) continue;
    for (const std::string arguments :
         {"estimate exact.vtu", "estimate exact.vtu --estimator=reduced-fe"}) {
      SCOPED_TRACE(arguments + " within " + std::to_string(megabytes) + " MB");
      const ProgramRun run = RunWithin(megabytes, arguments);
      if (run.exit_code == 2) {
        ++num_refused;
        EXPECT_NE(run.errors.find("elastimate: "), std::string::npos);
        EXPECT_NE(run.errors.find("memory"), std::string::npos) << run.errors;
      } else {
        ++num_done;
        EXPECT_EQ(run.exit_code, 0) << run.errors;
        EXPECT_NE(run.output.find("status"), std::string::npos);
      }
    }
  }
  EXPECT_GT(num_refused, 0);
  EXPECT_GT(num_done, 0);
}

// A lack of memory must not be reported as a damaged file.
TEST_F(LittleMemory, IsNotTakenForADamagedFile) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the sanitizer takes terabytes of address space";
#endif
  WriteText(folder_ / "one.msh",
            "$NOD\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$ENDNOD\n"
            "$ELM\n1\n1 4 1 1 4 1 2 3 4\n$ENDELM\n");
  WriteText(folder_ / "one.json",
            R"({"mesh": "one.msh", "supports": [{"nodes": {"ids": [0, 1, 2]}}],
                "cases": [{"loads": [{"type": "body_force",
                                      "value": [0, 0, 1]}]}]})");
  for (int megabytes = 220; megabytes <= 420; megabytes += 40) {
    SCOPED_TRACE(megabytes);
    const ProgramRun run = RunWithin(
        megabytes, "simulate one.json --youngs=1 --nu=0.3 --out=out.vtu");
    EXPECT_EQ(run.errors.find("damaged"), std::string::npos) << run.errors;
    if (run.exit_code != 0) {
      EXPECT_EQ(run.exit_code, 2);
      EXPECT_NE(run.errors.find("memory"), std::string::npos) << run.errors;
    }
  }
}

}  // namespace
}  // namespace elastimate::testing
