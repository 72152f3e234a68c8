#include "elastimate/io/scene/scene_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <limits>

#include "elastimate/core/scene/degrees_of_freedom.h"
#include "tests/io/gmsh_files.h"
#include "tests/io/scene_files.h"
#include "tests/io/vtk_files.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

const Eigen::MatrixXd& ForceOf(const LoadCase& load_case) {
  return std::get<NodalForces>(load_case.loads.at(0)).force;
}

/// The scenes agree up to `tolerance`, since text forms keep eleven digits
/// only.
void ExpectSameScene(const Scene& actual, const Scene& expected,
                     double tolerance) {
  EXPECT_TRUE(actual.mesh.nodes.isApprox(expected.mesh.nodes, tolerance));
  EXPECT_EQ(actual.mesh.elements, expected.mesh.elements);
  EXPECT_EQ(actual.mesh.regions, expected.mesh.regions);
  EXPECT_TRUE((actual.supports.held == expected.supports.held).all());
  EXPECT_TRUE(actual.supports.displacement.isApprox(
      expected.supports.displacement, tolerance));
  ASSERT_EQ(actual.load_cases.size(), expected.load_cases.size());
  for (std::size_t i = 0; i < actual.load_cases.size(); ++i) {
    const LoadCase& a = actual.load_cases[i];
    const LoadCase& b = expected.load_cases[i];
    EXPECT_TRUE(ForceOf(a).isApprox(ForceOf(b), tolerance));
    EXPECT_TRUE(a.displacement.isApprox(b.displacement, tolerance));
    ASSERT_EQ(a.observed.size(), b.observed.size());
    EXPECT_TRUE((a.observed == b.observed).all());
  }
}

class VtkEncodingTest : public ::testing::TestWithParam<VtkEncoding> {};

TEST_P(VtkEncodingTest, IsReadWithoutAWordOnStandardError) {
  const TemporaryFolder folder;
  const Scene scene = TwoTetrahedra();
  const auto path = folder.Path() / ("scene" + GetParam().Extension());
  WriteEncoded(path, scene.mesh, SceneFields(scene), GetParam());
  ::testing::internal::CaptureStderr();
  const SceneReading reading = ReadScene({path}, Measurement::kRequired);
  EXPECT_THAT(::testing::internal::GetCapturedStderr(), IsEmpty());
  EXPECT_THAT(reading.notices,
              ElementsAre(HasSubstr("regions share one material")));
  const bool is_text = GetParam().data == VtkEncoding::Data::kAscii;
  ExpectSameScene(reading.scene, scene, is_text ? 1e-9 : 0.0);
}

INSTANTIATE_TEST_SUITE_P(All, VtkEncodingTest,
                         ::testing::ValuesIn(AllVtkEncodings()),
                         [](const auto& parameter) {
                           return parameter.param.name;
                         });

class SceneReaderTest : public ::testing::Test {
 protected:
  SceneReading Read(const std::string& legacy_text,
                    Measurement measurement = Measurement::kRequired) const {
    return ReadScene({folder_.Write("scene.vtk", legacy_text)}, measurement);
  }

  /// Writes the fields as a VTU file and reads them.
  SceneReading Read(const Mesh& mesh, const Fields& fields,
                    Measurement measurement = Measurement::kRequired) const {
    const auto path = folder_.Path() / "scene.vtu";
    WriteEncoded(path, mesh, fields, AllVtkEncodings()[2]);
    return ReadScene({path}, measurement);
  }

  static Field& FieldOf(Fields& fields, const std::string& name) {
    for (Field& field : fields.point) {
      if (field.name == name) {
        return field;
      }
    }
    throw std::logic_error("no field " + name);
  }

  const TemporaryFolder folder_;
  const Scene scene_ = TwoTetrahedra();
  Fields fields_ = SceneFields(scene_);
};

