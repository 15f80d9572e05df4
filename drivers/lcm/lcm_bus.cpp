#include "drivers/lcm/lcm_bus.hpp"

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>
#include <utility>

#include "drivers/lcm/multicast_probe.hpp"

namespace pliant {

namespace {

/// LCM's log provider prints and leaks where it cannot read its file; this says it in one line before.
Outcome check_log_file(const std::string& path) {
  std::FILE* const file = std::fopen(path.c_str(), "rb");
  if (file == nullptr) {
    return Error{ErrorKind::bad_input,
                 "LCM log '" + path + "': " + std::strerror(errno)};  // NOLINT(concurrency-mt-unsafe)
  }
  std::array<unsigned char, 4> sync{};
  constexpr std::array<unsigned char, 4> kSync = {0xED, 0xA1, 0xDA, 0x01};
  const bool is_log = std::fread(sync.data(), 1, sync.size(), file) == sync.size() && sync == kSync;
  std::fclose(file);
  if (!is_log) return Error{ErrorKind::bad_input, "'" + path + "' is not an LCM log"};
  return success();
}

}  // namespace

LcmBus::LcmBus(LcmUrl url, lcm_t* lcm, std::unique_ptr<LcmLogWriter> log)
    : url_(std::move(url)), lcm_(lcm), log_(std::move(log)) {}

LcmBus::~LcmBus() {
  if (lcm_ != nullptr) lcm_destroy(lcm_);
}

bool LcmBus::publish(const std::string& channel, std::span<const std::uint8_t> body) noexcept {
  if (log_ != nullptr) return log_->write(channel, body);
  return lcm_publish(lcm_, channel.c_str(), body.data(), static_cast<unsigned int>(body.size())) == 0;
}

void LcmBus::close_log() noexcept {
  if (log_ != nullptr) log_->close();
}

Outcome LcmBus::log_failure() const {
  return log_ != nullptr ? log_->failure() : success();
}

Result<std::shared_ptr<LcmBus>> LcmBus::open(std::string_view url) {
  const auto parsed = LcmUrl::parse(url);
  if (!parsed) return parsed.error();
  return open(*parsed);
}

Result<std::shared_ptr<LcmBus>> LcmBus::open(const LcmUrl& url) {
  if (url.provider == LcmUrl::Provider::udp_multicast) {
    if (const char* const fault = multicast_route_fault(url); fault != nullptr) {
      return Error{ErrorKind::device, multicast_advice(url, fault)};
    }
  } else if (url.writes_log()) {
    auto log = LcmLogWriter::open(url.path, url.append);
    if (!log) return log.error();
    return std::shared_ptr<LcmBus>(new LcmBus(url, nullptr, std::move(*log)));
  } else if (url.provider == LcmUrl::Provider::log_file) {
    const auto checked = check_log_file(url.path);
    if (!checked) return checked.error();
  }
  lcm_t* const lcm = lcm_create(url.spelled.c_str());
  if (lcm == nullptr) return Error{ErrorKind::device, "LCM at " + url.spelled + ": cannot be started"};
  return std::shared_ptr<LcmBus>(new LcmBus(url, lcm, nullptr));
}

}  // namespace pliant
