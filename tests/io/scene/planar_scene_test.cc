// Tests of planar scenes in a scene.json, against solutions by hand.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <iomanip>
#include <sstream>
#include <string>

#include "elastimate/core/scene/loads.h"
#include "elastimate/estimators/registry.h"
#include "elastimate/io/scene/mesh_reader.h"
#include "elastimate/io/scene/scene_reader.h"
#include "elastimate/io/vtk/vtu_writer.h"
#include "tests/io/kind_scenes.h"
#include "tests/io/scene_files.h"
#include "tests/io/vtk_files.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

// Strains of 0.15 % are small ones.
constexpr double kYoungsModulus = 2000;
constexpr double kPoissonRatio = 0.25;
constexpr double kTraction = 3;

/// The rectangle of PlanarVtkText is pulled along x.
const std::string kPlanarDocument = R"({
  "model": "plane_stress", "thickness": 0.5,
  "mesh": "mesh.vtk",
  "supports": [ {"nodes": {"box": [[0, 0], [0, 1]]}, "components": "x"},
                {"nodes": {"box": [[0, 0, 6], [2, 0, 8]]}, "components": "y"} ],
  "cases": [
    { "displacement": {"file": "u.csv"},
      "loads": [ {"type": "traction", "value": [3, 0],
                  "surface": {"box": [[2, 0], [2, 1]]}} ] } ]
})";

/// Returns u = (x, y, ...) times the strains along the axes, with all digits.
std::string LinearField(const Eigen::MatrixXd& nodes,
                        const Eigen::VectorXd& strain) {
  std::ostringstream text;
  text << (strain.size() == 2 ? "ux,uy\n" : "ux,uy,uz\n")
       << std::setprecision(17);
  for (const auto& node : nodes.colwise()) {
    for (Eigen::Index i = 0; i < strain.size(); ++i) {
      text << (i == 0 ? "" : ",") << strain[i] * node[i];
    }
    text << "\n";
  }
  return text.str();
}

class PlanarSceneTest : public ::testing::Test {
 protected:
  PlanarSceneTest() {
    folder_.Write("mesh.vtk", PlanarVtkText());
    WriteField(1, -kPoissonRatio);
  }

  /// Writes a field of these strains, in units of the strain along the pull in
  /// plane stress.
  void WriteField(double along, double across) const {
    const Eigen::MatrixXd nodes =
        ReadMeshFile(folder_.Path() / "mesh.vtk").nodes.topRows(2);
    folder_.Write("u.csv",
                  LinearField(nodes, kTraction / kYoungsModulus *
                                         Eigen::Vector2d(along, across)));
  }

  Scene Read(const std::string& document,
             const SectionChoice& section = {}) const {
    return ReadScene({folder_.Write("scene.json", document)},
                     Measurement::kRequired, {section, {}, {}, {}})
        .scene;
  }

  Load ReadLoad(const std::string& load) const {
    return Read(Replaced(kPlanarDocument,
                         R"({"type": "traction", "value": [3, 0],
                  "surface": {"box": [[2, 0], [2, 1]]}})",
                         load))
        .load_cases.at(0)
        .loads.at(0);
  }

  const TemporaryFolder folder_;
};

// Fits of measured displacements take solutions that may be off by 1e-5.
void ExpectFound(const Scene& scene) {
  constexpr double kOfSolutions = 1e-5;
  for (const std::string_view name : EstimatorNames()) {
    const Estimate estimate = MakeEstimator(name)->Run(scene, {});
    EXPECT_NEAR(estimate.elasticity.youngs_modulus, kYoungsModulus,
                kOfSolutions * kYoungsModulus)
        << name << ": " << estimate.message;
    EXPECT_NEAR(estimate.elasticity.poisson_ratio, kPoissonRatio, kOfSolutions)
        << name;
  }
}

// In plane stress sigma_xx = p and all other stresses are zero, so eps_xx = p /
// E and eps_yy = -nu p / E.
TEST_F(PlanarSceneTest, FindsWhatTensionInPlaneStressIsByHand) {
  ExpectFound(Read(kPlanarDocument));
}

// In plane strain sigma_zz = nu p, so eps_xx = (1 - nu^2) p / E and eps_yy =
// -nu (1 + nu) p / E.
TEST_F(PlanarSceneTest, FindsWhatTensionInPlaneStrainIsByHand) {
  WriteField(1 - kPoissonRatio * kPoissonRatio,
             -kPoissonRatio * (1 + kPoissonRatio));
  ExpectFound(Read(Replaced(kPlanarDocument, "plane_stress", "plane_strain")));
}

