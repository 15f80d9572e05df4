// simulated_export OPTIONS FOLDER: writes the recording and the truth of a simulated source, for example
// simulated_export "cushion?frames=120" /tmp/cushion
#include <fmt/core.h>

#include <cstdio>
#include <string>

#include "drivers/recording/recording_writer.hpp"
#include "drivers/simulated/simulated.hpp"
#include "drivers/simulated/truth_writer.hpp"

namespace pliant {
namespace {

int fail(const Error& error) {
  fmt::print(stderr, "simulated_export: {}\n", error.message);
  return error.kind == ErrorKind::bad_input ? 2 : 3;
}

int export_all(const char* options, const char* folder) {
  auto source = open_simulated(options);
  if (!source) return fail(source.error());
  auto recording = RecordingWriter::create(folder, {(*source)->intrinsics(), (*source)->sensor()});
  if (!recording) return fail(recording.error());
  auto truth = TruthWriter::create(folder, (*source)->mesh());
  if (!truth) return fail(truth.error());
  SourceItem item;
  for ((*source)->next(0, item); item.event == SourceEvent::frame; (*source)->next(0, item)) {
    const SimulatedTruth& now = (*source)->truth();
    const std::int64_t position = (*recording)->frames();
    if (Outcome done = (*recording)->write(item.frame); !done) return fail(done.error());
    if (now.present)
      if (Outcome done = (*recording)->write_truth(now.utime, now.parts[0]); !done) return fail(done.error());
    if (Outcome done = (*truth)->write(position, now); !done) return fail(done.error());
  }
  if (Outcome done = (*recording)->finish(); !done) return fail(done.error());
  if (Outcome done = (*truth)->finish(); !done) return fail(done.error());
  fmt::print("{}: {} frames\n", folder, (*recording)->frames());
  return 0;
}

}  // namespace
}  // namespace pliant

int main(int count, char** arguments) {
  if (count != 3) {
    std::fputs("usage: simulated_export OPTIONS FOLDER\n", stderr);
    return 2;
  }
  return pliant::export_all(arguments[1], arguments[2]);
}
