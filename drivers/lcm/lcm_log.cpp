#include "drivers/lcm/lcm_log.hpp"

#include <array>
#include <cerrno>
#include <cstring>

#include "drivers/lcm/wire.hpp"

namespace pliant {

namespace {

constexpr std::uint32_t kSync = 0xEDA1DA01;
constexpr std::size_t kHeaderBytes =
    24;  // number (8), stamp (8), length of the channel's name (4), of the body (4)

}  // namespace

Result<LcmLog> LcmLog::open(const std::filesystem::path& path) {
  const auto bad = [&](const char* what) {
    return Error{ErrorKind::bad_input, "LCM log '" + path.string() + "': " + what};
  };
  std::error_code status;
  if (std::filesystem::is_directory(path, status)) return bad("is a folder");
  // Of a pipe the first byte may never come.
  if (std::filesystem::is_other(path, status)) return bad("is a device or a pipe; a log is a file");
  std::FILE* file = std::fopen(path.c_str(), "rb");
  if (file == nullptr) return bad(std::strerror(errno));  // NOLINT(concurrency-mt-unsafe)
  LcmLog log(file);
  std::array<std::uint8_t, 4> begin{};
  wire::Reader in(begin);
  const std::size_t got = std::fread(begin.data(), 1, begin.size(), file);
  if (got == 0 && std::ferror(file) == 0) return bad("is empty");
  if (got != begin.size() || in.get<std::uint32_t>() != kSync) return bad("is not an LCM log");
  std::rewind(file);
  return log;
}

bool LcmLog::find_begin(bool& damaged) {
  std::uint32_t seen = 0;
  for (std::size_t passed = 0;; ++passed) {
    const int byte = std::fgetc(file_.get());
    if (byte == EOF) {
      if (passed > 0) count(damaged);
      return false;
    }
    seen = seen << 8 | static_cast<std::uint32_t>(byte);
    if (seen == kSync && passed >= 3) {
      if (passed > 3) count(damaged);
      return true;
    }
  }
}

void LcmLog::count(bool& damaged) {
  damages_ += damaged ? 0 : 1;
  damaged = true;
}

bool LcmLog::next(LcmLogEvent& event) {
  bool damaged = false;  // what is passed over up to the next event is one stretch
  while (find_begin(damaged)) {
    std::array<std::uint8_t, kHeaderBytes> header{};
    const off_t after_sync = ftello(file_.get());
    if (std::fread(header.data(), 1, header.size(), file_.get()) != header.size()) {
      count(damaged);
      return false;
    }
    wire::Reader in(header);
    event.number = in.get<std::int64_t>();
    event.utime = in.get<std::int64_t>();
    const auto channel = in.get<std::int32_t>(), body = in.get<std::int32_t>();
    bool sound = channel > 0 && channel <= static_cast<std::int32_t>(kMaxChannel) && body >= 0 &&
                 body <= static_cast<std::int32_t>(kMaxBody);
    if (sound) {
      event.channel.resize(static_cast<std::size_t>(channel));
      event.body.resize(static_cast<std::size_t>(body));
      sound =
          std::fread(event.channel.data(), 1, event.channel.size(), file_.get()) == event.channel.size() &&
          std::fread(event.body.data(), 1, event.body.size(), file_.get()) == event.body.size();
    }
    if (sound) return true;
    // What looked like a begin was none, or the log is cut off: look on right behind it.
    count(damaged);
    if (fseeko(file_.get(), after_sync, SEEK_SET) != 0) return false;
  }
  return false;
}

}  // namespace pliant
