// pliant record: any source becomes a recording; a simulated one with its truth.
#include <fmt/format.h>

#include <memory>

#include "drivers/recording/depth_list.hpp"
#include "drivers/recording/recording_writer.hpp"
#include "drivers/simulated/truth_writer.hpp"
#include "firmware-app/commands/commands.hpp"
#include "firmware-app/commands/console.hpp"
#include "firmware-app/commands/inputs.hpp"
#include "firmware-app/commands/named_files.hpp"
#include "firmware-app/commands/option_checks.hpp"
#include "firmware-app/pipeline/recording_thread.hpp"
#include "firmware-app/pipeline/stop_signal.hpp"

namespace pliant {

namespace {

struct RecordOptions {
  std::string source, output, sensor;
  std::int64_t frames = -1;
};

/// What the frames of a source become.
class Recorder {
 public:
  [[nodiscard]] Outcome open(const std::string& folder, const OpenSource& source,
                             const SensorDescription& sensor) {
    Result<std::unique_ptr<RecordingWriter>> writer =
        RecordingWriter::create(folder, {source.source->intrinsics(), sensor});
    if (!writer) return writer.error();
    writer_ = std::move(*writer);
    if (source.source->live())
      thread_ = std::make_unique<RecordingThread>(*writer_, source.source->intrinsics());
    simulated_ = source.simulated;
    if (simulated_ == nullptr) return success();
    Result<std::unique_ptr<TruthWriter>> truth = TruthWriter::create(folder, simulated_->mesh());
    if (!truth) return truth.error();
    truth_ = std::move(*truth);
    return success();
  }
  /// A live source's frames wait for the disk in a queue, any other's are written at once.
  [[nodiscard]] Outcome write(const DepthFrame& frame) {
    if (thread_ != nullptr) {
      thread_->push(frame);
      return thread_->state();
    }
    const std::int64_t position = writer_->frames();
    if (Outcome written = writer_->write(frame); !written) return written;
    if (simulated_ == nullptr) return success();
    const SimulatedTruth& truth = simulated_->truth();
    if (truth.present)
      if (Outcome written = writer_->write_truth(frame.utime, truth.parts.front()); !written) return written;
    return truth_->write(position, truth);
  }
  [[nodiscard]] Outcome finish() {
    if (thread_ != nullptr)
      if (Outcome done = thread_->finish(); !done) return done;
    if (truth_)
      if (Outcome done = truth_->finish(); !done) return done;
    return writer_->finish();
  }
  [[nodiscard]] std::int64_t frames() const {
    return thread_ != nullptr ? thread_->written() : writer_->frames();
  }
  [[nodiscard]] std::int64_t dropped() const { return thread_ != nullptr ? thread_->dropped() : 0; }

 private:
  std::unique_ptr<RecordingWriter> writer_;
  std::unique_ptr<RecordingThread> thread_;
  std::unique_ptr<TruthWriter> truth_;
  const SimulatedSource* simulated_ = nullptr;
};

int record(const RecordOptions& options) {
  const StopSignal stop;
  const Outcome apart = NamedFiles()
                            .reads_source("--source", options.source)
                            .reads("--sensor", options.sensor)
                            .writes("--output", options.output)
                            .apart();
  if (!apart) return report(apart.error());
  SourceOptions source_options;
  source_options.keeps_frames = true;
  if (!options.sensor.empty()) {
    const Result<SensorFile> sensor = read_sensor(options.sensor);
    if (!sensor) return report(sensor.error());
    source_options.sensor = *sensor;
  }
  Result<OpenSource> source = open_source(options.source, source_options);
  if (!source) return report(source.error());
  Recorder recorder;
  if (const Outcome opened =
          recorder.open(options.output, *source, sensor_of(*source->source, source_options));
      !opened)
    return report(opened.error());

  LiveLine line;
  SourceItem item;
  std::int64_t taken = 0, bad_frames = 0, latest = -1;
  std::string fault;
  Outcome failure = success();
  while (!StopSignal::requested() && (options.frames < 0 || taken < options.frames)) {
    source->source->next(100, item);
    if (item.event == SourceEvent::end || item.event == SourceEvent::lost) break;
    if (item.event == SourceEvent::timeout) continue;
    ++taken;
    latest = item.frame.number;
    if (item.event == SourceEvent::frame && !is_listable(item.frame.utime)) {
      item.event = SourceEvent::bad_frame;
      item.fault = fmt::format("frame {} has a stamp of {} microseconds, which no recording can hold",
                               item.frame.number, item.frame.utime);
    }
    if (item.event == SourceEvent::bad_frame) {
      ++bad_frames;
      fault = item.fault;
      continue;
    }
    failure = recorder.write(item.frame);
    if (!failure) break;
    line.show(fmt::format("recorded {} frames", recorder.frames()));
  }
  line.clear();
  if (Outcome finished = recorder.finish(); failure && !finished) failure = finished;
  std::string summary = fmt::format("recorded {} frames to {}", recorder.frames(), options.output);
  if (bad_frames > 0) summary += fmt::format(", left out {} bad ones (the last: {})", bad_frames, fault);
  if (source->source->live() && latest >= taken)
    summary += fmt::format(", missed {} that were not fetched in time", latest + 1 - taken);
  if (recorder.dropped() > 0)
    summary += fmt::format(", dropped {} that the disk had no time for", recorder.dropped());
  if (!failure) {
    // What stands in the folder is a whole recording of so many frames.
    static_cast<void>(print(summary + "\n"));
    return report(failure.error());
  }
  if (!print(summary + "\n")) return kExitFailed;
  if (item.event == SourceEvent::lost) return report({ErrorKind::device, item.fault});
  if (recorder.frames() == 0 && !StopSignal::requested())
    return report(
        {ErrorKind::bad_input, fault.empty() ? "the source has no frame" : "no frame is usable: " + fault});
  return kExitDone;
}

}  // namespace

void add_record(CLI::App& program, Work& work) {
  CLI::App* app = program.add_subcommand("record", "Write the frames of a source as a recording");
  auto options = std::make_shared<RecordOptions>();
  app->add_option("--source", options->source, kSourceHelp)->required()->type_name("URI");
  app->add_option("-o,--output", options->output, "Folder of the new recording")
      ->required()
      ->check(names_a_folder())
      ->type_name("DIR");
  app->add_option("--sensor", options->sensor,
                  "Sensor description (TOML): mode, camera and noise of a device, noise of any other source")
      ->check(names_a_file())
      ->type_name("FILE");
  app->add_option("--frames", options->frames, "Take this many frames from the source")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1} << 62).description(""))
      ->type_name("N");
  app->callback([options, &work] { work = [options] { return record(*options); }; });
}

}  // namespace pliant
