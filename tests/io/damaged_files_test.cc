// Damages files of every format: the outcome must be a valid scene or
// std::invalid_argument, whatever the damage.
//
// ELASTIMATE_MUTATIONS=20 in the environment tries 20 times as many files.

#include <gmock/gmock.h>
#include <gmsh.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <random>

#include "elastimate/io/scene/scene_reader.h"
#include "tests/io/abaqus_files.h"
#include "tests/io/febio_files.h"
#include "tests/io/gmsh_files.h"
#include "tests/io/kind_scenes.h"
#include "tests/io/mutations.h"
#include "tests/io/scene_files.h"
#include "tests/io/vtk_files.h"

namespace elastimate {
namespace {

/// Holds the files of one scene, of which the file `damaged` is to be damaged.
struct Sample {
  std::map<std::string, std::string> files;
  std::string damaged;
  std::string scene;
};

Sample OneFile(const std::string& name, const std::string& content) {
  return {{{name, content}}, name, name};
}

/// Returns a scene in this encoding.
Sample VtkSample(const std::string& name, const Scene& scene) {
  const std::vector<VtkEncoding> encodings = AllVtkEncodings();
  const auto encoding =
      std::find_if(encodings.begin(), encodings.end(),
                   [&](const VtkEncoding& one) { return one.name == name; });
  const TemporaryFolder folder;
  const auto path = folder.Path() / ("scene" + encoding->Extension());
  WriteEncoded(path, scene.mesh, SceneFields(scene), *encoding);
  return OneFile(path.filename().string(), ReadFile(path));
}

Sample VtkSample(const std::string& name) {
  return VtkSample(name, TwoTetrahedra());
}

/// Returns a mesh as Gmsh writes it, with a scene.json that names it.
Sample GmshSample(const std::string& name, double version, bool is_binary) {
  const TemporaryFolder folder;
  const auto source = folder.Write("source.msh", GmshVersion2Mesh());
  gmsh::initialize(0, nullptr, false);
  gmsh::option::setNumber("General.Terminal", 0);
  gmsh::merge(source.string());
  gmsh::option::setNumber("Mesh.SaveAll", 1);
  gmsh::option::setNumber("Mesh.MshFileVersion", version);
  gmsh::option::setNumber("Mesh.Binary", is_binary ? 1 : 0);
  gmsh::write((folder.Path() / name).string());
  gmsh::finalize();
  const std::string json = R"({"mesh": ")" + name + R"(",
          "supports": [{"nodes": {"box": [[-1, -1, -0.1], [2, 2, 0.1]]}}],
          "cases": [{"loads": [{"type": "body_force", "value": [0, 0, -1]}]}]})";
  return {{{name, ReadFile(folder.Path() / name)}, {"scene.json", json}},
          name,
          "scene.json"};
}

/// Returns a scene.json with a mesh, and with fields in a CSV file.
Sample JsonSample(const std::string& damaged) {
  const std::string mesh = VtkSample("XmlAscii").files.begin()->second;
  return {
      {{"mesh.vtu", mesh},
       {"u.csv", "ux,uy,uz\n0,0,0\n0,0,0\n0,0,0\n.1,.2,.3\n-1e-3,2E-4,0.25\n"},
       {"scene.json",
        R"({
 "mesh": "mesh.vtu",
 "supports": [{"nodes": {"ids": [0, 1, 2]}, "components": "xyz",
               "displacement": [0, 0, 0]}],
 "cases": [
  {"displacement": {"file": "u.csv"},
   "observed": {"box": [[-1, -1, -2], [2, 2, 2]]},
   "loads": [{"type": "nodal_force", "value": [0, 0, -30], "nodes": "free"},
             {"type": "body_force", "value": [0, 0, -9810]},
             {"type": "pressure", "value": 500, "surface": "all"}],
   "noise_sd": 1e-5}]
}
)"}},
      damaged,
      "scene.json"};
}

/// Returns a mesh, and a table of points that lie in it.
Sample PointsSample(const std::string& table) {
  const std::string mesh = VtkSample("XmlAscii").files.begin()->second;
  return {{{"mesh.vtu", mesh}, {"points.csv", table}, {"scene.json", R"({
 "mesh": "mesh.vtu", "supports": [{"nodes": {"ids": [0, 1, 2]}}],
 "cases": [{"displacement": {"points": "points.csv", "tolerance": 100},
            "loads": [{"type": "body_force", "value": [0, 0, -1]}]}]})"}},
          "points.csv",
          "scene.json"};
}

