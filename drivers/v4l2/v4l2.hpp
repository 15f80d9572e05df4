// Depth cameras that the kernel's video drivers serve.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "drivers/depth_source/depth_source.hpp"
#include "drivers/depth_source/source_wish.hpp"
#include "drivers/v4l2/v4l2_node.hpp"
#include "drivers/v4l2/v4l2_system.hpp"

namespace pliant {

/// What the user names behind "v4l2:": a path ("/dev/video2"), a bus id ("usb-0000:00:14.0-2"), or nothing
/// for the first node that offers depth; then, if wanted, "?format=Z16", which the node must offer.
struct V4l2Address {
  std::string place;
  std::string format;  ///< empty: the best that is offered
};
[[nodiscard]] Result<V4l2Address> parse_v4l2_address(std::string_view text);

/// Opens the node and starts its stream: the mode of the wish's camera, four buffers, frames borrowed from
/// the kernel where the format allows. V4L2 tells no focal length, so the wish must hold a camera
/// (ErrorKind::bad_input). A frame's number counts those the kernel left out; its utime is the kernel's stamp
/// on the wall clock.
[[nodiscard]] Result<std::unique_ptr<DepthSource>> open_v4l2(const V4l2Address& address,
                                                             const SourceWish& wish,
                                                             V4l2System& system = kernel_v4l2());

/// Every node that delivers pictures, or why it cannot be asked.
struct V4l2Listing {
  std::vector<V4l2Node> nodes;
  std::vector<Error> faults;
};
[[nodiscard]] V4l2Listing list_v4l2(V4l2System& system = kernel_v4l2());

}  // namespace pliant
