#include "benchmarks/kernels.h"

#include <hwy/targets.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <iomanip>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <random>
#include <sstream>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "apps/linear_algebra.h"
#include "benchmarks/machine_limits.h"
#include "benchmarks/measured_body.h"
#include "benchmarks/naive_stiffness_product.h"
#include "benchmarks/random_matrix.h"
#include "elastimate/core/mechanics/internal_forces.h"
#include "elastimate/core/mechanics/large_strain_forces.h"
#include "elastimate/core/mechanics/stiffness_assembly.h"
#include "elastimate/core/mechanics/stiffness_product.h"
#include "elastimate/core/mesh/node_graph.h"
#include "elastimate/core/scene/quadratic_scene.h"
#include "elastimate/estimators/interface/stopwatch.h"
#include "elastimate/estimators/registry.h"
#include "elastimate/io/examples/example_scenes.h"

namespace elastimate {
namespace {

constexpr IsotropicElasticity kElasticity = {10e3, 0.33};
constexpr std::uint64_t kSeed = 1;
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

// Kernels take turns, so that a disturbance of the machine hits all of them.
// The shortest time of each counts.
constexpr int kRounds = 9;

// The element pass must be at least so many times as fast as the textbook pass
// in the same run.  The number is half of what was measured, so that only a
// real loss is reported.
constexpr double kLeastSpeedupOfFours = 15;
constexpr double kLeastSpeedupOfOnes = 8;

std::int64_t Tetrahedra(int cells) {
  return std::int64_t{5} * cells * cells * cells;
}

double SecondsOf(const std::function<void()>& work) {
  Stopwatch stopwatch;
  work();
  return stopwatch.Lap();
}

void UseInstructions(std::int64_t targets) {
  hwy::SetSupportedTargetsForTest(targets);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

// Returns the instructions that every processor of this architecture has.
std::int64_t BaselineInstructions() {
  auto targets = static_cast<std::uint64_t>(hwy::SupportedTargets());
  while ((targets & (targets - 1)) != 0) {
    targets &= targets - 1;
  }
  return static_cast<std::int64_t>(targets);
}

constexpr std::int64_t kAvx512 = HWY_AVX3 | HWY_AVX3_DL;

bool HasVectorsOfFour() {
  return (hwy::SupportedTargets() & (HWY_AVX2 | kAvx512)) != 0;
}

std::vector<int> RandomOrder(Eigen::Index size) {
  std::vector<int> order(size);
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937_64(kSeed));
  return order;
}

Mesh RandomlyNumbered(const Mesh& mesh) {
  const std::vector<int> nodes = RandomOrder(mesh.NumNodes());
  const std::vector<int> elements = RandomOrder(mesh.NumElements());
  Mesh random = mesh;
  for (Eigen::Index i = 0; i < mesh.NumNodes(); ++i) {
    random.nodes.col(nodes[i]) = mesh.nodes.col(i);
  }
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    for (int i = 0; i < 4; ++i) {
      random.elements(i, e) = nodes[mesh.elements(i, elements[e])];
    }
  }
  return random;
}

// Holds the work of a kernel for each tetrahedron and column: the bytes that it
// has to read or write at least once, and its floating-point operations.
struct Work {
  double bytes;
  double flops;
};

// A pass reads 16 bytes of node indices for each tetrahedron.  For each node it
// reads its position, and moves q, a and b of each column.
Work WorkOfPass(const Mesh& mesh, int columns) {
  constexpr double kGeometry = 42;
  constexpr double kColumn = 155;
  const double nodes = static_cast<double>(mesh.NumNodes()) /
                       static_cast<double>(mesh.NumElements());
  return {16.0 / columns + nodes * (24.0 / columns + 72),
          kGeometry / columns + kColumn};
}

struct Kernel {
  std::string name;
  std::string numbering;
  int threads;
  int columns;
  Work work;
  std::function<void()> run;
  double set_up_seconds = kUnknown;
  std::function<void()> before = [] {};
  std::function<void()> after = [] {};
  double seconds = std::numeric_limits<double>::infinity();
};

void TimeInTurns(std::vector<Kernel>& kernels, Progress& progress,
                 const std::string& size) {
  for (int round = 0; round < kRounds; ++round) {
    for (Kernel& kernel : kernels) {
      progress.Show("kernels: " + size + " tetrahedra, " + kernel.name);
      kernel.before();
      kernel.seconds = std::min(kernel.seconds, SecondsOf(kernel.run));
      kernel.after();
    }
  }
}

void RequireUsable(const Estimate& estimate) {
  if (!estimate.IsUsable()) {
    throw std::logic_error(estimate.message);
  }
}

// Owns everything that the kernels of one size work on.
class Cube {
 public:
  explicit Cube(int cells)
      : scene_(MeasuredCube(cells, kElasticity)),
        random_(RandomlyNumbered(scene_.mesh)),
        one_(RandomMatrix(3 * scene_.mesh.NumNodes(), 1, kSeed)),
        eight_(RandomMatrix(3 * scene_.mesh.NumNodes(), 8, kSeed)),
        assembly_(scene_.mesh, DegreesOfFreedom(scene_.supports)),
        closed_form_(MakeEstimator("closed-form")) {
    CheckPasses();
  }

