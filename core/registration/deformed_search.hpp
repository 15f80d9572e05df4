// The deformed points (section 3.3).
#pragma once

#include "core/registration/registration_state.hpp"

namespace pliant {

/// Radius search for the points that no region explains, among scene points that no region explains, one to
/// one. Completes positions, labels, matches and residuals, and marks what the instance used as taken.
void find_deformed(RegistrationState& s, InstanceBuffers& buffers, InstanceResult& instance) noexcept;

}  // namespace pliant
