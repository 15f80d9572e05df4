#include "drivers/lcm/depth_log.hpp"

#include <string>
#include <utility>

#include "drivers/lcm/depth_assembler.hpp"
#include "drivers/lcm/lcm_log.hpp"

namespace pliant {

namespace {

class DepthLog final : public DepthSource {
 public:
  DepthLog(LcmLog log, const DepthMessage& first, std::string channel, const SensorDescription& sensor)
      : log_(std::move(log)),
        camera_(first.camera),
        sensor_(sensor),
        channel_(std::move(channel)),
        assembler_(camera_),
        message_(first),
        waiting_(true) {}
  [[nodiscard]] const Intrinsics& intrinsics() const override { return camera_; }
  [[nodiscard]] const SensorDescription& sensor() const override { return sensor_; }
  [[nodiscard]] bool live() const override { return false; }
  void close() override { closed_ = true; }

  void next(int /*timeout_ms*/, SourceItem& item) override {
    item.frame = {};
    item.fault.clear();
    item.event = SourceEvent::end;
    if (closed_) return;
    while (waiting_ || read()) {
      if (assembler_.begins_another(message_)) {
        assembler_.give_up();  // the message waits for the next call
        return spoilt(item, "parts of a picture are missing");
      }
      waiting_ = false;
      if (!assembler_.fits(message_)) {
        // Told once a picture, by its first part.
        if (message_.part == 0) return spoilt(item, "a picture of another size or unit");
        continue;
      }
      if (!assembler_.take(message_)) continue;
      item.event = SourceEvent::frame;
      item.frame = assembler_.frame();
      item.frame.number = number_++;
      return;
    }
    closed_ = true;
    if (assembler_.begun()) spoilt(item, "the log ends inside a picture");
  }

 private:
  void spoilt(SourceItem& item, const char* why) {
    item.event = SourceEvent::bad_frame;
    item.frame.number = number_++;
    item.fault = std::string("LCM log: ") + why;
  }
  bool read() {
    while (log_.next(event_))
      if (event_.channel == channel_ && decode(event_.body, message_)) return waiting_ = true;
    return false;
  }

  LcmLog log_;
  Intrinsics camera_;
  SensorDescription sensor_;
  std::string channel_;
  DepthAssembler assembler_;
  LcmLogEvent event_;
  DepthMessage message_;
  bool waiting_, closed_ = false;
  std::int64_t number_ = 0;
};

}  // namespace

Result<std::unique_ptr<DepthSource>> open_depth_log(const std::filesystem::path& file,
                                                    const SensorDescription& sensor) {
  Result<LcmLog> log = LcmLog::open(file);
  if (!log) return log.error();
  LcmLogEvent event;
  DepthMessage message;
  while (log->next(event))
    if (decode(event.body, message))
      return std::unique_ptr<DepthSource>(
          std::make_unique<DepthLog>(std::move(*log), message, event.channel, sensor));
  return Error{
      ErrorKind::bad_input,
      "LCM log '" + file.string() + "': holds no depth pictures; 'pliant run --publish-depth' sends them"};
}

}  // namespace pliant
