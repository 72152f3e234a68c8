#include "benchmarks/solver_study.h"

#include <cholmod.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "apps/linear_algebra.h"
#include "benchmarks/child_process.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/core/scene/quadratic_scene.h"
#include "elastimate/core/solvers/cholesky.h"
#include "elastimate/core/solvers/multigrid.h"
#include "elastimate/core/solvers/stiffness_solver.h"
#include "elastimate/estimators/interface/stopwatch.h"
#include "elastimate/io/examples/example_scenes.h"

namespace elastimate {
namespace {

constexpr double kPoissonRatio = 0.3;
// A reduced model solves to the rough tolerance, a simulation to kTolerance.
constexpr double kRoughTolerance = 1e-3;
constexpr double kTolerance = StiffnessSolver::kAccurate;
constexpr ProcessLimits kLimits = {1200, std::int64_t{16} << 30};
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr double kMebibyte = 1024.0 * 1024.0;

// Short runs are repeated, and the shortest time counts.
constexpr double kRepeatSeconds = 0.2;

struct Body {
  std::string name;
  Eigen::Vector3i cells;  ///< Those of a cuboid.
  Eigen::Vector3d size;
  int order;
  int organ = 0;  ///< Tetrahedra of an organ, or 0 for a cuboid.
};

Body Organ(int tetrahedra) { return {"organ", {}, {}, 1, tetrahedra}; }

std::vector<Body> Bodies(bool is_quick) {
  const auto cube = [](int cells, int order) {
    return Body{"cube", Eigen::Vector3i::Constant(cells),
                Eigen::Vector3d::Ones(), order};
  };
  if (is_quick) {
    return {cube(6, 1), cube(4, 2), Organ(1000)};
  }
  return {cube(13, 1),
          cube(19, 1),
          cube(27, 1),
          cube(33, 1),
          cube(40, 1),
          {"plate", {120, 120, 4}, {1, 1, 0.04}, 1},
          {"bar", {200, 12, 12}, {10, 1, 1}, 1},
          cube(13, 2),
          cube(19, 2),
          {"plate", {80, 80, 1}, {1, 1, 0.02}, 2},
          Organ(200000)};
}

Scene MakeScene(const Body& body) {
  if (body.organ > 0) {
    OrganOptions options;
    options.tetrahedra = body.organ;
    return OrganScene(options);
  }
  CuboidOptions options;
  options.cells = body.cells;
  options.size = body.size;
  Scene scene = CuboidScene(options);
  return body.order == 2 ? QuadraticScene(scene) : scene;
}

// Holds what is measured of one solver on one body.  Some of it does not apply
// to every solver.
struct Measurement {
  double free_dofs = kUnknown;
  double flops = kUnknown;
  double analysis = kUnknown;
  double factorization = kUnknown;
  double rough_solve = kUnknown;
  double rough_iterations = kUnknown;
  double solve = kUnknown;
  double iterations = kUnknown;
};

// Uses CHOLMOD as its manual shows, with METIS.  That is the best that CHOLMOD
// does without knowing which unknowns belong to one node.
class BareCholmod {
 public:
  BareCholmod(const SymmetricPattern& pattern, Eigen::VectorXd& values) {
    cholmod_l_start(&common_);
    common_.supernodal = CHOLMOD_SUPERNODAL;
    common_.nmethods = 1;
    common_.method[0].ordering = CHOLMOD_METIS;
    matrix_.nrow = matrix_.ncol = pattern.Size();
    matrix_.nzmax = pattern.row.size();
    matrix_.p = const_cast<std::int64_t*>(pattern.column_start.data());
    matrix_.i = const_cast<std::int64_t*>(pattern.row.data());
    matrix_.x = values.data();
    matrix_.stype = -1;
    matrix_.itype = CHOLMOD_LONG;
    matrix_.xtype = CHOLMOD_REAL;
    matrix_.dtype = CHOLMOD_DOUBLE;
    matrix_.sorted = 1;
    matrix_.packed = 1;
  }
  ~BareCholmod() {
    cholmod_l_free_factor(&factor_, &common_);
    cholmod_l_finish(&common_);
  }
  BareCholmod(const BareCholmod&) = delete;
  BareCholmod& operator=(const BareCholmod&) = delete;

  void Analyze() { factor_ = cholmod_l_analyze(&matrix_, &common_); }
  void Factorize() {
    if (cholmod_l_factorize(&matrix_, factor_, &common_) == 0 ||
        common_.status != CHOLMOD_OK) {
      throw std::runtime_error("CHOLMOD could not factorise");
    }
  }
  void Solve(Eigen::MatrixXd& b) {
    cholmod_dense view{};
    view.nrow = view.d = view.nzmax = b.rows();
    view.ncol = 1;
    view.x = b.data();
    view.xtype = CHOLMOD_REAL;
    view.dtype = CHOLMOD_DOUBLE;
    cholmod_dense* x = cholmod_l_solve(CHOLMOD_A, factor_, &view, &common_);
    cholmod_l_free_dense(&x, &common_);
  }
  double Flops() const { return common_.fl; }

