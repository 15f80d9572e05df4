#include "tests/lcm/network_namespace.hpp"

#include <arpa/inet.h>
#include <net/if.h>
#include <net/route.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstring>

namespace pliant {

namespace {

class ControlSocket {
 public:
  ControlSocket() : descriptor_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {}
  ControlSocket(const ControlSocket&) = delete;
  ControlSocket& operator=(const ControlSocket&) = delete;
  ~ControlSocket() { ::close(descriptor_); }
  template <typename Request>
  [[nodiscard]] bool control(unsigned long what, Request& request) const {
    return ::ioctl(descriptor_, what, &request) == 0;
  }

 private:
  int descriptor_;
};

void put_address(sockaddr& out, in_addr_t address) {
  sockaddr_in in{};
  in.sin_family = AF_INET;
  in.sin_addr.s_addr = htonl(address);
  std::memcpy(&out, &in, sizeof(in));
}

bool raise_loopback() {
  const ControlSocket socket;
  ifreq request{};
  std::strcpy(request.ifr_name, "lo");  // NOLINT(clang-analyzer-security.insecureAPI.strcpy): fixed text
  request.ifr_flags = IFF_UP | IFF_RUNNING | IFF_LOOPBACK | IFF_MULTICAST;
  return socket.control(SIOCSIFFLAGS, request);
}

}  // namespace

const char* enter_network_namespace() {
  const bool entered =
      ::geteuid() == 0 ? ::unshare(CLONE_NEWNET) == 0 : ::unshare(CLONE_NEWUSER | CLONE_NEWNET) == 0;
  if (!entered) return "no network namespace of our own is permitted here";
  if (!raise_loopback() || !set_multicast_route(true)) return "the loopback interface cannot be set up";
  return nullptr;
}

bool set_multicast_route(bool present) {
  const ControlSocket socket;
  std::array<char, 3> device = {'l', 'o', '\0'};
  rtentry route{};
  put_address(route.rt_dst, 0xE0000000);
  put_address(route.rt_genmask, 0xF0000000);
  route.rt_flags = RTF_UP;
  route.rt_dev = device.data();
  return present ? socket.control(SIOCADDRT, route) : socket.control(SIOCDELRT, route);
}

}  // namespace pliant
