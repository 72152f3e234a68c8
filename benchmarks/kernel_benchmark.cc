// Times of factorisations, of what quadratic elements take, and of estimators,
// on a cube of tetrahedra.  The kernels for linear tetrahedra are timed by
// `elastimate_benchmark kernels`.
//
//   elastimate_kernel_benchmark
//
// runs all but the benchmarks whose names begin with "Large", which take
// minutes and gigabytes; those are run by
//
//   elastimate_kernel_benchmark --benchmark_filter=Large
//
// A cube of 10, 21, 39 and 58 cells along an edge has 5000, 46 305, 296 595 and
// 975 560 tetrahedra, quadratic ones where the name says so.  `per_tetrahedron`
// is the time for each tetrahedron (and each column of an element pass).

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "benchmarks/random_matrix.h"
#include "elastimate/core/equilibrium/equilibrium.h"
#include "elastimate/core/mechanics/stiffness_assembly.h"
#include "elastimate/core/mechanics/stiffness_product.h"
#include "elastimate/core/mechanics/stiffness_traces.h"
#include "elastimate/core/mesh/node_graph.h"
#include "elastimate/core/scene/degrees_of_freedom.h"
#include "elastimate/core/scene/finer_scene.h"
#include "elastimate/core/scene/quadratic_scene.h"
#include "elastimate/core/solvers/cholesky.h"
#include "elastimate/estimators/material_fit/reduced_fe.h"
#include "elastimate/estimators/registry.h"
#include "elastimate/io/examples/example_scenes.h"

