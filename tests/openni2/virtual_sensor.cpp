// A driver for libOpenNI2 with one device that plays frames from memory and has the faults that a test asks
// for.
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <cstring>
#include <new>
#include <random>
#include <thread>
#include <vector>

#define XN_NEW(type, ...) new type(__VA_ARGS__)
#define XN_DELETE(pointer) delete (pointer)
#define XN_MAX_UINT16 65535
#include <Driver/OniDriverAPI.h>

#include "tests/openni2/virtual_sensor.hpp"

namespace {

using pliant::test::SensorControl;
using pliant::test::SensorFault;

constexpr const char* kUri = "virtual/sensor@1/7";

/// The test's memory.
class Memory {
 public:
  Memory() {
    const char* path = std::getenv(pliant::test::kVirtualSensorVariable);
    if (path == nullptr) return;
    const int file = open(path, O_RDWR | O_CLOEXEC);
    if (file < 0) return;
    struct stat status {};
    if (fstat(file, &status) == 0) {
      size_ = static_cast<std::size_t>(status.st_size);
      void* mapped = mmap(nullptr, size_, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
      if (mapped != MAP_FAILED) control_ = static_cast<SensorControl*>(mapped);
    }
    close(file);
  }
  ~Memory() {
    if (control_ != nullptr) munmap(control_, size_);
  }
  Memory(const Memory&) = delete;
  Memory& operator=(const Memory&) = delete;
  [[nodiscard]] SensorControl* control() const { return control_; }
  [[nodiscard]] const unsigned char* frame(int index) const {
    const void* frames = control_ + 1;
    return static_cast<const unsigned char*>(frames) + frame_bytes() * static_cast<std::size_t>(index);
  }
  [[nodiscard]] std::size_t frame_bytes() const {
    return static_cast<std::size_t>(control_->width) * static_cast<std::size_t>(control_->height) * 2;
  }

 private:
  SensorControl* control_ = nullptr;
  std::size_t size_ = 0;
};

template <typename T>
OniStatus give(void* out, int* size, const T& value) {
  if (*size != static_cast<int>(sizeof value)) return ONI_STATUS_BAD_PARAMETER;
  std::memcpy(out, &value, sizeof value);
  return ONI_STATUS_OK;
}

class Stream final : public oni::driver::StreamBase {
 public:
  explicit Stream(const Memory& memory)
      : memory_(memory),
        control_(*memory.control()),
        mode_{ONI_PIXEL_FORMAT_DEPTH_1_MM, control_.width, control_.height, control_.rate} {}
  ~Stream() override { halt(); }

  OniStatus start() override {
    if (control_.fault == SensorFault::no_start) return ONI_STATUS_ERROR;
    running_ = true;
    thread_ = std::thread([this] { play(); });
    return ONI_STATUS_OK;
  }
  void stop() override { halt(); }

