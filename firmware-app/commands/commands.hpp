// The subcommands, one file each.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace pliant {

/// What the command line asks for; returns the exit code.
using Work = std::function<int()>;

/// Each adds its subcommand with its options to `program` and sets `work` when that one was chosen.
void add_model_commands(CLI::App& program, Work& work);
void add_model_build(CLI::App& model, Work& work);
void add_model_info(CLI::App& model, Work& work);
void add_model_export(CLI::App& model, Work& work);
void add_model_capture(CLI::App& model, Work& work);
void add_run(CLI::App& program, Work& work);
void add_register(CLI::App& program, Work& work);
void add_record(CLI::App& program, Work& work);
void add_devices(CLI::App& program, Work& work);
void add_check(CLI::App& program, Work& work);
void add_view(CLI::App& program, Work& work);
void add_snapshot(CLI::App& program, Work& work);
void add_plot(CLI::App& program, Work& work);
void add_export(CLI::App& program, Work& work);

}  // namespace pliant
