#include "tests/random_points.h"

#include <algorithm>
#include <random>

namespace elastimate::testing {

MeshPoints RandomPoints(const Mesh& mesh, Eigen::Index count,
                        std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  std::uniform_int_distribution<int> element(
      0, static_cast<int>(mesh.NumElements()) - 1);
  const int dimension = mesh.Dimension();
  MeshPoints points = {Eigen::VectorXi(count),
                       Eigen::MatrixXd(dimension, count)};
  for (Eigen::Index point = 0; point < count; ++point) {
    points.elements(point) = element(generator);
    Eigen::VectorXd xi(dimension);
    do {
      std::generate(xi.begin(), xi.end(), [&] { return unit(generator); });
    } while (IsSimplex(mesh.kind) && xi.sum() > 1);
    points.local.col(point) =
        IsSimplex(mesh.kind) ? xi : Eigen::VectorXd(2 * xi.array() - 1);
  }
  return points;
}

void MeasureAtPoints(Eigen::Index count, std::uint64_t seed, Scene& scene) {
  for (LoadCase& load_case : scene.load_cases) {
    load_case.points.points = RandomPoints(scene.mesh, count, seed++);
    load_case.points.displacement = Interpolate(
        scene.mesh, load_case.points.points, load_case.displacement);
    load_case.displacement.resize(0, 0);
    load_case.observed.resize(0, 0);
  }
}

void AddNoiseAtPoints(double standard_deviation, std::uint64_t seed,
                      Scene& scene) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> noise(0, standard_deviation);
  for (LoadCase& load_case : scene.load_cases) {
    for (double& value : load_case.points.displacement.reshaped()) {
      value += noise(generator);
    }
  }
}

}  // namespace elastimate::testing
