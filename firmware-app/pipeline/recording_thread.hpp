// Writes a live source's frames on a thread of its own, so that a slow disk does not hold up the device.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>
#include <vector>

#include "drivers/recording/recording_writer.hpp"

namespace pliant {

class RecordingThread {
 public:
  /// Frames that can wait for the disk: about half a second at 30 Hz, 10 MB at 640×480.
  static constexpr std::size_t kSlots = 16;

  /// The writer is borrowed, and used by the thread alone until finish().
  RecordingThread(RecordingWriter& writer, const Intrinsics& camera);
  ~RecordingThread();
  RecordingThread(const RecordingThread&) = delete;
  RecordingThread& operator=(const RecordingThread&) = delete;

  /// Copies the frame in. Where all slots wait for the disk the frame is dropped and counted. Never waits.
  void push(const DepthFrame& frame);
  /// The first failed write; after it nothing more is written.
  [[nodiscard]] Outcome state() const;
  /// Writes what waits and ends the thread.
  [[nodiscard]] Outcome finish();
  [[nodiscard]] std::int64_t dropped() const;
  [[nodiscard]] std::int64_t written() const;

 private:
  struct Slot {
    std::vector<std::uint16_t> pixels;
    DepthFrame frame;
  };
  void run();

  RecordingWriter& writer_;
  std::vector<Slot> slots_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::size_t first_ = 0, waiting_ = 0;  // slots in use, from `first_` on
  std::int64_t dropped_ = 0, written_ = 0;
  bool stop_ = false;
  Outcome state_ = success();
  std::thread thread_;
};

}  // namespace pliant