TEST_F(SceneReaderTest, DropsUnusedPointsAndIgnoresLinesAndTriangles) {
  const SceneReading reading = Read(LegacySceneText());
  const Scene& scene = reading.scene;
  EXPECT_EQ(scene.mesh.NumNodes(), 5);
  Eigen::MatrixXi elements(4, 2);
  elements.transpose() << 0, 1, 2, 3, 0, 1, 2, 4;
  EXPECT_EQ(scene.mesh.elements, elements);
  EXPECT_EQ(scene.mesh.regions, Eigen::Vector2i(7, 8));
  EXPECT_EQ(scene.mesh.nodes.col(2), Eigen::Vector3d(0, 1, 0));
  EXPECT_TRUE(scene.supports.held.leftCols(3).all());
  EXPECT_FALSE(scene.supports.held.rightCols(2).any());
  EXPECT_EQ(ForceOf(scene.load_cases[0]).col(3), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(scene.load_cases[0].displacement.col(4),
            Eigen::Vector3d(.4, .5, .6));
  EXPECT_THAT(reading.notices,
              ElementsAre(HasSubstr("1 point that no tetrahedron"),
                          HasSubstr("regions share one material")));
}

TEST_F(SceneReaderTest, TellsOfForcesThatAreDroppedWithTheirPoints) {
  const SceneReading reading = Read(Replaced(
      LegacySceneText(), "0 0 0 0 0 0 0 0 0 0", "0 0 0 0 0 0 0 9 0 0"));
  EXPECT_THAT(reading.notices,
              ElementsAre(HasSubstr("'force' has forces on 1 point that"),
                          HasSubstr("1 point that no"),
                          HasSubstr("regions share one material")));
}

TEST_F(SceneReaderTest, NotesRegionsOnce) {
  const auto first = folder_.Path() / "first.vtu";
  const auto second = folder_.Path() / "second.vtu";
  WriteEncoded(first, scene_.mesh, fields_, AllVtkEncodings()[2]);
  FieldOf(fields_, "force").values *= 2;
  FieldOf(fields_, "force_2").values *= 2;
  WriteEncoded(second, scene_.mesh, fields_, AllVtkEncodings()[2]);
  EXPECT_THAT(
      ReadScene({first, second}, Measurement::kRequired).notices,
      ElementsAre(::testing::EndsWith(
          "first.vtu: the mesh has 2 regions, but all regions share one "
          "material: E and nu are those of the mesh as a whole; "
          "--regions=each gives each its own")));
  fields_.cell[0].values.setConstant(7);
  EXPECT_THAT(Read(scene_.mesh, fields_).notices, IsEmpty());
}

TEST_F(SceneReaderTest, NotesNodesAtOnePlace) {
  // The two tetrahedra share a face, but the second has its own nodes there.  A
  // point that nothing uses lies there as well.
  const std::string apart = Replaced(
      Replaced(Replaced(Replaced(Replaced(Replaced(LegacySceneText(),
                                                   "POINTS 6", "POINTS 9"),
                                          "9 9 9", "0 0 0"),
                                 "0.25 0.25 -1\n",
                                 "0.25 0.25 -1  0 0 0  1 0 0  0 1 1e-7\n"),
                        "4 0 1 3 5", "4 6 7 8 5"),
               "-5 7 -6 8", "7 7 7 7"),
      "POINT_DATA 6", "POINT_DATA 9");
  const std::string fixed =
      Replaced(apart, "1 1 0 1 0 0\n", "1 1 0 1 0 0 1 1 1\n");
  const std::string zeros = " 0 0 0 0 0 0 0 0 0\n";
  const SceneReading reading =
      Read(Replaced(Replaced(Replaced(fixed, ".4 .5 .6\n", ".4 .5 .6" + zeros),
                             "force 3 6 int", "force 3 9 int"),
                    "4 5 6\n", "4 5 6" + zeros));
  EXPECT_THAT(
      reading.notices,
      ElementsAre(
          HasSubstr("1 point that no"),
          ::testing::EndsWith(
              "scene.vtk: 6 nodes lie at the same place as another node, such "
              "as at (0, 0, 0), so that the parts around them are not "
              "connected; merge them in the mesh tool if the parts should be "
              "one")));
}

TEST_F(SceneReaderTest, QuotesOnlyWhatIsFitToPrint) {
  // VTK decodes %1B and %0A in the names of a legacy file.
  EXPECT_THROWS_WITH(Read(Replaced(LegacySceneText(), "SCALARS fixed",
                                   "SCALARS f%1B[31mixed%0A")),
                     "the point arrays of this file are: "
                     ".*f\\\\x1b\\[31mixed\\\\n.*\\)$");
  const auto read = [&] { return Read(scene_.mesh, fields_); };
  fields_.point[0].name = std::string(2000, 'a');
  EXPECT_THROWS_WITH(read(),
                     "the point arrays of this file are: "
                     ".*a{37}\\.\\.\\.a{20}.*\\)$");
  fields_ = SceneFields(scene_);
  fields_.point.push_back(
      {"force_" + std::string(2000, '9'), Eigen::MatrixXd::Zero(3, 5)});
  EXPECT_THROWS_WITH(read(),
                     "the point array 'force_9{31}\\.\\.\\.9{20}' "
                     "belongs to no load case");
  EXPECT_THROWS_WITH(
      ReadScene({folder_.Path() / "a\n\033[2J.vtu"}, Measurement::kRequired),
      "a\\\\n\\\\x1b\\[2J.vtu: no such file");
  EXPECT_THROWS_WITH(
      ReadScene({folder_.Path() / "Größe.vtu"}, Measurement::kRequired),
      "/Größe.vtu: no such file");
}

TEST_F(SceneReaderTest, AcceptsThatNothingIsHeld) {
  FieldOf(fields_, "fixed").values.setZero();
  EXPECT_FALSE(Read(scene_.mesh, fields_).scene.supports.held.any());
}

TEST_F(SceneReaderTest, IgnoresWhatWasNotObservedEvenNan) {
  FieldOf(fields_, "displacement_2").values(2, 4) = kNan;
  const Scene scene = Read(scene_.mesh, fields_).scene;
  EXPECT_EQ(scene.load_cases[1].displacement(2, 4), 0.0);
}

TEST_F(SceneReaderTest, ReadsSceneWithoutMeasurementOnlyWhenToldTo) {
  fields_.point = {FieldOf(fields_, "fixed"), FieldOf(fields_, "force"),
                   FieldOf(fields_, "force_2")};
  EXPECT_THROWS_WITH(Read(scene_.mesh, fields_),
                     "scene.vtu: the point array 'displacement' is missing");
  const Scene scene = Read(scene_.mesh, fields_, Measurement::kOptional).scene;
  ASSERT_EQ(scene.load_cases.size(), 2);
  EXPECT_EQ(scene.load_cases[1].displacement.size(), 0);
}

TEST_F(SceneReaderTest, NamesMissingArraysAndThoseThereAre) {
  for (const std::string name : {"fixed", "force", "displacement"}) {
    Fields fields = fields_;
    FieldOf(fields, name).name = "other";
    EXPECT_THROWS_WITH(
        Read(scene_.mesh, fields),
        "scene.vtu: the point array '" + name + "' is missing; add it .*other");
  }
}

TEST_F(SceneReaderTest, NamesWronglyShapedArrays) {
  for (const std::string name :
       {"fixed", "force", "displacement", "prescribed", "observed_2"}) {
    Fields fields = fields_;
    FieldOf(fields, name).values = Eigen::MatrixXd::Ones(2, 5);
    EXPECT_THROWS_WITH(Read(scene_.mesh, fields),
                       "the point array '" + name + "' has 2 components");
  }
  fields_.cell[0].values = Eigen::MatrixXd::Ones(3, 2);
  EXPECT_THROWS_WITH(Read(scene_.mesh, fields_), "'region' has 3 components");
}

TEST_F(SceneReaderTest, NamesOptionalArraysThatSeemMisspelt) {
  for (const std::string name :
       {"prescribd", "Prescribed", "PRESCRIBED_2", "observd", "Observed"}) {
    Fields fields = fields_;
    fields.point.push_back(FieldOf(fields, "force"));
    fields.point.back().name = name;
    EXPECT_THROWS_WITH(Read(scene_.mesh, fields),
                       "the point array '" + name + "' is not read");
  }
  Fields fields = fields_;
  fields.point.push_back(FieldOf(fields, "force"));
  fields.point.back().name = "temperature";
  EXPECT_NO_THROW(Read(scene_.mesh, fields));
}

TEST_F(SceneReaderTest, NamesLoadCasesOutOfSequence) {
  Fields fields = fields_;
  FieldOf(fields, "displacement_2").name = "displacement_3";
  EXPECT_THROWS_WITH(Read(scene_.mesh, fields), "'displacement_2' is missing");
  FieldOf(fields, "force_2").name = "force_3";
  EXPECT_THROWS_WITH(Read(scene_.mesh, fields),
                     "array 'force_3' belongs to no load case");
  fields = fields_;
  FieldOf(fields, "force_2").name = "traction";
  EXPECT_THROWS_WITH(Read(scene_.mesh, fields), "'force_2' is missing");
}

TEST_F(SceneReaderTest, ReadsSupportsOfOneLoadCase) {
  Fields fields = fields_;
  fields.point.push_back(FieldOf(fields, "fixed"));
  fields.point.back().name = "fixed_2";
  // Supports of a load case that equal those of the scene are not kept apart.
  EXPECT_FALSE(HasSupportsOfCases(Read(scene_.mesh, fields).scene));
  fields.point.back().values(0, 0) = 1 - fields.point.back().values(0, 0);
  const Scene scene = Read(scene_.mesh, fields).scene;
  EXPECT_FALSE(scene.load_cases[0].supports);
  ASSERT_TRUE(scene.load_cases[1].supports);
  EXPECT_NE(scene.load_cases[1].supports->held(0, 0),
            scene.supports.held(0, 0));
  fields.point.back().name = "fixed_3";
  EXPECT_THROWS_WITH(Read(scene_.mesh, fields),
                     "array 'fixed_3' belongs to no load case");
}

TEST_F(SceneReaderTest, ReadsWhatWasWrittenOfSupportsOfOneLoadCase) {
  Scene scene = scene_;
  scene.load_cases[1].supports = scene.supports;
  scene.load_cases[1].supports->displacement *= -2;
  const Scene read = Read(scene.mesh, SceneFields(scene)).scene;
  ASSERT_TRUE(read.load_cases[1].supports);
  EXPECT_TRUE((read.supports.held == scene.supports.held).all());
  EXPECT_TRUE((read.load_cases[1].supports->held == scene.supports.held).all());
  EXPECT_TRUE(
      HeldDisplacement(*read.load_cases[1].supports)
          .isApprox(HeldDisplacement(*scene.load_cases[1].supports), 1e-12));
}

TEST_F(SceneReaderTest, ErrsOnTwoArraysOfOneName) {
  EXPECT_THROWS_WITH(
      Read(LegacySceneText() + "VECTORS displacement double\n"
                               "0 0 0 0 0 0 7 7 7 0 0 0 .1 .2 .3 .4 .5 .6\n"),
      "scene.vtk: .*it has two arrays 'displacement'");
  const auto path = folder_.Path() / "scene.vtu";
  WriteEncoded(path, scene_.mesh, fields_, AllVtkEncodings()[2]);
  const std::string whole = ReadFile(path);
  EXPECT_THROWS_WITH(
      ReadScene({folder_.Write(
                    "a.vtu", Replaced(whole, "\"force\"", "\"displacement\""))},
                Measurement::kRequired),
      "a.vtu: .*its PointData has two arrays 'displacement'");
  EXPECT_THROWS_WITH(
      ReadScene({folder_.Write("a.vtu", Replaced(whole, "Name=\"force\"", ""))},
                Measurement::kRequired),
      "a.vtu: .*an array of its PointData has no name");
  EXPECT_THROWS_WITH(
      ReadScene({folder_.Write("a.msh", GmshVersion2Scene() +
                                            GmshNodeData("force", "1 2 3"))},
                Measurement::kRequired),
      "a.msh: it has the data 'force' twice");
}

// VTK would crash on strings that do not end.
TEST_F(SceneReaderTest, LeavesArraysOfStringsAlone) {
  const auto path = folder_.Path() / "scene.vtu";
  WriteEncoded(path, scene_.mesh, fields_, AllVtkEncodings()[0]);
  const std::string whole = ReadFile(path);
  for (const std::string text : {"104 0 104 0 104 0 104 0 104 0", "104", ""}) {
    const std::string array =
        R"(<Array type="String" Name="name" format="ascii">)" + text +
        "</Array>";
    const auto with_text = folder_.Write(
        "text.vtu", Replaced(whole, "</PointData>", array + "</PointData>"));
    ExpectSameScene(ReadScene({with_text}, Measurement::kRequired).scene,
                    scene_, 1e-9);
  }
  EXPECT_THROWS_WITH(
      ReadScene(
          {folder_.Write("text.vtu",
                         Replaced(whole, "type=\"Float64\" Name=\"force\"",
                                  "type=\"String\" Name=\"force\""))},
          Measurement::kRequired),
      "text.vtu: the point array 'force' is missing");
}

TEST_F(SceneReaderTest, NamesNodesThatAreNotFinite) {
  for (const std::string name :
       {"fixed", "force", "displacement_2", "observed_2"}) {
    for (const double value : {kNan, HUGE_VAL, -HUGE_VAL}) {
      Fields fields = fields_;
      FieldOf(fields, name).values(1, 3) = value;
      EXPECT_THROWS_WITH(
          Read(scene_.mesh, fields),
          "scene.vtu: the point array '" + name + "' of node 3 \\(y\\) is");
    }
  }
  Fields fields = fields_;
  FieldOf(fields, "displacement_2").values(1, 3) = kNan;
  EXPECT_THROWS_WITH(Read(scene_.mesh, fields),
                     "node 3 \\(y\\) is nan; correct it or mark it as not "
                     "measured in the array 'observed_2'");
  FieldOf(fields_, "prescribed").values(0, 1) = kNan;
  EXPECT_THROWS_WITH(Read(scene_.mesh, fields_),
                     "'prescribed' of node 1 \\(x\\) is nan");
}

TEST_F(SceneReaderTest, NumbersNodesAsTheFileDoesDespiteUnusedOnes) {
  // The file has the scene with one more point ahead of the others.
  Mesh mesh = scene_.mesh;
  mesh.nodes.resize(3, 6);
  mesh.nodes << Eigen::Vector3d(9, 9, 9), scene_.mesh.nodes;
  mesh.elements.array() += 1;
  Fields fields = fields_;
  for (Field& field : fields.point) {
    const Eigen::MatrixXd values = field.values;
    field.values.resize(3, 6);
    field.values << Eigen::Vector3d(kNan, HUGE_VAL, 0), values;
  }
  EXPECT_NO_THROW(Read(mesh, fields));
  FieldOf(fields, "force").values(1, 4) = kNan;
  EXPECT_THROWS_WITH(Read(mesh, fields), "'force' of node 4 \\(y\\) is nan");
  mesh.nodes(1, 4) = HUGE_VAL;
  EXPECT_THROWS_WITH(Read(mesh, fields),
                     "the position of node 4 is not a finite number");
}

TEST_F(SceneReaderTest, ErrsOnRegionsThatAreNoIntegers) {
  fields_.cell[0].values(0, 1) = 0.5;
  EXPECT_THROWS_WITH(Read(scene_.mesh, fields_), "'region' is 0.5.*integers");
  fields_.cell[0].values(0, 1) = kNan;
  EXPECT_THROWS_WITH(Read(scene_.mesh, fields_), "'region' is nan");
  fields_.cell[0].values(0, 1) = 1e300;
  EXPECT_THROWS_WITH(Read(scene_.mesh, fields_), "'region' is 1e\\+300 at");
}

TEST_F(SceneReaderTest, ErrsOnFlatTetrahedra) {
  Mesh mesh = scene_.mesh;
  mesh.nodes(2, 4) = 0.0;
  EXPECT_THROWS_WITH(Read(mesh, fields_), "scene.vtu: .*1.* is flat");
}

TEST_F(SceneReaderTest, ErrsOnTetrahedraThatComeTwice) {
  Mesh mesh = scene_.mesh;
  mesh.elements.col(1) = mesh.elements.col(0).reverse().eval();
  EXPECT_THROWS_WITH(Read(mesh, fields_),
                     "scene.vtu: tetrahedra 0 and 1 have the same nodes; keep "
                     "one of them");
}

TEST_F(SceneReaderTest, ErrsWhenEverythingIsHeld) {
  FieldOf(fields_, "fixed").values.setOnes();
  EXPECT_THROWS_WITH(Read(scene_.mesh, fields_),
                     "scene.vtu: every degree of freedom is held");
}

TEST_F(SceneReaderTest, ErrsWhenNothingIsObserved) {
  FieldOf(fields_, "observed_2").values.setZero();
  EXPECT_THROWS_WITH(Read(scene_.mesh, fields_),
                     "nothing is observed in load case 2");
}

TEST_F(SceneReaderTest, ErrsOnPointsOutOfRange) {
  EXPECT_THROWS_WITH(Read(Replaced(LegacySceneText(), "0 1 3 5", "0 1 3 6")),
                     "scene.vtk: cell 3 names point 6, but there are 6 "
                     "points");
  EXPECT_THROWS_WITH(Read(Replaced(LegacySceneText(), "0 1 3 5", "0 -1 3 5")),
                     "cell 3 names point -1");
  Mesh mesh = scene_.mesh;
  mesh.elements(2, 1) = 123456789;
  EXPECT_THROWS_WITH(Read(mesh, fields_), "cell 1 names point 123456789");
}

TEST_F(SceneReaderTest, ErrsOnOtherCells) {
  EXPECT_THROWS_WITH(
      Read(Replaced(LegacySceneText(), "3 10 5 10", "3 10 5 24")),
      "scene.vtk: cell 3 is a quadratic tetra, but cell 1 is a tetra; mesh the "
      "specimen with cells of one kind, or with all linear or all quadratic "
      "ones");
  EXPECT_THROWS_WITH(
      Read(Replaced(LegacySceneText(), "3 10 5 10", "3 10 5 32")),
      "cell 3 is a bi quadratic quadratic wedge, but the cells of a scene are "
      "tetrahedra of 4 or 10 nodes");
  EXPECT_THROWS_WITH(
      Read(Replaced(LegacySceneText(), "3 10 5 10", "3 10 5 13")),
      "cell 3 is a wedge of 4 points where 6 are due");
  EXPECT_THROWS_WITH(
      Read(Replaced(LegacySceneText(), "3 10 5 10", "3 24 5 24")),
      "cell 1 is a quadratic tetra of 4 points where 10 are due");
  EXPECT_THROWS_WITH(
      Read(Replaced(LegacySceneText(), "3 10 5 10", "3 10 5 250")),
      "unknown type 250");
  EXPECT_THROWS_WITH(Read(Replaced(LegacySceneText(), "3 10 5 10", "3 5 5 5")),
                     "cell 1 is a triangle of 4 points where 3 are due");
  EXPECT_THROWS_WITH(Read(Replaced(LegacySceneText(), "3 10 5 10", "3 4 3 4")),
                     "scene.vtk: the mesh has no elements");
}

TEST_F(SceneReaderTest, ErrsOnFilesThatAreNone) {
  const auto expect = [](const std::filesystem::path& path,
                         const std::string& pattern) {
    EXPECT_THROWS_WITH(ReadScene({path}, Measurement::kRequired), pattern);
  };
  expect(folder_.Path() / "none.vtu", "none.vtu: no such file");
  expect(folder_.Path(), "this is a folder");
  expect("/dev/null", "/dev/null: this is not a regular file");
  for (const std::string name :
       {"empty.vtu", "empty.vtk", "empty.msh", "empty.json", "empty.mesh"}) {
    expect(folder_.Write(name, ""), name + ": the file is empty");
  }
  expect(folder_.Write("scene.xyz", "a"), "scene.xyz: the file name does not");
  expect(folder_.Write("scene", "a"), "scene: the file name does not");
  const std::string image = "\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\1\0";
  for (const std::string name :
       {"i.vtu", "i.vtk", "i.msh", "i.mesh", "i.unv", "i.bdf"}) {
    expect(folder_.Write(name, image), name + ": the file is damaged or");
    expect(folder_.Write(name, "hello\n"), name + ": the file is damaged or");
  }
  EXPECT_THROWS_WITH(ReadScene({}, Measurement::kRequired),
                     "no scene file is given");
}

TEST_F(SceneReaderTest, ErrsOnOtherKindsOfVtkData) {
  EXPECT_THROWS_WITH(
      Read(Replaced(LegacySceneText(), "UNSTRUCTURED_GRID", "POLYDATA")),
      "Cannot read dataset type: polydata");
  EXPECT_THROWS_WITH(
      ReadScene({folder_.Write("p.vtu",
                               "<VTKFile type=\"PolyData\"><PolyData/>"
                               "</VTKFile>")},
                Measurement::kRequired),
      "its type is 'PolyData' instead of 'UnstructuredGrid'");
}

TEST_F(SceneReaderTest, ErrsOnArraysOfAnotherLength) {
  for (const VtkEncoding& encoding : AllVtkEncodings()) {
    SCOPED_TRACE(encoding.name);
    for (const std::string name : {"displacement", "fixed", "region"}) {
      Fields fields = fields_;
      Field& field = name == "region" ? fields.cell[0] : FieldOf(fields, name);
      const Eigen::MatrixXd values = field.values;
      field.values.resize(values.rows(), values.cols() + 1);
      field.values << values, values.col(0);
      const auto path = folder_.Path() / ("scene" + encoding.Extension());
      WriteEncoded(path, scene_.mesh, fields, encoding);
      EXPECT_THROWS_WITH(ReadScene({path}, Measurement::kRequired),
                         "the file is damaged .*" + name);
    }
  }
}

TEST_F(SceneReaderTest, NamesTextArraysThatAreTooLongOrTooShort) {
  const auto path = folder_.Path() / "scene.vtu";
  WriteEncoded(path, scene_.mesh, fields_, AllVtkEncodings()[0]);
  const std::string whole = ReadFile(path);
  EXPECT_THROWS_WITH(
      ReadScene({folder_.Write("a.vtu", Replaced(whole, "NumberOfPoints=\"5",
                                                 "NumberOfPoints=\"4"))},
                Measurement::kRequired),
      "a.vtu: .*its array '.*' has 15 values where 12 are due");
  EXPECT_THROWS_WITH(
      ReadScene({folder_.Write("a.vtu", Replaced(whole, "NumberOfPoints=\"5",
                                                 "NumberOfPoints=\"6"))},
                Measurement::kRequired),
      "a.vtu: .*its array '.*' has 15 values where 18 are due");
  EXPECT_THROWS_WITH(
      ReadScene({folder_.Write("a.vtu", Replaced(whole, "NumberOfCells=\"2",
                                                 "NumberOfCells=\"1"))},
                Measurement::kRequired),
      "a.vtu: .*its array 'region' has 2 values where 1 are due");
}

TEST_F(SceneReaderTest, AcceptsExtensionsInCapitals) {
  const auto expect_same = [this](const std::string& small,
                                  const std::string& capital) {
    const auto path = folder_.Path() / small;
    std::filesystem::copy_file(path, folder_.Path() / capital);
    const Scene scene = ReadScene({path}, Measurement::kRequired).scene;
    ExpectSameScene(
        ReadScene({folder_.Path() / capital}, Measurement::kRequired).scene,
        scene, 0.0);
  };
  WriteEncoded(folder_.Path() / "s.vtu", scene_.mesh, fields_,
               AllVtkEncodings()[0]);
  expect_same("s.vtu", "S.VTU");
  WriteEncoded(folder_.Path() / "s.vtk", scene_.mesh, fields_,
               AllVtkEncodings()[10]);
  expect_same("s.vtk", "S.VTK");
  folder_.Write("s.msh", GmshVersion2Scene());
  expect_same("s.msh", "S.MSH");
  folder_.Write(
      "s.json",
      R"({"mesh": "S.MSH", "supports": [{"nodes": {"array": "fixed"}}],
          "cases": [{"displacement": {"array": "displacement"},
                     "loads": [{"type": "nodal_force", "array": "force"}]}]})");
  expect_same("s.json", "S.JSON");
  // Gmsh would run such a file as a script.
  EXPECT_THROWS_WITH(
      ReadScene({folder_.Write("s.Mesh", "Exit;\n")}, Measurement::kRequired),
      "s.Mesh: the file name does not end in");
}

