#include "elastimate/io/file_output.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>
#include <iterator>
#include <thread>

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