  std::vector<Kernel> Kernels() {
    std::vector<Kernel> kernels;
    const Mesh& mesh = scene_.mesh;
    kernels.push_back({"naive", "natural", 1, 1, WorkOfPass(mesh, 1),
                       [&] { products_ = MultiplyNaively(mesh, one_); }});
    AddOperatorsWith(BaselineInstructions(), "scalar", kernels);
    if ((hwy::SupportedTargets() & kAvx512) != 0) {
      AddOperatorsWith(hwy::SupportedTargets() & ~kAvx512, "AVX2", kernels);
    }
    for (const int threads : {1, 2}) {
      for (const int columns : {1, 8}) {
        AddOperator("vector", "natural", mesh, threads, columns, kernels);
      }
    }
    for (const int columns : {1, 8}) {
      kernels.push_back({"vector", "random", 1, columns,
                         WorkOfPass(mesh, columns), [this, columns] {
                           products_ = MultiplyStiffnessBasis(random_,
                                                              Columns(columns));
                         }});
    }
    for (const int threads : {1, 2}) {
      for (const int columns : {1, 8}) {
        AddOperator("vector", "reordered", random_, threads, columns, kernels);
      }
    }
    AddCombination(kernels);
    kernels.push_back(
        {"closed-form", "natural", 1, 1, {kUnknown, kUnknown}, [&] {
           RequireUsable(closed_form_->Run(scene_, {}));
         }});
    AddFurtherMeasurements(kernels);
    return kernels;
  }

 private:
  // Times a further measurement by an estimator that is prepared for the scene.
  void AddFurtherMeasurements(std::vector<Kernel>& kernels) {
    // Preparing reduced-fe for larger meshes takes too long.
    constexpr Eigen::Index kMostElementsOfReducedFe = 50000;
    for (const std::string name :
         {"closed-form", "virtual-fields", "reduced-fe"}) {
      if (name == "reduced-fe" &&
          scene_.mesh.NumElements() > kMostElementsOfReducedFe) {
        continue;
      }
      estimators_.push_back(MakeEstimator(name));
      const auto prepared = std::make_shared<PreparedEstimator>(
          estimators_.back()->Prepare(scene_, {}));
      kernels.push_back(
          {"further " + name,
           "natural",
           1,
           1,
           {kUnknown, kUnknown},
           [this, prepared] {
             RequireUsable(prepared->Run({scene_.load_cases[0].displacement}));
           }});
    }
  }

  const Eigen::MatrixXd& Columns(int columns) const {
    return columns == 1 ? one_ : eight_;
  }

