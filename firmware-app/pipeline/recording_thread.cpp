#include "firmware-app/pipeline/recording_thread.hpp"

#include <csignal>
#include <cstring>

namespace pliant {

RecordingThread::RecordingThread(RecordingWriter& writer, const Intrinsics& camera)
    : writer_(writer), slots_(kSlots) {
  for (Slot& slot : slots_)
    slot.pixels.resize(static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height));
  // Signals go to the main thread, which ends the recording.
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  thread_ = std::thread([this] { run(); });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

RecordingThread::~RecordingThread() {
  static_cast<void>(finish());
}

void RecordingThread::push(const DepthFrame& frame) {
  Slot* slot = nullptr;
  {
    const std::lock_guard lock(mutex_);
    if (waiting_ == slots_.size() || !state_) {
      ++dropped_;
      return;
    }
    slot = &slots_[(first_ + waiting_) % slots_.size()];
  }
  // The slot is this thread's until `waiting_` counts it.
  slot->frame = frame;
  slot->frame.depth = slot->pixels.data();
  slot->frame.stride = frame.width;
  const auto width = static_cast<std::size_t>(frame.width);
  slot->pixels.resize(width * static_cast<std::size_t>(frame.height));
  for (int v = 0; v < frame.height; ++v)
    std::memcpy(slot->pixels.data() + static_cast<std::size_t>(v) * width,
                frame.depth + static_cast<std::ptrdiff_t>(v) * frame.stride, width * sizeof(std::uint16_t));
  slot->frame.depth = slot->pixels.data();
  const std::lock_guard lock(mutex_);
  ++waiting_;
  changed_.notify_all();
}

void RecordingThread::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return stop_ || waiting_ > 0; });
    if (waiting_ == 0) return;
    const DepthFrame frame = slots_[first_].frame;
    lock.unlock();
    Outcome written = writer_.write(frame);
    lock.lock();
    first_ = (first_ + 1) % slots_.size();
    --waiting_;
    if (written) {
      ++written_;
      continue;
    }
    dropped_ += static_cast<std::int64_t>(waiting_) + 1;
    waiting_ = 0;
    state_ = written;
    return;
  }
}

Outcome RecordingThread::state() const {
  const std::lock_guard lock(mutex_);
  return state_;
}

Outcome RecordingThread::finish() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
    changed_.notify_all();
  }
  if (thread_.joinable()) thread_.join();
  return state();
}

std::int64_t RecordingThread::dropped() const {
  const std::lock_guard lock(mutex_);
  return dropped_;
}

std::int64_t RecordingThread::written() const {
  const std::lock_guard lock(mutex_);
  return written_;
}

}  // namespace pliant
