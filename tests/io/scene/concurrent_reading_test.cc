#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <string>
#include <thread>
#include <vector>

#include "elastimate/io/scene/scene_reader.h"
#include "tests/io/gmsh_files.h"
#include "tests/io/scene_files.h"
#include "tests/io/vtk_files.h"

namespace elastimate {
namespace {

class ConcurrentReading : public ::testing::Test {
 protected:
  ConcurrentReading() {
    for (const int encoding : {0, 2, 7, 10, 13}) {
      const VtkEncoding how = AllVtkEncodings()[encoding];
      paths_.push_back(folder_.Path() / (how.name + how.Extension()));
      WriteEncoded(paths_.back(), scene_.mesh, SceneFields(scene_), how);
    }
    paths_.push_back(folder_.Write("scene.msh", GmshVersion4Scene()));
    paths_.push_back(folder_.Write(
        "scene.json",
        R"({"mesh": "scene.msh", "supports": [{"nodes": {"array": "fixed"}}],
            "cases": [{"displacement": {"array": "displacement"},
            "loads": [{"type": "nodal_force", "array": "force"}]}]})"));
    damaged_ = folder_.Write(
        "damaged.vtk", Replaced(LegacySceneText(), "POINTS 6", "POINTS 7"));
    damaged_xml_ = folder_.Write(
        "damaged.vtu", Replaced(ReadFile(paths_[0]), "NumberOfPoints=\"5",
                                "NumberOfPoints=\"4"));
  }

  /// Whether all files give what they should.
  bool ReadsAll() const {
    bool is_right = true;
    for (const auto& path : paths_) {
      const Scene scene = ReadScene({path}, Measurement::kRequired).scene;
      is_right = is_right && scene.mesh.NumNodes() == 5;
    }
    for (const auto& path : {damaged_, damaged_xml_}) {
      try {
        ReadScene({path}, Measurement::kRequired);
        is_right = false;
      } catch (const std::invalid_argument& error) {
        is_right =
            is_right && std::string(error.what()).find(path.string()) == 0;
      }
    }
    return is_right;
  }

  const TemporaryFolder folder_;
  const Scene scene_ = TwoTetrahedra();
  std::vector<std::filesystem::path> paths_;
  std::filesystem::path damaged_;
  std::filesystem::path damaged_xml_;
};

TEST_F(ConcurrentReading, IsThatOfOneThread) {
  constexpr int kThreads = 6;
  std::vector<int> is_right(kThreads, 0);
  std::vector<std::thread> threads;
  for (int i = 0; i < kThreads; ++i) {
    threads.emplace_back([&, i] { is_right[i] = ReadsAll() && ReadsAll(); });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  EXPECT_EQ(is_right, std::vector<int>(kThreads, 1));
}

TEST_F(ConcurrentReading, DoesNotMindWhatTheProgramDoesAboutItsChildren) {
  auto* const before = std::signal(SIGCHLD, SIG_IGN);
  EXPECT_TRUE(ReadsAll());
  std::signal(SIGCHLD, before);
}

TEST_F(ConcurrentReading, DoesNotNeedStandardStreams) {
  EXPECT_EXIT(
      {
        for (const int stream : {0, 1, 2}) {
          close(stream);
        }
        _exit(ReadsAll() ? 0 : 1);
      },
      ::testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace elastimate
