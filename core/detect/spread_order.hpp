// An order of points of which each prefix is spread over all of them.
#pragma once

#include <cstddef>

namespace pliant {

/// Steps of the golden ratio through 0 … count − 1, each once, from 0: at = next(at).
class SpreadOrder {
 public:
  explicit SpreadOrder(std::size_t count) noexcept : count_(count), stride_(count * 1000 / 1618 + 1) {
    while (stride_ > 1 && has_common_divisor(stride_)) --stride_;
  }
  [[nodiscard]] std::size_t next(std::size_t at) const noexcept { return (at + stride_) % count_; }

 private:
  [[nodiscard]] bool has_common_divisor(std::size_t b) const noexcept {
    std::size_t a = count_;
    while (b != 0) {
      const std::size_t rest = a % b;
      a = b;
      b = rest;
    }
    return a != 1;
  }

  std::size_t count_, stride_;
};

}  // namespace pliant
