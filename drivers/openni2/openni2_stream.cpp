#include "drivers/openni2/openni2_stream.hpp"

#include <fmt/format.h>

#include <cmath>
#include <vector>

namespace pliant {

namespace {

double units_per_metre(OniPixelFormat format) {
  return format == ONI_PIXEL_FORMAT_DEPTH_100_UM ? 10000 : 1000;
}

bool is_depth(OniPixelFormat format) {
  return format == ONI_PIXEL_FORMAT_DEPTH_1_MM || format == ONI_PIXEL_FORMAT_DEPTH_100_UM;
}

std::string describe(const OniVideoMode& mode) {
  return fmt::format("{}x{} at {} Hz", mode.resolutionX, mode.resolutionY, mode.fps);
}

}  // namespace

Outcome OpenNi2Stream::open(const std::string& uri) {
  const OpenNi2Api& api = library_->api();
  if (const OniStatus status = api.device_open(uri.c_str(), &device_); status != ONI_STATUS_OK) {
    device_ = nullptr;
    return library_->fault("cannot open " + uri, status);
  }
  if (const OniStatus status = api.create_stream(device_, ONI_SENSOR_DEPTH, &stream_);
      status != ONI_STATUS_OK) {
    stream_ = nullptr;
    return library_->fault(uri + " has no depth stream", status);
  }
  return success();
}

Outcome OpenNi2Stream::choose_mode(const SourceWish& wish, OniVideoMode& mode) const {
  const OniSensorInfo* info = library_->api().device_sensor_info(device_, ONI_SENSOR_DEPTH);
  if (info == nullptr || info->numSupportedVideoModes <= 0)
    return Error{ErrorKind::device, "openni2: the device tells no depth mode"};
  struct Size {
    int width, height;
  };
  const std::vector<Size> sizes = wish.camera ? std::vector<Size>{{wish.camera->width, wish.camera->height}}
                                              : std::vector<Size>{{640, 480}, {320, 240}};
  // Whole millimetres are what every device has and 16 bits hold up to 65 m.
  for (const Size& size : sizes)
    for (const OniPixelFormat format : {ONI_PIXEL_FORMAT_DEPTH_1_MM, ONI_PIXEL_FORMAT_DEPTH_100_UM}) {
      const OniVideoMode* best = nullptr;
      for (int i = 0; i < info->numSupportedVideoModes; ++i) {
        const OniVideoMode& m = info->pSupportedVideoModes[i];
        if (m.resolutionX != size.width || m.resolutionY != size.height || m.pixelFormat != format) continue;
        if (best == nullptr || std::abs(m.fps - wish.rate) < std::abs(best->fps - wish.rate)) best = &m;
      }
      if (best != nullptr) {
        mode = *best;
        return success();
      }
    }
  std::string offered;
  for (int i = 0; i < info->numSupportedVideoModes; ++i)
    if (is_depth(info->pSupportedVideoModes[i].pixelFormat))
      offered += (offered.empty() ? "" : ", ") + describe(info->pSupportedVideoModes[i]);
  return Error{ErrorKind::device,
               fmt::format("openni2: no depth mode of {}x{}; the device has {}", sizes.front().width,
                           sizes.front().height, offered.empty() ? "none" : offered)};
}

Outcome OpenNi2Stream::switch_off(int property, const char* what) {
  const OpenNi2Api& api = library_->api();
  if (api.stream_has(stream_, property) == 0) return success();
  OniBool on = FALSE;
  static_cast<void>(api.stream_set(stream_, property, &on, sizeof on));  // what counts is what is read back
  if (!get(property, on)) return Error{ErrorKind::device, fmt::format("openni2: {} cannot be read", what)};
  if (on != FALSE) return Error{ErrorKind::device, fmt::format("openni2: {} cannot be switched off", what)};
  return success();
}

Outcome OpenNi2Stream::set_up(const SourceWish& wish) {
  const OpenNi2Api& api = library_->api();
  // Depth that is warped into the colour camera no longer fits its own camera.
  if (api.device_has(device_, ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION) != 0) {
    OniImageRegistrationMode off = ONI_IMAGE_REGISTRATION_OFF;
    int size = sizeof off;
    if (const OniStatus status =
            api.device_set(device_, ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION, &off, sizeof off);
        status != ONI_STATUS_OK)
      return library_->fault("registration to colour cannot be switched off", status);
    // Not every driver that sets it can tell it.
    if (api.device_get(device_, ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION, &off, &size) == ONI_STATUS_OK &&
        off != ONI_IMAGE_REGISTRATION_OFF)
      return Error{ErrorKind::device, "openni2: registration to colour stays on"};
  }
  OniVideoMode mode{};
  if (Outcome chosen = choose_mode(wish, mode); !chosen) return chosen;
  if (const OniStatus status = api.stream_set(stream_, ONI_STREAM_PROPERTY_VIDEO_MODE, &mode, sizeof mode);
      status != ONI_STATUS_OK)
    return library_->fault("the mode " + describe(mode) + " was refused", status);
  OniVideoMode set{};
  if (!get(ONI_STREAM_PROPERTY_VIDEO_MODE, set))
    return Error{ErrorKind::device, "openni2: the mode cannot be read"};
  if (set.resolutionX != mode.resolutionX || set.resolutionY != mode.resolutionY ||
      set.pixelFormat != mode.pixelFormat)
    return Error{ErrorKind::device,
                 fmt::format("openni2: the device took {} instead of {}", describe(set), describe(mode))};
  if (Outcome off = switch_off(ONI_STREAM_PROPERTY_MIRRORING, "mirroring"); !off) return off;
  OniCropping cropping{};
  if (api.stream_has(stream_, ONI_STREAM_PROPERTY_CROPPING) != 0 &&
      get(ONI_STREAM_PROPERTY_CROPPING, cropping) && cropping.enabled != 0) {
    cropping.enabled = 0;
    if (const OniStatus status =
            api.stream_set(stream_, ONI_STREAM_PROPERTY_CROPPING, &cropping, sizeof cropping);
        status != ONI_STATUS_OK)
      return library_->fault("cropping cannot be switched off", status);
  }
  return learn(wish);
}

Outcome OpenNi2Stream::learn(const SourceWish& wish) {
  if (!get(ONI_STREAM_PROPERTY_VIDEO_MODE, mode_))
    return Error{ErrorKind::device, "openni2: the mode cannot be read"};
  if (!is_depth(mode_.pixelFormat))
    return Error{ErrorKind::device, "openni2: the stream is not depth in millimetres"};
  OniBool mirrored = FALSE;
  mirrored_ = get(ONI_STREAM_PROPERTY_MIRRORING, mirrored) && mirrored != FALSE;
  if (wish.camera) {
    camera_ = *wish.camera;
    if (camera_.width != mode_.resolutionX || camera_.height != mode_.resolutionY)
      return Error{ErrorKind::device,
                   fmt::format("openni2: frames are {}x{}, the sensor description says {}x{}",
                               mode_.resolutionX, mode_.resolutionY, camera_.width, camera_.height)};
  } else {
    float across = 0, down = 0;  // radians
    const bool told =
        get(ONI_STREAM_PROPERTY_HORIZONTAL_FOV, across) && get(ONI_STREAM_PROPERTY_VERTICAL_FOV, down);
    if (!told || !(across > 0.01F && across < 3.1F && down > 0.01F && down < 3.1F))
      return Error{ErrorKind::device,
                   "openni2: the device tells no field of view; name a sensor description with --sensor"};
    camera_.width = mode_.resolutionX;
    camera_.height = mode_.resolutionY;
    camera_.fx = 0.5 * camera_.width / std::tan(0.5 * static_cast<double>(across));
    camera_.fy = 0.5 * camera_.height / std::tan(0.5 * static_cast<double>(down));
    camera_.cx = 0.5 * (camera_.width - 1);
    camera_.cy = 0.5 * (camera_.height - 1);
  }
  camera_.depth_scale = units_per_metre(mode_.pixelFormat);
  if (const char* fault = intrinsics_fault(camera_); fault != nullptr)
    return Error{ErrorKind::device, fmt::format("openni2: the device's camera cannot be used: {}", fault)};
  return success();
}

Outcome OpenNi2Stream::start() {
  if (const OniStatus status = library_->api().stream_start(stream_); status != ONI_STATUS_OK)
    return library_->fault("the stream does not start", status);
  started_ = true;
  return success();
}

OpenNi2Stream::Got OpenNi2Stream::read(int timeout_ms, DepthFrame& frame, std::string& fault) {
  const OpenNi2Api& api = library_->api();
  let_frame_go();
  int which = 0;
  OniStatus status = api.wait_for_any_stream(&stream_, 1, &which, timeout_ms < 0 ? 0 : timeout_ms);
  if (status == ONI_STATUS_TIME_OUT) return Got::timeout;
  if (status == ONI_STATUS_OK) status = api.read_frame(stream_, &frame_);
  if (status != ONI_STATUS_OK || frame_ == nullptr) {
    frame_ = nullptr;
    fault = library_->fault("no frame can be read", status).message;
    return Got::failed;
  }
  const OniFrame& f = *frame_;
  const std::int64_t row = std::int64_t{f.width} * 2;
  if (f.data == nullptr || f.sensorType != ONI_SENSOR_DEPTH || f.videoMode.pixelFormat != mode_.pixelFormat ||
      f.width < 1 || f.height < 1 || f.stride < row || f.stride % 2 != 0 ||
      f.dataSize < std::int64_t{f.stride} * (f.height - 1) + row) {
    fault = fmt::format("openni2: a frame of {}x{} with {} bytes is no whole depth frame", f.width, f.height,
                        f.dataSize);
    return Got::unfit;
  }
  frame = {static_cast<const std::uint16_t*>(f.data), f.width,     f.height, f.stride / 2,
           static_cast<std::int64_t>(f.timestamp),    f.frameIndex};
  return Got::frame;
}

void OpenNi2Stream::let_frame_go() {
  if (frame_ != nullptr) library_->api().frame_release(frame_);
  frame_ = nullptr;
}

void OpenNi2Stream::close() {
  const OpenNi2Api& api = library_->api();
  let_frame_go();
  if (started_) api.stream_stop(stream_);
  if (stream_ != nullptr) api.stream_destroy(stream_);
  if (device_ != nullptr) static_cast<void>(api.device_close(device_));
  started_ = false;
  stream_ = nullptr;
  device_ = nullptr;
}

}  // namespace pliant
