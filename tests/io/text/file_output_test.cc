#include "elastimate/io/text/file_output.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <thread>
#include <vector>

#include "tests/io/scene_files.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

namespace fs = std::filesystem;

class FileOutputTest : public ::testing::Test {
 protected:
  /// Besides what the tests themselves made there is never a file left.
  std::ptrdiff_t NumFiles() const {
    return std::distance(fs::directory_iterator(folder_.Path()), {});
  }
  const TemporaryFolder folder_;
};

TEST_F(FileOutputTest, WritesAndReplaces) {
  const fs::path path = folder_.Path() / "out.json";
  std::string content("a\0b\n", 4);
  WriteWholeFile(path, content);
  EXPECT_EQ(ReadFile(path), content);
  content.assign(3000000, 'x');
  WriteWholeFile(path, content);
  EXPECT_EQ(ReadFile(path), content);
  WriteWholeFile(path, "");
  EXPECT_EQ(ReadFile(path), "");
  EXPECT_EQ(NumFiles(), 1);
}

TEST_F(FileOutputTest, WritesInTheCurrentFolder) {
  const fs::path before = fs::current_path();
  fs::current_path(folder_.Path());
  WriteWholeFile("out.json", "here");
  fs::current_path(before);
  EXPECT_EQ(ReadFile(folder_.Path() / "out.json"), "here");
}

TEST_F(FileOutputTest, FollowsUmaskAndKeepsPermissions) {
  const mode_t before = umask(027);
  const fs::path path = folder_.Path() / "out.json";
  WriteWholeFile(path, "new");
  umask(before);
  EXPECT_EQ(static_cast<unsigned>(fs::status(path).permissions()), 0640U);
  fs::permissions(path, static_cast<fs::perms>(0604));
  WriteWholeFile(path, "newer");
  EXPECT_EQ(static_cast<unsigned>(fs::status(path).permissions()), 0604U);
}

TEST_F(FileOutputTest, WritesThroughSymbolicLinks) {
  fs::create_directory(folder_.Path() / "data");
  const fs::path link = folder_.Path() / "link.json";
  fs::create_symlink("data/target.json", link);
  for (const std::string content : {"dangling before", "existing before"}) {
    WriteWholeFile(link, content);
    EXPECT_TRUE(fs::is_symlink(link));
    EXPECT_EQ(ReadFile(folder_.Path() / "data" / "target.json"), content);
  }
}

TEST_F(FileOutputTest, WritesToPipesInPlace) {
  const fs::path pipe = folder_.Path() / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  std::string received;
  std::thread reader([&] { received = ReadFile(pipe); });
  WriteWholeFile(pipe, "through the pipe");
  reader.join();
  EXPECT_EQ(received, "through the pipe");
  EXPECT_TRUE(fs::is_fifo(pipe));
  EXPECT_NO_THROW(WriteWholeFile("/dev/null", "gone"));
}

// Memory under a device folder, as /dev/shm is, holds files like any other.
TEST_F(FileOutputTest, ReplacesFilesUnderADeviceFolder) {
  if (access("/dev/shm", W_OK) != 0) {
    GTEST_SKIP() << "no writable folder /dev/shm";
  }
  std::string name = "/dev/shm/elastimate-XXXXXX";
  const int descriptor = mkstemp(name.data());
  ASSERT_GE(descriptor, 0);
  close(descriptor);
  WriteWholeFile(name, "first");
  WriteWholeFile(name, "second");
  EXPECT_EQ(ReadFile(name), "second");
  unlink(name.c_str());
}

TEST_F(FileOutputTest, RefusesOpenFilesByTheirNumber) {
  const fs::path file = folder_.Write("open.json", "what was there");
  const int descriptor = open(file.c_str(), O_WRONLY | O_APPEND);
  ASSERT_GE(descriptor, 0);
  const std::string number = std::to_string(descriptor);
  fs::create_symlink("/dev/fd/" + number, folder_.Path() / "link.json");
  for (const fs::path& name :
       {fs::path("/dev/fd/" + number), fs::path("/proc/self/fd/" + number),
        folder_.Path() / "link.json", fs::path("/dev/fd/987")}) {
    EXPECT_THROWS_WITH(CheckWritable(name),
                       "this is the number of an open file");
    EXPECT_THROWS_WITH(WriteWholeFile(name, "x"),
                       "this is the number of an open file");
  }
  close(descriptor);
  EXPECT_EQ(ReadFile(file), "what was there");
  // A pipe has no name of its own: the shell gives it so.
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  WriteWholeFile("/dev/fd/" + std::to_string(ends[1]), "through the pipe");
  close(ends[1]);
  char received[32] = {};
  EXPECT_EQ(read(ends[0], received, sizeof received), 16);
  EXPECT_STREQ(received, "through the pipe");
  close(ends[0]);
}

TEST_F(FileOutputTest, RefusesWhatIsNoFile) {
  const int descriptor = socket(AF_UNIX, SOCK_STREAM, 0);
  ASSERT_GE(descriptor, 0);
  const fs::path path = folder_.Path() / "socket";
  sockaddr_un address = {};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, path.c_str(), sizeof address.sun_path - 1);
  ASSERT_EQ(bind(descriptor, reinterpret_cast<const sockaddr*>(&address),
                 sizeof address),
            0);
  EXPECT_THROWS_WITH(WriteWholeFile(path, "x"), "this is a disk or a socket");
  close(descriptor);
}