  OniBool isPropertySupported(int id) override {
    switch (id) {
      case ONI_STREAM_PROPERTY_CROPPING:
      case ONI_STREAM_PROPERTY_HORIZONTAL_FOV:
      case ONI_STREAM_PROPERTY_VERTICAL_FOV:
      case ONI_STREAM_PROPERTY_VIDEO_MODE:
      case ONI_STREAM_PROPERTY_MAX_VALUE:
      case ONI_STREAM_PROPERTY_MIN_VALUE:
      case ONI_STREAM_PROPERTY_STRIDE:
      case ONI_STREAM_PROPERTY_MIRRORING:
        return TRUE;
      default:
        return FALSE;
    }
  }
  OniStatus getProperty(int id, void* out, int* size) override {
    switch (id) {
      case ONI_STREAM_PROPERTY_CROPPING:  // without it a recording plays back no frame
        return give(out, size, OniCropping{FALSE, 0, 0, control_.width, control_.height});
      case ONI_STREAM_PROPERTY_HORIZONTAL_FOV:
        return give(out, size, control_.field_of_view_across);
      case ONI_STREAM_PROPERTY_VERTICAL_FOV:
        return give(out, size, control_.field_of_view_down);
      case ONI_STREAM_PROPERTY_VIDEO_MODE:
        return give(out, size, mode_);
      case ONI_STREAM_PROPERTY_MAX_VALUE:
        return give(out, size, 10000);
      case ONI_STREAM_PROPERTY_MIN_VALUE:
        return give(out, size, 0);
      case ONI_STREAM_PROPERTY_STRIDE:
        return give(out, size, 2 * control_.width);
      case ONI_STREAM_PROPERTY_MIRRORING:
        return give(out, size, mirror_);
      default:
        return ONI_STATUS_NOT_IMPLEMENTED;
    }
  }
  OniStatus setProperty(int id, const void* in, int size) override {
    if (id == ONI_STREAM_PROPERTY_VIDEO_MODE && size == static_cast<int>(sizeof(OniVideoMode))) {
      OniVideoMode wanted{};
      std::memcpy(&wanted, in, sizeof wanted);
      if (wanted.resolutionX != control_.width || wanted.resolutionY != control_.height)
        return ONI_STATUS_NOT_SUPPORTED;
      mode_ = wanted;
      if (control_.fault == SensorFault::other_mode) mode_.resolutionX /= 2;
      return ONI_STATUS_OK;
    }
    if (id == ONI_STREAM_PROPERTY_MIRRORING && size == static_cast<int>(sizeof(OniBool))) {
      if (control_.fault == SensorFault::keeps_mirror) return ONI_STATUS_NOT_SUPPORTED;
      std::memcpy(&mirror_, in, sizeof mirror_);
      return ONI_STATUS_OK;
    }
    return ONI_STATUS_NOT_IMPLEMENTED;
  }
  void notifyAllProperties() override {
    tell(ONI_STREAM_PROPERTY_VIDEO_MODE, mode_);
    tell(ONI_STREAM_PROPERTY_HORIZONTAL_FOV, control_.field_of_view_across);
    tell(ONI_STREAM_PROPERTY_VERTICAL_FOV, control_.field_of_view_down);
    tell(ONI_STREAM_PROPERTY_MAX_VALUE, 10000);
    tell(ONI_STREAM_PROPERTY_MIRRORING, mirror_);
  }

 private:
  template <typename T>
  void tell(int id, const T& value) {
    raisePropertyChanged(id, &value, static_cast<int>(sizeof value));
  }
  void halt() {
    running_ = false;
    if (thread_.joinable()) thread_.join();
  }
  void play() {
    using Clock = std::chrono::steady_clock;
    auto due = Clock::now();
    std::int64_t stamp = 0;
    for (int n = 0; running_;) {
      const SensorFault fault = control_.fault;
      const std::int64_t period = 1'000'000 / control_.rate * (fault == SensorFault::slow ? 4 : 1);
      due = std::max(due + std::chrono::microseconds(period), Clock::now() - std::chrono::milliseconds(100));
      stamp += period;
      while (running_ && Clock::now() < due)
        std::this_thread::sleep_until(std::min(due, Clock::now() + std::chrono::milliseconds(10)));
      if (!running_ || control_.plugged == 0 || fault == SensorFault::silent) continue;
      OniFrame* frame = getServices().acquireFrame();
      if (frame == nullptr) continue;
      fill(*frame, fault, n, stamp);
      raiseNewFrame(frame);
      getServices().releaseFrame(frame);
      ++control_.sent;
      if (fault != SensorFault::stuck) ++n;
    }
  }
  void fill(OniFrame& frame, SensorFault fault, int n, std::int64_t stamp) {
    frame.frameIndex = n + 1;
    frame.videoMode = mode_;
    frame.width = control_.width;
    frame.height = fault == SensorFault::wrong_size ? control_.height / 2 : control_.height;
    frame.cropOriginX = frame.cropOriginY = 0;
    frame.croppingEnabled = FALSE;
    frame.sensorType = ONI_SENSOR_DEPTH;
    frame.stride = 2 * control_.width;
    frame.dataSize = fault == SensorFault::cut ? 100 : frame.stride * frame.height;
    frame.timestamp =
        static_cast<std::uint64_t>(fault == SensorFault::delayed ? stamp - 500'000 : stamp) + 1'000'000;
    auto* pixels = static_cast<std::uint16_t*>(frame.data);
    const std::size_t count = memory_.frame_bytes() / 2;
    // There and back again, so that nothing ever jumps.
    const int cycle = 2 * control_.frames - 2, at = cycle > 0 ? n % cycle : 0;
    std::memcpy(pixels, memory_.frame(at < control_.frames ? at : cycle - at), memory_.frame_bytes());
    if (fault == SensorFault::zero) std::memset(pixels, 0, memory_.frame_bytes());
    if (fault == SensorFault::noise)
      for (std::size_t i = 0; i < count; ++i) pixels[i] = static_cast<std::uint16_t>(random_() % 10000);
  }

  const Memory& memory_;
  SensorControl& control_;
  OniVideoMode mode_;
  OniBool mirror_ = TRUE;  // as PrimeSense devices begin
  std::minstd_rand random_{1};
  std::atomic<bool> running_{false};
  std::thread thread_;
};

class Device final : public oni::driver::DeviceBase {
 public:
  explicit Device(const Memory& memory) : memory_(memory) {
    const SensorControl& control = *memory.control();
    modes_ = {{ONI_PIXEL_FORMAT_DEPTH_1_MM, 160, 120, control.rate},
              {ONI_PIXEL_FORMAT_DEPTH_1_MM, control.width, control.height, control.rate}};
    info_ = {ONI_SENSOR_DEPTH, static_cast<int>(modes_.size()), modes_.data()};
  }
  OniStatus getSensorInfoList(OniSensorInfo** infos, int* count) override {
    *infos = &info_;
    *count = 1;
    return ONI_STATUS_OK;
  }
  oni::driver::StreamBase* createStream(OniSensorType type) override {
    return type == ONI_SENSOR_DEPTH ? new Stream(memory_) : nullptr;
  }
  void destroyStream(oni::driver::StreamBase* stream) override { delete stream; }
  OniBool isPropertySupported(int id) override { return id == ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION; }
  OniStatus getProperty(int id, void* out, int* size) override {
    if (id != ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION) return ONI_STATUS_NOT_IMPLEMENTED;
    return give(out, size,
                memory_.control()->fault == SensorFault::keeps_registration
                    ? ONI_IMAGE_REGISTRATION_DEPTH_TO_COLOR
                    : ONI_IMAGE_REGISTRATION_OFF);
  }
  OniStatus setProperty(int id, const void* /*in*/, int /*size*/) override {
    return id == ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION ? ONI_STATUS_OK : ONI_STATUS_NOT_IMPLEMENTED;
  }

