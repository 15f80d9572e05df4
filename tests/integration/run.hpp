// A whole run on one thread of the test's own, with everything that the tests look at.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "drivers/model_files/model_file.hpp"
#include "firmware-app/demo/truth_check.hpp"
#include "firmware-app/pipeline/run_pipeline.hpp"

namespace pliant::test {

/// Settings of a run that publishes nothing and sheds nothing.
[[nodiscard]] RunSettings quiet_settings(const DepthSource& source);

/// A run on a simulated source, compared with its truth.
struct SimulatedRun {
  std::unique_ptr<demo::RememberingSource> source;
  ModelFile model;
  std::unique_ptr<demo::TruthCheck> check;
  RunEnd end;
};
void run_simulated(const std::string& uri, SimulatedRun& run);

/// The model built from `mesh`, or a failed test.
[[nodiscard]] ModelFile model_of(const std::string& mesh);

/// Folder of the shared data, empty where there is none.
[[nodiscard]] std::string shared_data(const std::string& name);

}  // namespace pliant::test
