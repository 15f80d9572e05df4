// pliant: finds a known deformable object in depth frames and follows it.
#include <fmt/format.h>

#include <clocale>
#include <csignal>
#include <exception>
#include <iostream>
#include <new>
#include <string>
#include <vector>

#include "firmware-app/commands/commands.hpp"
#include "firmware-app/commands/console.hpp"

namespace pliant {

namespace {

/// The names of the chosen subcommands: "pliant model build".
std::string chosen_name(const CLI::App& program) {
  std::string name = program.get_name();
  const CLI::App* app = &program;
  while (!app->get_subcommands().empty()) {
    app = app->get_subcommands().front();
    name += " " + app->get_name();
  }
  return name;
}

/// What is wrong where a command is missing or is none of those there are; empty where nothing of that is.
std::string command_fault(const CLI::App& program) {
  const CLI::App* app = &program;
  while (!app->get_subcommands().empty()) app = app->get_subcommands().front();
  std::string known;
  for (const CLI::App* command : app->get_subcommands([](const CLI::App*) { return true; }))
    known += (known.empty() ? "" : ", ") + command->get_name();
  if (known.empty()) return {};
  const std::vector<std::string> words = program.remaining(true);
  if (words.empty()) return fmt::format("a command is missing; there are {}", known);
  return fmt::format("'{}' is no command; there are {}", words.front(), known);
}

int run_program(int count, char** words) {
  CLI::App program("Finds a known deformable object in depth frames and follows it.", "pliant");
  program.set_version_flag("--version", "pliant " PLIANT_VERSION, "Print the version and exit");
  program.set_help_flag("-h,--help", "Print this help and exit");
  program.require_subcommand(1);
  program.footer(
      "'pliant COMMAND --help' tells more. Exit codes: 0 done; 1 the object was not found; "
      "2 bad input; 3 a device was lost or a write failed.");
  Work work;
  add_model_commands(program, work);
  add_register(program, work);
  add_run(program, work);
  add_record(program, work);
  add_devices(program, work);
  add_check(program, work);
  add_view(program, work);
  add_snapshot(program, work);
  add_plot(program, work);
  add_export(program, work);
  try {
    program.parse(count, words);
  } catch (const CLI::Success& wanted) {  // --help, --version
    program.exit(wanted, std::cout, std::cerr);
    std::cout.flush();
    return std::cout ? kExitDone : kExitFailed;
  } catch (const CLI::ParseError& fault) {
    const std::string command = command_fault(program);
    print_warning(
        fmt::format("{}; see '{} --help'", command.empty() ? fault.what() : command, chosen_name(program)));
    return kExitBadInput;
  }
  return work ? work() : kExitBadInput;
}

}  // namespace

}  // namespace pliant

int main(int count, char** words) {
  // A reader that went away, and a limit of a file's size, show as a failed write.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  try {
    return pliant::run_program(count, words);
  } catch (const std::bad_alloc&) {
    return pliant::report({pliant::ErrorKind::device, "out of memory"});
  } catch (const std::exception& fault) {
    return pliant::report({pliant::ErrorKind::device, fmt::format("internal error: {}", fault.what())});
  }
}