TEST_F(SceneReaderTest, ErrsOnAFileGivenTwice) {
  const auto path = folder_.Path() / "scene.vtu";
  WriteEncoded(path, scene_.mesh, fields_, AllVtkEncodings()[2]);
  const auto again = folder_.Path() / "." / "scene.vtu";
  EXPECT_THROWS_WITH(ReadScene({path, again}, Measurement::kRequired),
                     "scene.vtu: this file is given twice, also as "
                     "'.*scene.vtu'; give each load case only once");
  const auto copy = folder_.Path() / "copy.vtu";
  std::filesystem::copy_file(path, copy);
  EXPECT_THROWS_WITH(ReadScene({path, copy}, Measurement::kRequired),
                     "copy.vtu: load case 1 has the displacements and forces "
                     "of load case 1 of '.*scene.vtu'; give each");
  FieldOf(fields_, "displacement_2").values =
      FieldOf(fields_, "displacement").values;
  FieldOf(fields_, "observed_2").values.setOnes();
  EXPECT_NO_THROW(Read(scene_.mesh, fields_));  // By other forces.
  FieldOf(fields_, "force_2").values = FieldOf(fields_, "force").values;
  FieldOf(fields_, "observed_2").name = "other";
  EXPECT_THROWS_WITH(Read(scene_.mesh, fields_),
                     "scene.vtu: load case 2 has the displacements and forces "
                     "of load case 1 of");
}

