#include "drivers/lcm/lcm_url.hpp"

#include <arpa/inet.h>
#include <lcm/lcm.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <optional>

#include "drivers/lcm/messages.hpp"

namespace pliant {

namespace {

Error bad_url(std::string_view url, std::string_view why) {
  return {ErrorKind::bad_input, "LCM URL '" + std::string(url) + "': " + std::string(why)};
}

std::optional<std::int64_t> whole_number(std::string_view text, std::int64_t lowest, std::int64_t highest) {
  std::int64_t value = 0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (fault != std::errc() || end != text.data() + text.size() || value < lowest || value > highest)
    return {};
  return value;
}

/// Calls `take(key, value)` for each option; false when it refused one.
template <typename Take>
bool each_option(std::string_view options, const Take& take) {
  while (!options.empty()) {
    const std::size_t end = std::min(options.find('&'), options.size());
    const std::string_view option = options.substr(0, end);
    const std::size_t equals = std::min(option.find('='), option.size());
    if (!take(option.substr(0, equals), option.substr(std::min(equals + 1, option.size())))) return false;
    options.remove_prefix(std::min(end + 1, options.size()));
  }
  return true;
}

Result<LcmUrl> parse_multicast(std::string_view url, std::string_view network, std::string_view options) {
  LcmUrl result;
  result.group_text = "239.255.76.67";
  result.port = 7667;
  const std::size_t colon = std::min(network.find(':'), network.size());
  if (colon > 0) result.group_text = network.substr(0, colon);
  if (colon < network.size()) {
    const auto port = whole_number(network.substr(colon + 1), 1, 65535);
    if (!port) return bad_url(url, "the port must be 1 to 65535");
    result.port = static_cast<std::uint16_t>(*port);
  }
  in_addr address{};
  if (inet_pton(AF_INET, result.group_text.c_str(), &address) != 1 || (ntohl(address.s_addr) >> 28) != 0xE) {
    return bad_url(url,
                   "'" + result.group_text + "' is no IPv4 multicast address (224.0.0.0 to 239.255.255.255)");
  }
  result.group = ntohl(address.s_addr);

  std::int64_t ttl = 0;
  std::int64_t receive_buffer = 0;
  std::string fault;
  each_option(options, [&](std::string_view key, std::string_view value) {
    const bool is_ttl = key == "ttl";
    if (!is_ttl && key != "recv_buf_size") {
      fault = "unknown option '" + std::string(key) + "'; known are ttl and recv_buf_size";
      return false;
    }
    const auto number = whole_number(value, 0, is_ttl ? 255 : 1 << 30);
    if (!number)
      fault = is_ttl ? "ttl must be 0 to 255" : "recv_buf_size must be a number of bytes up to 1 GiB";
    if (number) (is_ttl ? ttl : receive_buffer) = *number;
    return number.has_value();
  });
  if (!fault.empty()) return bad_url(url, fault);
  result.ttl = static_cast<int>(ttl);
  result.receive_buffer = static_cast<int>(receive_buffer);
  result.spelled =
      "udpm://" + result.group_text + ":" + std::to_string(result.port) + "?ttl=" + std::to_string(ttl);
  if (receive_buffer > 0) result.spelled += "&recv_buf_size=" + std::to_string(receive_buffer);
  return result;
}

Result<LcmUrl> parse_file(std::string_view url, std::string_view path, std::string_view options) {
  if (path.empty()) return bad_url(url, "the file's path is missing");
  LcmUrl result;
  result.provider = LcmUrl::Provider::log_file;
  result.writes = false;
  result.path = path;
  std::string fault;
  each_option(options, [&](std::string_view key, std::string_view value) {
    if (key == "mode") {
      if (value != "r" && value != "w" && value != "a") fault = "mode must be r, w or a";
      result.writes = value != "r";
      result.append = value == "a";
    } else if (key != "speed" && key != "start_timestamp") {
      fault = "unknown option '" + std::string(key) + "'; known are mode, speed and start_timestamp";
    }
    return fault.empty();
  });
  if (!fault.empty()) return bad_url(url, fault);
  result.spelled = url;
  return result;
}

}  // namespace

Result<LcmUrl> LcmUrl::parse(std::string_view text) {
  if (text.empty()) {
    const char* const environment = std::getenv("LCM_DEFAULT_URL");  // NOLINT(concurrency-mt-unsafe)
    text = environment != nullptr && *environment != '\0' ? environment : kDefaultLcmUrl;
  }
  const std::size_t separator = text.find("://");
  if (separator == std::string_view::npos) {
    return bad_url(text, "expected PROVIDER://…, for example " + std::string(kDefaultLcmUrl));
  }
  const std::string_view provider = text.substr(0, separator);
  const std::string_view rest = text.substr(separator + 3);
  const std::size_t question = std::min(rest.find('?'), rest.size());
  const std::string_view network = rest.substr(0, question);
  const std::string_view options = rest.substr(std::min(question + 1, rest.size()));
  if (provider == "udpm") return parse_multicast(text, network, options);
  if (provider == "file") return parse_file(text, network, options);
  if (provider == "memq") {
    if (!network.empty() || !options.empty()) return bad_url(text, "memq:// takes nothing behind it");
    LcmUrl result;
    result.provider = Provider::in_process;
    result.spelled = "memq://";
    return result;
  }
  // LCM 1.3's tcpq aborts the process where no server answers.
  return bad_url(text, std::string("'").append(provider).append(
                           "' cannot be used; use udpm://, file://PATH?mode=w or memq://"));
}

Outcome check_channel_prefix(std::string_view prefix) {
  std::size_t longest_suffix = 0;
  for (int kind = 0; kind < kMessageKinds; ++kind) {
    longest_suffix = std::max(longest_suffix, channel_suffix(static_cast<MessageKind>(kind)).size());
  }
  const std::size_t limit = LCM_MAX_CHANNEL_NAME_LENGTH - longest_suffix;
  const bool known_characters = std::all_of(prefix.begin(), prefix.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-' || c == '.' || c == '/';
  });
  if (!prefix.empty() && prefix.size() <= limit && known_characters) return success();
  return Error{ErrorKind::bad_input, "LCM prefix '" + std::string(prefix) + "': must be 1 to " +
                                         std::to_string(limit) + " letters, digits, '_', '-', '.' or '/'"};
}

}  // namespace pliant
