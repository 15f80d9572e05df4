// What the user's sensor description asks of a device.
#pragma once

#include <optional>

#include "core/camera/intrinsics.hpp"
#include "core/camera/sensor.hpp"

namespace pliant {

struct SourceWish {
  /// Size, focal lengths and depth unit; the size is asked of the device, the rest wins over what it says of
  /// itself. Empty: 640×480, or 320×240 where the device has no larger mode.
  std::optional<Intrinsics> camera;
  SensorDescription sensor;
  double rate = 30;  ///< frames a second
};

}  // namespace pliant
