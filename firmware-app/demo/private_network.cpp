#include "firmware-app/demo/private_network.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <net/if.h>
#include <net/route.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace pliant::demo {

namespace {

void write_text(const char* path, const std::string& text) {
  const int file = open(path, O_WRONLY | O_CLOEXEC);
  if (file < 0) return;
  [[maybe_unused]] const ssize_t written = write(file, text.data(), text.size());
  close(file);
}

sockaddr address(in_addr_t host_order) {
  sockaddr_in internet{};
  internet.sin_family = AF_INET;
  internet.sin_addr.s_addr = htonl(host_order);
  sockaddr general{};
  std::memcpy(&general, &internet, sizeof general);
  return general;
}

/// Brings the loopback up with multicast, and routes all multicast to it.
bool open_loopback() {
  const int socket_descriptor = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (socket_descriptor < 0) return false;
  char name[] = "lo";
  ifreq device{};
  std::memcpy(device.ifr_name, name, sizeof name);
  bool well = ioctl(socket_descriptor, SIOCGIFFLAGS, &device) == 0;
  device.ifr_flags = static_cast<short>(device.ifr_flags | IFF_UP | IFF_MULTICAST);
  well = well && ioctl(socket_descriptor, SIOCSIFFLAGS, &device) == 0;
  rtentry route{};
  route.rt_dst = address(0xE0000000);      // 224.0.0.0
  route.rt_genmask = address(0xF0000000);  // /4
  route.rt_gateway = address(0);
  route.rt_flags = RTF_UP;
  route.rt_dev = name;
  well = well && ioctl(socket_descriptor, SIOCADDRT, &route) == 0;
  const int fault = errno;
  close(socket_descriptor);
  errno = fault;
  return well;
}

}  // namespace

std::string enter_private_network() {
  const uid_t user = geteuid();
  const gid_t group = getegid();
  if (user == 0) {
    if (unshare(CLONE_NEWNET) != 0) return fmt::format("no network of its own: {}", std::strerror(errno));
  } else {
    if (unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0)
      return fmt::format("no network of its own: {}", std::strerror(errno));
    write_text("/proc/self/setgroups", "deny");
    write_text("/proc/self/uid_map", fmt::format("{0} {0} 1", user));
    write_text("/proc/self/gid_map", fmt::format("{0} {0} 1", group));
  }
  if (!open_loopback())
    return fmt::format("its network's loopback cannot be set up: {}", std::strerror(errno));
  return {};
}

}  // namespace pliant::demo
