#include "apps/validation_summary.h"

#include <algorithm>
#include <cstddef>

#include "elastimate/core/text/numbers.h"

namespace elastimate {
namespace {

// More parameters do not fit a line.
constexpr std::size_t kMostParametersShown = 3;

using Cells = std::vector<std::string>;

// Returns lines of columns that are as wide as they have to be.
std::string Table(const std::vector<Cells>& rows) {
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const Cells& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      widths[i] = std::max(widths[i], row[i].size());
    }
  }
  std::string text;
  for (const Cells& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      line += i == 0 ? "" : "  ";
      line += row[i];
      line.append(widths[i] - row[i].size(), ' ');
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

void AddPrediction(const Prediction& prediction, Cells& row) {
  if (prediction.num_values == 0) {
    row.insert(row.end(), {"-", "-", "-", "not predicted"});
    return;
  }
  row.push_back(std::to_string(prediction.num_values));
  row.push_back(NumberText(prediction.RmsError(), 3));
  row.push_back(Percent(prediction.RelativeError()));
  row.push_back(NumberText(prediction.ErrorRatio(), 3) +
                (prediction.IsOff() ? "  too large" : ""));
}

Cells HeadingOf(const std::string& first) {
  return {first, "values", "rms error", "of displacement",
          "error / stated error"};
}

std::string FoldTable(const Folds& folds, const CrossValidation& validation) {
  std::vector<Cells> rows = {HeadingOf("held out")};
  const std::vector<ParameterEstimate>& parameters =
      validation.folds.front().estimate.parameters;
  const bool shows_parameters = parameters.size() <= kMostParametersShown;
  for (std::size_t i = 0; shows_parameters && i < parameters.size(); ++i) {
    rows[0].insert(rows[0].begin() + 1 + std::ptrdiff_t(i),
                   parameters[i].Label());
  }
  for (std::size_t f = 0; f < validation.folds.size(); ++f) {
    const FoldPrediction& fold = validation.folds[f];
    Cells row = {folds.names[f]};
    for (std::size_t i = 0; shows_parameters && i < parameters.size(); ++i) {
      row.push_back(i < fold.estimate.parameters.size()
                        ? NumberText(fold.estimate.parameters[i].value, 4)
                        : "-");
    }
    AddPrediction(fold.prediction, row);
    rows.push_back(std::move(row));
  }
  Cells total = {"all"};
  total.resize(rows[0].size() - HeadingOf("").size() + 1);
  AddPrediction(validation.Total(), total);
  rows.push_back(std::move(total));
  return Table(rows);
}

// Returns why the fit of a part was refused, or predicted nothing, for the
// first such part; the other parts mostly have the same reason.
std::string Refusals(const Folds& folds, const CrossValidation& validation) {
  std::string text;
  int num_refused = 0;
  for (std::size_t f = 0; f < validation.folds.size(); ++f) {
    const FoldPrediction& fold = validation.folds[f];
    const std::string& why =
        fold.why_not.empty() ? fold.estimate.message : fold.why_not;
    if (!why.empty() && ++num_refused == 1) {
      text = "the fit without " + folds.names[f] + " is refused: " + why + "\n";
    }
  }
  return num_refused > 1
             ? text + "fits without " + std::to_string(num_refused - 1) +
                   " other parts are refused as well\n"
             : text;
}

std::string Meaning(const CrossValidation& validation) {
  if (!validation.IsComplete()) {
    return "NOT VALIDATED: a part could not be predicted\n";
  }
  if (validation.IsOff()) {
    return "PREDICTION IS OFF: the model misses what it has not seen by more "
           "than its stated errors, so that errors of parameters may be "
           "understated as well; compare models (--compare), or look where it "
           "is off (--out)\n";
  }
  return "the model predicts what it has not seen: its errors are " +
         NumberText(validation.Total().ErrorRatio(), 2) +
         " times the stated ones\n";
}

}  // namespace

std::string ValidationSummary(const Folds& folds,
                              const std::vector<std::string>& models,
                              const std::vector<CrossValidation>& validations) {
  std::string text = FoldTable(folds, validations.front()) +
                     Refusals(folds, validations.front());
  if (models.size() > 1) {
    std::vector<Cells> rows = {HeadingOf("model")};
    for (std::size_t i = 0; i < models.size(); ++i) {
      Cells row = {models[i]};
      AddPrediction(
          validations[i].IsComplete() ? validations[i].Total() : Prediction{},
          row);
      rows.push_back(std::move(row));
    }
    text += "\n" + Table(rows);
    for (std::size_t i = 1; i < models.size(); ++i) {
      if (!validations[i].IsComplete()) {
        text += models[i] + ", " + Refusals(folds, validations[i]);
      }
    }
  }
  return text + "\n" + Meaning(validations.front());
}

}  // namespace elastimate