/// Returns a table as GOM Correlate writes it.
std::string GomTable() {
  return "# Units: length:mm\nstage;index;date\n\"Stage 2\";2;\"2024\"\n"
         "id;x [mm];y [mm];z [mm];displacement_x [um];displacement_y [um];"
         "displacement_z [um]\n0;0,1;0,1;0,1;2;3;4\n1;0,2;0,1;0,1;2;3;5\n";
}

std::string Utf16Table() {
  std::string table = "\xFF\xFE";
  for (const char c : GomTable()) {
    table += c;
    table += '\0';
  }
  return table;
}

/// Returns a scene of the sets of a mesh.
Sample SetsSample(const std::string& name, const std::string& content,
                  const std::string& support, const std::string& surface) {
  return {{{name, content},
           {"scene.json", R"({"mesh": ")" + name +
                              R"(", "supports": [{"nodes": {"set": ")" +
                              support + R"("}}], "cases": [{"loads": [
           {"type": "pressure", "value": 1, "surface": {"set": ")" +
                              surface + R"("}}]}]})"}},
          name,
          "scene.json"};
}

Sample AbaqusSample() {
  const std::string text = AbaqusDeckText();
  // A cut between the assembly and the first step cannot be seen.
  return SetsSample("mesh.inp", text.substr(0, text.find("*Material")), "Set-1",
                    "Top");
}

/// Returns a mesh of Abaqus, and displacements of its nodes that FEBio might
/// have written.
Sample NodesSample() {
  return {{{"mesh.inp", AbaqusDeckText()},
           {"u.csv",
            "*Step  = 1\n*Time  = 0.5\n*Data  = ux;uy;uz\n2,0,0,0\n3,0,0,0\n"
            "5,.1,.2,.3\n7,-1e-3,2E-4,0.25\n10,0,0,0\n"},
           {"scene.json", R"({"mesh": "mesh.inp",
 "supports": [{"nodes": {"set": "Set-1"}}],
 "cases": [{"displacement": {"nodes": "u.csv"},
            "loads": [{"type": "body_force", "value": [0, 0, -1]}]}]})"}},
          "u.csv",
          "scene.json"};
}

/// Returns a scene.json with a planar mesh that has no field data.
Sample PlanarJsonSample() {
  return {{{"mesh.vtk", PlanarVtkText()}, {"scene.json", R"({"mesh": "mesh.vtk",
 "model": "plane_stress", "thickness": 0.5,
 "supports": [{"nodes": {"box": [[-1, -1], [0, 9]]}, "components": "x"},
              {"nodes": {"ids": [0]}, "displacement": [0, 0]}],
 "cases": [
  {"loads": [{"type": "traction", "value": [3, 0],
              "surface": {"box": [[2, -1], [2, 9]]}},
             {"type": "body_force", "value": [0, -1]},
             {"type": "pressure", "value": 500, "surface": "all"}],
   "noise_sd": 1e-5}]
}
)"}},
          "scene.json",
          "scene.json"};
}

Sample MakeSample(const std::string& name) {
  static const std::map<std::string, Sample (*)()> kOthers = {
      {"Msh1", [] { return OneFile("scene.msh", GmshVersion1Scene()); }},
      {"Msh2", [] { return OneFile("scene.msh", GmshVersion2Scene()); }},
      {"Msh41", [] { return OneFile("scene.msh", GmshVersion4Scene()); }},
      {"Msh2Binary", [] { return GmshSample("mesh.msh", 2.2, true); }},
      {"Msh40", [] { return GmshSample("mesh.msh", 4.0, false); }},
      {"Msh41Binary", [] { return GmshSample("mesh.msh", 4.1, true); }},
      {"Medit", [] { return GmshSample("mesh.mesh", 4.1, false); }},
      {"Unv", [] { return GmshSample("mesh.unv", 4.1, false); }},
      {"Bdf", [] { return GmshSample("mesh.bdf", 4.1, false); }},
      {"XmlHex8", [] { return VtkSample("XmlAscii", SceneOf("hex8")); }},
      {"XmlTet10", [] { return VtkSample("XmlRaw", SceneOf("tet10")); }},
      {"XmlQuad4", [] { return VtkSample("XmlAscii", SceneOf("quad4")); }},
      {"LegacyTri6",
       [] { return VtkSample("LegacyAscii42", SceneOf("tri6")); }},
      {"LegacyQuad4",
       [] { return VtkSample("LegacyBinary51", SceneOf("quad4")); }},
      {"PlanarJson", PlanarJsonSample},
      {"Abaqus", AbaqusSample},
      {"Nodes", NodesSample},
      {"Febio3",
       [] { return SetsSample("mesh.feb", FebioText(false), "held", "top"); }},
      {"Febio4",
       [] { return SetsSample("mesh.feb", FebioText(true), "held", "top"); }},
      {"Json", [] { return JsonSample("scene.json"); }},
      {"Csv", [] { return JsonSample("u.csv"); }},
      {"Points", [] { return PointsSample(GomTable()); }},
      {"PointsUtf16", [] { return PointsSample(Utf16Table()); }}};
  const auto found = kOthers.find(name);
  return found == kOthers.end() ? VtkSample(name) : found->second();
}

