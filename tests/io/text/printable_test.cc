#include "elastimate/io/text/printable.h"

#include <gtest/gtest.h>

#include <random>

#include "elastimate/io/text/input_error.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

using namespace std::string_literals;

TEST(Printable, LeavesOrdinaryTextAlone) {
  for (const std::string text :
       {"", "scene.vtu", "a name's \"quotes\" and \\ backslashes",
        "Flügel/Größe_µ.vtu", "肝臓.msh", "🫀.json", "e\u0301", "می\u200cروم",
        "👩\u200d🔬"}) {
    EXPECT_EQ(Printable(text), text);
  }
}

TEST(Printable, EscapesControlCharacters) {
  EXPECT_EQ(Printable("a\033[31mred\033[0m"), "a\\x1b[31mred\\x1b[0m");
  EXPECT_EQ(Printable("one\ntwo\tthree\r"), "one\\ntwo\\tthree\\r");
  EXPECT_EQ(Printable("nul\0bell\a\x7f"s), "nul\\x00bell\\x07\\x7f");
  // Some characters beyond ASCII are as harmful: one that begins a command of a
  // terminal, a separator of lines, and marks that turn the direction, by which
  // "gpj.exe" would look like "exe.jpg".
  EXPECT_EQ(Printable("\u009b31m"), "\\u009b31m");
  EXPECT_EQ(Printable("a\u2028b"), "a\\u2028b");
  EXPECT_EQ(Printable("\u202egpj\u202c.exe"), "\\u202egpj\\u202c.exe");
}

TEST(Printable, EscapesWhatIsNoUtf8) {
  EXPECT_EQ(Printable("\xFF\xFE"), "\\xff\\xfe");
  EXPECT_EQ(Printable("gr\xFC\xDF"), "gr\\xfc\\xdf");       // Latin-1.
  EXPECT_EQ(Printable("\xC0\xAF"), "\\xc0\\xaf");           // Overlong "/".
  EXPECT_EQ(Printable("\xED\xA0\x80"), "\\xed\\xa0\\x80");  // A surrogate.
  EXPECT_EQ(Printable("\xF4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");
  EXPECT_EQ(Printable("\xE8\x82"), "\\xe8\\x82");  // Cut short.
}

TEST(Printable, WritesTheMicroSignOfLatin1AsThatOfUtf8) {
  EXPECT_EQ(Printable("u [\xB5m]"), "u [\xC2\xB5m]");
}

TEST(Printable, CutsTheMiddleOfLongText) {
  const std::string sixty(60, 'a');
  EXPECT_EQ(Printable(sixty), sixty);
  EXPECT_EQ(Printable(std::string(1000, 'a') + std::string(1000, 'z')),
            std::string(37, 'a') + "..." + std::string(20, 'z'));
  std::string umlauts;
  for (int i = 0; i < 2000; ++i) {
    umlauts += "ü";
  }
  EXPECT_EQ(Printable(umlauts).size(), 2 * 57 + 3);
  EXPECT_EQ(Printable(std::string(61, '\033')).find("\\x1b\\x1b"), 0);
}

// Any bytes become one line of UTF-8 without control characters, and that line
// stays as it is.
TEST(Printable, HoldsForAnyBytes) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 2000; ++trial) {
    std::string bytes(random() % 200, ' ');
    for (char& byte : bytes) {
      byte = static_cast<char>(random() % 256);
    }
    const std::string text = Printable(bytes, kLongestSentence);
    for (const char byte : text) {
      EXPECT_TRUE(static_cast<unsigned char>(byte) >= 0x20 && byte != 0x7F);
    }
    EXPECT_EQ(Printable(text, kLongestSentence), text);
  }
}

TEST(ThrowInputError, IsOneLineWhateverItQuotes) {
  EXPECT_THROWS_WITH(ThrowInputError("a\n\033.vtu", "the array '\033[2J' is"),
                     "^a\\\\n\\\\x1b.vtu: the array '\\\\x1b\\[2J' is$");
  try {
    ThrowInputError(std::string(5000, 'p'), std::string(5000, 's'));
  } catch (const std::invalid_argument& error) {
    EXPECT_LE(std::string(error.what()).size(),
              kLongestPath + 2 + kLongestSentence);
  }
}

}  // namespace
}  // namespace elastimate