  void AddOperator(const std::string& name, const std::string& numbering,
                   const Mesh& mesh, int threads, int columns,
                   std::vector<Kernel>& kernels) {
    std::shared_ptr<StiffnessOperator> stiffness;
    const double set_up = SecondsOf([&] {
      stiffness = std::make_shared<StiffnessOperator>(mesh, threads);
    });
    kernels.push_back({name, numbering, threads, columns,
                       WorkOfPass(mesh, columns),
                       [this, stiffness, columns] {
                         StiffnessProducts& products =
                             columns == 1 ? one_products_ : eight_products_;
                         stiffness->Multiply(Columns(columns), products);
                       },
                       stiffness->IsReordered() ? set_up : kUnknown});
  }

  void AddOperatorsWith(std::int64_t targets, const std::string& name,
                        std::vector<Kernel>& kernels) {
    for (const int columns : {1, 8}) {
      AddOperator(name, "natural", scene_.mesh, 1, columns, kernels);
      kernels.back().before = [targets] { UseInstructions(targets); };
      kernels.back().after = [] { UseInstructions(0); };
    }
  }

  void AddCombination(std::vector<Kernel>& kernels) {
    const double values = static_cast<double>(assembly_.H().size()) /
                          static_cast<double>(scene_.mesh.NumElements());
    kernels.push_back(
        {"K from H and J", "natural", 1, 1, {24 * values, 2 * values}, [this] {
           assembly_.Combine(0.3, stiffness_);
         }});
  }

  void CheckPasses() {
    const StiffnessProducts naive = MultiplyNaively(scene_.mesh, one_);
    const StiffnessProducts fast = MultiplyStiffnessBasis(scene_.mesh, one_);
    if (!naive.h.isApprox(fast.h, 1e-12) || !naive.j.isApprox(fast.j, 1e-12)) {
      throw std::logic_error("the naive and the fast element pass differ");
    }
  }

  Scene scene_;
  Mesh random_;
  Eigen::MatrixXd one_;
  Eigen::MatrixXd eight_;
  StiffnessAssembly assembly_;
  Eigen::VectorXd stiffness_;
  std::shared_ptr<const Estimator> closed_form_;
  std::vector<std::shared_ptr<const Estimator>> estimators_;
  StiffnessProducts products_;
  StiffnessProducts one_products_;
  StiffnessProducts eight_products_;
};

// Holds the times of the kernels of one size for each tetrahedron and column
// [s], by name, numbering, threads and columns.
class Times {
 public:
  explicit Times(const std::vector<Kernel>& kernels) {
    for (const Kernel& kernel : kernels) {
      times_[{kernel.name, kernel.numbering, kernel.threads, kernel.columns}] =
          kernel.seconds / kernel.columns;
    }
  }

  bool Have(const std::string& name) const {
    return times_.count({name, "natural", 1, 1}) > 0;
  }

  double Of(const std::string& name, const std::string& numbering = "natural",
            int threads = 1, int columns = 1) const {
    return times_.at({name, numbering, threads, columns});
  }

