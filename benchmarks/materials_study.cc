#include "benchmarks/materials_study.h"

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "benchmarks/anisotropy_levels.h"
#include "benchmarks/material_cell.h"
#include "benchmarks/material_levels.h"
#include "benchmarks/processor_time.h"
#include "benchmarks/trial.h"
#include "elastimate/estimators/material_fit/merge.h"
#include "elastimate/estimators/registry.h"

namespace elastimate {
namespace {

constexpr int kMaterialTrials = 20;
constexpr int kQuickMaterialTrials = 1;
// Fits of many parameters have fewer trials by this factor, since each takes
// that much longer.
constexpr int kTimesFewerOfMany = 5;
constexpr Eigen::Index kManyParameters = 9;

// A method is an estimator, before which regions may be merged.
struct MaterialMethod {
  std::string name;
  std::string estimator;
  bool merges = false;
};

// Merges regions before the estimate, as `estimate --regions=merge` does.
Estimate RunMerged(const Estimator& estimator, Scene scene) {
  const MaterialMerge merge = MergeMaterials(scene, {});
  scene.materials = merge.materials;
  Estimate estimate = estimator.Run(scene, {});
  EnterMerge(merge, estimate);
  return estimate;
}

void RunMaterialMethod(const MaterialMethod& method,
                       const PreparedLevel& prepared, int num_trials,
                       Table& table) {
  const std::shared_ptr<const Estimator> estimator =
      MakeEstimator(method.estimator);
  MaterialCell cell(prepared);
  for (int seed = 1; seed <= num_trials; ++seed) {
    const Scene scene = prepared.Measured(seed);
    const double start = ProcessorSeconds();
    const Estimate estimate = method.merges ? RunMerged(*estimator, scene)
                                            : estimator->Run(scene, {});
    cell.Add(estimate, ProcessorSeconds() - start);
  }
  cell.AddTo(table, method.name);
}

bool IsOfMany(const MaterialLevel& level) {
  return MaterialParameters(level.materials_of_model,
                            level.specimen.mesh.section.model)
             .NumParameters() >= kManyParameters;
}

std::vector<MaterialMethod> MethodsFor(const MaterialLevel& level) {
  std::vector<MaterialMethod> methods;
  if (!level.is_for_fits_alone) {
    methods.push_back({"virtual-fields", "virtual-fields"});
  }
  for (const std::string name : {"reduced-fe", "iterative-fe"}) {
    methods.push_back({name, name});
  }
  if (!IsOfMany(level)) {
    // With many parameters `auto` is left out to save time; the methods above
    // are its rungs.
    methods.push_back({"auto", "auto"});
  }
  if (level.is_also_merged) {
    methods.push_back({"iterative-fe merged", "iterative-fe", true});
  }
  return methods;
}

int NumTrials(const MaterialLevel& level, int num_trials) {
  if (level.is_for_fits_alone) {
    return 1;
  }
  return IsOfMany(level) ? std::max(1, num_trials / kTimesFewerOfMany)
                         : num_trials;
}

}  // namespace

StudyResult RunMaterialsStudy(bool is_quick, Progress& progress) {
  const int num_trials = is_quick ? kQuickMaterialTrials : kMaterialTrials;
  std::vector<MaterialLevel> levels = MaterialLevels();
  const std::vector<MaterialLevel> of_anisotropy = AnisotropyLevels();
  levels.insert(levels.end(), of_anisotropy.begin(), of_anisotropy.end());
  Table table = MaterialCell::MakeTable();
  for (const MaterialLevel& level : levels) {
    if (is_quick && !level.is_in_quick) {
      continue;
    }
    const PreparedLevel prepared(level);
    for (const MaterialMethod& method : MethodsFor(level)) {
      progress.Show("materials: " + level.factor + ", " + level.level + ", " +
                    level.assumption + ", " + method.name);
      RunMaterialMethod(method, prepared, NumTrials(level, num_trials), table);
    }
  }
  return {
      {table},
      {{"strip",
        "2 x 1 x 1 in plane strain, of 24 x 12 quadrilaterals, held at one "
        "end, pulled by (100, 20) at the other; E = 10 000 and nu = 0.3, or "
        "twice as stiff and nu = 0.2, in pieces in turn; two of them unless "
        "said otherwise"},
       {"bar",
        "1 x 1 x 2, of 3 x 3 x 5 hexahedra, held at z = 0; E_T = 10 000, "
        "E_L three times as large unless said otherwise, nu_LT = nu_TT = "
        "0.3, G_LT = E_T / 2.6, L along (1, 1, 2); three load cases unless "
        "said otherwise: forces on the end of (30, 20, 100), (100, 0, 0) "
        "and (0, 100, 0), then its torsion, and pressures on two sides"},
       {"bar_of_ten_regions",
        "1 x 1 x 3, of cells of five tetrahedra, held at z = 0, pulled by "
        "(30, 20, 100) at the other end; ten pieces of the two materials of "
        "the strip"},
       {"unless_said_otherwise",
        "Gaussian noise of 1 % of the rms displacement at all nodes, of "
        "the same elements"},
       {"unseen_load",
        "a body force of (1, -2), of the bar (-10, 20, 5), of that of ten "
        "regions (1, -2, 1)"},
       {"noise_seeds", "1 to the number of trials"},
       {"dishonest_standard_errors", kWrongStandardErrors},
       {"dishonest_stiffness_error", kWrongYoungsModulus},
       {"dishonest_ratio_error", kWrongPoissonRatio}}};
}

}  // namespace elastimate
