// Who may look.
#pragma once

#include <string>
#include <string_view>

namespace pliant::viewer {

/// 127.x.y.z, ::1 and localhost.
[[nodiscard]] bool is_loopback(std::string_view host);

/// The host of a Host header, without port and brackets.
[[nodiscard]] std::string_view host_of(std::string_view header);

/// 128 random bits as 32 hexadecimal digits; empty where the system gives none.
[[nodiscard]] std::string random_token();

/// What a request brings along.
struct Visit {
  std::string_view host = {};    ///< its Host header
  std::string_view origin = {};  ///< its Origin header, empty where there is none
  std::string_view query = {};   ///< behind the question mark
  std::string_view cookie = {};  ///< its Cookie header
};

/// Without a token (a server on the loopback) the host must be the loopback's: a web site's own name that was
/// made to lead here is none. With one the query or the cookie must hold it. A page of another origin is
/// refused either way.
[[nodiscard]] bool may_look(const Visit& visit, std::string_view token);

/// "token=…" in the query; empty where there is none.
[[nodiscard]] std::string_view token_in_query(std::string_view query);

}  // namespace pliant::viewer
