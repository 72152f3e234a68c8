// The page that `elastimate report` writes.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <vector>

#include "elastimate/core/package/package_file.h"
#include "elastimate/io/scene/mesh_reader.h"
#include "tests/apps/region_scene.h"
#include "tests/program.h"

namespace elastimate {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

bool HasPage() { return !FindPackageFile("report.html").empty(); }

// Decodes base64 with a table of its alphabet.
std::vector<std::uint8_t> Decoded(const std::string& text) {
  const std::string alphabet =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<std::uint8_t> bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char character : text) {
    const std::size_t digit = alphabet.find(character);
    if (digit == std::string::npos) {
      EXPECT_EQ(character, '=');
      break;
    }
    bits = bits << 6 | std::uint32_t(digit);
    count += 6;
    if (count >= 8) {
      count -= 8;
      bytes.push_back(std::uint8_t(bits >> count));
    }
  }
  return bytes;
}

template <typename Number>
Eigen::Matrix<Number, Eigen::Dynamic, 1> Numbers(const json& text) {
  const std::vector<std::uint8_t> bytes = Decoded(text.get<std::string>());
  EXPECT_EQ(bytes.size() % sizeof(Number), 0U);
  Eigen::Matrix<Number, Eigen::Dynamic, 1> values(bytes.size() /
                                                  sizeof(Number));
  std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

Eigen::MatrixXd Vectors(const json& text) {
  const Eigen::VectorXd values = Numbers<float>(text).cast<double>();
  return values.reshaped(3, values.size() / 3);
}

class Page : public testing::ProgramTest {
 protected:
  void SetUp() override {
    testing::ProgramTest::SetUp();
    if (!HasPage()) {
      GTEST_SKIP() << "this build has no page, which needs npm";
    }
  }

  void Simulate(const std::string& generate,
                const std::string& simulate = "") const {
    Succeed("generate " + generate + " --out=scene.vtu");
    Succeed("simulate scene.vtu --youngs=50000 --nu=0.3 " + simulate +
            " --out=measured.vtu");
  }

  std::string Text() const {
    return testing::ReadText(folder_ / "report.html");
  }

  json Data() const {
    const std::string text = Text();
    const std::string start = "<script type=\"application/json\" id=\"data\">";
    const std::size_t first = text.find(start) + start.size();
    const std::size_t last = text.find("</script>", first);
    const std::string data = text.substr(first, last - first);
    EXPECT_THAT(data, Not(HasSubstr("<")));
    return json::parse(data);
  }
};

TEST_F(Page, HasTheReportAndTheCommand) {
  Simulate("organ --tetrahedra=300", "--noise=0.02");
  const testing::ProgramRun run = Succeed(
      "report measured.vtu --estimator=reduced-fe --out=report.html "
      "--json=report.json --noise_sd='1e-5'");
  EXPECT_THAT(run.output, HasSubstr("Young's modulus E"));
  const json data = Data();
  EXPECT_EQ(data["report"],
            json::parse(testing::ReadText(folder_ / "report.json")));
  EXPECT_EQ(data["command"],
            "elastimate report measured.vtu --estimator=reduced-fe "
            "--out=report.html --json=report.json --noise_sd=1e-5");
  EXPECT_EQ(data["labels"][0], json({{"label", "E"}, {"is_relative", true}}));
}

TEST_F(Page, LoadsNothingFromElsewhere) {
  Simulate("rectangle");
  Succeed("report measured.vtu --out=report.html");
  const std::string text = Text();
  // The policy forbids a browser what the page does not hold itself.
  EXPECT_THAT(text, HasSubstr("content=\"default-src 'none'; script-src "
                              "'unsafe-inline'; style-src 'unsafe-inline'; "
                              "img-src data: blob:\""));
  EXPECT_FALSE(std::regex_search(
      text, std::regex("<(link|img|iframe)|<script[^>]* src|@import|"
                       "url\\(")));
}

TEST_F(Page, DrawsTheSurfaceOfTheSpecimen) {
  Simulate("cuboid --cells=3,2,2 --size=3,2,1");
  Succeed("report measured.vtu --out=report.html");
  const json specimen = Data()["specimen"];
  ASSERT_EQ(specimen["corners"], 3);
  const Eigen::MatrixXd nodes = Vectors(specimen["nodes"]);
  const auto facets = Numbers<std::uint32_t>(specimen["facets"]);
  double area = 0;
  double volume = 0;
  for (Eigen::Index i = 0; i < facets.size(); i += 3) {
    const Eigen::Vector3d a = nodes.col(facets(i));
    const Eigen::Vector3d b = nodes.col(facets(i + 1));
    const Eigen::Vector3d c = nodes.col(facets(i + 2));
    area += (b - a).cross(c - a).norm() / 2;
    volume += a.dot(b.cross(c)) / 6;
  }
  EXPECT_NEAR(area, 2 * (3 * 2 + 3 * 1 + 2 * 1), 1e-5);
  EXPECT_NEAR(volume, 6, 1e-5);
  const json& load_case = specimen["cases"][0];
  const auto held = Numbers<std::uint8_t>(load_case["held"]);
  const Eigen::MatrixXd displacement = Vectors(load_case["displacement"]);
  ASSERT_EQ(held.size(), nodes.cols());
  for (Eigen::Index i = 0; i < held.size(); ++i) {
    EXPECT_EQ(held(i) == 7, displacement.col(i).norm() == 0) << i;
  }
}

TEST_F(Page, HasAsMuchResidualAsTheReportSays) {
  std::filesystem::copy(
      std::filesystem::path(ELASTIMATE_SOURCE) / "examples/block",
      folder_ / "block");
  Succeed("report block/scene.json --estimator=auto --out=report.html");
  const json data = Data();
  const json& points = data["specimen"]["cases"][0]["points"];
  EXPECT_EQ(points["total"], 60);
  EXPECT_EQ(points["are_nodes"], false);
  EXPECT_NEAR(Vectors(points["residual"]).norm() /
                  Vectors(points["displacement"]).norm(),
              data["report"]["residual"]["displacement_relative"], 1e-5);
  EXPECT_THAT(Text(), HasSubstr("<title>block/scene.json</title>"));
}

// Parameters are corrected for the error of the elements behind a fit, also
// those of a law that is given, but what it leaves is that of its minimum.
TEST_F(Page, HasTheResidualOfAFitOfLargeStrains) {
  Simulate("cuboid --cells=3,2,2 --elements=tet4",
           "--material=neo_hookean --order=2 --noise=0.002");
  Succeed(
      "report measured.vtu --estimator=iterative-fe --material=neo_hookean "
      "--out=report.html");
  const json data = Data();
  const json& points = data["specimen"]["cases"][0]["points"];
  EXPECT_NEAR(Vectors(points["residual"]).norm() /
                  Vectors(points["displacement"]).norm(),
              data["report"]["residual"]["displacement_relative"], 1e-5);
}

// A face that moved with a load cell: its arrow is in the middle of its area,
// which is not the mean of its nodes.
TEST_F(Page, HasResultantsInTheMiddleOfTheirFaces) {
  testing::WriteText(folder_ / "mesh.inp",
                     "*NODE\n1,0,0\n2,2,0\n3,2,2\n4,0,2\n5,2,0.5\n6,1,1\n"
                     "*ELEMENT, TYPE=CPS3\n1,1,2,6\n2,2,5,6\n3,5,3,6\n"
                     "4,3,4,6\n5,4,1,6\n");
  testing::WriteText(folder_ / "u.csv",
                     "node,ux,uy\n1,0,0\n2,0.01,0\n3,0.01,0\n4,0,0\n"
                     "5,0.01,0\n6,0.005,0\n");
  testing::WriteText(folder_ / "scene.json", R"({"mesh": "mesh.inp",
    "model": "plane_stress", "thickness": 1,
    "supports": [{"nodes": {"box": [[0, 0], [0, 2]]}},
                 {"nodes": {"box": [[2, 0], [2, 2]]}, "displacement": "rigid"}],
    "cases": [{"displacement": {"nodes": "u.csv"}, "noise_sd": 1e-4,
               "loads": [{"type": "resultant", "value": [1, null], "sd": 0.01,
                          "surface": {"box": [[2, 0], [2, 2]]}}]}]})");
  EXPECT_LE(Run("report scene.json --estimator=iterative-fe --nu=0.3 "
                "--out=report.html")
                .exit_code,
            1);
  const json load_case = Data()["specimen"]["cases"][0];
  EXPECT_EQ(load_case["loads"][0]["at"], json({2.0, 1.0, 0.0}));
  const auto moved = Numbers<std::uint8_t>(load_case["moved"]);
  const auto held = Numbers<std::uint8_t>(load_case["held"]);
  ASSERT_EQ(moved.size(), 6);
  EXPECT_EQ((held.array() == 3).count(), 5);
  EXPECT_EQ((moved.array() == 3).count(), 3);
}