 private:
  std::map<std::tuple<std::string, std::string, int, int>, double> times_;
};

std::vector<std::string> Ratios(std::int64_t tetrahedra, const Times& times) {
  const double pass = times.Of("vector");
  std::vector<std::pair<std::string, double>> ratios = {
      {"naive / vector", times.Of("naive") / pass},
      {"scalar / vector", times.Of("scalar") / pass},
      {"each of 8 columns / one", times.Of("vector", "natural", 1, 8) / pass},
      {"reordered / natural", times.Of("vector", "reordered") / pass},
      {"reordered / natural, 8 columns",
       times.Of("vector", "reordered", 1, 8) /
           times.Of("vector", "natural", 1, 8)},
      {"one thread / two", pass / times.Of("vector", "natural", 2)},
      {"closed-form / pass", times.Of("closed-form") / pass},
  };
  for (const std::string name :
       {"closed-form", "virtual-fields", "reduced-fe"}) {
    if (times.Have("further " + name)) {
      ratios.emplace_back(name + ", further measurement / pass",
                          times.Of("further " + name) / pass);
    }
  }
  if (times.Have("AVX2")) {
    const double with_avx2 = times.Of("AVX2");
    ratios.insert(ratios.end(),
                  {{"naive / AVX2", times.Of("naive") / with_avx2},
                   {"scalar / AVX2", times.Of("scalar") / with_avx2},
                   {"AVX2, each of 8 columns / one",
                    times.Of("AVX2", "natural", 1, 8) / with_avx2}});
  }
  std::vector<std::string> lines;
  for (const auto& [name, ratio] : ratios) {
    std::ostringstream line;
    line << tetrahedra << " tetrahedra, " << name << ": " << std::fixed
         << std::setprecision(2) << ratio;
    lines.push_back(line.str());
  }
  return lines;
}

// Returns a mesh of each element kind that has no vector kernel.
std::vector<Mesh> MeshesOfOtherKinds(bool is_quick) {
  const int n = is_quick ? 10 : 30;
  CuboidOptions cuboid;
  cuboid.cells = {n, n, n};
  const Scene tetrahedra = CuboidScene(cuboid);
  cuboid.kind = ElementKind::kHex8;
  RectangleOptions rectangle;
  rectangle.cells = {10 * n, 10 * n};
  const Scene quadrilaterals = RectangleScene(rectangle);
  rectangle.kind = ElementKind::kTri3;
  const Scene triangles = RectangleScene(rectangle);
  return {QuadraticScene(tetrahedra).mesh, CuboidScene(cuboid).mesh,
          triangles.mesh, QuadraticScene(triangles).mesh, quadrilaterals.mesh};
}

// The pass of other kinds must be at least so many times as fast as the
// textbook pass.  The number is half of what was measured for the slowest kind.
constexpr double kLeastSpeedupOfOtherKinds = 2;

// Adds the time of the pass of other kinds, and that of the textbook pass.
void CompareOtherKinds(bool is_quick, Progress& progress, KernelTimes& times) {
  for (const Mesh& mesh : MeshesOfOtherKinds(is_quick)) {
    const std::string kind(mesh.Topology().name);
    progress.Show("kernels: " + kind);
    const Eigen::MatrixXd q = RandomMatrix(mesh.NumDofs(), 1, kSeed);
    const StiffnessOperator stiffness(mesh);
    StiffnessProducts fast;
    StiffnessProducts naive;
    double seconds = std::numeric_limits<double>::infinity();
    double naive_seconds = seconds;
    for (int round = 0; round < kRounds; ++round) {
      seconds =
          std::min(seconds, SecondsOf([&] { stiffness.Multiply(q, fast); }));
      naive_seconds = std::min(
          naive_seconds, SecondsOf([&] { naive = MultiplyNaively(mesh, q); }));
    }
    if (!naive.h.isApprox(fast.h, 1e-12) || !naive.j.isApprox(fast.j, 1e-12)) {
      throw std::logic_error("the naive and the fast pass of " + kind +
                             " differ");
    }
    const double speedup = naive_seconds / seconds;
    std::ostringstream line;
    line << mesh.NumElements() << " " << kind << std::fixed
         << std::setprecision(1) << ", pass: "
         << 1e9 * seconds / static_cast<double>(mesh.NumElements())
         << " ns an element, naive / pass: " << speedup;
    times.ratios.push_back(line.str());
    if (speedup < kLeastSpeedupOfOtherKinds) {
      times.regressions.push_back("the pass of " + kind +
                                  " is less than twice as fast as the "
                                  "textbook's");
    }
  }
}

// Returns the shortest times [s] of works that take turns.
std::vector<double> ShortestOfEach(
    const std::vector<std::function<void()>>& works) {
  std::vector<double> seconds(works.size(),
                              std::numeric_limits<double>::infinity());
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t i = 0; i < works.size(); ++i) {
      seconds[i] = std::min(seconds[i], SecondsOf(works[i]));
    }
  }
  return seconds;
}