 private:
  cholmod_common common_{};
  cholmod_sparse matrix_{};
  cholmod_factor* factor_ = nullptr;
};

template <typename Work>
double ShortestSeconds(const Work& work) {
  double shortest = std::numeric_limits<double>::infinity();
  double total = 0;
  do {
    Stopwatch stopwatch;
    work();
    const double seconds = stopwatch.Lap();
    shortest = std::min(shortest, seconds);
    total += seconds;
  } while (total < kRepeatSeconds);
  return shortest;
}

void Require(bool is_done, const std::string& what) {
  if (!is_done) {
    throw std::runtime_error(what + " failed");
  }
}

Measurement MeasureSolver(const Body& body, const std::string& solver) {
  const Scene scene = MakeScene(body);
  const DegreesOfFreedom dofs(scene.supports);
  const StiffnessAssembly assembly(scene.mesh, dofs);
  Eigen::VectorXd values = assembly.Combine(kPoissonRatio);
  Eigen::MatrixXd force = dofs.Restrict(AssembleLoadCases(scene));
  Measurement measured;
  measured.free_dofs = static_cast<double>(dofs.NumFree());
  Stopwatch stopwatch;
  if (solver == "cholmod") {
    BareCholmod cholmod(assembly.Pattern(), values);
    cholmod.Analyze();
    measured.analysis = stopwatch.Lap();
    measured.flops = cholmod.Flops();
    measured.factorization = ShortestSeconds([&] { cholmod.Factorize(); });
    measured.solve = ShortestSeconds([&] { cholmod.Solve(force); });
    return measured;
  }
  std::unique_ptr<LinearSolver> linear_solver;
  if (solver == "cholesky") {
    auto cholesky = std::make_unique<Cholesky>(assembly, dofs);
    measured.flops = cholesky->FactorizationFlops();
    linear_solver = std::move(cholesky);
  } else {
    linear_solver = MakeMultigrid(scene.mesh, assembly, dofs);
  }
  measured.analysis = stopwatch.Lap();
  measured.factorization = ShortestSeconds(
      [&] { Require(linear_solver->Factorize(values), solver); });
  const auto iterations_of = [&](double tolerance) {
    const int before = linear_solver->NumIterations();
    Require(linear_solver->Solve(force, tolerance, {}).has_value(), solver);
    return linear_solver->NumIterations() - before;
  };
  measured.iterations = iterations_of(kTolerance);
  measured.solve = ShortestSeconds([&] { iterations_of(kTolerance); });
  if (solver == "multigrid") {
    measured.rough_iterations = iterations_of(kRoughTolerance);
    measured.rough_solve =
        ShortestSeconds([&] { iterations_of(kRoughTolerance); });
  }
  return measured;
}

std::string AsText(const Measurement& measured) {
  std::ostringstream text;
  text.precision(17);
  for (const double value :
       {measured.free_dofs, measured.flops, measured.analysis,
        measured.factorization, measured.rough_solve, measured.rough_iterations,
        measured.solve, measured.iterations}) {
    text << value << " ";
  }
  return text.str();
}

}  // namespace

StudyResult RunSolverStudy(bool is_quick, Progress& progress) {
  Table table(
      "solvers",
      {"body", "order [1]", "tetrahedra [1]", "solver", "threads [1]",
       "outcome", "free_degrees_of_freedom [1]", "factorization_flops [1]",
       "analysis_time [s]", "factorization_time [s]", "rough_solve_time [s]",
       "rough_iterations [1]", "solve_time [s]", "iterations [1]",
       "peak_memory [MiB]"});
  const int all_threads = static_cast<int>(std::thread::hardware_concurrency());
  struct Variant {
    std::string solver;
    int threads;
  };
  std::vector<Variant> variants = {
      {"cholmod", all_threads}, {"cholesky", all_threads}, {"cholesky", 1}};
  if (HasMultigrid()) {
    variants.push_back({"multigrid", all_threads});
    variants.push_back({"multigrid", 1});
  }
  for (const Body& body : Bodies(is_quick)) {
    const std::int64_t tetrahedra =
        body.organ > 0 ? body.organ : std::int64_t{5} * body.cells.prod();
    for (const Variant& variant : variants) {
      progress.Show("solvers: " + body.name + " of " +
                    std::to_string(tetrahedra) + " tetrahedra, " +
                    variant.solver);
      const ProcessReport report = RunInChildProcess(kLimits, [&] {
        SetThreads(variant.threads);
        return AsText(MeasureSolver(body, variant.solver));
      });
      std::vector<double> values(8, kUnknown);
      std::istringstream text(report.output);
      std::string word;
      for (std::size_t i = 0; i < values.size() && text >> word; ++i) {
        values[i] = std::stod(word);  // Operator >> does not read "nan".
      }
      const bool is_finished = report.outcome == ProcessOutcome::kFinished;
      table.AddRow(
          {body.name, std::int64_t{body.order}, tetrahedra, variant.solver,
           std::int64_t{variant.threads}, is_finished ? "measured" : "limit"},
          {values[0], values[1], values[2], values[3], values[4], values[5],
           values[6], values[7],
           static_cast<double>(report.peak_memory) / kMebibyte});
    }
  }
  return {{table},
          {{"poisson_ratio", kPoissonRatio},
           {"rough_tolerance", kRoughTolerance},
           {"tolerance", kTolerance},
           {"times", "wall; the shortest of repetitions for 0.2 s"},
           {"peak_memory", "of a process of its own, scene included"},
           {"limit_of_processor_time [s]", kLimits.processor_seconds},
           {"limit_of_memory [MiB]",
            static_cast<double>(kLimits.memory) / kMebibyte}}};
}

}  // namespace elastimate
