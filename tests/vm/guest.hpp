// What the tests inside the virtual machine have in common.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/camera/intrinsics.hpp"
#include "core/geometry/rigid_transform.hpp"
#include "drivers/lcm/subscriber.hpp"
#include "drivers/v4l2/v4l2_node.hpp"
#include "tests/commands/program.hpp"

namespace pliant::test {

/// Made by run.sh outside, where it takes no time: a recording of the simulated box, and its model.
inline constexpr const char* kRecording = "/guest/box";
inline constexpr const char* kModel = "/guest/box.model";

/// Where the camera of the tests is plugged in, and how V4L2 names this place.
inline constexpr int kPort = 0;
inline constexpr const char* kBus = "usb-vhci_hcd.0-1";

/// Frames a second that the tracker must reach under emulation.
inline constexpr double kLeastRate = 5;

using Pictures = std::vector<std::vector<std::uint16_t>>;

/// Until `met`, asking often; false after `seconds`.
[[nodiscard]] bool wait_until(double seconds, const std::function<bool()>& met);

/// What the recording holds, read once.
struct Recorded {
  Intrinsics camera;
  Pictures pictures;
  std::vector<RigidTransform> poses;  ///< of the object, camera ← model, by picture
};
[[nodiscard]] const Recorded& recorded();

/// The node that offers depth at this bus id; an empty path where there is none.
[[nodiscard]] V4l2Node depth_node(const std::string& bus);

/// `pliant run` beside the test, followed by what it publishes.
class Tracking {
 public:
  /// `folder` holds its outputs; the sensor description is the recorded camera's, at this rate.
  Tracking(const std::filesystem::path& folder, const std::string& source, double rate);
  ~Tracking();
  Tracking(const Tracking&) = delete;
  Tracking& operator=(const Tracking&) = delete;

  /// Until a status meets the condition; false after `seconds` or when the program has ended.
  [[nodiscard]] bool until(double seconds, const std::function<bool(const StatusMessage&)>& met);
  [[nodiscard]] const StatusMessage& latest() const { return latest_; }
  /// The states of the device in the order in which they were told: "opening streaming …".
  [[nodiscard]] const std::string& states() const { return states_; }
  /// How far the base region is from where the object was in that picture, in the median over all frames
  /// heard so far, metres; for a source whose frame numbers count the pictures from the first.
  [[nodiscard]] double median_error() const;
  /// Frames tracked in a second, over the first five seconds in which they are kLeastRate; the most there
  /// were where that takes longer than `seconds`: other work on this machine may hold the guest up.
  [[nodiscard]] double rate_within(double seconds);
  /// Asks the program to end.
  [[nodiscard]] Ended stop();
  /// Everything known, for a failure's message.
  [[nodiscard]] std::string told() const;

 private:
  [[nodiscard]] bool ended();
  [[nodiscard]] double rate_over(double seconds);

  std::filesystem::path folder_;
  std::unique_ptr<LcmSubscriber> subscriber_;
  pid_t process_ = -1;
  StatusMessage latest_;
  std::string states_, errors_;
  std::vector<double> errors_of_place_;  // metres, by frame
  std::int64_t heard_ = 0;
};

}  // namespace pliant::test