// The strain is eps = p / E (1, -nu, -nu) in two hexahedra with an oblique face
// between them.
TEST_F(PlanarSceneTest, FindsWhatTensionOfHexahedraIsByHand) {
  folder_.Write("solid.vtk",
                "# vtk DataFile Version 3.0\ntwo hexahedra\nASCII\n"
                "DATASET UNSTRUCTURED_GRID\nPOINTS 12 double\n"
                "0 0 0  0.9 0 0  2 0 0  0 1 0  1.1 1 0  2 1 0\n"
                "0 0 1  1.2 0 1  2 0 1  0 1 1  0.8 1 1  2 1 1\n"
                "CELLS 2 18\n8 0 1 4 3 6 7 10 9\n8 1 2 5 4 7 8 11 10\n"
                "CELL_TYPES 2\n12 12\n");
  folder_.Write(
      "u.csv",
      LinearField(ReadMeshFile(folder_.Path() / "solid.vtk").nodes,
                  kTraction / kYoungsModulus *
                      Eigen::Vector3d(1, -kPoissonRatio, -kPoissonRatio)));
  const Scene scene = Read(R"({
    "model": "3d", "mesh": "solid.vtk",
    "supports": [
      {"nodes": {"box": [[0, 0, 0], [0, 1, 1]]}, "components": "x"},
      {"nodes": {"box": [[0, 0, 0], [2, 0, 1]]}, "components": "y"},
      {"nodes": {"box": [[0, 0, 0], [2, 1, 0]]}, "components": "z"} ],
    "cases": [
      { "displacement": {"file": "u.csv"},
        "loads": [ {"type": "pressure", "value": -3,
                    "surface": {"box": [[2, 0, 0], [2, 1, 1]]}} ] } ] })");
  EXPECT_EQ(scene.mesh.kind, ElementKind::kHex8);
  ExpectFound(scene);
}

TEST_F(PlanarSceneTest, HasLoadsOnEdgesTimesTheThickness) {
  const Mesh mesh = Read(kPlanarDocument).mesh;
  const auto expect = [&](const std::string& load, const Eigen::Vector2d& sum) {
    EXPECT_LT((ResultantOf(mesh, ReadLoad(load)).force - sum).norm(), 1e-12)
        << load;
  };
  const std::string end = R"("surface": {"box": [[2, 0], [2, 1]]}})";
  const std::string top = R"("surface": {"box": [[0, 1], [2, 1]]}})";
  expect(R"({"type": "traction", "value": [3, 4], )" + end, {1.5, 2});
  expect(R"({"type": "pressure", "value": 8, )" + end, {-4, 0});
  expect(R"({"type": "pressure", "value": 8, )" + top, {0, -8});
  expect(R"({"type": "force", "value": [3, 4], )" + top, {3, 4});
  expect(R"({"type": "body_force", "value": [0, -9]})", {0, -9});
  expect(
      R"({"type": "nodal_force", "value": [1, 0], "nodes": {"ids": [5, 8]}})",
      {2, 0});
}

TEST_F(PlanarSceneTest, TakesFieldsOfThreeColumnsInThePlane) {
  const std::string field = ReadFile(folder_.Path() / "u.csv");
  const Scene scene = Read(kPlanarDocument);
  std::string three = "x,y,z\n";
  std::istringstream rows(field);
  std::string row;
  std::getline(rows, row);
  while (std::getline(rows, row)) {
    three += row + ",0\n";
  }
  folder_.Write("u.csv", three);
  EXPECT_EQ(Read(kPlanarDocument).load_cases[0].displacement,
            scene.load_cases[0].displacement);
  folder_.Write("u.csv", Replaced(three, "0,0\n", "0,0.5\n"));
  EXPECT_THROWS_WITH(Read(kPlanarDocument),
                     "u.csv: the row of node 0 \\(z\\) is 0.5, but the mesh is "
                     "planar; make it 0");
  // A displacement across the plane is no error at a node that was not
  // observed.
  EXPECT_NO_THROW(Read(Replaced(kPlanarDocument, R"("loads")",
                                R"("observed": {"ids": [4, 5, 8]}, "loads")")));
}

