// Does the model, moved against itself, look as before? A cup does when it is turned about its axis.
#pragma once

#include <cstddef>

#include "core/geometry/rigid_transform.hpp"
#include "core/model/model_view.hpp"

namespace pliant {

/// Of the model's first `count` points, moved by `motion` (model <- model), the share that lies on the model,
/// `tolerance` metres along its normal, facing as it does. [0, 1]
[[nodiscard]] double self_likeness(const ModelView& model, const RigidTransform& motion, std::size_t count,
                                   double tolerance) noexcept;

}  // namespace pliant
