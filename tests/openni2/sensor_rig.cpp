#include "tests/openni2/sensor_rig.hpp"

#include <OniCAPI.h>
#include <OniCProperties.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <new>
#include <vector>

#include "drivers/simulated/simulated.hpp"

namespace pliant::test {

SensorRig::SensorRig(const std::string& simulated) {
  Result<std::unique_ptr<SimulatedSource>> source = open_simulated(simulated);
  EXPECT_TRUE(source);
  const Intrinsics& camera = (*source)->intrinsics();
  const std::size_t frame_bytes =
      2 * static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  const auto frames = static_cast<std::size_t>((*source)->frame_count());
  bytes_ = sizeof(SensorControl) + frames * frame_bytes;
  const std::string file = (folder_ / "sensor").string();
  const int descriptor = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  EXPECT_EQ(ftruncate(descriptor, static_cast<off_t>(bytes_)), 0);
  void* memory = mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
  close(descriptor);
  EXPECT_NE(memory, MAP_FAILED);
  control_ = new (memory) SensorControl;
  control_->width = camera.width;
  control_->height = camera.height;
  control_->frames = static_cast<std::int32_t>(frames);
  control_->field_of_view_across = static_cast<float>(2 * std::atan(0.5 * camera.width / camera.fx));
  control_->field_of_view_down = static_cast<float>(2 * std::atan(0.5 * camera.height / camera.fy));
  SourceItem item;
  for (std::size_t i = 0; i < frames; ++i) {
    (*source)->next(1000, item);
    std::memcpy(static_cast<unsigned char*>(memory) + sizeof(SensorControl) + i * frame_bytes,
                item.frame.depth, frame_bytes);
  }
  setenv(kVirtualSensorVariable, file.c_str(), 1);  // NOLINT(concurrency-mt-unsafe): before any thread
}

SensorRig::~SensorRig() {
  unsetenv(kVirtualSensorVariable);  // NOLINT(concurrency-mt-unsafe): after every thread
  munmap(control_, bytes_);
}

const std::uint16_t* SensorRig::frame(int index) const {
  const void* frames = control_ + 1;
  return static_cast<const std::uint16_t*>(frames) +
         std::ptrdiff_t{index} * control_->width * control_->height;
}

void SensorRig::record_oni(const std::filesystem::path& file, int frames) const {
  ASSERT_EQ(oniInitialize(ONI_API_VERSION), ONI_STATUS_OK) << oniGetExtendedError();
  OniDeviceHandle device = nullptr;
  OniStreamHandle stream = nullptr;
  OniRecorderHandle recorder = nullptr;
  ASSERT_EQ(oniDeviceOpen(nullptr, &device), ONI_STATUS_OK) << oniGetExtendedError();
  ASSERT_EQ(oniDeviceCreateStream(device, ONI_SENSOR_DEPTH, &stream), ONI_STATUS_OK);
  const OniBool off = FALSE;
  ASSERT_EQ(oniStreamSetProperty(stream, ONI_STREAM_PROPERTY_MIRRORING, &off, sizeof off), ONI_STATUS_OK);
  ASSERT_EQ(oniCreateRecorder(file.c_str(), &recorder), ONI_STATUS_OK);
  ASSERT_EQ(oniRecorderAttachStream(recorder, stream, FALSE), ONI_STATUS_OK);
  ASSERT_EQ(oniRecorderStart(recorder), ONI_STATUS_OK);
  ASSERT_EQ(oniStreamStart(stream), ONI_STATUS_OK);
  const std::int32_t before = control_->sent;
  while (control_->sent < before + frames) usleep(1000);
  oniStreamStop(stream);
  oniRecorderStop(recorder);
  oniRecorderDestroy(&recorder);
  oniStreamDestroy(stream);
  oniDeviceClose(device);
  oniShutdown();
}

}  // namespace pliant::test
