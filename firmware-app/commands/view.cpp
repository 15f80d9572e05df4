// pliant view: starts the web viewer, a program of its own, so that the tracker links no web server.
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <climits>
#include <cstring>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "drivers/lcm/lcm_url.hpp"
#include "firmware-app/commands/commands.hpp"
#include "firmware-app/commands/console.hpp"
#include "firmware-app/commands/option_checks.hpp"
#include "firmware-app/config/config.hpp"

namespace pliant {

namespace {

struct ViewOptions {
  std::string config;
  std::optional<std::string> bind, url, prefix;
  std::optional<int> port;
};

/// Beside this program, or where packages put programs that users do not call. Empty when it is in neither.
std::string viewer_program() {
  std::error_code fault;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", fault);
  if (fault) return {};
  const std::filesystem::path folder = self.parent_path();
  for (const std::filesystem::path& candidate :
       {folder / "pliant-view", folder.parent_path() / "libexec/pliant/pliant-view",
        folder.parent_path() / "lib/pliant/pliant-view"})
    if (::access(candidate.c_str(), X_OK) == 0) return candidate.string();
  return {};
}

int view(const ViewOptions& options) {
  Config config;
  if (!options.config.empty()) {
    const Result<Config> read = read_config(options.config);
    if (!read) return report(read.error());
    config = *read;
  }
  if (options.bind) {
    config.view.bind = *options.bind;
    config.places.erase("view.bind");
  }
  if (options.url) {
    config.lcm.url = *options.url;
    config.places.erase("lcm.url");
  }
  if (options.prefix) {
    config.lcm.prefix = *options.prefix;
    config.places.erase("lcm.prefix");
  }
  if (const Outcome bind = check_bind(config.view.bind); !bind)
    return report(at_key(config, "view.bind", bind.error()));
  if (config.lcm.url != "none")
    if (const Result<LcmUrl> url = LcmUrl::parse(config.lcm.url); !url)
      return report(at_key(config, "lcm.url", url.error()));
  if (const Outcome prefix = check_channel_prefix(config.lcm.prefix); !prefix)
    return report(at_key(config, "lcm.prefix", prefix.error()));
  std::vector<std::string> words = {viewer_program(),
                                    "--bind",
                                    config.view.bind,
                                    "--port",
                                    std::to_string(options.port.value_or(config.view.port)),
                                    "--lcm-url",
                                    config.lcm.url,
                                    "--prefix",
                                    config.lcm.prefix};
  if (words[0].empty())
    return report(
        {ErrorKind::bad_input,
         "the web viewer is not installed: it is in the package pliant-viewer, and ./dev view builds it from "
         "the sources"});
  if (words[6] == "none")
    return report(
        {ErrorKind::bad_input, "the config publishes nothing (url \"none\"): there is nothing to view"});
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  ::execv(arguments[0], arguments.data());
  return report({ErrorKind::device, fmt::format("cannot start {}: {}", words[0],
                                                std::strerror(errno))});  // NOLINT(concurrency-mt-unsafe)
}

}  // namespace

void add_view(CLI::App& program, Work& work) {
  CLI::App* app = program.add_subcommand("view", "Show in a web browser what a tracker publishes");
  auto options = std::make_shared<ViewOptions>();
  app->add_option("--port", options->port, "Port to listen on [8080]; 0 for any free one")
      ->check(CLI::Range(0, 65535).description(""))
      ->type_name("N");
  app->add_option(
         "--bind", options->bind,
         "Address to listen on [127.0.0.1]; any other than the loopback's asks for a token, which is "
         "printed")
      ->type_name("ADDRESS");
  app->add_option("--lcm-url", options->url, "LCM network to listen to")->type_name("URL");
  app->add_option("--prefix", options->prefix, "First word of the channels' names [PLIANT]")
      ->type_name("PREFIX");
  app->add_option("--config", options->config, "Config file (TOML); the options above win over it")
      ->check(names_a_file())
      ->type_name("FILE");
  app->callback([options, &work] { work = [options] { return view(*options); }; });
}

}  // namespace pliant
