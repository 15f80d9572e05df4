// Publishes the status of a device that stands still after many bad frames, ten times a second until it is
// ended.
#include <chrono>
#include <lcm/lcm-cpp.hpp>
#include <thread>

#include "pliant/status_t.hpp"

int main() {
  lcm::LCM bus("udpm://239.255.76.67:7667?ttl=0");
  if (!bus.good()) return 2;
  pliant::status_t status{};
  status.version = "0";
  status.source = "ailing";
  status.frame = 99;
  status.device = pliant::status_t::DEVICE_STALLED;
  status.stream_fault = pliant::status_t::FAULT_ZERO;
  status.bad_frames = 30;
  status.zero_frames = 11;
  status.stuck_frames = 12;
  status.delayed_frames = 3;
  status.broken_frames = 4;
  status.slow_frames = 5;
  status.stalls = 6;
  status.reopenings = 8;
  while (bus.publish("PLIANT_STATUS", &status) == 0)
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  return 1;
}
