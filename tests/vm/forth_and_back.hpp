// The order in which cameras of the tests play their pictures.
#pragma once

#include <cstddef>

namespace pliant::test {

/// Of `pictures`, two at least, the one that comes as number `count`: 0, 1, …, last, …, 1, 0, 1, …
[[nodiscard]] constexpr std::size_t forth_and_back(std::size_t count, std::size_t pictures) {
  const std::size_t last = pictures - 1, turn = count % (2 * last);
  return turn <= last ? turn : 2 * last - turn;
}

}  // namespace pliant::test
