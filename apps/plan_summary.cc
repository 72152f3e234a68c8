#include "apps/plan_summary.h"

#include <cmath>

#include "elastimate/core/text/numbers.h"

namespace elastimate {
namespace {

// With more parameters a line is too long to show the error of each.
constexpr std::size_t kMostColumns = 6;
constexpr int kWidthOfName = 22;
constexpr int kWidthOfColumn = 15;

std::string Padded(const std::string& text, int width) {
  const std::size_t size = std::size_t(width);
  return text.size() < size ? text + std::string(size - text.size(), ' ')
                            : text + " ";
}

std::string ErrorText(double error, bool is_relative) {
  return !std::isfinite(error) ? "undetermined"
         : is_relative         ? Percent(error)
                               : NumberText(error, 2);
}

std::string WorstText(const ExpectedErrors& errors,
                      const std::vector<ParameterEstimate>& free) {
  const std::string worst = ErrorText(errors.standard_errors(0), false) + ": " +
                            CombinationInWords(errors.directions.col(0), free);
  const Eigen::Index undetermined = errors.NumUndetermined();
  return undetermined > 1
             ? worst + ", and " + std::to_string(undetermined - 1) + " more"
             : worst;
}

std::string ColumnsOfErrors(const std::vector<double>& errors,
                            const std::vector<ParameterEstimate>& free) {
  std::string columns;
  for (std::size_t i = 0; i < free.size(); ++i) {
    columns +=
        Padded(ErrorText(errors[i], free[i].IsStiffness()), kWidthOfColumn);
  }
  return columns;
}

std::string Row(const std::string& name, const ExpectedErrors& errors,
                const std::vector<ParameterEstimate>& free) {
  std::string row = Padded(name, kWidthOfName);
  if (free.size() <= kMostColumns) {
    const Eigen::VectorXd of_parameters = errors.OfParameters();
    row += ColumnsOfErrors({of_parameters.begin(), of_parameters.end()}, free);
  }
  return row + WorstText(errors, free);
}

// Returns the row with the full errors of the estimate of the load cases that
// were measured; empty where there is none.
std::string RowOfEstimate(const PlanBasis& basis,
                          const std::vector<ParameterEstimate>& free) {
  if (basis.errors_of_estimate.size() != free.size() ||
      free.size() > kMostColumns) {
    return "";
  }
  return Padded("before, all errors", kWidthOfName) +
         ColumnsOfErrors(basis.errors_of_estimate, free) + "of the estimate\n";
}

std::string Heading(const std::vector<ParameterEstimate>& free) {
  std::string heading = Padded("standard error of", kWidthOfName);
  if (free.size() <= kMostColumns) {
    for (const ParameterEstimate& parameter : free) {
      heading += Padded(parameter.Label(), kWidthOfColumn);
    }
  }
  return heading + "worst combination\n";
}

std::string ParametersText(const LoadPlan& plan, const PlanBasis& basis) {
  std::string text;
  if (plan.parameters.size() <= kMostColumns) {
    for (const ParameterEstimate& parameter : plan.parameters) {
      text += parameter.Label() + " " +
              (parameter.IsStiffness() && !basis.is_scale_known
                   ? "of any size"
                   : NumberText(parameter.value, 4)) +
              (parameter.is_known ? " (known), " : ", ");
    }
  } else {
    text = std::to_string(plan.parameters.size()) + " values, ";
  }
  return text + (basis.parameters == "given"      ? "as given"
                 : basis.parameters == "estimate" ? "as estimated"
                                                  : "typical values");
}

std::string LoadCasesText(const PlanBasis& basis) {
  std::string text =
      basis.load_cases.size() == 1 ? "load case " : "load cases ";
  for (std::size_t i = 0; i < basis.load_cases.size(); ++i) {
    text += (i == 0 ? "" : ", ") + std::to_string(basis.load_cases[i]);
  }
  return text + (basis.is_measured ? "" : ", as if it were measured");
}

std::string NoiseText(const PlanBasis& basis) {
  return basis.noise_sd ? "standard deviation " + NumberText(*basis.noise_sd, 3)
                        : PercentOf(basis.relative_noise,
                                    "the rms displacement of each load case");
}

std::string SizeText(std::size_t place, const std::optional<double>& factor,
                     const PlanBasis& basis,
                     const std::vector<CandidateLoad>& candidates) {
  return candidates[place].is_free_in_size && basis.is_scale_known && factor
             ? ", of about " + NumberText(*factor, 2)
             : "";
}

}  // namespace

std::string PlanSummary(const LoadPlan& plan, const PlanBasis& basis,
                        const std::vector<CandidateLoad>& candidates) {
  const std::vector<ParameterEstimate> free = plan.Free();
  std::string text = Padded("before", kWidthOfName) + LoadCasesText(basis) +
                     "\n" + Padded("parameters", kWidthOfName) +
                     ParametersText(plan, basis) + "\n" +
                     Padded("noise", kWidthOfName) + NoiseText(basis) + "\n" +
                     Padded("errors", kWidthOfName) +
                     "those of noise; an estimate also has errors of the mesh, "
                     "the supports and the model\n\n" +
                     Heading(free) + Row("before", plan.before, free) + "\n" +
                     RowOfEstimate(basis, free);
  for (const PlannedLoad& load : plan.loads) {
    text += Row("+ " + candidates[load.candidate].name, load.errors, free) +
            (load.factor ? "\n" : " (moves nothing that is observed)\n");
  }
  text += "\n";
  for (std::size_t i = 0; i < plan.sequence.size(); ++i) {
    const PlannedLoad& load = plan.sequence[i];
    text += Padded(i == 0 ? "measure next" : "then", kWidthOfName) +
            candidates[load.candidate].name +
            SizeText(load.candidate, load.factor, basis, candidates);
    text += i == 0 ? "\n"
                   : ", which leaves an error of " +
                         WorstText(load.errors, free) + "\n";
  }
  const ExpectedErrors& last =
      plan.sequence.empty() ? plan.before : plan.sequence.back().errors;
  if (!plan.AreDetermined(last)) {
    text += Padded("NOT DETERMINED", kWidthOfName) +
            "even all of these loads leave an error of " +
            WorstText(last, free) +
            "; observe more points, or load another surface (--surface)\n";
  }
  return text;
}

std::string MapPlanSummary(const MapPlan& plan, const PlanBasis& basis,
                           const std::vector<CandidateLoad>& candidates) {
  std::string text = Padded("before", kWidthOfName) + LoadCasesText(basis) +
                     "\n" + Padded("noise", kWidthOfName) + NoiseText(basis) +
                     "\n\n" + Padded("load", kWidthOfName) +
                     "parameters of the map that the data support\n" +
                     Padded("before", kWidthOfName) +
                     NumberText(plan.supported_before, 3) + "\n";
  for (const PlannedMapLoad& load : plan.loads) {
    text += Padded("+ " + candidates[load.candidate].name, kWidthOfName) +
            NumberText(load.supported_parameters, 3) +
            (load.factor ? "\n" : " (moves nothing that is observed)\n");
  }
  const PlannedMapLoad& best = plan.loads.front();
  return text + "\n" + Padded("measure next", kWidthOfName) +
         candidates[best.candidate].name +
         SizeText(best.candidate, best.factor, basis, candidates) + "\n";
}

}  // namespace elastimate
