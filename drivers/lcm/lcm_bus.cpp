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

/// LCM's log provider prints and leaks where it cannot open its file; this says it in one line before.
Outcome check_log_file(const LcmUrl& url) {
  const std::string rest = url.spelled.substr(std::strlen("file://"));
  const std::string path = rest.substr(0, rest.find('?'));
  std::FILE* const file = std::fopen(path.c_str(), url.writes ? "ab" : "rb");
  if (file == nullptr) {
    return Error{url.writes ? ErrorKind::write : ErrorKind::bad_input,
                 "LCM log '" + path + "': " + std::strerror(errno)};  // NOLINT(concurrency-mt-unsafe)
  }
  std::array<unsigned char, 4> sync{};
  constexpr std::array<unsigned char, 4> kSync = {0xED, 0xA1, 0xDA, 0x01};
  const bool is_log =
      url.writes || (std::fread(sync.data(), 1, sync.size(), file) == sync.size() && sync == kSync);
  std::fclose(file);
  if (!is_log) return Error{ErrorKind::bad_input, "'" + path + "' is not an LCM log"};
  return success();
}

}  // namespace

LcmBus::LcmBus(LcmUrl url, lcm_t* lcm) : url_(std::move(url)), lcm_(lcm) {}

LcmBus::~LcmBus() {
  lcm_destroy(lcm_);
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
  } else if (url.provider == LcmUrl::Provider::log_file) {
    const auto checked = check_log_file(url);
    if (!checked) return checked.error();
  }
  lcm_t* const lcm = lcm_create(url.spelled.c_str());
  if (lcm == nullptr) return Error{ErrorKind::device, "LCM at " + url.spelled + ": cannot be started"};
  return std::shared_ptr<LcmBus>(new LcmBus(url, lcm));
}

}  // namespace pliant
