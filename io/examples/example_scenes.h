#ifndef ELASTIMATE_IO_EXAMPLES_EXAMPLE_SCENES_H_
#define ELASTIMATE_IO_EXAMPLES_EXAMPLE_SCENES_H_

#include <Eigen/Core>
#include <optional>

#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// A cuboid of `cells` cells, each cut into five tetrahedra, or each one
/// hexahedron.  The default has 250 tetrahedra, like the cuboid of Becker &
/// Teschner 2007, section 5 (the paper states neither its size nor its
/// supports).
struct CuboidOptions {
  /// Number of cells along x, y, z; at least 1 each, and no more than
  /// 2 000 000 in all.
  Eigen::Vector3i cells = {5, 5, 2};
  /// Edge lengths [m], 1e-50 to 1e50; the longest edge of a cell is no more
  /// than 100 000 times the shortest.
  Eigen::Vector3d size = {1.0, 1.0, 0.4};
  /// Force on every free node [N]; of magnitude 1e-50 to 1e50, or zero.
  Eigen::Vector3d force = {0.0, 0.0, -30.0};
  ElementKind kind = ElementKind::kTet4;  ///< Or kHex8.
};

/// A cuboid with one corner at the origin, held at z = 0, with one load case
/// and no measurement.  The nodes are numbered along x first, then y, then z.
/// Throws std::invalid_argument, beginning with the option's name, for an
/// option out of its range.  O(num_elements): 0.03 s for a million tetrahedra.
[[nodiscard]] Scene CuboidScene(const CuboidOptions& options);

/// A strip of sheet metal of `cells` quadrilaterals, or of twice as many
/// triangles, that is pulled.
struct RectangleOptions {
  /// Number of cells along x and y; at least 1 each, and no more than 2 000 000
  /// in all.
  Eigen::Vector2i cells = {20, 4};
  /// Edge lengths [m], 1e-50 to 1e50; the longest edge of a cell is no more
  /// than 100 000 times the shortest.
  Eigen::Vector2d size = {0.1, 0.02};
  /// Total force on the end [N]; of magnitude 1e-50 to 1e50, or zero.
  Eigen::Vector2d force = {1000.0, 0.0};
  ElementKind kind = ElementKind::kQuad4;  ///< Or kTri3.
  /// Plane stress or plane strain, and a thickness of 1e-50 to 1e50 [m].
  Section section = {SectionModel::kPlaneStress, 0.001};
};

/// A rectangle with one corner at the origin, held at x = 0, with one load case
/// of a force that is spread uniformly over its other end, and no measurement.
/// The nodes are numbered along x first, then y.  Throws std::invalid_argument,
/// beginning with the option's name, for an option out of its range.
/// O(num_elements).
[[nodiscard]] Scene RectangleScene(const RectangleOptions& options);

/// What pulls the end of a plate.
enum class PlateEnds {
  kTraction,  ///< A force that is spread uniformly over the end.
  kGrips,     ///< A rigid grip, which the end follows without narrowing.
};

/// A quarter of a plate with a hole that is pulled along x: by symmetry the
/// whole plate is 2 W x 2 H, and its hole is whole.
struct PlateOptions {
  /// W, H: edge lengths of the quarter [mm], 1e-50 to 1e50.
  Eigen::Vector2d size = {10.0, 10.0};
  /// Radius of the hole [mm], below both edge lengths, and at least 1e-5 of the
  /// longer one.
  double hole = 2.5;
  /// Number of cells along the arc, and as many from there to the edges: 2 to
  /// 1414.
  int cells = 54;
  PlateEnds ends = PlateEnds::kTraction;
  /// Total force along x on the end of the quarter [N], of magnitude 1e-50 to
  /// 1e50, or zero; for kTraction.
  double force = 1500.0;
  /// How far a grip moves along x [mm], of magnitude 1e-50 to 1e50; for kGrips.
  /// A thousandth of W where it is not given.
  std::optional<double> elongation;
  ElementKind kind = ElementKind::kQuad4;  ///< Or kTri3.
  /// Plane stress or plane strain, and a thickness of 1e-50 to 1e50 [mm].
  Section section = {SectionModel::kPlaneStress, 1.0};
};

/// The quarter 0 <= x <= W, 0 <= y <= H without the hole around the origin,
/// held by symmetry (u_x = 0 at x = 0, u_y = 0 at y = 0), with one load case
/// and no measurement.  A grip holds u_y = 0 at x = W, too.
///
/// Nodes lie on rays from the origin, one through the corner (W, H), with
/// distances in geometric progression from the arc to the edges, so that cells
/// are about square beside the hole.  They are numbered from the arc outwards
/// first, then from the x axis to the y axis.  Throws std::invalid_argument,
/// beginning with the option's name, for an option out of its range.
/// O(num_elements).
[[nodiscard]] Scene PlateScene(const PlateOptions& options);

/// A smooth, closed, liver-like solid: a big right lobe (small x) that tapers
/// to a thin left lobe, domed above, hollow behind and below, with a thin lower
/// edge.  x goes to the organ's left, y to the back, z up; the organ is about
/// 0.67 lengths deep and 0.62 lengths high, with a volume of 0.114 length^3
/// (0.9 litres for the default length).
struct OrganOptions {
  int tetrahedra = 1970;  ///< Wanted number of tetrahedra, reached within 5 %;
                          ///< 200 to 2 000 000.
  double length = 0.2;    ///< Extent along x [m]; 1e-50 to 1e50.
  /// Force on every free node [N]; of magnitude 1e-50 to 1e50, or zero.  The
  /// default adds up to about the organ's weight for the default number of
  /// tetrahedra, and moves it by up to 5 % of its length for E = 50 kPa and
  /// nu = 0.3.  The sum grows with the number of nodes.
  Eigen::Vector3d force = {0.0, 0.0, -0.02};
};

/// The organ, meshed by the Gmsh library at a uniform size, with nodes inside
/// and with surface nodes on a smooth surface.  All components are held at zero
/// over about 12 % of the surface at the back and the top, where a liver is
/// tied to the diaphragm; there is one load case and no measurement.
///
/// The smallest dihedral angle was above 15 degrees for 128 numbers of
/// tetrahedra from 200 to 100 000, 14.7 degrees for 500 000 and 11.9 degrees
/// for 2 000 000.  Takes about 0.5 s for 2000 tetrahedra, 3 s for 50 000, 45 s
/// for 500 000, 200 s for 2 000 000; up to some times that where a mesh has to
/// be made again for its number or its angles.  One thread; the same scene on
/// every run.
///
/// Throws std::invalid_argument, beginning with the option's name, for an
/// option out of its range, and std::runtime_error, naming the step, when the
/// meshing fails, which the program elastimate-organ does in a process of its
/// own.
[[nodiscard]] Scene OrganScene(const OrganOptions& options);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_EXAMPLES_EXAMPLE_SCENES_H_
