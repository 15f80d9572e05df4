// Whether a scene is of any use.
#pragma once

#include "core/registration/registration_state.hpp"

namespace pliant {

/// What to say when a scene is of no use, or `found` when it may be searched. Sets the result's size ratio.
[[nodiscard]] RegistrationOutcome examine(RegistrationState& s, std::span<const Point3f> scene) noexcept;

}  // namespace pliant
