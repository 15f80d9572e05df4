#include "firmware-app/viewer/access.hpp"

#include <sys/random.h>

#include <algorithm>
#include <array>
#include <cstdint>

namespace pliant::viewer {

namespace {

/// In a time that does not tell how much of it is right.
bool same(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  int difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    difference |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]);
  return difference == 0;
}

/// The value of `name` in "name=value<separator>name=value".
std::string_view value_of(std::string_view text, std::string_view name, char separator) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(separator), text.size());
    std::string_view part = text.substr(0, end);
    while (part.starts_with(' ')) part.remove_prefix(1);
    const std::size_t equals = part.find('=');
    if (equals != std::string_view::npos && part.substr(0, equals) == name) return part.substr(equals + 1);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return {};
}

}  // namespace

bool is_loopback(std::string_view host) {
  return host == "localhost" || host == "::1" ||
         (host.starts_with("127.") && host.find_first_not_of("0123456789.") == std::string_view::npos);
}

std::string_view host_of(std::string_view header) {
  if (header.starts_with('[')) return header.substr(1, std::min(header.find(']'), header.size()) - 1);
  return header.substr(0, header.find(':'));
}

std::string random_token() {
  std::array<std::uint8_t, 16> bits{};
  if (getrandom(bits.data(), bits.size(), 0) != static_cast<ssize_t>(bits.size())) return {};
  std::string token;
  for (const std::uint8_t byte : bits) {
    token += "0123456789abcdef"[byte >> 4];
    token += "0123456789abcdef"[byte & 15];
  }
  return token;
}

std::string_view token_in_query(std::string_view query) {
  return value_of(query, "token", '&');
}

bool may_look(const Visit& visit, std::string_view token) {
  if (!visit.origin.empty()) {
    const std::size_t scheme = visit.origin.find("://");
    if (scheme == std::string_view::npos || visit.origin.substr(scheme + 3) != visit.host) return false;
  }
  if (token.empty()) return is_loopback(host_of(visit.host));
  return same(token_in_query(visit.query), token) || same(value_of(visit.cookie, "pliant_token", ';'), token);
}

}  // namespace pliant::viewer
