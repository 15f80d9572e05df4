// Playback of .oni recordings.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <thread>
#include <utility>
#include <vector>

#include "drivers/openni2/oni_layout.hpp"
#include "drivers/openni2/openni2.hpp"
#include "drivers/openni2/openni2_stream.hpp"
#include "drivers/openni2/thread_watch.hpp"

namespace pliant {

namespace {

using Clock = std::chrono::steady_clock;

/// After its last frame the library says nothing at all; a frame that it announced and does not bring in this
/// time does not come.
constexpr auto kLongestGap = std::chrono::seconds(3);

/// The library's thread (PlayerDevice::MainLoop) looks through the list of streams without the lock under
/// which one is taken out of it. It does so between two frames only, and, at the end of a file that is not
/// repeated, without pause: then it reads memory that is free. So the file is repeated and stands still until
/// a frame is asked for, which leaves the thread waiting to hand out the next one, and it is given this time
/// to get there: it runs from the moment the file is open, whether the stream was ever started or not.
constexpr auto kToRest = std::chrono::milliseconds(30);

/// Told to end before it began, that thread never hears of it: it is killed after 3 s, while what it looks
/// through is freed. A busy machine may well keep it from beginning for as long as opening takes.
constexpr auto kLongestToBegin = std::chrono::seconds(10);

class OniFile final : public DepthSource {
 public:
  OniFile(std::shared_ptr<OpenNi2Library> library, const SensorDescription& sensor)
      : library_(std::move(library)), sensor_(sensor), stream_(library_) {}
  OniFile(const OniFile&) = delete;
  OniFile& operator=(const OniFile&) = delete;
  ~OniFile() override { close(); }

  [[nodiscard]] Outcome open(const std::string& file, const SourceWish& wish) {
    const std::vector<int> before = threads_now();
    const Outcome opened = stream_.open(file);
    const std::vector<int> now = threads_now();
    std::set_difference(now.begin(), now.end(), before.begin(), before.end(),
                        std::back_inserter(library_threads_));
    if (!opened) return opened;
    // By hand instead of by the clock: a frame is read when it is asked for, and none is left out.
    if (const OniStatus status = play_by_hand(); status != ONI_STATUS_OK)
      return library_->fault("the speed of playback cannot be set", status);
    if (const OniStatus status = repeat(); status != ONI_STATUS_OK)
      return library_->fault("repeating cannot be switched on", status);
    if (Outcome done = stream_.learn(wish); !done) return done;
    int count = 0;
    if (!stream_.get(ONI_STREAM_PROPERTY_NUMBER_OF_FRAMES, count) || count < 1)
      return Error{ErrorKind::bad_input, "the recording holds no depth frame"};
    count_ = count;
    if (stream_.mirrored())
      turned_.resize(static_cast<std::size_t>(stream_.camera().width) *
                     static_cast<std::size_t>(stream_.camera().height));
    return stream_.start();
  }
  [[nodiscard]] const Intrinsics& intrinsics() const override { return stream_.camera(); }
  [[nodiscard]] const SensorDescription& sensor() const override { return sensor_; }
  [[nodiscard]] bool live() const override { return false; }
  [[nodiscard]] double rate() const override { return stream_.rate(); }
  [[nodiscard]] std::int64_t frame_count() const override { return count_; }
  void close() override {
    if (stream_.device() != nullptr) {
      // again, since opening may have failed before it came to that
      static_cast<void>(play_by_hand());
      static_cast<void>(repeat());
      const Clock::time_point latest = Clock::now() + kLongestToBegin;
      do std::this_thread::sleep_for(kToRest);
      while (!have_all_waited(library_threads_) && Clock::now() < latest);
    }
    stream_.close();
    closed_ = true;
  }

  void next(int timeout_ms, SourceItem& item) override {
    item.frame = {};
    item.fault.clear();
    item.event = SourceEvent::end;
    if (closed_ || number_ >= count_) return;
    if (!waiting_) {
      waiting_ = true;
      last_ = Clock::now();
    }
    switch (stream_.read(timeout_ms, item.frame, item.fault)) {
      case OpenNi2Stream::Got::frame:
        if (item.frame.number <= index_ && item.frame.utime <= stamp_) {
          closed_ = true;  // it begins anew: fewer frames than were announced
          item.frame = {};
          return;
        }
        index_ = item.frame.number;
        stamp_ = item.frame.utime;
        item.event = SourceEvent::frame;
        if (stream_.mirrored()) turn(item.frame);
        break;
      case OpenNi2Stream::Got::unfit:
        item.event = SourceEvent::bad_frame;
        break;
      case OpenNi2Stream::Got::timeout:
        if (Clock::now() - last_ < kLongestGap) {
          item.event = SourceEvent::timeout;
          return;
        }
        closed_ = true;  // cut off: what was announced is not there
        return;
      case OpenNi2Stream::Got::failed:
        item.event = SourceEvent::lost;
        return;
    }
    waiting_ = false;
    item.frame.number = number_++;
  }

 private:
  OniStatus play_by_hand() const {
    const float speed = -1;
    return library_->api().device_set(stream_.device(), ONI_DEVICE_PROPERTY_PLAYBACK_SPEED, &speed,
                                      sizeof speed);
  }
  OniStatus repeat() const {
    const OniBool on = TRUE;
    return library_->api().device_set(stream_.device(), ONI_DEVICE_PROPERTY_PLAYBACK_REPEAT_ENABLED, &on,
                                      sizeof on);
  }
  void turn(DepthFrame& frame) {
    const auto width = static_cast<std::size_t>(frame.width), height = static_cast<std::size_t>(frame.height);
    if (width * height > turned_.size()) return;  // another size; whoever takes it refuses it
    for (std::size_t v = 0; v < height; ++v) {
      const std::uint16_t* row = frame.depth + static_cast<std::ptrdiff_t>(v) * frame.stride;
      for (std::size_t u = 0; u < width; ++u) turned_[v * width + u] = row[width - 1 - u];
    }
    frame.depth = turned_.data();
    frame.stride = frame.width;
  }

  std::shared_ptr<OpenNi2Library> library_;
  SensorDescription sensor_;
  OpenNi2Stream stream_;
  std::vector<int> library_threads_;  ///< that began with opening the file
  std::vector<std::uint16_t> turned_;
  std::int64_t count_ = 0, number_ = 0;
  std::int64_t index_ = -1, stamp_ = -1;  // the library's own, of the latest frame
  Clock::time_point last_;
  bool waiting_ = false, closed_ = false;
};

}  // namespace

Result<std::unique_ptr<DepthSource>> open_oni(std::shared_ptr<OpenNi2Library> library,
                                              const std::filesystem::path& file, const SourceWish& wish) {
  // The library's own messages name neither the file nor what is wrong with it.
  if (const Outcome sound = check_oni_layout(file); !sound) return sound.error();
  auto source = std::make_unique<OniFile>(std::move(library), wish.sensor);
  if (const Outcome opened = source->open(std::filesystem::absolute(file).string(), wish); !opened)
    return Error{ErrorKind::bad_input, fmt::format("{}: {}", file.string(), opened.error().message)};
  return std::unique_ptr<DepthSource>(std::move(source));
}

}  // namespace pliant
