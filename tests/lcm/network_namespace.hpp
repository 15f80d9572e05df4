// A network of the test's own: one loopback interface, whose multicast route can be taken away and put back.
#pragma once

namespace pliant {

/// Moves this process, before it has further threads, into a fresh network namespace. Null when done, else
/// why not.
[[nodiscard]] const char* enter_network_namespace();
/// Puts the route for 224.0.0.0/4 to the loopback interface, or takes it away.
[[nodiscard]] bool set_multicast_route(bool present);

}  // namespace pliant
