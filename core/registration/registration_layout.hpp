// Where the buffers of a registration lie in its block.
#pragma once

#include "core/registration/registration_state.hpp"

namespace pliant {

/// Lays the buffers out for scenes of up to `scene_points` points, with the settings brought into their
/// ranges.
void lay_out(Workspace& workspace, const ModelView& model, std::size_t scene_points,
             const RegistrationSettings& given, RegistrationState& s) noexcept;

}  // namespace pliant
