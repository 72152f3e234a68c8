// Pages of `elastimate report` in a browser, which draws them without a screen.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iomanip>
#include <regex>
#include <sstream>
#include <string>

#include "elastimate/core/package/package_file.h"
#include "tests/apps/region_scene.h"
#include "tests/program.h"

namespace elastimate {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// A failure does not show the page, which is long.
bool Has(const std::string& page, const std::string& part) {
  return page.find(part) != std::string::npos;
}

// Each test starts a browser, which takes some seconds.
class PageInBrowserLong : public testing::ProgramTest {
 protected:
  void SetUp() override {
    testing::ProgramTest::SetUp();
    if (std::string(ELASTIMATE_CHROMIUM).empty() ||
        FindPackageFile("report.html").empty()) {
      GTEST_SKIP() << "there is no chromium, or this build has no page";
    }
  }

  void Report(const std::string& arguments) const {
    const testing::ProgramRun run =
        Run("report " + arguments + " --out=report.html");
    EXPECT_LE(run.exit_code, 1) << run.errors;
  }

  // Returns the page as the browser leaves it once it has drawn.  Expects that
  // nothing was written to its console.
  std::string Drawn(const std::string& flags = "") const {
    const std::string command =
        "cd '" + folder_.string() +
        "' && HOME=. '" ELASTIMATE_CHROMIUM
        "' --headless --no-sandbox --use-gl=angle --use-angle=swiftshader "
        "--enable-unsafe-swiftshader --enable-logging=stderr "
        "--host-resolver-rules='MAP * ~NOTFOUND' --user-data-dir=browser "
        "--virtual-time-budget=5000 " +
        flags + " --dump-dom report.html >drawn.html 2>console.txt </dev/null";
    EXPECT_EQ(std::system(command.c_str()), 0);
    const std::string console = testing::ReadText(folder_ / "console.txt");
    std::istringstream lines(console);
    for (std::string line; std::getline(lines, line);) {
      EXPECT_THAT(line, Not(HasSubstr(":CONSOLE")));
    }
    return testing::ReadText(folder_ / "drawn.html");
  }

  // Returns the text of the page that people see.
  static std::string TextOf(const std::string& page) {
    const std::size_t first = page.find("<main>");
    const std::size_t last = page.find("</main>");
    EXPECT_NE(first, std::string::npos);
    EXPECT_NE(last, std::string::npos);
    const std::string text = std::regex_replace(
        page.substr(first, last - first), std::regex("<[^>]*>"), " ");
    for (const std::string wrong :
         {"NaN", "undefined", "null", "Infinity", "[object"}) {
      EXPECT_THAT(text, Not(HasSubstr(wrong)));
    }
    return text;
  }

  static int NumTriangles(const std::string& page) {
    std::smatch match;
    return std::regex_search(page, match,
                             std::regex("data-triangles=\"([0-9]+)\""))
               ? std::stoi(match[1])
               : 0;
  }

  void WriteFrames() const {
    std::ostringstream record;
    record << "force\n";
    for (int number = 1; number <= 5; ++number) {
      std::ostringstream text;
      text << std::setprecision(17) << "x,y,ux,uy\n";
      for (int i = 0; i < 65; ++i) {
        const double x = 0.5 * (i / 5);
        const double y = 0.5 * (i % 5);
        const double strain = number / 2000.;
        text << x << "," << y << ","
             << strain * x + 1e-4 * std::sin(37.7 * i * number) << ","
             << -0.3 * strain * y + 1e-4 * std::cos(55.5 * i * number) << "\n";
      }
      testing::WriteText(folder_ / ("frame_" + std::to_string(number) + ".csv"),
                         text.str());
      record << number << "\n";
    }
    testing::WriteText(folder_ / "record.csv", record.str());
    testing::WriteText(folder_ / "scene.json", R"({
      "model": "plane_stress", "thickness": 0.5,
      "mesh": {"points": "frame_1.csv", "margin": 0},
      "supports": [
        {"nodes": {"box": [[0, 0], [0, 2]]}, "displacement": "measured"},
        {"nodes": {"box": [[6, 0], [6, 2]]}, "displacement": "measured"} ],
      "cases": [ {"loads": [ {"type": "resultant", "value": [1, null],
                              "surface": {"box": [[6, 0], [6, 2]]},
                              "sd": 1e-4} ]} ],
      "frames": {"files": "frame_*.csv",
                 "load_record": {"file": "record.csv", "column": "force"}}
    })");
  }
};

