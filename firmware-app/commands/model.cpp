// pliant model: the family of commands about model files.
#include "firmware-app/commands/commands.hpp"

namespace pliant {

void add_model_commands(CLI::App& program, Work& work) {
  CLI::App* model = program.add_subcommand("model", "Build, capture, inspect and export model files");
  model->require_subcommand(1);
  add_model_build(*model, work);
  add_model_capture(*model, work);
  add_model_info(*model, work);
  add_model_export(*model, work);
}

}  // namespace pliant