// The same two solutions as `simulate` computes them, at the parameters of the
// fit.
TEST_F(Page, HasTheMeshErrorOfTheFields) {
  Simulate("rectangle --elements=tri3 --cells=24,6 --force=0,1e-4",
           "--noise=0.001 --order=2");
  // This mesh is too coarse for nu, which does not matter here.
  const json report =
      Run("estimate measured.vtu --estimator=reduced-fe --refine=0 "
          "--origin=measured --json=- --out=fields.vtu")
          .Json();
  const json& correction = report["diagnostics"]["discretization_correction"];
  const double youngs_modulus =
      report["youngs_modulus"].get<double>() *
      std::exp(-correction["youngs_modulus"].get<double>());
  const double poisson_ratio = report["poisson_ratio"].get<double>() -
                               correction["poisson_ratio"].get<double>();
  const std::string parameters = " --youngs=" + json(youngs_modulus).dump() +
                                 " --nu=" + json(poisson_ratio).dump();
  Succeed("simulate scene.vtu --out=linear.vtu" + parameters);
  Succeed("simulate scene.vtu --order=2 --out=quadratic.vtu" + parameters);
  const auto field = [this](const std::string& file, const std::string& name) {
    const MeshFile mesh = ReadMeshFile(folder_ / file);
    const Eigen::MatrixXd* const values = FindArray(mesh.node_arrays, name);
    EXPECT_NE(values, nullptr) << name;
    return values == nullptr ? Eigen::MatrixXd() : *values;
  };
  const Eigen::MatrixXd linear = field("linear.vtu", "displacement");
  const Eigen::MatrixXd expected =
      field("quadratic.vtu", "displacement") - linear;
  EXPECT_GT(expected.norm(), 0.02 * linear.norm());
  EXPECT_LT((field("fields.vtu", "mesh_error") - expected).norm(),
            1e-5 * expected.norm());
}

