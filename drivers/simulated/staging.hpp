// Actors put before the simulated sensor.
#pragma once

#include <memory>

#include "drivers/simulated/actor.hpp"
#include "drivers/simulated/options.hpp"
#include "drivers/simulated/scene.hpp"
#include "drivers/simulated/simulated.hpp"

namespace pliant::simulated {

struct Stage {
  std::unique_ptr<Actor> actor;
  View view;
};

[[nodiscard]] std::unique_ptr<SimulatedSource> stage_source(const Options& options, Stage stage);

}  // namespace pliant::simulated
