// Reads scene files and fits them; writes the report as JSON.
//
//   02_estimate_file scene.vtu [more load cases.vtu ...]

#include <elastimate/estimators/registry.h>
#include <elastimate/io/report/report.h>
#include <elastimate/io/scene/scene_reader.h>

#include <exception>
#include <iostream>

int main(int argc, char** argv) {
  try {
    const elastimate::SceneReading reading = elastimate::ReadScene(
        {argv + 1, argv + argc}, elastimate::Measurement::kRequired);
    elastimate::EstimatorOptions options;
    options.poisson_ratio.upper = 0.495;
    const elastimate::Estimate estimate =
        elastimate::MakeEstimator("iterative-fe")->Run(reading.scene, options);
    std::cout << elastimate::JsonReport(estimate, reading.scene, options, {},
                                        reading.notices);
    return estimate.IsUsable() ? 0 : 1;
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 2;
  }
}
