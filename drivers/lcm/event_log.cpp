#include "drivers/lcm/event_log.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <span>

#include "drivers/lcm/wire.hpp"

namespace pliant {

namespace {

// Sync word, number, stamp, length of the channel's name and of the body: big-endian.
constexpr std::size_t kHeaderBytes = 28;
constexpr std::uint32_t kSync = 0xEDA1DA01;
constexpr std::uint32_t kMaxChannel = 64;
constexpr std::uint32_t kMaxBody = 1U << 26;

}  // namespace

Result<EventLogReader> EventLogReader::open(const std::string& path) {
  EventLogReader reader;
  reader.file_.reset(std::fopen(path.c_str(), "rbe"));
  if (!reader.file_)
    return Error{ErrorKind::bad_input,
                 "LCM log '" + path + "': " + std::strerror(errno)};  // NOLINT(concurrency-mt-unsafe)
  std::array<std::uint8_t, 4> start{};
  const std::size_t got = std::fread(start.data(), 1, start.size(), reader.file_.get());
  if (got == 0 && std::ferror(reader.file_.get()) == 0)
    return Error{ErrorKind::bad_input, "LCM log '" + path + "' is empty"};
  wire::Reader in(std::span<const std::uint8_t>(start).first(got));
  if (in.get<std::uint32_t>() != kSync || !in.ok())
    return Error{ErrorKind::bad_input, "'" + path + "' is not an LCM log"};
  std::rewind(reader.file_.get());
  return reader;
}

bool EventLogReader::next(LoggedEvent& event) {
  std::array<std::uint8_t, kHeaderBytes> header{};
  const std::size_t got = std::fread(header.data(), 1, header.size(), file_.get());
  if (got == 0) return false;
  damaged_ = true;
  if (got != header.size()) return false;
  wire::Reader in(header);
  const auto sync = in.get<std::uint32_t>();
  static_cast<void>(in.get<std::int64_t>());
  event.received_us = in.get<std::int64_t>();
  const auto channel = in.get<std::uint32_t>();
  const auto body = in.get<std::uint32_t>();
  if (sync != kSync || channel == 0 || channel > kMaxChannel || body > kMaxBody) return false;
  event.channel.resize(channel);
  event.body.resize(body);
  if (std::fread(event.channel.data(), 1, channel, file_.get()) != channel ||
      std::fread(event.body.data(), 1, body, file_.get()) != body)
    return false;
  damaged_ = false;
  return true;
}

}  // namespace pliant
