#include "elastimate/io/text/text_file.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/io/scene_files.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

using namespace std::string_literals;

class TextFileTest : public ::testing::Test {
 protected:
  std::string Read(const std::string& bytes) const {
    return ReadTextFile(folder_.Write("text.csv", bytes));
  }

  const TemporaryFolder folder_;
};

TEST_F(TextFileTest, TakesOffTheByteOrderMark) {
  EXPECT_EQ(Read("\xEF\xBB\xBFx\n"), "x\n");
  EXPECT_EQ(Read("x\xB5"), "x\xB5");
}

TEST_F(TextFileTest, ReadsBothKindsOfUtf16) {
  EXPECT_EQ(Read("\xFF\xFEx\0\xB5\0"s), "x\xC2\xB5");
  EXPECT_EQ(Read("\xFE\xFF\0x\0\xB5"s), "x\xC2\xB5");
  EXPECT_EQ(Read("x\0y\0"s), "xy");
  EXPECT_EQ(Read("\0x\0y"s), "xy");
  // Two halves of one character.
  EXPECT_EQ(Read("\xFF\xFE\x3D\xD8\x00\xDE"s), "\xF0\x9F\x98\x80");
}

TEST_F(TextFileTest, RefusesHalfACharacter) {
  EXPECT_THROWS_WITH(Read("\xFF\xFEx\0\x3D\xD8"s),
                     "text.csv: .* no character 2 bytes before its end");
  EXPECT_THROWS_WITH(Read("\xFF\xFEx\0\x3D\xD8x\0"s), "4 bytes before");
  EXPECT_THROWS_WITH(Read("\xFF\xFEx\0x"s), "1 bytes before its end");
  EXPECT_THROWS_WITH(Read(""), "the file is empty");
}

}  // namespace
}  // namespace elastimate
