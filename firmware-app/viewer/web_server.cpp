#include "firmware-app/viewer/web_server.hpp"

#include <civetweb.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>
#include <utility>

#include "firmware-app/viewer/access.hpp"
#include "firmware-app/viewer/assets.hpp"

namespace pliant::viewer {

namespace {

std::string_view text_of(const char* text) {
  return text == nullptr ? std::string_view() : text;
}

Visit visit_of(const mg_connection* connection) {
  return {text_of(mg_get_header(connection, "Host")), text_of(mg_get_header(connection, "Origin")),
          text_of(mg_get_request_info(connection)->query_string),
          text_of(mg_get_header(connection, "Cookie"))};
}

int answer(mg_connection* connection, int code, std::string_view reason, std::string_view type,
           std::string_view extra, std::string_view body) {
  const std::string head = fmt::format(
      "HTTP/1.1 {} {}\r\nContent-Type: {}\r\nContent-Length: {}\r\nCache-Control: no-store\r\n"
      "Content-Security-Policy: default-src 'self'; img-src 'self' data:; connect-src 'self' ws: wss:; "
      "frame-ancestors 'none'\r\n"
      "X-Content-Type-Options: nosniff\r\nReferrer-Policy: no-referrer\r\nConnection: close\r\n{}\r\n",
      code, reason, type, body.size(), extra);
  mg_write(connection, head.data(), head.size());
  if (std::strcmp(mg_get_request_info(connection)->request_method, "HEAD") != 0)
    mg_write(connection, body.data(), body.size());
  return code;
}

}  // namespace

/// What the library calls, on a thread for each connection.
struct WebServer::Handlers {
  static constexpr std::size_t kKeyLength = 24;  ///< RFC 6455: 16 bytes in base64

  static int page(mg_connection* connection, void* context) {
    const auto& server = *static_cast<const WebServer*>(context);
    const Visit visit = visit_of(connection);
    if (!may_look(visit, server.token_))
      return answer(connection, 403, "Forbidden", "text/plain", "",
                    "Open the address that 'pliant view' printed, with its token.\n");
    const std::string_view method = text_of(mg_get_request_info(connection)->request_method);
    if (method != "GET" && method != "HEAD")
      return answer(connection, 405, "Method Not Allowed", "text/plain", "Allow: GET, HEAD\r\n", "");
    std::string_view path = text_of(mg_get_request_info(connection)->local_uri);
    if (path == "/") path = "/index.html";
    const auto all = assets();
    const auto asset =
        std::find_if(all.begin(), all.end(), [&](const Asset& one) { return one.path == path; });
    if (asset == all.end()) return answer(connection, 404, "Not Found", "text/plain", "", "Not here.\n");
    std::string extra;
    if (asset->gzip) extra += "Content-Encoding: gzip\r\n";
    // The page's own requests bring the token as a cookie.
    if (!server.token_.empty() && !token_in_query(visit.query).empty())
      extra +=
          fmt::format("Set-Cookie: pliant_token={}; HttpOnly; SameSite=Strict; Path=/\r\n", server.token_);
    return answer(connection, 200, "OK", asset->type, extra, asset->bytes);
  }

  static int connect(const mg_connection* connection, void* context) {
    auto& server = *static_cast<WebServer*>(context);
    if (!may_look(visit_of(connection), server.token_)) return 1;
    // The library hangs up on a longer key without a call of close(), which would keep the place for ever.
    if (text_of(mg_get_header(connection, "Sec-WebSocket-Key")).size() != kKeyLength) return 1;
    if (server.viewers_.fetch_add(1) >= kMostViewers) {
      server.viewers_.fetch_sub(1);
      return 1;
    }
    mg_set_user_connection_data(connection, new Stream::Seen{});
    return 0;
  }

  static int data(mg_connection* connection, int flags, char* text, std::size_t size, void* context) {
    auto& server = *static_cast<WebServer*>(context);
    const int kind = flags & 15;
    if (kind == MG_WEBSOCKET_OPCODE_CONNECTION_CLOSE) return 0;
    if (kind == MG_WEBSOCKET_OPCODE_PING)
      return mg_websocket_write(connection, MG_WEBSOCKET_OPCODE_PONG, text, size) >= 0 ? 1 : 0;
    if (kind != MG_WEBSOCKET_OPCODE_TEXT) return 1;
    const std::string_view wish(text, size);
    if (wish != "next" && wish != "next depth") return 0;
    auto& seen = *static_cast<Stream::Seen*>(mg_get_user_connection_data(connection));
    constexpr std::chrono::milliseconds kLongest{1000};
    for (const Packet& packet : server.stream_.take_newer(seen, kLongest, wish == "next depth")) {
      if (mg_websocket_write(connection, MG_WEBSOCKET_OPCODE_BINARY,
                             reinterpret_cast<const char*>(packet->data()), packet->size()) <= 0)
        return 0;
    }
    return mg_websocket_write(connection, MG_WEBSOCKET_OPCODE_TEXT, "end", 3) > 0 ? 1 : 0;
  }

  static void close(const mg_connection* connection, void* context) {
    auto* const seen = static_cast<Stream::Seen*>(mg_get_user_connection_data(connection));
    if (seen == nullptr) return;
    delete seen;
    mg_set_user_connection_data(connection, nullptr);
    static_cast<WebServer*>(context)->viewers_.fetch_sub(1);
  }
};

Result<std::unique_ptr<WebServer>> WebServer::start(const std::string& bind, int port,
                                                    const std::string& token, Stream& stream) {
  std::unique_ptr<WebServer> server(new WebServer(token, stream));
  const std::string address = bind == "localhost" ? "127.0.0.1" : bind;
  const std::string place = address.find(':') != std::string::npos ? fmt::format("[{}]:{}", address, port)
                                                                   : fmt::format("{}:{}", address, port);
  // A thread for each viewer, which waits for the next frame, and some for the page's files.
  const std::string threads = std::to_string(kMostViewers + 6);
  std::array<const char*, 13> options = {"listening_ports",
                                         place.c_str(),
                                         "num_threads",
                                         threads.c_str(),
                                         "request_timeout_ms",
                                         "10000",
                                         "websocket_timeout_ms",
                                         "15000",
                                         "enable_directory_listing",
                                         "no",
                                         "tcp_nodelay",
                                         "1",
                                         nullptr};
  mg_init_library(0);
  std::array<char, 256> words{};
  unsigned code = 0;
  mg_error_data fault{&code, words.data(), words.size()};
  const mg_callbacks callbacks{};
  mg_init_data init{&callbacks, server.get(), options.data()};
  server->context_ = mg_start2(&init, &fault);
  if (server->context_ == nullptr) {
    mg_exit_library();
    return Error{
        ErrorKind::bad_input,
        fmt::format("cannot listen on port {} of {}: another program has it, or the address is not this "
                    "machine's; give --port or --bind",
                    port, bind)};
  }
  std::array<mg_server_port, 4> ports{};
  if (mg_get_server_ports(server->context_, static_cast<int>(ports.size()), ports.data()) > 0)
    server->port_ = ports[0].port;
  mg_set_request_handler(server->context_, "/", &Handlers::page, server.get());
  mg_set_websocket_handler(server->context_, "/stream", &Handlers::connect, nullptr, &Handlers::data,
                           &Handlers::close, server.get());
  return server;
}

WebServer::~WebServer() {
  if (context_ == nullptr) return;
  stream_.close();
  mg_stop(context_);
  mg_exit_library();
}

}  // namespace pliant::viewer