TEST_F(FileOutputTest, UnlinksOnlyWhatIsStaged) {
  const fs::path old = folder_.Write("old.json", "old");
  const fs::path other = folder_.Path() / "new.vtu";
  StagedFiles files;
  files.Add(old, "newer");
  files.Add(other, "new");
  WriteWholeFile(folder_.Path() / "whole.json", "whole");
  EXPECT_EQ(NumFiles(), 4);
  UnlinkStagedFiles();
  EXPECT_EQ(NumFiles(), 2);
  EXPECT_EQ(ReadFile(old), "old");
  EXPECT_EQ(ReadFile(folder_.Path() / "whole.json"), "whole");
}

// Places for names are used again, by several threads at once.
TEST_F(FileOutputTest, WritesFromSeveralThreads) {
  std::vector<std::thread> threads;
  threads.reserve(4);
  for (int thread = 0; thread < 4; ++thread) {
    threads.emplace_back([this, thread] {
      for (int i = 0; i < 20; ++i) {
        WriteWholeFile(folder_.Path() / std::to_string(thread),
                       std::to_string(i));
      }
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  UnlinkStagedFiles();
  EXPECT_EQ(NumFiles(), 4);
  EXPECT_EQ(ReadFile(folder_.Path() / "3"), "19");
}

TEST_F(FileOutputTest, LeavesTheOldFileWhenItFails) {
  const fs::path path = folder_.Write("out.json", "old");
  rlimit before = {};
  getrlimit(RLIMIT_FSIZE, &before);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small = {1000, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  EXPECT_THROWS_WITH(WriteWholeFile(path, std::string(5000, 'x')),
                     "out.json: cannot be written \\(File too large");
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(ReadFile(path), "old");
  EXPECT_EQ(NumFiles(), 1);
}

TEST_F(FileOutputTest, FilesAppearTogetherOrNotAtAll) {
  const fs::path old = folder_.Write("old.json", "old");
  const fs::path other = folder_.Path() / "new.vtu";
  {
    StagedFiles files;
    files.Add(other, "new");
    files.Add(old, "newer");
    EXPECT_THROWS_WITH(files.Add("/dev/full", "x"), "/dev/full: cannot be");
  }
  EXPECT_EQ(ReadFile(old), "old");
  EXPECT_EQ(NumFiles(), 1);
  StagedFiles files;
  files.Add(other, "new");
  files.Add(old, "newer");
  EXPECT_FALSE(fs::exists(other));
  EXPECT_EQ(ReadFile(old), "old");
  files.Commit();
  EXPECT_EQ(ReadFile(other), "new");
  EXPECT_EQ(ReadFile(old), "newer");
  EXPECT_EQ(NumFiles(), 2);
}

TEST_F(FileOutputTest, KnowsAFileByItsOtherNames) {
  const fs::path file = folder_.Write("file", "");
  const fs::path missing = folder_.Path() / "missing";
  fs::create_symlink("file", folder_.Path() / "link");
  fs::create_symlink("missing", folder_.Path() / "dangling");
  fs::create_hard_link(file, folder_.Path() / "twin");
  for (const std::string name : {"file", "./file", "link", "twin"}) {
    EXPECT_TRUE(AreSameFile(file, folder_.Path() / name)) << name;
    EXPECT_FALSE(AreSameFile(missing, folder_.Path() / name)) << name;
  }
  for (const std::string name : {"missing", "./missing", "dangling"}) {
    EXPECT_TRUE(AreSameFile(missing, folder_.Path() / name)) << name;
    EXPECT_FALSE(AreSameFile(file, folder_.Path() / name)) << name;
  }
  EXPECT_TRUE(AreSameFile("missing", fs::current_path() / "missing"));
  EXPECT_FALSE(AreSameFile("missing", "other"));
  EXPECT_FALSE(AreSameFile("", "other"));
}

TEST_F(FileOutputTest, ErrsWithTheReason) {
  const fs::path file = folder_.Write("file", "");
  for (const auto& write :
       {+[](const fs::path& path) { WriteWholeFile(path, "x"); },
        +[](const fs::path& path) { CheckWritable(path); }}) {
    EXPECT_THROWS_WITH(write(folder_.Path()), ": this is a folder");
    EXPECT_THROWS_WITH(write(folder_.Path() / "no" / "out.vtu"),
                       "out.vtu: there is no folder '.*/no' to write it in");
    EXPECT_THROWS_WITH(write(file / "out.vtu"), "out.vtu: there is no folder");
    EXPECT_THROWS_WITH(write(""), "names no file");
    EXPECT_THROWS_WITH(write(folder_.Path() / "out/"), "out/: ");
  }
  EXPECT_THROWS_WITH(WriteWholeFile("/dev/full", "x"),
                     "/dev/full: cannot be written \\(No space left");
  EXPECT_THROWS_WITH(WriteWholeFile("/proc/out.json", "x"),
                     "/proc/out.json: cannot be written");
  EXPECT_EQ(NumFiles(), 1);
}

TEST_F(FileOutputTest, CheckCreatesNothing) {
  CheckWritable(folder_.Path() / "out.vtu");
  CheckWritable("/dev/null");
  EXPECT_EQ(NumFiles(), 0);
  const fs::path path = folder_.Write("out.vtu", "old");
  CheckWritable(path);
  EXPECT_EQ(ReadFile(path), "old");
}

}  // namespace
}  // namespace elastimate