// Returns a smooth displacement that turns no element inside out.
Eigen::VectorXd SmoothDisplacement(const Mesh& mesh) {
  const Eigen::VectorXd size =
      mesh.nodes.rowwise().maxCoeff() - mesh.nodes.rowwise().minCoeff();
  Eigen::MatrixXd u(mesh.Dimension(), mesh.NumNodes());
  for (Eigen::Index node = 0; node < mesh.NumNodes(); ++node) {
    const Eigen::VectorXd place = mesh.nodes.col(node).cwiseQuotient(size);
    for (Eigen::Index i = 0; i < u.rows(); ++i) {
      u(i, node) = 0.1 * size(i) * place(i) * place((i + 1) % u.rows());
    }
  }
  return u.reshaped();
}

// Returns the meshes of all kinds; planar ones in plane strain and in plane
// stress.
std::vector<Mesh> MeshesOfSections(bool is_quick) {
  CuboidOptions tetrahedra;
  tetrahedra.cells.setConstant(is_quick ? 10 : 30);
  std::vector<Mesh> meshes = {CuboidScene(tetrahedra).mesh};
  for (Mesh& mesh : MeshesOfOtherKinds(is_quick)) {
    if (mesh.Dimension() == 2) {
      mesh.section.model = SectionModel::kPlaneStrain;
      meshes.push_back(mesh);
      mesh.section.model = SectionModel::kPlaneStress;
    }
    meshes.push_back(std::move(mesh));
  }
  return meshes;
}

// Adds the times of forces and tangents at large strains, and those of small
// strains in the same run.
Table CompareLargeStrains(bool is_quick, Progress& progress,
                          KernelTimes& times) {
  Table table("kernels_large_strains",
              {"kind", "elements [1]", "small_forces_per_element [ns]",
               "large_forces_per_element [ns]", "ratio_of_forces [1]",
               "small_tangent_per_element [ns]",
               "large_tangent_per_element [ns]", "ratio_of_tangents [1]"});
  for (const Mesh& mesh : MeshesOfSections(is_quick)) {
    std::string kind(mesh.Topology().name);
    if (mesh.Dimension() == 2) {
      kind += mesh.section.model == SectionModel::kPlaneStrain
                  ? " in plane strain"
                  : " in plane stress";
    }
    progress.Show("kernels: large strains of " + kind);
    Material material;
    material.law = "neo_hookean";
    const InternalForces small(mesh, {});
    const LargeStrainForces large(mesh, {material});
    const NodeGraph graph(mesh);
    const Eigen::VectorXd u = SmoothDisplacement(mesh);
    const Eigen::Vector2d parameters(kElasticity.youngs_modulus,
                                     kElasticity.poisson_ratio);
    const Eigen::VectorXd of_small = small.Parameters().Moduli(parameters);
    const Eigen::VectorXd of_large = large.Parameters().Moduli(parameters);
    Eigen::MatrixXd result;
    std::vector<double> ns = ShortestOfEach(
        {[&] { result = small.Columns(u); },
         [&] { result = large.Columns(of_large, u); },
         [&] { result = small.Blocks(of_small, graph); },
         [&] { result = large.TangentBlocks(of_large, u, graph); }});
    for (double& time : ns) {
      time *= 1e9 / static_cast<double>(mesh.NumElements());
    }
    const double of_forces = ns[1] / ns[0];
    const double of_tangents = ns[3] / ns[2];
    table.AddRow({kind, std::int64_t{mesh.NumElements()}, ns[0], ns[1],
                  of_forces, ns[2], ns[3], of_tangents});
    std::ostringstream line;
    line << mesh.NumElements() << " " << kind << std::fixed
         << std::setprecision(1) << ", large / small strains: forces " << ns[1]
         << " / " << ns[0] << " ns = " << of_forces << ", tangent " << ns[3]
         << " / " << ns[2] << " ns = " << of_tangents;
    times.ratios.push_back(line.str());
  }
  return table;
}

