#include "drivers/recording/recording.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "drivers/images/png.hpp"
#include "drivers/recording/camera_file.hpp"
#include "drivers/recording/depth_list.hpp"

namespace pliant {

namespace {

/// A decoded picture, or why there is none.
struct Slot {
  GreyImage16 image;
  std::string fault;
};

class Recording final : public DepthSource {
 public:
  Recording(std::filesystem::path folder, const CameraFile& camera, std::vector<DepthListEntry> entries)
      : folder_(std::move(folder)), camera_(camera), entries_(std::move(entries)) {
    const auto pixels = static_cast<std::size_t>(camera.intrinsics.width) *
                        static_cast<std::size_t>(camera.intrinsics.height);
    for (Slot& slot : slots_) {
      slot.image.pixels.reserve(pixels);
      slot.fault.reserve(256);
    }
    decoder_ = std::thread([this] { decode_all(); });
  }
  ~Recording() override { stop(); }
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

  [[nodiscard]] const Intrinsics& intrinsics() const override { return camera_.intrinsics; }
  [[nodiscard]] const SensorDescription& sensor() const override { return camera_.sensor; }
  [[nodiscard]] bool live() const override { return false; }
  [[nodiscard]] std::int64_t frame_count() const override {
    return static_cast<std::int64_t>(entries_.size());
  }

  void next(int timeout_ms, SourceItem& item) override {
    item.frame = {};
    item.fault.clear();
    std::unique_lock lock(mutex_);
    if (held_) {  // the borrowed frame goes back
      held_ = false;
      ++taken_;
      changed_.notify_all();
    }
    item.event = SourceEvent::end;
    if (closed_ || taken_ == entries_.size()) return;
    item.event = SourceEvent::timeout;
    const auto patience = std::chrono::milliseconds(std::max(timeout_ms, 0));
    if (!changed_.wait_for(lock, patience, [this] { return decoded_ > taken_; })) return;
    held_ = true;
    const Slot& slot = slots_[taken_ % slots_.size()];
    item.frame.number = static_cast<std::int64_t>(taken_);
    item.frame.utime = entries_[taken_].utime;
    if (!slot.fault.empty()) {
      item.event = SourceEvent::bad_frame;
      item.fault = slot.fault;
      return;
    }
    item.event = SourceEvent::frame;
    item.frame.depth = slot.image.pixels.data();
    item.frame.width = item.frame.stride = slot.image.width;
    item.frame.height = slot.image.height;
  }

  void close() override { stop(); }

 private:
  void stop() {
    {
      const std::lock_guard lock(mutex_);
      closed_ = true;
      changed_.notify_all();
    }
    if (decoder_.joinable()) decoder_.join();
  }

  void decode_all() {
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return closed_ || i < taken_ + slots_.size(); });
        if (closed_) return;
      }
      decode(entries_[i], slots_[i % slots_.size()]);
      const std::lock_guard lock(mutex_);
      decoded_ = i + 1;
      changed_.notify_all();
    }
  }

  /// The slot is the decoder's alone until `decoded_` passes it.
  void decode(const DepthListEntry& entry, Slot& slot) {
    slot.fault.clear();
    const std::filesystem::path file = folder_ / entry.file;
    if (const Outcome read = reader_.read(file, slot.image); !read) {
      slot.fault = read.error().message;
      return;
    }
    const Intrinsics& camera = camera_.intrinsics;
    if (slot.image.width != camera.width || slot.image.height != camera.height)
      slot.fault = fmt::format("{}: {}x{} pixels; camera.toml says {}x{}", file.string(), slot.image.width,
                               slot.image.height, camera.width, camera.height);
  }

  std::filesystem::path folder_;
  CameraFile camera_;
  std::vector<DepthListEntry> entries_;
  PngReader reader_;
  std::array<Slot, 3> slots_;  ///< frame i lives in slot i mod 3: one borrowed, two decoded ahead

  std::mutex mutex_;
  std::condition_variable changed_;
  std::size_t taken_ = 0;    ///< frames given back by the caller
  std::size_t decoded_ = 0;  ///< frames ready or gone
  bool held_ = false;        ///< frame `taken_` is borrowed
  bool closed_ = false;
  std::thread decoder_;
};

}  // namespace

Result<std::unique_ptr<DepthSource>> open_recording(const std::filesystem::path& folder) {
  constexpr const char* kWhatItIs = "a recording is a folder with camera.toml and depth.txt";
  std::error_code status;
  if (folder.empty()) return Error{ErrorKind::bad_input, "recording: names no folder; write recording:DIR"};
  if (!std::filesystem::is_directory(folder, status)) {
    if (!std::filesystem::exists(folder, status))
      return Error{ErrorKind::bad_input, fmt::format("{}: no such recording", folder.string())};
    return Error{ErrorKind::bad_input, fmt::format("{}: not a folder; {}", folder.string(), kWhatItIs)};
  }
  for (const char* const file : {"camera.toml", "depth.txt"})
    if (!std::filesystem::exists(folder / file, status))
      return Error{ErrorKind::bad_input,
                   fmt::format("{}: holds no {}; {}", folder.string(), file, kWhatItIs)};
  const Result<CameraFile> camera = read_camera(folder / "camera.toml");
  if (!camera) return camera.error();
  Result<std::vector<DepthListEntry>> entries = read_depth_list(folder);
  if (!entries) return entries.error();
  return std::unique_ptr<DepthSource>(std::make_unique<Recording>(folder, *camera, std::move(*entries)));
}

}  // namespace pliant
