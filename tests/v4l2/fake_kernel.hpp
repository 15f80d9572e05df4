// A kernel with one depth camera, for the V4L2 driver's tests: it keeps the rules of V4L2, and any of its
// calls can be made to fail.
#pragma once

#include <linux/videodev2.h>

#include <cstring>
#include <map>
#include <string>
#include <vector>

#include "drivers/v4l2/v4l2_system.hpp"

namespace pliant::test {

class FakeKernel final : public V4l2System {
 public:
  // The camera.
  std::vector<std::uint32_t> formats = {V4L2_PIX_FMT_YUYV, V4L2_PIX_FMT_Z16};
  std::string bus = "usb-0000:00:14.0-2", path = "/dev/video2";
  std::vector<std::uint32_t> other_formats;  ///< of the camera's other node, /dev/video0; without any, none
  bool multi_planar = false, plugged = true, is_capture = true;
  bool used_elsewhere = false;            ///< another program streams from it
  std::uint32_t width = 64, height = 48;  ///< the only size that it has
  std::uint32_t padding = 0;              ///< bytes behind each row
  int open_error = 0;                     ///< of open()
  std::uint32_t buffers_given = 4;
  // The frames.
  std::int64_t frame_us = 1000;      ///< between frames
  std::int64_t stamp_offset_us = 0;  ///< of the clock that frames are stamped by
  std::uint32_t used = 0;            ///< bytes of a frame; 0 for all
  std::uint32_t flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
  std::uint32_t sequence_step = 1;
  std::uint32_t index_offset = 0;  ///< added to the index of a buffer, a lie
  bool silent = false;
  std::vector<std::byte> picture;  ///< what every frame holds
  // Failures: call number `fail_at` (from 1) gives `fail_with`; so do those after it where `fail_on` is set.
  int calls = 0, fail_at = 0, fail_with = 0;
  bool fail_on = false;
  // What is in use.
  int open_files = 0, maps = 0;
  std::int64_t now_us = 1'000'000'000, wall_offset_us = 1'700'000'000'000'000;

  std::vector<std::string> nodes() override { return {"/dev/video0", path}; }
  int open(const char* name) override;
  int close(int file) override;
  int ioctl(int file, unsigned long request, void* argument) override;
  void* map(std::size_t length, int file, std::int64_t offset) override;
  int unmap(void* memory, std::size_t length) override;
  int poll(int file, int timeout_ms, short& events) override;
  std::int64_t monotonic_us() override { return now_us; }
  std::int64_t wall_us() override { return now_us + wall_offset_us; }

 private:
  [[nodiscard]] bool fails();
  [[nodiscard]] std::uint32_t row_bytes() const;
  [[nodiscard]] std::uint32_t image_bytes() const;
  int answer(unsigned long request, void* argument);
  int set_format(v4l2_format& format);
  int dequeue(v4l2_buffer& buffer);

  std::uint32_t code_ = V4L2_PIX_FMT_YUYV;
  std::vector<std::vector<std::byte>> memory_;
  std::vector<std::uint32_t> queue_;
  bool streaming_ = false;
  std::uint32_t sequence_ = 0;
  std::int64_t due_us_ = 0;
};

}  // namespace pliant::test