TEST_F(SceneReaderTest, JoinsFilesOfOneMesh) {
  const auto first = folder_.Path() / "first.vtu";
  const auto second = folder_.Path() / "second.vtk";
  WriteEncoded(first, scene_.mesh, fields_, AllVtkEncodings()[5]);
  // This encoding keeps fewer digits than the other.
  WriteEncoded(second, scene_.mesh, fields_, AllVtkEncodings()[10]);
  const Scene scene = ReadScene({first, second}, Measurement::kRequired).scene;
  ASSERT_EQ(scene.load_cases.size(), 4);
  EXPECT_TRUE(scene.load_cases[3].displacement.isApprox(
      scene_.load_cases[1].displacement, 1e-9));
  EXPECT_EQ(scene.mesh.nodes, scene_.mesh.nodes);
}

TEST_F(SceneReaderTest, KeepsTheSupportsOfEachFile) {
  const auto first = folder_.Path() / "first.vtu";
  const auto second = folder_.Path() / "second.vtu";
  WriteEncoded(first, scene_.mesh, fields_, AllVtkEncodings()[2]);
  Fields fields = fields_;
  FieldOf(fields, "displacement").values *= 2;
  FieldOf(fields, "displacement_2").values *= 2;
  FieldOf(fields, "prescribed").values(0, 1) = 0.2;
  WriteEncoded(second, scene_.mesh, fields, AllVtkEncodings()[2]);
  const SceneReading reading =
      ReadScene({first, second}, Measurement::kRequired);
  ASSERT_EQ(reading.scene.load_cases.size(), 4);
  for (int k = 0; k < 4; ++k) {
    EXPECT_EQ(reading.scene.load_cases[k].supports.has_value(), k > 1);
  }
  EXPECT_EQ(reading.scene.load_cases[2].supports->displacement(0, 1), 0.2);
  ASSERT_FALSE(reading.notices.empty());
  EXPECT_THAT(reading.notices.back(),
              ::testing::HasSubstr("has other supports than"));
}

