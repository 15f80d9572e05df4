// A machine so busy that a library's thread has no processor until long after it was started: this program's
// own pthread_create and pthread_cancel go before the C library's.
#include <dlfcn.h>
#include <gtest/gtest.h>
#include <pthread.h>

#include <atomic>
#include <chrono>
#include <memory>

#include "drivers/openni2/openni2.hpp"
#include "tests/openni2/sensor_rig.hpp"

namespace {

struct Machine {
  static inline std::atomic<int> late_by = 0;  // milliseconds
  static inline std::atomic<int> cancelled = 0;
};

struct Start {
  void* (*run)(void*);
  void* argument;
  std::chrono::milliseconds late_by;
};

/// Busy, so that to the kernel it has not waited.
void* begin_late(void* given) {
  const std::unique_ptr<Start> start(static_cast<Start*>(given));
  const auto from = std::chrono::steady_clock::now();
  while (std::chrono::steady_clock::now() - from < start->late_by) continue;
  return start->run(start->argument);
}

}  // namespace

extern "C" __attribute__((visibility("default"))) int pthread_create(pthread_t* thread,
                                                                     const pthread_attr_t* attributes,
                                                                     void* (*run)(void*), void* argument) {
  static const auto real = reinterpret_cast<decltype(&pthread_create)>(dlsym(RTLD_NEXT, "pthread_create"));
  if (Machine::late_by == 0) return real(thread, attributes, run, argument);
  auto start = std::make_unique<Start>(Start{run, argument, std::chrono::milliseconds(Machine::late_by)});
  const int fault = real(thread, attributes, &begin_late, start.get());
  if (fault == 0) static_cast<void>(start.release());
  return fault;
}

extern "C" __attribute__((visibility("default"))) int pthread_cancel(pthread_t thread) {
  static const auto real = reinterpret_cast<decltype(&pthread_cancel)>(dlsym(RTLD_NEXT, "pthread_cancel"));
  ++Machine::cancelled;
  return real(thread);
}

namespace pliant::test {
namespace {

TEST(LateThread, OfAFileWithoutADepthStreamIsWaitedForBeforeItIsToldToEnd) {
  const SensorRig rig;
  rig.control().rate = 60;
  const std::filesystem::path file = rig.folder() / "five.oni";
  rig.record_oni(file, 5);
  OpenNi2Api api;  // with a stream, the library itself waits for a thread
  api.create_stream = [](OniDeviceHandle, OniSensorType, OniStreamHandle*) { return ONI_STATUS_ERROR; };
  auto library = OpenNi2Library::start(nullptr, api);
  ASSERT_TRUE(library) << library.error().message;
  for (const int late_by : {60, 300}) {
    Machine::cancelled = 0;
    Machine::late_by = late_by;
    const auto source = open_oni(*library, file, {});
    Machine::late_by = 0;
    EXPECT_FALSE(source);
    EXPECT_EQ(Machine::cancelled, 0) << "a thread that began " << late_by << " ms late";
  }
}

}  // namespace
}  // namespace pliant::test