TEST_F(PlanarSceneTest, TakesTheSectionOfFlagsBeforeThatOfTheDocument) {
  SectionChoice section;
  section.thickness = 2;
  EXPECT_EQ(Read(kPlanarDocument, section).mesh.section.thickness, 2);
  EXPECT_EQ(Read(kPlanarDocument, section).mesh.section.model,
            SectionModel::kPlaneStress);
  section.model = SectionModel::kPlaneStrain;
  EXPECT_EQ(Read(kPlanarDocument, section).mesh.section.model,
            SectionModel::kPlaneStrain);
}

TEST_F(PlanarSceneTest, ErrsOnWhatIsNotOfAPlane) {
  const auto expect = [this](const std::string& from, const std::string& to,
                             const std::string& pattern) {
    EXPECT_THROWS_WITH(Read(Replaced(kPlanarDocument, from, to)), pattern);
  };
  expect(R"("model": "plane_stress",)", "",
         "mesh.vtk: the mesh is of quadrilaterals, which are planar, but no "
         "model is given; give --model=plane_stress or --model=plane_strain");
  expect(R"("thickness": 0.5,)", "",
         "mesh.vtk: .* which are planar, but no thickness is given; give "
         "--thickness=X, or \"thickness\" in a scene.json");
  expect("plane_stress", "3d", "which are planar, but the model is 3d");
  expect("plane_stress", "flat",
         "scene.json: model is \"flat\"; make it 3d, plane_stress or");
  expect("\"plane_stress\"", "1", "scene.json: model must be a string");
  expect("0.5", "0", "scene.json: thickness must be positive");
  expect("\"components\": \"x\"", "\"components\": \"z\"",
         "must name each of x and y at most once, like \"xy\"");
  expect("\"components\": \"x\"", "\"components\": \"\"",
         "is empty; name some of x and y");
  expect("[3, 0]", "[3, 0, 0]",
         "cases\\[0\\].loads\\[0\\].value must be a list of 2 numbers");
  expect("[[0, 0], [0, 1]]", "[[0, 0]]",
         "must be two corners, \\[\\[x,y\\],\\[x,y\\]\\]");
  expect("[[0, 0], [0, 1]]", "[[0, 0], [0, 1, 2]]",
         "box\\[1\\] must be a list of 2 numbers");
  folder_.Write("u.csv", "ux,uz\n");
  EXPECT_THROWS_WITH(Read(kPlanarDocument),
                     "u.csv: the header must be x,y or ux,uy");
}

TEST_F(PlanarSceneTest, ErrsOnNodesThatAreNotInOnePlane) {
  folder_.Write("mesh.vtk", Replaced(PlanarVtkText(), "2 0.5 7", "2 0.5 8"));
  EXPECT_THROWS_WITH(Read(kPlanarDocument),
                     "mesh.vtk: node 5 is at z = 8 and node 0 at z = 7, but "
                     "quadrilaterals must lie in one plane z = const");
}

TEST_F(PlanarSceneTest, ErrsOnASectionOfASolid) {
  const Scene solid = TwoTetrahedra();
  const auto path = folder_.Path() / "solid.vtu";
  WriteVtu(path, solid.mesh, SceneFields(solid));
  SceneChoices choices;
  choices.section.model = SectionModel::kSolid;
  EXPECT_NO_THROW(ReadScene({path}, Measurement::kRequired, choices));
  choices.section.model = SectionModel::kPlaneStrain;
  EXPECT_THROWS_WITH(ReadScene({path}, Measurement::kRequired, choices),
                     "solid.vtu: the mesh is of tetrahedra, which are solid, "
                     "but the model is plane_strain; leave it out");
  choices.section = {std::nullopt, 1.0};
  EXPECT_THROWS_WITH(ReadScene({path}, Measurement::kRequired, choices),
                     "which are solid, but a thickness is given; leave it out");
}

class PlanarArrays : public ::testing::Test {
 protected:
  Scene Read(const std::string& name, const Eigen::MatrixXd& values) {
    for (Field& field : fields_.point) {
      if (field.name == name) {
        field.values = values;
      }
    }
    const auto path = folder_.Path() / "scene.vtu";
    WriteEncoded(path, scene_.mesh, fields_, AllVtkEncodings()[2]);
    return ReadScene({path}, Measurement::kRequired).scene;
  }

