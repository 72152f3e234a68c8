// Cuts files at many places and spoils bytes of them: the outcome must be a
// scene or std::invalid_argument, whatever the damage.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "elastimate/io/scene_reader.h"
#include "tests/io/gmsh_files.h"
#include "tests/io/scene_files.h"
#include "tests/io/vtk_files.h"

namespace elastimate {
namespace {

struct Sample {
  std::string name;
  std::string extension;
  std::string content;
  int num_trials;
};

std::vector<Sample> VtkSamples() {
  const TemporaryFolder folder;
  const Scene scene = TwoTetrahedra();
  std::vector<Sample> samples;
  for (const VtkEncoding& encoding : AllVtkEncodings()) {
    const auto path = folder.Path() / ("scene" + encoding.Extension());
    WriteEncoded(path, scene.mesh, SceneFields(scene), encoding);
    samples.push_back(
        {encoding.name, encoding.Extension(), ReadFile(path), 150});
  }
  return samples;
}

std::vector<Sample> AllSamples() {
  std::vector<Sample> samples = VtkSamples();
  samples.push_back({"GmshVersion1", ".msh", GmshVersion1Scene(), 60});
  samples.push_back({"GmshVersion2", ".msh", GmshVersion2Scene(), 60});
  samples.push_back({"GmshVersion4", ".msh", GmshVersion4Scene(), 60});
  return samples;
}

class DamagedFileTest : public ::testing::TestWithParam<Sample> {
 protected:
  /// The error message, or "valid".
  std::string Read(const std::string& content) const {
    const auto path = folder_.Write("scene" + GetParam().extension, content);
    try {
      ReadScene({path}, Measurement::kRequired);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "valid";
  }

  const TemporaryFolder folder_;
};

class CutFileTest : public DamagedFileTest {};

TEST_P(CutFileTest, IsNeverTakenForAWholeOne) {
  const std::string& content = GetParam().content;
  ASSERT_EQ(Read(content), "valid");
  // What is left off at the end may be white space and closing words only.
  const std::size_t harmless = 60;
  for (int i = 0; i < GetParam().num_trials; ++i) {
    const std::size_t size =
        i * (content.size() - harmless) / GetParam().num_trials;
    const std::string outcome = Read(content.substr(0, size));
    EXPECT_NE(outcome, "valid")
        << "cut at " << size << " of " << content.size();
    EXPECT_THAT(outcome, ::testing::HasSubstr("scene."));
  }
}

TEST_P(DamagedFileTest, EndsWellWhenBytesAreSpoilt) {
  const std::string& content = GetParam().content;
  std::mt19937 random(20071);
  ::testing::internal::CaptureStderr();
  for (int i = 0; i < GetParam().num_trials; ++i) {
    std::string spoilt = content;
    for (unsigned k = 0; k <= random() % 4; ++k) {
      char& byte = spoilt[random() % spoilt.size()];
      byte = static_cast<char>(i % 2 == 0 ? byte ^ (1 << random() % 8)
                                          : random() % 256);
    }
    EXPECT_NO_FATAL_FAILURE(Read(spoilt));
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST_P(DamagedFileTest, EndsWellWhenNumbersAreSpoilt) {
  const std::string& content = GetParam().content;
  std::mt19937 random(20072);
  for (int i = 0; i < GetParam().num_trials; ++i) {
    std::string spoilt = content;
    const std::size_t digit =
        spoilt.find_first_of("0123456789", random() % spoilt.size());
    if (digit == std::string::npos) {
      continue;
    }
    const std::string replacements[] = {"", "-", "99999999999", "x", "7"};
    spoilt.replace(digit, 1, replacements[random() % 5]);
    EXPECT_NO_FATAL_FAILURE(Read(spoilt));
  }
}

std::string NameOf(const ::testing::TestParamInfo<Sample>& sample) {
  return sample.param.name;
}

INSTANTIATE_TEST_SUITE_P(All, CutFileTest, ::testing::ValuesIn(AllSamples()),
                         NameOf);

// Not with Gmsh, which does not survive every damage.
INSTANTIATE_TEST_SUITE_P(All, DamagedFileTest,
                         ::testing::ValuesIn(VtkSamples()), NameOf);

}  // namespace
}  // namespace elastimate
