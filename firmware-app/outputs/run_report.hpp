// What a run leaves for people and programs to read.
#pragma once

#include <string>

#include "firmware-app/outputs/words.hpp"
#include "firmware-app/pipeline/run_figures.hpp"

namespace pliant {

/// The stats file: one JSON object.
[[nodiscard]] std::string stats_json(const RunFigures& figures);

/// The closing table.
[[nodiscard]] std::string closing_table(const RunFigures& figures);

/// The live status, without a line end.
[[nodiscard]] std::string status_line(const LiveFigures& live, std::int64_t frame_count);

}  // namespace pliant