TEST_F(Page, OfTwentyThousandElementsHasTwoMegabytesAtMost) {
  Simulate("cuboid --cells=16,16,16 --size=1,1,1", "--noise=0.01");
  const testing::ProgramRun run =
      Run("report measured.vtu --estimator=virtual-fields --out=report.html");
  EXPECT_LE(run.exit_code, 1) << run.errors;
  const json data = Data();
  EXPECT_GE(data["report"]["mesh"]["elements"], 20000);
  EXPECT_EQ(data["specimen"]["cases_left_out"], 0);
  EXPECT_LE(std::filesystem::file_size(folder_ / "report.html"), 2000000U);
}

TEST_F(Page, LeavesOutLoadCasesForWhichThereIsNoRoom) {
  Succeed("generate rectangle --cells=120,60 --out=scene.vtu");
  std::string files;
  for (int i = 0; i < 5; ++i) {
    const std::string name = "case_" + std::to_string(i) + ".vtu";
    Succeed("simulate scene.vtu --youngs=50000 --nu=0.3 --noise=0.001 --seed=" +
            std::to_string(i) + " --out=" + name);
    files += " " + name;
  }
  Succeed("report" + files + " --estimator=virtual-fields --out=report.html");
  const json specimen = Data()["specimen"];
  const int num_left_out = specimen["cases_left_out"];
  EXPECT_GT(num_left_out, 0);
  EXPECT_EQ(specimen["cases"].size() + std::size_t(num_left_out), 5U);
  EXPECT_LE(std::filesystem::file_size(folder_ / "report.html"), 2000000U);
}

TEST_F(Page, OfAnEstimateThatIsNotUsableIsWrittenToo) {
  Simulate("organ --tetrahedra=300", "--noise=0.1");
  const testing::ProgramRun run = Run("report measured.vtu --out=report.html");
  EXPECT_EQ(run.exit_code, 1) << run.errors;
  EXPECT_EQ(Data()["report"]["usable"], false);
}

TEST_F(Page, QuotesWhatWouldEndItsData) {
  Simulate("rectangle");
  std::filesystem::rename(folder_ / "measured.vtu",
                          folder_ / "<!--<script>a b'.vtu");
  Succeed("report \"<!--<script>a b'.vtu\" --out=report.html");
  const json data = Data();
  EXPECT_EQ(data["title"], "<!--<script>a b'.vtu");
  EXPECT_THAT(Text(), HasSubstr("<title>&lt;!--&lt;script&gt;a b'.vtu<"));
  EXPECT_EQ(data["command"],
            R"(elastimate report '<!--<script>a b'\''.vtu' --out=report.html)");
}

TEST_F(Page, IsRefusedWhereItCannotBeWritten) {
  Simulate("rectangle");
  Refuse("report measured.vtu", "report needs --out=FILE.html");
  Refuse("report --out=report.html", "report needs a scene file");
  Refuse("report measured.vtu --out=report.vtu",
         "the name must end in .html, as a page is written");
  Refuse("estimate measured.vtu --out=report.html",
         "the name must end in .vtu");
  Refuse("report none.vtu --out=report.html", "none.vtu");
  Refuse("report measured.vtu --out=no_folder/report.html", "no_folder");
  Refuse("report measured.vtu --out=a.html --json=a.html",
         "name the same file");
}

class PageOfABuildWithoutNpm : public testing::ProgramTest {};

TEST_F(PageOfABuildWithoutNpm, IsRefusedInOneSentence) {
  Succeed("generate rectangle --out=scene.vtu");
  // Files of the package are looked for in these folders first.
  setenv("LD_LIBRARY_PATH", folder_.c_str(), 1);
  testing::WriteText(folder_ / "report.html", "");
  Refuse("report scene.vtu --out=page.html",
         "this build has no page for reports; build elastimate with npm");
  unsetenv("LD_LIBRARY_PATH");
}

}  // namespace
}  // namespace elastimate
