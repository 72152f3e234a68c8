#include "elastimate/io/text/csv_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/io/scene_files.h"

namespace elastimate {
namespace {

using ::testing::ElementsAre;

class CsvTableTest : public ::testing::Test {
 protected:
  CsvTable Read(const std::string& text) const {
    return ReadCsvTable(folder_.Write("table.csv", text));
  }

  const TemporaryFolder folder_;
};

TEST_F(CsvTableTest, TakesSpacesWhereTheHeaderHasNothingElse) {
  EXPECT_THAT(Read("a  b   c\n 1 2\t 3 \n").columns,
              ElementsAre("a", "b", "c"));
  EXPECT_THAT(Read("a  b   c\n 1 2\t 3 \n").rows[0].cells,
              ElementsAre("1", "2", "3"));
}

TEST_F(CsvTableTest, TakesWordsAboveOneColumnForItsName) {
  EXPECT_THAT(Read("Force [N]\n1\n2\n").columns, ElementsAre("Force [N]"));
  EXPECT_THAT(Read("\"Force [N]\"\n1\n2\n").columns, ElementsAre("Force [N]"));
  EXPECT_EQ(Read("Force [N]\n1\n2\n").rows.size(), 2U);
}

TEST_F(CsvTableTest, SkipsCommentsOfBothKinds) {
  const CsvTable table = Read("*** made by\n# me\na,b\n***\n1,2\n");
  EXPECT_THAT(table.columns, ElementsAre("a", "b"));
  EXPECT_EQ(table.rows.size(), 1U);
  EXPECT_EQ(table.rows[0].line, 5U);
}

TEST_F(CsvTableTest, TakesTheLastCommentForAHeaderOnlyWhereItNamesTheColumns) {
  EXPECT_THAT(Read("# other\n#  a ; b\n1;2\n").columns, ElementsAre("a", "b"));
  // A header of numbers, above which a comment says something else.
  EXPECT_THAT(Read("# one word\n1;2\n3;4\n").columns, ElementsAre("1", "2"));
}

}  // namespace
}  // namespace elastimate
