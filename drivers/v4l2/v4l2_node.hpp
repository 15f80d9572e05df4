// One video node: what it is and what it offers.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "drivers/common/result.hpp"
#include "drivers/v4l2/v4l2_system.hpp"

namespace pliant {

/// An open file of a node; closed by the destructor.
class V4l2File {
 public:
  V4l2File() = default;
  V4l2File(V4l2System& system, int file) : system_(&system), file_(file) {}
  V4l2File(V4l2File&& other) noexcept : system_(other.system_), file_(other.file_) { other.file_ = -1; }
  V4l2File& operator=(V4l2File&& other) noexcept;
  ~V4l2File() { close(); }
  void close();
  [[nodiscard]] bool is_open() const noexcept { return file_ >= 0; }
  [[nodiscard]] int get() const noexcept { return file_; }
  /// ioctl() that goes on after a signal. 0 or the errno.
  [[nodiscard]] int call(unsigned long request, void* argument) const;

 private:
  V4l2System* system_ = nullptr;
  int file_ = -1;
};

struct V4l2Node {
  std::string path, card, bus;  ///< bus: "usb-0000:00:14.0-2", the same for the same plug
  bool capture = false;         ///< delivers pictures, by streaming
  bool multi_planar = false;
  bool busy = false;                   ///< another program streams from it; list_v4l2() asks
  std::vector<std::uint32_t> formats;  ///< that it offers
  [[nodiscard]] bool offers_depth() const;
};

/// What failed, with the errno's meaning and, where there is one, the mend. ErrorKind::absent for a node or
/// device that is not there.
[[nodiscard]] Error v4l2_error(const std::string& path, std::string_view what, int error);

/// Opens a node and asks what it is.
[[nodiscard]] Outcome open_v4l2_node(V4l2System& system, const std::string& path, V4l2File& file,
                                     V4l2Node& node);

}  // namespace pliant
