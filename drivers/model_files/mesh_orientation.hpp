// Which way is out.
#pragma once

#include <string>
#include <vector>

#include "drivers/model_files/mesh.hpp"

namespace pliant {

/// Winds the triangles so that their normals point outward: neighbours alike first, then each connected part
/// by its volume when it is closed, else by the side that is seen from around, else by the normals of the
/// file, else as the file winds most of it. Returns whether the surface is closed (no border anywhere).
bool orient_mesh(Mesh& mesh, std::vector<std::string>& warnings);

/// No border anywhere.
[[nodiscard]] bool is_closed(const Mesh& mesh);

}  // namespace pliant
