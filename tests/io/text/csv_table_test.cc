#include "elastimate/io/text/csv_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/io/scene_files.h"

namespace elastimate {
namespace {

using ::testing::ElementsAre;

class CsvTableTest : public ::testing::Test {
 protected:
  // The table that has a column of this title.
  CsvTable Read(const std::string& text, const std::string& title = "a") const {
    return ReadCsvTable(folder_.Write("table.csv", text),
                        [&](const ColumnTitles& titles) {
                          return !titles.Find(title).empty();
                        });
  }

  static std::vector<std::string> Titles(const CsvTable& table) {
    std::vector<std::string> titles;
    for (std::size_t i = 0; i < table.titles.Size(); ++i) {
      titles.push_back(table.titles[i].text);
    }
    return titles;
  }

  const TemporaryFolder folder_;
};

TEST_F(CsvTableTest, TakesSpacesWhereTheHeaderHasNothingElse) {
  EXPECT_THAT(Titles(Read("a  b   c\n 1 2\t 3 \n")),
              ElementsAre("a", "b", "c"));
  EXPECT_THAT(Read("a  b   c\n 1 2\t 3 \n").rows[0].cells,
              ElementsAre("1", "2", "3"));
}

TEST_F(CsvTableTest, TakesWordsAboveOneColumnForItsName) {
  EXPECT_THAT(Titles(Read("Force [N]\n1\n2\n", "Force [N]")),
              ElementsAre("Force [N]"));
  EXPECT_THAT(Titles(Read("\"Force [N]\"\n1\n2\n", "Force")),
              ElementsAre("Force [N]"));
  EXPECT_EQ(Read("Force [N]\n1\n2\n", "Force [N]").rows.size(), 2U);
}

TEST_F(CsvTableTest, SkipsCommentsOfBothKinds) {
  const CsvTable table = Read("*** made by\n# me\na,b\n***\n1,2\n");
  EXPECT_THAT(Titles(table), ElementsAre("a", "b"));
  EXPECT_EQ(table.rows.size(), 1U);
  EXPECT_EQ(table.rows[0].line, 5U);
}

TEST_F(CsvTableTest, TakesTheLastCommentForAHeaderOnlyWhereItNamesTheColumns) {
  EXPECT_THAT(Titles(Read("# other\n#  a ; b\n1;2\n")), ElementsAre("a", "b"));
  // It does not name as many, so that there is none.
  EXPECT_TRUE(Read("# a\n1;2\n3;4\n").rows.empty());
}

}  // namespace
}  // namespace elastimate
