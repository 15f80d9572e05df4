// Work that can be done side by side. The core has no threads: who calls it may bring some.
#pragma once

#include <cstddef>

namespace pliant {

/// Runs the pieces of a task, in any order or at once; returns when all are done. Pieces write to places of
/// their own, so that the result does not depend on how they are shared out.
struct WorkSharer {
  using Piece = void (*)(void* task, std::size_t piece) noexcept;
  void (*run)(void* context, std::size_t pieces, Piece work, void* task) = nullptr;
  void* context = nullptr;

  /// Calls work(0) … work(pieces − 1), one after the other where nobody helps.
  template <typename Work>
  void share(std::size_t pieces, Work&& work) const noexcept {
    const auto call = [](void* task, std::size_t piece) noexcept { (*static_cast<Work*>(task))(piece); };
    if (run == nullptr || pieces < 2) {
      for (std::size_t piece = 0; piece < pieces; ++piece) work(piece);
    } else {
      run(context, pieces, call, &work);
    }
  }
};

}  // namespace pliant