/// Holds a format, and how many of its files are tried.  Files that need a
/// process of their own take longer.
struct Trials {
  std::string name;
  int number;
};

constexpr int kGmshTrials = 5;
constexpr int kLegacyTrials = 8;

std::vector<Trials> AllTrials() {
  std::vector<Trials> trials;
  for (const VtkEncoding& encoding : AllVtkEncodings()) {
    trials.push_back({encoding.name, encoding.is_legacy ? kLegacyTrials : 60});
  }
  for (const std::string name : {"Msh1", "Msh2", "Msh41", "Msh2Binary", "Msh40",
                                 "Msh41Binary", "Medit", "Unv", "Bdf"}) {
    trials.push_back({name, kGmshTrials});
  }
  for (const std::string name : {"LegacyTri6", "LegacyQuad4"}) {
    trials.push_back({name, kLegacyTrials});
  }
  for (const std::string name :
       {"XmlHex8", "XmlTet10", "XmlQuad4", "PlanarJson", "Json", "Csv"}) {
    trials.push_back({name, 50});
  }
  for (const std::string name :
       {"Points", "PointsUtf16", "Nodes", "Abaqus", "Febio3", "Febio4"}) {
    trials.push_back({name, 100});
  }
  return trials;
}

class DamagedFileTest : public ::testing::TestWithParam<Trials> {
 protected:
  static int IndexOfFormat() {
    const std::vector<Trials> all = AllTrials();
    return static_cast<int>(std::find_if(all.begin(), all.end(),
                                         [](const Trials& trials) {
                                           return trials.name ==
                                                  GetParam().name;
                                         }) -
                            all.begin());
  }

  void SetUp() override {
    for (const auto& [name, content] : sample_.files) {
      folder_.Write(name, content);
    }
  }

