// Every call of the library fails once: each time an error with a reason, or frames all the same.
#include <gtest/gtest.h>

#include <type_traits>

#include "drivers/openni2/openni2.hpp"
#include "tests/openni2/sensor_rig.hpp"

namespace pliant::test {
namespace {

struct Sweep {
  static inline int calls = 0, fail_at = 0;
  static inline OniStatus status = ONI_STATUS_ERROR;
  static bool fails() { return ++calls == fail_at; }
};

/// `Real`, but for the call whose turn it is. What must happen in any case (`Always`) happens.
template <auto Real, bool Always = false>
struct Failing;
template <typename R, typename... A, R (*Real)(A...), bool Always>
struct Failing<Real, Always> {
  static R call(A... arguments) {
    if (!Sweep::fails()) return Real(arguments...);
    if constexpr (Always) static_cast<void>(Real(arguments...));
    if constexpr (std::is_same_v<R, OniStatus>)
      return Sweep::status;
    else
      return R{};  // nothing there, not supported
  }
};

OpenNi2Api failing_api() {
  OpenNi2Api api;
  api.initialize = &Failing<&oniInitialize>::call;
  api.get_device_list = &Failing<&oniGetDeviceList>::call;
  api.release_device_list = &Failing<&oniReleaseDeviceList, true>::call;
  api.register_callbacks = &Failing<&oniRegisterDeviceCallbacks>::call;
  api.extended_error = &Failing<&oniGetExtendedError>::call;
  api.device_open = &Failing<&oniDeviceOpen>::call;
  api.device_close = &Failing<&oniDeviceClose, true>::call;
  api.device_sensor_info = &Failing<&oniDeviceGetSensorInfo>::call;
  api.device_set = &Failing<&oniDeviceSetProperty>::call;
  api.device_get = &Failing<&oniDeviceGetProperty>::call;
  api.device_has = &Failing<&oniDeviceIsPropertySupported>::call;
  api.create_stream = &Failing<&oniDeviceCreateStream>::call;
  api.stream_start = &Failing<&oniStreamStart>::call;
  api.stream_set = &Failing<&oniStreamSetProperty>::call;
  api.stream_get = &Failing<&oniStreamGetProperty>::call;
  api.stream_has = &Failing<&oniStreamIsPropertySupported>::call;
  api.wait_for_any_stream = &Failing<&oniWaitForAnyStream>::call;
  api.read_frame = &Failing<&oniStreamReadFrame>::call;
  return api;
}

struct Outcome3 {
  int frames = 0;
  std::string error;
};

/// Opens and takes three frames, or ends with an error.
template <typename Open>
Outcome3 three_frames(const Open& open) {
  auto library = OpenNi2Library::start(nullptr, failing_api());
  if (!library) return {0, library.error().message};
  auto source = open(*library);
  if (!source) return {0, source.error().message};
  Outcome3 outcome;
  SourceItem item;
  for (int i = 0; i < 20 && outcome.frames < 3; ++i) {
    (*source)->next(200, item);
    if (item.event == SourceEvent::frame) ++outcome.frames;
    if (item.event == SourceEvent::lost || item.event == SourceEvent::end) {
      outcome.error = item.fault;
      break;
    }
  }
  return outcome;
}

template <typename Open>
void sweep(const Open& open) {
  for (const OniStatus status : {ONI_STATUS_ERROR, ONI_STATUS_TIME_OUT}) {
    Sweep::status = status;
    int errors = 0, n = 1;
    for (;; ++n) {
      Sweep::calls = 0;
      Sweep::fail_at = n;
      const Outcome3 outcome = three_frames(open);
      EXPECT_TRUE(outcome.frames == 3 || !outcome.error.empty()) << "call " << n;
      errors += outcome.error.empty() ? 0 : 1;
      if (Sweep::calls < n) break;  // all calls had their turn
      ASSERT_LT(n, 200);
    }
    EXPECT_GE(n, 12);
    EXPECT_GE(errors, 5);
  }
}

TEST(OpenNi2Failures, OfADeviceEndInAnErrorOrFrames) {
  const SensorRig rig;
  rig.control().rate = 200;
  sweep([](const std::shared_ptr<OpenNi2Library>& library) { return open_openni2(library, "", {}); });
}

TEST(OpenNi2Failures, OfAFileEndInAnErrorOrFrames) {
  const SensorRig rig;
  rig.control().rate = 60;
  const std::filesystem::path file = rig.folder() / "five.oni";
  rig.record_oni(file, 5);
  sweep([&](const std::shared_ptr<OpenNi2Library>& library) { return open_oni(library, file, {}); });
}

// The library's thread for the file looks through the streams while one of them is taken away.
TEST(OpenNi2Failures, OfAFileThatIsClosedBeforeItPlaysHarmNothing) {
  const SensorRig rig;
  rig.control().rate = 60;
  const std::filesystem::path file = rig.folder() / "five.oni";
  rig.record_oni(file, 5);
  Sweep::status = ONI_STATUS_ERROR;
  int failed = 0;
  constexpr int kRounds = 20;
  for (int round = 0; round < kRounds; ++round)
    for (int n = 4;; ++n) {
      Sweep::calls = 0;
      Sweep::fail_at = n;
      auto library = OpenNi2Library::start(nullptr, failing_api());
      if (!library) continue;
      const auto source = open_oni(*library, file, {});
      if (source && Sweep::calls < n) break;  // all calls of opening had their turn
      if (!source) ++failed;
      ASSERT_LT(n, 200);
    }
  EXPECT_GE(failed, kRounds * 5);
}

}  // namespace
}  // namespace pliant::test
