// The ways in which a log can be written.
#pragma once

#include <memory>
#include <string>

#include "firmware-app/export/log_exporter.hpp"

namespace pliant {

/// The base region's path: "<seconds> tx ty tz qx qy qz qw" a line, as `pliant run --trajectory` writes it.
[[nodiscard]] Result<std::unique_ptr<LogExporter>> export_tum(const std::string& path);

/// A points file per tracked frame, as `pliant run --points` writes them; the residual, which is not
/// published, is NaN, the match -1. Frames of a tracker that was started again are run2_NNNNNN.ply and so on.
/// The folder is made; one that already holds such files is refused.
[[nodiscard]] Result<std::unique_ptr<LogExporter>> export_ply(const std::string& folder);

/// Tables frames.csv, regions.csv, deformed.csv, status.csv and stages.csv. The folder is made.
[[nodiscard]] Result<std::unique_ptr<LogExporter>> export_csv(const std::string& folder);

/// One MCAP file with Foxglove's schemas: transforms, points, status, depth with the camera.
[[nodiscard]] Result<std::unique_ptr<LogExporter>> export_mcap(const std::string& path);

}  // namespace pliant
