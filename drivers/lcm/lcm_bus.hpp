// One connection to LCM. Several publishers and subscribers of a process may share it.
#pragma once

#include <lcm/lcm.h>

#include <memory>
#include <string_view>

#include "drivers/common/result.hpp"
#include "drivers/lcm/lcm_url.hpp"

namespace pliant {

class LcmBus {
 public:
  /// Bad URLs are ErrorKind::bad_input, a network that is not there ErrorKind::device with the commands that
  /// mend it, a log file that cannot be written ErrorKind::write.
  [[nodiscard]] static Result<std::shared_ptr<LcmBus>> open(std::string_view url);
  [[nodiscard]] static Result<std::shared_ptr<LcmBus>> open(const LcmUrl& url);
  ~LcmBus();
  LcmBus(const LcmBus&) = delete;
  LcmBus& operator=(const LcmBus&) = delete;

  [[nodiscard]] lcm_t* get() const noexcept { return lcm_; }
  [[nodiscard]] const LcmUrl& url() const noexcept { return url_; }

 private:
  LcmBus(LcmUrl url, lcm_t* lcm);
  LcmUrl url_;
  lcm_t* lcm_;
};

}  // namespace pliant
