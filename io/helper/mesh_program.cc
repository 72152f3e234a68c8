#include "elastimate/io/helper/mesh_program.h"

#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <iostream>
#include <new>
#include <stdexcept>

#include "elastimate/io/helper/mesh_message.h"

#ifdef __SANITIZE_ADDRESS__
/// Stands in for the limit of memory, which cannot be set then.
extern "C" const char* __asan_default_options() {  // NOLINT
  return "max_allocation_size_mb=1000:detect_leaks=0";
}
#endif

namespace elastimate {
namespace {

constexpr int kOutput = 3;

std::FILE* output = nullptr;  // NOLINT: the handler of new has no argument.

void DieWithParent(pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) {  // It was too late to ask for the signal.
    _exit(EXIT_FAILURE);
  }
}

void LimitTime(rlim_t seconds) {
  const rlimit no_dump = {0, 0};
  setrlimit(RLIMIT_CORE, &no_dump);
  if (seconds > 0) {
    const rlimit limit = {seconds, seconds + 1};
    setrlimit(RLIMIT_CPU, &limit);
  }
}

/// What the process takes without doing anything.
rlim_t AddressSpaceInUse() {
  std::uint64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * sysconf(_SC_PAGESIZE);
}

/// Limits what is taken beyond what is in use, and tells whether there is less
/// than that.
bool LimitMemory(rlim_t bytes) {
  rlimit limit{};
  getrlimit(RLIMIT_AS, &limit);
  const rlim_t own = AddressSpaceInUse() + bytes;
  if (bytes == 0 || limit.rlim_cur < own) {
    return limit.rlim_cur != RLIM_INFINITY;
  }
#ifndef __SANITIZE_ADDRESS__  // It takes terabytes of address space.
  limit.rlim_cur = own;
  setrlimit(RLIMIT_AS, &limit);
#endif
  return false;
}

void TellOfLackOfMemory() {
  WriteSentence(output, MeshMessage::Kind::kOutOfMemory, "");
  _exit(EXIT_FAILURE);
}

void TellMesh(
    const std::function<MeshFile(const std::vector<std::string>&)>& make,
    const std::vector<std::string>& arguments) {
  using Kind = MeshMessage::Kind;
  try {
    WriteMesh(output, make(arguments));
  } catch (const std::invalid_argument& error) {
    WriteSentence(output, Kind::kWrongInput, error.what());
  } catch (const std::bad_alloc&) {
    TellOfLackOfMemory();
  } catch (const std::exception& error) {
    WriteSentence(output, Kind::kFailure, error.what());
  }
}

}  // namespace

int RunMeshProgram(
    int argc, char** argv,
    const std::function<MeshFile(const std::vector<std::string>&)>& make) {
  output = argc > 4 ? fdopen(kOutput, "wb") : nullptr;
  if (output == nullptr) {
    std::cerr << "This is a part of the library elastimate_io, which starts it "
                 "to read a file.\n";
    return EXIT_FAILURE;
  }
  const auto number = [&](int i) {
    return std::strtoull(argv[i], nullptr, 10);
  };
  DieWithParent(static_cast<pid_t>(number(1)));
  LimitTime(number(2));
  WriteStart(output, LimitMemory(number(3)));
  // Not all code that gets no memory says so.
  std::set_new_handler(TellOfLackOfMemory);
  TellMesh(make, {argv + 4, argv + argc});
  // To take a large mesh apart would take long, and is of no use.
  _exit(EXIT_SUCCESS);
}

}  // namespace elastimate