TEST_F(SceneReaderTest, SaysHowFilesDiffer) {
  const auto first = folder_.Path() / "first.vtu";
  WriteEncoded(first, scene_.mesh, fields_, AllVtkEncodings()[2]);
  const auto expect = [&](const Mesh& mesh, const Fields& fields,
                          const std::string& pattern) {
    const auto second = folder_.Path() / "second.vtu";
    WriteEncoded(second, mesh, fields, AllVtkEncodings()[2]);
    EXPECT_THROWS_WITH(ReadScene({first, second}, Measurement::kRequired),
                       "second.vtu: this is not a further load case of "
                       ".*first.vtu', because " +
                           pattern);
  };
  Mesh mesh = scene_.mesh;
  mesh.nodes(0, 3) += 1e-3;
  expect(mesh, fields_, "its nodes are at other positions");
  mesh = scene_.mesh;
  mesh.elements.col(0).swap(mesh.elements.col(1));
  expect(mesh, fields_, "its cells differ");
  Fields fields = fields_;
  fields.cell.clear();
  expect(scene_.mesh, fields, "its regions differ");
  const auto larger = folder_.Write("larger.vtk", LegacySceneText());
  EXPECT_THROWS_WITH(
      ReadScene({larger, folder_.Write("smaller.vtk",
                                       Replaced(LegacySceneText(), "3 10 5 10",
                                                "3 10 5 5"))},
                Measurement::kRequired),
      "smaller.vtk: this is not .*, because it has 4 nodes instead of 5");
}

TEST_F(SceneReaderTest, ReadsTheScenesOfAnIndependentCode) {
  const std::filesystem::path folder = ELASTIMATE_SHARED_DATA;
  if (!std::filesystem::exists(folder / "liver_same_mesh.vtu")) {
    GTEST_SKIP() << "no scenes in " << folder;
  }
  const Scene liver =
      ReadScene({folder / "liver_same_mesh.vtu"}, Measurement::kRequired).scene;
  EXPECT_EQ(liver.mesh.NumNodes(), 181);
  EXPECT_EQ(liver.mesh.NumElements(), 596);
  EXPECT_THROWS_WITH(ReadScene({folder / "liver.msh"}, Measurement::kRequired),
                     "liver.msh: a mesh alone is not a scene, as it has no "
                     "supports, loads and displacements; write a scene.json");
}

}  // namespace
}  // namespace elastimate
