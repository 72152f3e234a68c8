// The command that tells what this installation can do on this machine.

#include <hwy/highway.h>

#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "apps/commands.h"
#include "apps/linear_algebra.h"
#include "apps/outputs.h"
#include "elastimate/core/package/package_file.h"
#include "elastimate/core/package/version.h"
#include "elastimate/core/solvers/multigrid.h"

namespace elastimate {
namespace {

std::string DescribeMultigrid() {
  const std::string why_not = WhyNoMultigrid();
  return why_not.empty()
             ? "there (--solver=multigrid)"
             : "not there, so that large scenes take more memory: " + why_not;
}

std::string DescribeGmsh() {
  const std::string path = FindPackageFile("elastimate-gmsh");
  return path.empty()
             ? "not there, so that files that only Gmsh reads are refused"
             : "there, " + path;
}

}  // namespace

int RunDoctor(const std::vector<std::string>& arguments) {
  CheckNoArguments("doctor", arguments);
  std::ostringstream text;
  text << "version                 " << Version() << "\n"
       << "processors              " << std::thread::hardware_concurrency()
       << "\n"
       << "vector instructions     "
       << hwy::TargetName(hwy::SupportedTargets() & -hwy::SupportedTargets())
       << "\n"
       << "BLAS                    " << DescribeBlas() << "\n"
       << "multigrid of PETSc      " << DescribeMultigrid() << "\n"
       << "reader of Gmsh's files  " << DescribeGmsh() << "\n";
  WriteStandardOutput(text.str());
  return 0;
}

}  // namespace elastimate
