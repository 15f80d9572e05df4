// What the programs that are compared across architectures share: pictures from memory, digests, marks.
#pragma once

#include <sys/syscall.h>
#include <unistd.h>

#include <bit>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "core/memory/workspace.hpp"
#include "core/track_settings.hpp"
#include "drivers/recording/recording.hpp"
#include "drivers/simulated/simulated.hpp"

namespace pliant::cross {

inline constexpr long kMark = 0x504C4E54;  // as in count_instructions.c
enum class Mark : long { frame_begins, stage_done, frame_done };

/// A harmless system call with marked arguments, by which the instruction counter (count_instructions.c)
/// tells frames and stages apart.
inline void mark(Mark what, long value) {
  (void)::syscall(SYS_getppid, kMark, static_cast<long>(what), value);
}

/// FNV-1a over bytes.
class Digest {
 public:
  template <typename T>
  void add(const T& value) {
    static_assert(std::has_unique_object_representations_v<T>);
    unsigned char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    for (const unsigned char b : bytes) hash_ = (hash_ ^ b) * 1099511628211ULL;
  }
  void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
  void add(float value) { add(std::bit_cast<std::uint32_t>(value)); }
  void add(const RigidTransform& pose) {
    for (int i = 0; i < 9; ++i) add(pose.rotation(i / 3, i % 3));
    for (int i = 0; i < 3; ++i) add(pose.translation[i]);
  }
  [[nodiscard]] unsigned long long value() const { return hash_; }

 private:
  std::uint64_t hash_ = 14695981039346656037ULL;
};

struct Options {
  Kernels kernels = Kernels::automatic;
  std::size_t frames = SIZE_MAX;
};

/// Reads "[--kernels K] [--frames N]" from `first` on; false where there is anything else.
inline bool parse(int count, char** words, int first, Options& options) {
  for (int i = first; i + 1 < count; i += 2) {
    const std::string name = words[i], value = words[i + 1];
    if (name == "--frames") {
      options.frames = static_cast<std::size_t>(std::atoll(value.c_str()));
    } else if (name == "--kernels") {
      const char* const names[] = {"auto", "scalar", "sse", "avx2", "neon"};
      for (int k = 0; k < 5; ++k)
        if (value == names[k]) options.kernels = static_cast<Kernels>(k);
    } else {
      return false;
    }
  }
  return true;
}

/// A recording's folder or "simulated:...".
inline Result<std::unique_ptr<DepthSource>> open(const std::string& source) {
  if (!source.starts_with("simulated:")) return open_recording(source);
  Result<std::unique_ptr<SimulatedSource>> simulated = open_simulated(source);
  if (!simulated) return simulated.error();
  return std::unique_ptr<DepthSource>(std::move(*simulated));
}

struct Picture {
  std::vector<std::uint16_t> depth;
  DepthFrame frame;
};

/// All pictures first: decoding is not counted. Closes the source.
inline std::vector<Picture> pictures_of(DepthSource& source, std::size_t most) {
  std::vector<Picture> pictures;
  SourceItem item;
  for (source.next(1000, item); item.event != SourceEvent::end && pictures.size() < most;
       source.next(1000, item)) {
    if (item.event != SourceEvent::frame) continue;
    Picture& p = pictures.emplace_back();
    for (int v = 0; v < item.frame.height; ++v) {
      const std::uint16_t* row = item.frame.depth + static_cast<std::ptrdiff_t>(v) * item.frame.stride;
      p.depth.insert(p.depth.end(), row, row + item.frame.width);
    }
    p.frame = item.frame;
    p.frame.stride = item.frame.width;
    p.frame.depth = p.depth.data();
  }
  source.close();
  return pictures;
}

/// Memory for what is replayed.
struct FreeBlock {
  void operator()(std::byte* block) const { std::free(block); }
};
inline std::unique_ptr<std::byte, FreeBlock> block_of(std::size_t bytes) {
  constexpr std::size_t kAlignment = Workspace::kAlignment;
  return std::unique_ptr<std::byte, FreeBlock>(static_cast<std::byte*>(
      std::aligned_alloc(kAlignment, (bytes + kAlignment - 1) / kAlignment * kAlignment)));
}

}  // namespace pliant::cross
