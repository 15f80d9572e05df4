// Whether a run still does its work, judged from outside of its threads.
#pragma once

#include <cstdint>

namespace pliant {

/// Counts that only grow, taken at one moment.
struct Beats {
  std::uint64_t captured = 0;  ///< answers of the source: a frame, or that honestly none has come
  std::uint64_t begun = 0;     ///< frames that tracking has taken up
  std::uint64_t finished = 0;  ///< and done with, messages included
};

/// Alive: tracking finished a frame since the look before, or it has nothing to do and the source answered. A
/// frame that never ends, or a source that never answers, is no life.
class Liveness {
 public:
  /// Whether there was life since the last look that saw some. The first look sees it when anything moved at
  /// all.
  [[nodiscard]] bool look(const Beats& now) noexcept {
    const bool idle = now.begun == now.finished;
    const bool alive = now.finished != last_.finished || (idle && now.captured != last_.captured);
    if (alive) last_ = now;
    return alive;
  }

 private:
  Beats last_;
};

}  // namespace pliant
