// Puts depth pictures together from the messages that they were sent as.
#pragma once

#include <cstdint>
#include <vector>

#include "core/camera/depth_frame.hpp"
#include "drivers/lcm/messages.hpp"

namespace pliant {

/// Of one camera. Messages may come in any order within a picture, and twice.
class DepthAssembler {
 public:
  explicit DepthAssembler(const Intrinsics& camera);

  /// The message is of another picture than the one begun, which therefore stays unfinished: give_up() first.
  [[nodiscard]] bool begins_another(const DepthMessage& message) const noexcept;
  /// Takes a message in. True when it makes the picture whole; frame() then holds until the next call. A
  /// message of another camera is not taken: fits() tells.
  [[nodiscard]] bool take(const DepthMessage& message);
  [[nodiscard]] bool fits(const DepthMessage& message) const noexcept;
  /// The picture begun is thrown away.
  void give_up() noexcept { begun_ = false; }
  [[nodiscard]] bool begun() const noexcept { return begun_; }
  [[nodiscard]] DepthFrame frame() const noexcept;

 private:
  Intrinsics camera_;
  std::vector<std::uint16_t> pixels_;
  std::vector<std::uint8_t> row_seen_;
  int rows_missing_ = 0;
  bool begun_ = false;
  std::int64_t utime_ = 0, frame_ = 0;
};

}  // namespace pliant
