// pliant-view: what `pliant view` runs. A program of its own, so that the tracker links no web server.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <array>
#include <csignal>
#include <exception>

#include "firmware-app/commands/console.hpp"
#include "firmware-app/pipeline/stop_signal.hpp"
#include "firmware-app/viewer/access.hpp"
#include "firmware-app/viewer/listener.hpp"
#include "firmware-app/viewer/web_server.hpp"

namespace pliant::viewer {

namespace {

struct Options {
  std::string bind = "127.0.0.1", url, prefix = "PLIANT";
  int port = 8080;
};

/// The address to open; a server on all addresses is opened by the host's own name.
std::string page_address(const Options& options, int port, const std::string& token) {
  std::string host = options.bind;
  if (host == "0.0.0.0" || host == "::") {
    std::array<char, 256> name{};
    host = gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "localhost";
  } else if (host.find(':') != std::string::npos) {
    host = "[" + host + "]";
  }
  return fmt::format("http://{}:{}/{}", host, port, token.empty() ? "" : "?token=" + token);
}

int serve(const Options& options) {
  const StopSignal stop;
  Stream stream;
  Listener listener(options.url, options.prefix, stream);
  if (const Outcome connected = listener.connect(); !connected) return report(connected.error());
  if (!listener.link().fault.empty()) print_warning(listener.link().fault);
  std::string token;
  if (!is_loopback(options.bind)) {
    token = random_token();
    if (token.empty()) return report({ErrorKind::device, "the system gives no random numbers for a token"});
  }
  const Result<std::unique_ptr<WebServer>> server =
      WebServer::start(options.bind, options.port, token, stream);
  if (!server) return report(server.error());
  if (!print(fmt::format("listening to {}_* at {}\nopen {}\n", options.prefix, listener.link().url,
                         page_address(options, (*server)->port(), token))))
    return kExitFailed;
  while (!StopSignal::requested()) listener.listen(50);
  return kExitDone;
}

int run(int count, char** words) {
  Options options;
  CLI::App app("Shows in a browser what a tracker publishes; 'pliant view' starts it.", "pliant-view");
  app.add_option("--bind", options.bind, "Address to listen on");
  app.add_option("--port", options.port, "Port to listen on, 0 for any")->check(CLI::Range(0, 65535));
  app.add_option("--lcm-url", options.url, "LCM network to listen to");
  app.add_option("--prefix", options.prefix, "First word of the channels' names");
  try {
    app.parse(count, words);
  } catch (const CLI::ParseError& fault) {
    return app.exit(fault) == 0 ? kExitDone : kExitBadInput;
  }
  return serve(options);
}

}  // namespace

}  // namespace pliant::viewer

int main(int count, char** words) {
  std::signal(SIGPIPE, SIG_IGN);
  try {
    return pliant::viewer::run(count, words);
  } catch (const std::exception& fault) {
    return pliant::report({pliant::ErrorKind::device, fmt::format("internal error: {}", fault.what())});
  }
}