  const TemporaryFolder folder_;
  const Scene scene_ = SceneOf("quad4");
  Fields fields_ = SceneFields(scene_);
  const Eigen::Index num_nodes_ = scene_.mesh.NumNodes();
};

TEST_F(PlanarArrays, MayBeHeldAcrossThePlane) {
  const Scene scene =
      Read("fixed", Eigen::MatrixXd::Ones(3, num_nodes_) -
                        Eigen::MatrixXd::Identity(3, num_nodes_));
  EXPECT_EQ(scene.supports.held.rows(), 2);
  EXPECT_FALSE(scene.supports.held(0, 0));
}

TEST_F(PlanarArrays, AreOfThePlane) {
  for (const std::string name : {"force", "displacement"}) {
    const Fields before = fields_;
    Eigen::MatrixXd values = Eigen::MatrixXd::Ones(3, num_nodes_);
    values.row(2).setZero();
    values(2, 6) = -2;
    EXPECT_THROWS_WITH(Read(name, values),
                       "scene.vtu: the point array '" + name +
                           "' of node 6 \\(z\\) is -2, but the mesh is planar; "
                           "make it 0");
    EXPECT_THROWS_WITH(Read(name, Eigen::MatrixXd::Ones(4, num_nodes_)),
                       "has 4 components; give it 2");
    fields_ = before;
  }
}

class PlanarFieldData : public ::testing::Test {
 protected:
  PlanarFieldData() {
    const Scene scene = SceneOf("quad4");
    WriteEncoded(path_, scene.mesh, SceneFields(scene), AllVtkEncodings()[0]);
    content_ = ReadFile(path_);
  }

  Section Read(const std::string& field_data) const {
    const std::size_t begin = content_.find("<FieldData>");
    const std::size_t end = content_.find("</FieldData>");
    folder_.Write("scene.vtu", content_.substr(0, begin) + "<FieldData>" +
                                   field_data + content_.substr(end));
    return ReadScene({path_}, Measurement::kRequired).scene.mesh.section;
  }

  static std::string Number(const std::string& name, const std::string& value) {
    return "<DataArray type=\"Float64\" Name=\"" + name +
           "\" NumberOfTuples=\"1\" format=\"ascii\">" + value + "</DataArray>";
  }
  /// Returns an array of more strings than it says, which VTK would write
  /// beyond its end.
  static std::string Strings(const std::string& name) {
    std::string strings = "<Array type=\"String\" Name=\"" + name +
                          "\" NumberOfTuples=\"1\" format=\"ascii\">";
    for (int i = 0; i < 1000; ++i) {
      strings += "112 108 97 110 101 0 ";
    }
    return strings + "</Array>";
  }

  const TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_.Path() / "scene.vtu";
  std::string content_;
};

TEST_F(PlanarFieldData, AreNumbers) {
  EXPECT_EQ(Read(Number("model", "1") + Number("thickness", "3")).model,
            SectionModel::kPlaneStress);
  const Section section = Read(Number("model", "2") + Number("thickness", "3"));
  EXPECT_EQ(section.model, SectionModel::kPlaneStrain);
  EXPECT_EQ(section.thickness, 3);
  EXPECT_THROWS_WITH(Read(Number("model", "0") + Number("thickness", "3")),
                     "which are planar, but the model is 3d");
  EXPECT_THROWS_WITH(Read(Number("model", "3") + Number("thickness", "3")),
                     "scene.vtu: the field data 'model' is 3; make it 0 for 3d,"
                     " 1 for plane_stress or 2 for plane_strain");
  EXPECT_THROWS_WITH(Read(Number("model", "1") + Number("thickness", "-3")),
                     "scene.vtu: the thickness is not positive and finite");
  EXPECT_THROWS_WITH(Read(Number("model", "1")), "no thickness is given");
}

TEST_F(PlanarFieldData, LeaveWhatIsNoNumberAlone) {
  EXPECT_EQ(Read(Strings("note") + Number("model", "1") + Strings("other") +
                 Number("thickness", "3"))
                .thickness,
            3);
  EXPECT_THROWS_WITH(Read(Strings("model")), "no model is given");
  EXPECT_THROWS_WITH(Read(Replaced(Number("model", "1"), "Float64", "Float-7")),
                     "no model is given");
  EXPECT_THROWS_WITH(Read(Replaced(Number("model", "1"), "type=", "tipe=")),
                     "no model is given");
}

}  // namespace
}  // namespace elastimate
