// The buffers that the kernel fills.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "drivers/v4l2/v4l2_node.hpp"

namespace pliant {

/// A buffer that was filled.
struct V4l2Filled {
  std::uint32_t index = 0;
  std::span<const std::byte> bytes;  ///< the part that the kernel filled
  bool faulty = false;               ///< the kernel says that its content may be damaged
  std::uint32_t sequence = 0;
  std::int64_t stamp_us = 0;  ///< monotonic; 0 where the kernel gives none
};

/// Requested, mapped and queued by start(); given back by stop() or the destructor. The file must outlive it.
class V4l2Buffers {
 public:
  static constexpr std::uint32_t kCount =
      4;  ///< one with the tracker, one being filled, two for late scheduling

  V4l2Buffers(V4l2System& system, const V4l2File& file, bool multi_planar)
      : system_(system), file_(file), multi_planar_(multi_planar) {}
  ~V4l2Buffers() { stop(); }
  V4l2Buffers(const V4l2Buffers&) = delete;
  V4l2Buffers& operator=(const V4l2Buffers&) = delete;

  /// `least_bytes` of a buffer. Streams when it succeeds.
  [[nodiscard]] Outcome start(const std::string& path, std::size_t least_bytes);
  void stop();
  /// 0, or the errno of VIDIOC_DQBUF; EPROTO where what the kernel says cannot be true.
  [[nodiscard]] int take(V4l2Filled& filled);
  /// 0, or the errno of VIDIOC_QBUF.
  [[nodiscard]] int give_back(std::uint32_t index);

 private:
  struct Mapped {
    void* memory = nullptr;
    std::size_t length = 0;
  };
  [[nodiscard]] std::uint32_t type() const;

  V4l2System& system_;
  const V4l2File& file_;
  bool multi_planar_;
  std::vector<Mapped> buffers_;
  bool requested_ = false, streaming_ = false;
};

}  // namespace pliant
