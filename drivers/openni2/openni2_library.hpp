// libOpenNI2, started: what is plugged in, and word of what comes and goes.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/common/result.hpp"
#include "drivers/depth_source/arrival_signal.hpp"
#include "drivers/openni2/openni2_api.hpp"

namespace pliant {

struct OpenNi2Device {
  std::string uri, vendor, name;
  std::uint16_t vendor_id = 0, product_id = 0;  ///< of USB
};

/// Shut down when the last who holds it lets go.
class OpenNi2Library {
 public:
  /// `arrivals`, where given, is told when devices come or go. ErrorKind::device where the library cannot
  /// start.
  [[nodiscard]] static Result<std::shared_ptr<OpenNi2Library>> start(
      std::shared_ptr<ArrivalSignal> arrivals = nullptr, const OpenNi2Api& api = {});
  ~OpenNi2Library();
  OpenNi2Library(const OpenNi2Library&) = delete;
  OpenNi2Library& operator=(const OpenNi2Library&) = delete;

  [[nodiscard]] Result<std::vector<OpenNi2Device>> devices() const;
  /// Set to true once the device with this URI is unplugged or fails, as long as the flag lives.
  [[nodiscard]] std::shared_ptr<std::atomic<bool>> watch(const std::string& uri);
  [[nodiscard]] const OpenNi2Api& api() const noexcept { return api_; }
  /// An error that names `what` failed, with the status and what the library says.
  [[nodiscard]] Error fault(std::string_view what, OniStatus status) const;

 private:
  OpenNi2Library(std::shared_ptr<ArrivalSignal> arrivals, const OpenNi2Api& api)
      : api_(api), arrivals_(std::move(arrivals)) {}
  void gone(const OniDeviceInfo* device);
  void tell() const;

  struct Watch {
    std::string uri;
    std::weak_ptr<std::atomic<bool>> gone;
  };
  const OpenNi2Api api_;
  const std::shared_ptr<ArrivalSignal> arrivals_;
  OniCallbackHandle callbacks_ = nullptr;
  bool started_ = false;
  std::mutex mutex_;
  std::vector<Watch> watches_;
};

}  // namespace pliant
