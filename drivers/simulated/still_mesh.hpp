// Any mesh before the simulated sensor, standing still: to try what was not made for it.
#pragma once

#include <memory>
#include <string_view>

#include "drivers/simulated/simulated.hpp"

namespace pliant {

/// `mesh` (metres, z upwards, triangles and unit normals) stands on the table, or is turned on it, as
/// "?motion=turned&frames=300" says, with the keys of open_simulated(); its model frame is the mesh's own.
/// ErrorKind::bad_input names what is unknown or out of range.
[[nodiscard]] Result<std::unique_ptr<SimulatedSource>> open_still_mesh(Geometry mesh,
                                                                       std::string_view options);

}  // namespace pliant