TEST_F(PageInBrowserLong, ShowsASpecimenInSpace) {
  std::filesystem::copy(
      std::filesystem::path(ELASTIMATE_SOURCE) / "examples/block",
      folder_ / "block");
  Report("block/scene.json --estimator=auto");
  const std::string page = Drawn();
  const std::string text = TextOf(page);
  EXPECT_THAT(text, HasSubstr("Young's modulus E is 0.1005"));
  EXPECT_THAT(text, HasSubstr("most of the error of E comes from the mesh"));
  EXPECT_THAT(text, HasSubstr("elastimate report block/scene.json"));
  for (const std::string field :
       {"displacement", "mesh_error", "residual", "strain_energy_density"}) {
    EXPECT_TRUE(Has(page, "<option value=\"" + field + "\""));
  }
  // The outer surface of 4 x 4 x 4 cells has 192 triangles.
  EXPECT_GT(NumTriangles(page), 192);
}

TEST_F(PageInBrowserLong, ShowsAPlanarSpecimenOnANarrowScreen) {
  Succeed("generate plate --cells=12 --out=plate.vtu");
  Succeed(
      "simulate plate.vtu --youngs=70000 --nu=0.3 --noise=0.01 "
      "--out=measured.vtu");
  Report("measured.vtu --estimator=auto");
  const std::string page = Drawn("--window-size=400,800");
  EXPECT_THAT(TextOf(page), HasSubstr("plane stress"));
  EXPECT_GT(NumTriangles(page), 100);
}

TEST_F(PageInBrowserLong, ShowsRegions) {
  std::filesystem::copy(
      std::filesystem::path(ELASTIMATE_SOURCE) / "examples/three_regions",
      folder_ / "regions");
  Report("regions/block.vtu --regions=merge --estimator=auto");
  const std::string page = Drawn();
  const std::string text = TextOf(page);
  EXPECT_THAT(text, HasSubstr("regions 2 and 3"));
  EXPECT_TRUE(Has(page, "<option value=\"youngs_modulus\""));
}

TEST_F(PageInBrowserLong, ShowsAMap) {
  std::filesystem::copy(
      std::filesystem::path(ELASTIMATE_SOURCE) / "examples/three_regions",
      folder_ / "regions");
  Report("regions/block.vtu --map=youngs_modulus --estimator=auto");
  const std::string page = Drawn();
  EXPECT_THAT(TextOf(page), HasSubstr("Map of Young's modulus"));
  EXPECT_TRUE(Has(page, "<option value=\"resolution_length\""));
}

TEST_F(PageInBrowserLong, SaysFirstWhyAnEstimateIsRefused) {
  Succeed("generate organ --tetrahedra=300 --out=organ.vtu");
  Succeed(
      "simulate organ.vtu --youngs=50000 --nu=0.3 --noise=0.1 "
      "--out=measured.vtu");
  Report("measured.vtu");
  const std::string text = TextOf(Drawn());
  EXPECT_THAT(text, HasSubstr("NOT USABLE"));
  EXPECT_LT(text.find("gave no usable answer"), text.find("Parameters"));
  EXPECT_THAT(text, HasSubstr("What to do: "));
}

TEST_F(PageInBrowserLong, ShowsASeries) {
  WriteFrames();
  Report("scene.json --estimator=auto");
  const std::string page = Drawn();
  EXPECT_THAT(TextOf(page), HasSubstr("Frame by frame"));
  EXPECT_TRUE(Has(page, "aria-label=\"Young's modulus E of each frame\""));
}

}  // namespace
}  // namespace elastimate
