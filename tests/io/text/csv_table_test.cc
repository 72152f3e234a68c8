#include "elastimate/io/text/csv_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/io/scene_files.h"
#include "tests/throws.h"

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

TEST_F(CsvTableTest, FindsTheTableBelowOthers) {
  const CsvTable table = Read(
      "Specimen: left, 3\nstage;index;time\n\"Stage 2\";2;21.5\n\n# Points\n"
      "id;a;b\n0;1;2\n1;3;4\n");
  EXPECT_THAT(Titles(table), ElementsAre("id", "a", "b"));
  ASSERT_EQ(table.rows.size(), 2U);
  EXPECT_EQ(table.rows[1].line, 8U);
  EXPECT_THAT(Read("x;y\n1;2\na;b\n1,5;2\n").rows[0].cells,
              ElementsAre("1,5", "2"));
}

TEST_F(CsvTableTest, KeepsUnitsWithTheWordsBeforeThem) {
  EXPECT_THAT(Titles(Read("a [mm]  b (N)   c\n1 2 3\n")),
              ElementsAre("a [mm]", "b (N)", "c"));
  EXPECT_THAT(Titles(Read("\"a [mm]\" \"b c\"\n1 2\n")),
              ElementsAre("a [mm]", "b c"));
  EXPECT_THAT(Read("a;b\n[mm];[um]\n1;2\n").units, ElementsAre("[mm]", "[um]"));
}

TEST_F(CsvTableTest, ReadsDecimalCommasWhereTheySeparateNothing) {
  for (const std::string text :
       {"a;b\n-1,5;2\n", "a\tb\r\n-1,5\t2\r\n", "a b\n-1,5 2\n",
        "# a b\n-1,5 2\n", "a;b;\r-1,5;2;\r"}) {
    const CsvTable table = Read(text);
    ASSERT_EQ(table.rows.size(), 1U) << text;
    EXPECT_EQ(table.Number(table.rows[0], 0), -1.5) << text;
  }
  const CsvTable quoted = Read("a,b\n\"1,234\",2\n");
  EXPECT_THROWS_WITH(quoted.Number(quoted.rows[0], 0), "'1,234' has a comma");
  const CsvTable mixed = Read("a;b\n1,5;1.5\n1.5;2\n");
  EXPECT_THROWS_WITH(mixed.CheckDecimalMarks({0}),
                     "line 2 has a decimal comma and line 3 a decimal point");
  EXPECT_NO_THROW(mixed.CheckDecimalMarks({1}));
}

TEST_F(CsvTableTest, RefusesRowsThatDoNotFit) {
  EXPECT_THROWS_WITH(
      Read("a,b\n1,5,2,5\n"),
      "line 2 has 4 columns, but the titles have 2; .* semicolons");
  EXPECT_THROWS_WITH(Read("a,b\n1;2\n"), "line 2 has 1 columns");
  EXPECT_THROWS_WITH(Read("a;b\n1,2\n"), "line 2 has 1 columns");
  EXPECT_THROWS_WITH(Read("a,b\n"), "no row of numbers");
  EXPECT_THROWS_WITH(Read("\n \n"), "no row of numbers");
}

TEST_F(CsvTableTest, FindsColumnsByTheirNames) {
  const CsvTable table =
      Read("a,X [mm],x [um],Force_N (kN), c / mm\n1,2,3,4,5\n");
  EXPECT_EQ(table.At("X [mm]"), 1U);
  EXPECT_EQ(table.At("x"), 2U);
  EXPECT_EQ(table.At("X"), 1U);
  EXPECT_EQ(table.At("x [\xC2\xB5m]"), 2U);
  EXPECT_EQ(table.At("force_n (kn)"), 3U);
  EXPECT_EQ(table.At("C"), 4U);
  EXPECT_THROWS_WITH(table.At("x [m]"), "no column 'x .m.' among a, X .mm., x");
  EXPECT_THROWS_WITH(Read("a,u_x,U x\n1,2,3\n").At("ux"),
                     "several columns have the name 'ux' \\(u_x, U x\\)");
  EXPECT_THROWS_WITH(Read("a,a\n1,2\n").At("a"), "several columns");
}

TEST_F(CsvTableTest, EndsOnATableOfVeryManyColumns) {
  std::string titles = "c";
  std::string row = "1";
  for (int i = 0; i < 100000; ++i) {
    titles += ",c" + std::to_string(i);
    row += ",1";
  }
  EXPECT_THROWS_WITH(Read(titles + "\n" + row + "\n").At("a"),
                     "no column 'a' among c, c0, c1, .*; add it");
}

}  // namespace
}  // namespace elastimate
