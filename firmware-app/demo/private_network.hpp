// A network of the program's own, so that a demonstration needs none of the machine's.
#pragma once

#include <string>

namespace pliant::demo {

/// Moves the process into a network of its own whose loopback carries multicast. To be called before any
/// thread is started. Empty when done, else why not.
[[nodiscard]] std::string enter_private_network();

}  // namespace pliant::demo