namespace elastimate {
namespace {

// Fits of displacements are timed on measurements with this noise.
constexpr double kNoise = 0.01;
constexpr std::uint64_t kSeed = 1;

// Returns a cube with this number of cells along each edge.  It is made only
// once.
const Scene& Cube(std::int64_t cells) {
  static std::map<std::int64_t, Scene> scenes;
  const auto known = scenes.find(cells);
  if (known != scenes.end()) {
    return known->second;
  }
  CuboidOptions options;
  options.cells.setConstant(static_cast<int>(cells));
  options.size.setOnes();
  return scenes.emplace(cells, CuboidScene(options)).first->second;
}

// Returns the cube with quadratic elements.  It is made only once.
const Scene& QuadraticCube(std::int64_t cells) {
  static std::map<std::int64_t, Scene> scenes;
  const auto known = scenes.find(cells);
  return known != scenes.end()
             ? known->second
             : scenes.emplace(cells, QuadraticScene(Cube(cells))).first->second;
}

using SceneOfCells = const Scene& (*)(std::int64_t);

void CountTetrahedra(benchmark::State& state, const Mesh& mesh,
                     std::int64_t columns = 1) {
  state.counters["tetrahedra"] = static_cast<double>(mesh.NumElements());
  state.counters["per_tetrahedron"] =
      benchmark::Counter(static_cast<double>(mesh.NumElements() * columns),
                         benchmark::Counter::kIsIterationInvariantRate |
                             benchmark::Counter::kInvert);
}

// ---------------------------------------------------------------------------
// Element passes.

void QuadraticElementPass(benchmark::State& state) {
  const Mesh& mesh = QuadraticCube(state.range(0)).mesh;
  const Eigen::MatrixXd q =
      RandomMatrix(3 * mesh.NumNodes(), state.range(1), kSeed);
  while (state.KeepRunning()) {
    benchmark::DoNotOptimize(MultiplyStiffnessBasis(mesh, q));
  }
  CountTetrahedra(state, mesh, state.range(1));
}

void TracesExact(benchmark::State& state) {
  const Scene& scene = Cube(state.range(0));
  const DegreesOfFreedom dofs(scene.supports);
  const InternalForces forces(scene.mesh, {});
  while (state.KeepRunning()) {
    benchmark::DoNotOptimize(StiffnessTraces(scene.mesh, forces, dofs));
  }
  CountTetrahedra(state, scene.mesh);
}

void TracesEstimated(benchmark::State& state) {
  const Scene& scene = Cube(state.range(0));
  const ComponentMask& held = scene.supports.held;
  const DegreesOfFreedom dofs(scene.supports);
  const InternalForces forces(scene.mesh, {});
  Eigen::MatrixXd probes(held.size(), 2);
  while (state.KeepRunning()) {
    SetTraceProbes(held, probes);
    benchmark::DoNotOptimize(
        EstimateStiffnessTraces(dofs, forces.Products(probes)));
  }
  CountTetrahedra(state, scene.mesh);
}

// ---------------------------------------------------------------------------
// Assembly.

void GraphOfNodes(benchmark::State& state) {
  const Mesh& mesh = Cube(state.range(0)).mesh;
  while (state.KeepRunning()) {
    const NodeGraph graph(mesh);
    benchmark::DoNotOptimize(graph.row.data());
  }
  CountTetrahedra(state, mesh);
}

// Times the graph, the pattern and the values together.
template <SceneOfCells kScene>
void Assembly(benchmark::State& state) {
  const Scene& scene = kScene(state.range(0));
  const DegreesOfFreedom dofs(scene.supports);
  while (state.KeepRunning()) {
    const StiffnessAssembly assembly(scene.mesh, dofs);
    benchmark::DoNotOptimize(assembly.H().data());
  }
  CountTetrahedra(state, scene.mesh);
}

// ---------------------------------------------------------------------------
// Factorisation.

template <SceneOfCells kScene>
void CholeskyAnalysis(benchmark::State& state) {
  const Scene& scene = kScene(state.range(0));
  const DegreesOfFreedom dofs(scene.supports);
  const StiffnessAssembly assembly(scene.mesh, dofs);
  while (state.KeepRunning()) {
    const Cholesky cholesky(assembly, dofs);
    benchmark::DoNotOptimize(cholesky.FactorValues());
  }
  CountTetrahedra(state, scene.mesh);
}

template <SceneOfCells kScene>
void CholeskyFactorization(benchmark::State& state) {
  const Scene& scene = kScene(state.range(0));
  const DegreesOfFreedom dofs(scene.supports);
  const StiffnessAssembly assembly(scene.mesh, dofs);
  Cholesky cholesky(assembly, dofs);
  const Eigen::VectorXd values = assembly.Combine(0.3);
  while (state.KeepRunning()) {
    if (!cholesky.Factorize(values)) {
      state.SkipWithError("the stiffness is not positive definite");
      break;
    }
  }
  CountTetrahedra(state, scene.mesh);
  state.counters["gigabytes"] = 8e-9 * cholesky.FactorValues();
}

template <SceneOfCells kScene>
void CholeskySolve(benchmark::State& state) {
  const Scene& scene = kScene(state.range(0));
  const DegreesOfFreedom dofs(scene.supports);
  const StiffnessAssembly assembly(scene.mesh, dofs);
  Cholesky cholesky(assembly, dofs);
  if (!cholesky.Factorize(assembly.Combine(0.3))) {
    state.SkipWithError("the stiffness is not positive definite");
    return;
  }
  const Eigen::MatrixXd b = RandomMatrix(dofs.NumFree(), state.range(1), kSeed);
  while (state.KeepRunning()) {
    benchmark::DoNotOptimize(cholesky.Solve(b, 0, {}));
  }
  CountTetrahedra(state, scene.mesh);
}

// Solves for displacements of quadratic elements of a cube without their
// factor, at nu = range(1) / 100.  With `kFiner` = 2 the elements have half the
// size.
template <int kFiner>
void RefinedSolve(benchmark::State& state) {
  std::vector<Scene> scenes = {Cube(state.range(0))};
  for (int i = 0; i < kFiner; ++i) {
    scenes.push_back(FinerScene(scenes.back()));
  }
  std::vector<const Scene*> spaces;
  for (const Scene& scene : scenes) {
    spaces.push_back(&scene);
  }
  Work work;
  while (state.KeepRunning()) {
    state.PauseTiming();
    // A new equilibrium starts without a solution, so that every run does the
    // same work.
    Equilibrium equilibrium(spaces, SolverKind::kCholesky);
    const Eigen::VectorXd moduli = equilibrium.Forces().Parameters().Moduli(
        Eigen::Vector2d(1, 0.01 * static_cast<double>(state.range(1))));
    state.ResumeTiming();
    if (!equilibrium.Solve(moduli)) {
      state.SkipWithError("the iterations did not converge");
      break;
    }
    work = equilibrium.WorkDone();
  }
  CountTetrahedra(state, scenes.back().mesh);
  state.counters["iterations"] = work.iterations;
  state.counters["passes"] = work.element_passes;
}

// ---------------------------------------------------------------------------
// Estimators, end to end, on displacements of E = 10 kPa, nu = 0.3.

// Returns a cube with independent noise of this norm, relative to the norm of
// the displacement.
Scene MeasuredCube(std::int64_t cells, double noise) {
  Scene scene = Cube(cells);
  const Eigen::VectorXd displacement =
      DisplacementsAt(scene, Eigen::Vector2d(1e8, 0.3));
  const DegreesOfFreedom dofs(scene.supports);
  const Eigen::VectorXd random =
      dofs.Extend(RandomMatrix(dofs.NumFree(), 1, kSeed));
  scene.load_cases[0].displacement =
      (displacement + noise * displacement.norm() / random.norm() * random)
          .reshaped(3, scene.mesh.NumNodes());
  return scene;
}

void RunEstimator(benchmark::State& state, const char* name, double noise) {
  const Scene scene = MeasuredCube(state.range(0), noise);
  const auto estimator = MakeEstimator(name);
  Estimate estimate;
  while (state.KeepRunning()) {
    estimate = estimator->Run(scene, {});
  }
  if (!estimate.IsUsable()) {
    state.SkipWithError(estimate.message.c_str());
  }
  CountTetrahedra(state, scene.mesh);
  state.counters["factorizations"] = estimate.work.factorizations;
  state.counters["solves"] = estimate.work.solves;
}

// Times a further measurement of a scene that reduced-fe is prepared for.
void MeasureAgain(benchmark::State& state) {
  const Scene scene = MeasuredCube(state.range(0), kNoise);
  const ReducedFe reduced_fe;
  PreparedEstimator prepared = reduced_fe.Prepare(scene, {});
  const std::vector<Eigen::MatrixXd> displacements = {
      scene.load_cases[0].displacement};
  Estimate estimate = prepared.Run(displacements);
  while (state.KeepRunning()) {
    estimate = prepared.Run(displacements);
  }
  CountTetrahedra(state, scene.mesh);
  state.counters["solves"] = estimate.work.solves;
}

// ---------------------------------------------------------------------------

constexpr std::int64_t kTiny = 10;
constexpr std::int64_t kSmall = 21;
constexpr std::int64_t kMedium = 39;
constexpr std::int64_t kBig = 58;

void RegisterQuadraticBenchmarks() {
  for (const std::int64_t cells : {kTiny, kSmall}) {
    const auto add = [cells](const std::string& name, auto function) {
      return benchmark::RegisterBenchmark(name.c_str(), function)
          ->ArgNames({"cells", "columns"})
          ->Args({cells, 1})
          ->Unit(benchmark::kMillisecond)
          ->UseRealTime();
    };
    add("Quadratic/ElementPass", QuadraticElementPass)->Args({cells, 8});
    add("Quadratic/Assembly", Assembly<QuadraticCube>);
    const std::string prefix = cells == kSmall ? "Large/" : "";
    add(prefix + "Quadratic/CholeskyAnalysis", CholeskyAnalysis<QuadraticCube>);
    add(prefix + "Quadratic/CholeskyFactorization",
        CholeskyFactorization<QuadraticCube>);
    add(prefix + "Quadratic/CholeskySolve", CholeskySolve<QuadraticCube>);
  }
  for (const std::int64_t hundredths : {30, 45, 49}) {
    const auto add = [hundredths](const char* name, auto function) {
      benchmark::RegisterBenchmark(name, function)
          ->ArgNames({"cells", "hundredths_of_nu"})
          ->Args({kTiny, hundredths})
          ->Unit(benchmark::kMillisecond)
          ->UseRealTime();
    };
    add("Quadratic/RefinedSolve", RefinedSolve<1>);
    add("Divided/RefinedSolve", RefinedSolve<2>);
  }
}

void RegisterBenchmarks() {
  for (const std::int64_t cells : {kSmall, kMedium, kBig}) {
    const auto single_threaded = [cells](const char* name, auto function) {
      return benchmark::RegisterBenchmark(name, function)
          ->ArgNames({"cells"})
          ->Args({cells})
          ->Unit(benchmark::kMillisecond)
          ->MinTime(0.2);
    };
    single_threaded("TracesExact", TracesExact);
    single_threaded("TracesEstimated", TracesEstimated);
    single_threaded("NodeGraph", GraphOfNodes);
    single_threaded("Assembly", Assembly<Cube>);
  }
  for (const std::int64_t cells : {kTiny, kSmall, kMedium}) {
    // BLAS has threads of its own, so wall-clock time counts.
    const auto threaded = [cells](const std::string& name, auto function) {
      const std::string prefix = cells == kMedium ? "Large/" : "";
      return benchmark::RegisterBenchmark((prefix + name).c_str(), function)
          ->Unit(benchmark::kMillisecond)
          ->UseRealTime();
    };
    threaded("CholeskyAnalysis", CholeskyAnalysis<Cube>)
        ->ArgNames({"cells"})
        ->Args({cells});
    threaded("CholeskyFactorization", CholeskyFactorization<Cube>)
        ->ArgNames({"cells"})
        ->Args({cells});
    threaded("CholeskySolve", CholeskySolve<Cube>)
        ->ArgNames({"cells", "columns"})
        ->Args({cells, 1})
        ->Args({cells, 4});
    // The closed form is meant for data without noise.
    for (const char* const name :
         {"closed-form", "reduced-fe", "iterative-fe"}) {
      const double noise = std::string(name) == "closed-form" ? 0 : kNoise;
      threaded(std::string("Estimate/") + name,
               [name, noise](benchmark::State& state) {
                 RunEstimator(state, name, noise);
               })
          ->ArgNames({"cells"})
          ->Args({cells});
    }
    threaded("MeasureAgain", MeasureAgain)->ArgNames({"cells"})->Args({cells});
  }
}

int Main(int argc, char** argv) {
  const bool has_filter =
      std::any_of(argv + 1, argv + argc, [](std::string_view argument) {
        return argument.rfind("--benchmark_filter", 0) == 0;
      });
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) {
    return 1;
  }
  RegisterBenchmarks();
  RegisterQuadraticBenchmarks();
  if (has_filter) {
    benchmark::RunSpecifiedBenchmarks();
  } else {
    benchmark::RunSpecifiedBenchmarks("-^Large/");
  }
  benchmark::Shutdown();
  return 0;
}

}  // namespace
}  // namespace elastimate

int main(int argc, char** argv) { return elastimate::Main(argc, argv); }