std::string WhyRegressed(const Times& times) {
  const double least =
      HasVectorsOfFour() ? kLeastSpeedupOfFours : kLeastSpeedupOfOnes;
  const double speedup = times.Of("naive") / times.Of("vector");
  if (speedup >= least) {
    return "";
  }
  std::ostringstream text;
  text << "the element pass is " << speedup
       << " times as fast as the textbook's, less than the recorded " << least;
  return text.str();
}

void AddRow(const Kernel& kernel, std::int64_t tetrahedra,
            const MachineLimits& machine, Table& table) {
  const double count = static_cast<double>(tetrahedra);
  const double time = kernel.seconds / count / kernel.columns;
  table.AddRow({kernel.name, tetrahedra, kernel.numbering,
                std::int64_t{kernel.threads}, std::int64_t{kernel.columns},
                1e9 * time, 1e9 * kernel.set_up_seconds / count,
                kernel.work.bytes / time / machine.memory_bandwidth,
                kernel.work.flops / time / machine.peak_flops});
}

nlohmann::ordered_json Describe(const std::map<int, MachineLimits>& limits) {
  nlohmann::ordered_json machine;
  for (const auto& [threads, limit] : limits) {
    machine[std::to_string(threads) + " threads"] = {
        {"memory_bandwidth [GB/s]", 1e-9 * limit.memory_bandwidth},
        {"peak [Gflop/s]", 1e-9 * limit.peak_flops}};
  }
  return machine;
}

}  // namespace

KernelTimes TimeKernels(bool is_quick, Progress& progress) {
  SetThreads(1);
  progress.Show("kernels: memory bandwidth and peak flops");
  std::map<int, MachineLimits> limits;
  for (const int threads : {1, 2}) {
    limits[threads] = MeasureMachineLimits(threads);
  }
  Table table(
      "kernels",
      {"kernel", "tetrahedra [1]", "numbering", "threads [1]", "columns [1]",
       "time_per_tetrahedron_and_column [ns]", "set_up_per_tetrahedron [ns]",
       "memory_bandwidth_fraction [1]", "peak_flops_fraction [1]"});
  KernelTimes times;
  const std::vector<int> sizes =
      is_quick ? std::vector<int>{13, 27} : std::vector<int>{13, 27, 58};
  for (const int cells : sizes) {
    const std::int64_t tetrahedra = Tetrahedra(cells);
    progress.Show("kernels: " + std::to_string(tetrahedra) + " tetrahedra");
    Cube cube(cells);
    std::vector<Kernel> kernels = cube.Kernels();
    TimeInTurns(kernels, progress, std::to_string(tetrahedra));
    for (const Kernel& kernel : kernels) {
      AddRow(kernel, tetrahedra, limits.at(kernel.threads), table);
    }
    const Times of_size(kernels);
    for (const std::string& line : Ratios(tetrahedra, of_size)) {
      times.ratios.push_back(line);
    }
    if (cells == sizes.back()) {
      const std::string why = WhyRegressed(of_size);
      if (!why.empty()) {
        times.regressions.push_back(why);
      }
    }
  }
  CompareOtherKinds(is_quick, progress, times);
  const Table large_strains = CompareLargeStrains(is_quick, progress, times);
  times.result = {
      {table, large_strains},
      {{"cube", "of five tetrahedra in each of n x n x n cells"},
       {"instructions",
        hwy::TargetName(hwy::SupportedTargets() & -hwy::SupportedTargets())},
       {"machine", Describe(limits)},
       {"times", "shortest of " + std::to_string(kRounds) + " rounds, clock"},
       {"bytes",
        "read or written at least once: 16 for the nodes of an element, 24 for "
        "the position of a node, 72 for q, a and b of each column"},
       {"flops", "42 for each tetrahedron, 155 for each of its columns"},
       {"large_strains",
        "forces of both unit moduli and the assembled tangent of neo_hookean, "
        "hexahedra, and quadrilaterals in plane strain, with mean dilatation; "
        "over those of the isotropic law of small strains"},
       {"seed", kSeed},
       {"blas_threads", 1},
       {"ratios", times.ratios}}};
  return times;
}

}  // namespace elastimate
