// Serves the page and the stream to browsers.
#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "drivers/common/result.hpp"
#include "firmware-app/viewer/stream.hpp"

struct mg_context;

namespace pliant::viewer {

class WebServer {
 public:
  static constexpr int kMostViewers = 16;

  /// `bind`: an address or "localhost"; port 0: any free one. Without a token only the loopback is answered.
  /// Both are borrowed. ErrorKind::bad_input where the address or the port cannot be had.
  [[nodiscard]] static Result<std::unique_ptr<WebServer>> start(const std::string& bind, int port,
                                                                const std::string& token, Stream& stream);
  /// Browsers are sent away; the stream is closed.
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  [[nodiscard]] int port() const { return port_; }

 private:
  struct Handlers;
  WebServer(std::string token, Stream& stream) : token_(std::move(token)), stream_(stream) {}

  std::string token_;
  Stream& stream_;
  mg_context* context_ = nullptr;
  int port_ = 0;
  std::atomic<int> viewers_{0};
};

}  // namespace pliant::viewer