 private:
  const Memory& memory_;
  std::vector<OniVideoMode> modes_;
  OniSensorInfo info_{};
};

class VirtualSensor final : public oni::driver::DriverBase {
 public:
  explicit VirtualSensor(OniDriverServices* services) : DriverBase(services) {}
  OniStatus initialize(oni::driver::DeviceConnectedCallback connected,
                       oni::driver::DeviceDisconnectedCallback disconnected,
                       oni::driver::DeviceStateChangedCallback changed, void* cookie) override {
    DriverBase::initialize(connected, disconnected, changed, cookie);
    if (memory_.control() == nullptr) return ONI_STATUS_OK;
    std::strcpy(device_.uri, kUri);
    std::strcpy(device_.vendor, "test");
    std::strcpy(device_.name, "virtual sensor");
    device_.usbVendorId = 0x1d27;
    device_.usbProductId = 0x0600;
    if (memory_.control()->plugged != 0) plug(true);
    running_ = true;
    thread_ = std::thread([this] {
      while (running_) {
        const bool wanted = memory_.control()->plugged != 0;
        if (wanted != plugged_) plug(wanted);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
    });
    return ONI_STATUS_OK;
  }
  oni::driver::DeviceBase* deviceOpen(const char* /*uri*/, const char* /*mode*/) override {
    return plugged_ ? new Device(memory_) : nullptr;
  }
  void deviceClose(oni::driver::DeviceBase* device) override { delete device; }
  OniStatus tryDevice(const char* /*uri*/) override { return ONI_STATUS_ERROR; }
  void shutdown() override {
    running_ = false;
    if (thread_.joinable()) thread_.join();
  }

 private:
  void plug(bool in) {
    plugged_ = in;
    if (in)
      deviceConnected(&device_);
    else
      deviceDisconnected(&device_);
    ++memory_.control()->unplugged;
  }
  Memory memory_;
  OniDeviceInfo device_{};
  std::atomic<bool> running_{false}, plugged_{false};
  std::thread thread_;
};

}  // namespace

ONI_EXPORT_DRIVER(VirtualSensor)
