// One depth stream of libOpenNI2, of a device or a file.
#pragma once

#include <memory>
#include <string>

#include "core/camera/depth_frame.hpp"
#include "drivers/depth_source/source_wish.hpp"
#include "drivers/openni2/openni2_library.hpp"

namespace pliant {

/// Opens, sets up and reads. Frames are borrowed from the library: no copy, no heap call of ours.
class OpenNi2Stream {
 public:
  enum class Got {
    frame,    ///< frame() is set, until the next call of read()
    unfit,    ///< one came that is no depth frame; `fault` says why
    timeout,  ///< none in the time given
    failed    ///< the library failed; `fault` says how
  };
  explicit OpenNi2Stream(std::shared_ptr<OpenNi2Library> library) : library_(std::move(library)) {}
  ~OpenNi2Stream() { close(); }
  OpenNi2Stream(const OpenNi2Stream&) = delete;
  OpenNi2Stream& operator=(const OpenNi2Stream&) = delete;

  /// Opens the device or file and its depth stream.
  [[nodiscard]] Outcome open(const std::string& uri);
  /// Asks for the mode, and for what this program needs: no mirror, no registration, no cropping; reads all
  /// of it back. For devices; a file is as it was recorded.
  [[nodiscard]] Outcome set_up(const SourceWish& wish);
  /// Takes mode and camera as they are; the wish's camera wins where there is one.
  [[nodiscard]] Outcome learn(const SourceWish& wish);
  [[nodiscard]] Outcome start();
  void close();

  /// Waits at most `timeout_ms`; never calls a read that could wait for ever. `utime` of the frame is the
  /// library's stamp, its number the library's index.
  [[nodiscard]] Got read(int timeout_ms, DepthFrame& frame, std::string& fault);

  [[nodiscard]] const Intrinsics& camera() const noexcept { return camera_; }
  [[nodiscard]] double rate() const noexcept { return mode_.fps; }
  [[nodiscard]] OniDeviceHandle device() const noexcept { return device_; }
  [[nodiscard]] bool mirrored() const noexcept { return mirrored_; }
  template <typename T>
  [[nodiscard]] bool get(int property, T& value) const {
    int size = sizeof value;
    return library_->api().stream_get(stream_, property, &value, &size) == ONI_STATUS_OK &&
           size == sizeof value;
  }

 private:
  [[nodiscard]] Outcome choose_mode(const SourceWish& wish, OniVideoMode& mode) const;
  [[nodiscard]] Outcome switch_off(int property, const char* what);
  void let_frame_go();

  std::shared_ptr<OpenNi2Library> library_;
  OniDeviceHandle device_ = nullptr;
  OniStreamHandle stream_ = nullptr;
  OniFrame* frame_ = nullptr;
  OniVideoMode mode_{};
  Intrinsics camera_;
  bool started_ = false, mirrored_ = false;
};

}  // namespace pliant