  /// Returns the error message, or "valid".
  std::string Read(const std::string& content) const {
    folder_.Write(sample_.damaged, content);
    try {
      const Scene scene =
          ReadScene({folder_.Path() / sample_.scene}, Measurement::kOptional)
              .scene;
      ValidateScene(scene);
      return "valid";
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
  }

  const Sample sample_ = MakeSample(GetParam().name);
  const TemporaryFolder folder_;
};

TEST_P(DamagedFileTest, IsNeverTakenForAWholeOneWhenItIsCut) {
  const std::string& content = sample_.files.at(sample_.damaged);
  ASSERT_EQ(Read(content), "valid");
  if (sample_.damaged == "u.csv" || sample_.damaged == "points.csv") {
    return;  // Its last number may lose digits, or it may lose its last rows.
  }
  // The last characters of a file may be white space and closing words only, so
  // that a cut there does no harm.
  const std::size_t harmless = 60;
  const int num_cuts = std::min(GetParam().number, 60);
  for (int i = 0; i < num_cuts; ++i) {
    const std::size_t size = i * (content.size() - harmless) / num_cuts;
    const std::string outcome = Read(content.substr(0, size));
    EXPECT_NE(outcome, "valid")
        << "cut at " << size << " of " << content.size();
    EXPECT_THAT(outcome, ::testing::HasSubstr(sample_.damaged));
  }
}

/// The message has to be one line of bounded length that names a file and holds
/// no characters that control a terminal.
void ExpectSentence(const std::string& message,
                    const std::filesystem::path& folder) {
  EXPECT_EQ(message.find(folder.string() + "/"), 0U) << message;
  EXPECT_LT(message.size(), 1500U) << message;
  EXPECT_TRUE(std::none_of(message.begin(), message.end(), [](char c) {
    return std::iscntrl(static_cast<unsigned char>(c)) != 0;
  })) << message;
}

#ifdef __SANITIZE_ADDRESS__  // It takes terabytes of address space.
constexpr bool kMemoryIsLimited = false;
#else
constexpr bool kMemoryIsLimited = true;
#endif

std::int64_t LargestChildInMegabytes() {
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  return usage.ru_maxrss / 1024;
}

int Factor() {
  const char* const factor = std::getenv("ELASTIMATE_MUTATIONS");
  return factor == nullptr ? 1 : std::max(1, std::atoi(factor));
}

TEST_P(DamagedFileTest, EndsWell) {
  using Clock = std::chrono::steady_clock;
  const std::string& content = sample_.files.at(sample_.damaged);
  // Each format has its own seeds, so that together they meet more kinds of
  // damage.
  const std::uint32_t first_seed = 20071 + 100000 * IndexOfFormat();
  for (int i = 0; i < Factor() * GetParam().number; ++i) {
    const std::uint32_t seed = first_seed + i;
    std::mt19937 random(seed);
    const std::string damaged = Mutated(content, random);
    SCOPED_TRACE("seed " + std::to_string(seed));
    ::testing::internal::CaptureStderr();
    ::testing::internal::CaptureStdout();
    const Clock::time_point start = Clock::now();
    std::string outcome;
    EXPECT_NO_THROW(outcome = Read(damaged));
    // The limit is far more than the 10 s of processor time that a small file
    // gets.
    EXPECT_LT(Clock::now() - start, std::chrono::seconds(180));
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
    EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
    if (outcome != "valid") {
      ExpectSentence(outcome, folder_.Path());
    }
  }
  if (kMemoryIsLimited) {
    EXPECT_LT(LargestChildInMegabytes(), 1500);
  }
}

/// Selects the formats with so many trials.  Each selection is a suite, and
/// suites may run side by side.
std::vector<Trials> TrialsBetween(int least, int most) {
  std::vector<Trials> trials;
  for (const Trials& of_format : AllTrials()) {
    if (of_format.number >= least && of_format.number <= most) {
      trials.push_back(of_format);
    }
  }
  return trials;
}

std::string NameOfFormat(const ::testing::TestParamInfo<Trials>& trials) {
  return trials.param.name;
}

INSTANTIATE_TEST_SUITE_P(OfGmsh, DamagedFileTest,
                         ::testing::ValuesIn(TrialsBetween(0, kGmshTrials)),
                         NameOfFormat);
INSTANTIATE_TEST_SUITE_P(OfLegacyVtk, DamagedFileTest,
                         ::testing::ValuesIn(TrialsBetween(kGmshTrials + 1,
                                                           kLegacyTrials)),
                         NameOfFormat);
INSTANTIATE_TEST_SUITE_P(OfOthers, DamagedFileTest,
                         ::testing::ValuesIn(TrialsBetween(kLegacyTrials + 1,
                                                           1000)),
                         NameOfFormat);

// Gmsh and VTK once crashed or hung on these files.
TEST(KnownDamage, IsTold) {
  const TemporaryFolder folder;
  const auto expect = [&](const std::string& name, const std::string& content,
                          const std::string& pattern) {
    SCOPED_TRACE(pattern);
    try {
      ReadScene({folder.Write(name, content)}, Measurement::kOptional);
      ADD_FAILURE() << "it is valid";
    } catch (const std::invalid_argument& error) {
      EXPECT_THAT(error.what(), ::testing::ContainsRegex(pattern));
    }
  };
  const std::string v2 = GmshVersion2Scene();
  for (const std::string number : {"1000000000", "2147483647"}) {
    std::string far = v2;
    for (std::size_t place = 0;
         (place = far.find("\n10 ", place)) != std::string::npos;) {
      far.replace(place + 1, 2, number);
    }
    for (std::size_t place = 0;
         (place = far.find(" 10 2 ", place)) != std::string::npos;) {
      far.replace(place + 1, 2, number);
    }
    std::string outcome = "valid";
    try {
      ReadScene({folder.Write("far.msh", far)}, Measurement::kOptional);
    } catch (const std::invalid_argument& error) {
      outcome = error.what();
    }
    EXPECT_THAT(outcome, ::testing::AnyOf(::testing::StrEq("valid"),
                                          ::testing::HasSubstr("far.msh: ")));
  }
  expect("tags.msh", Replaced(v2, "4 4 2 1 1 10", "4 4 -2 1 1 10"),
         "tags.msh: ");
  std::string binary = VtkSample("LegacyBinary42").files.begin()->second;
  for (std::size_t place = 0;
       (place = binary.find('\n', place)) != std::string::npos; place += 2) {
    binary.replace(place, 1, "\r\n");
  }
  expect("ends.vtk", binary, "ends.vtk: ");
}

}  // namespace
}  // namespace elastimate
