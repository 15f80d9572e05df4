#include "drivers/lcm/multicast_probe.hpp"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <bit>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

namespace pliant {

namespace {

class Socket {
 public:
  Socket() noexcept : descriptor_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {}
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  ~Socket() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  [[nodiscard]] int get() const noexcept { return descriptor_; }

 private:
  int descriptor_;
};

sockaddr_in address_of(const LcmUrl& url, std::uint16_t port) noexcept {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(url.group);
  address.sin_port = htons(port);
  return address;
}

const sockaddr* generic(const sockaddr_in& address) noexcept {
  return reinterpret_cast<const sockaddr*>(&address);
}

bool join(const Socket& socket, const sockaddr_in& group) noexcept {
  ip_mreq membership{};
  membership.imr_multiaddr = group.sin_addr;
  membership.imr_interface.s_addr = htonl(INADDR_ANY);
  return ::setsockopt(socket.get(), IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof(membership)) == 0;
}

/// The device of the kernel's main routing table that leads to `address` (network byte order); empty when
/// none does. The table prints addresses as they lie in memory.
std::string device_towards(in_addr_t address) {
  std::ifstream table("/proc/net/route");
  std::string line, found;
  std::getline(table, line);
  int longest = -1;
  while (std::getline(table, line)) {
    std::istringstream fields(line);
    std::string device, skipped;
    std::uint32_t destination = 0, mask = 0;
    fields >> device >> std::hex >> destination >> skipped >> skipped >> skipped >> skipped >> skipped >>
        mask;
    if (!fields || (address & mask) != destination || std::popcount(mask) <= longest) continue;
    longest = std::popcount(mask);
    found = device;
  }
  return found;
}

/// The first network device that leads out of this host; the usual name where there is none.
std::string outward_device() {
  std::string name = "eth0";
  ifaddrs* devices = nullptr;
  if (::getifaddrs(&devices) != 0) return name;
  for (const ifaddrs* device = devices; device != nullptr; device = device->ifa_next) {
    constexpr unsigned kFit = IFF_UP | IFF_MULTICAST;
    if ((device->ifa_flags & kFit) == kFit && (device->ifa_flags & IFF_LOOPBACK) == 0) {
      name = device->ifa_name;
      break;
    }
  }
  ::freeifaddrs(devices);
  return name;
}

}  // namespace

const char* multicast_route_fault(const LcmUrl& url) noexcept {
  const Socket socket;
  if (socket.get() < 0) return "no network socket can be opened";
  const sockaddr_in group = address_of(url, url.port);
  if (::connect(socket.get(), generic(group), sizeof(group)) != 0 || !join(socket, group)) {
    return errno == ENETUNREACH || errno == ENODEV || errno == EHOSTUNREACH
               ? "there is no route for multicast"
               : "the multicast group cannot be joined";
  }
  return nullptr;
}

bool multicast_comes_back(const LcmUrl& url) noexcept {
  const Socket receiver;
  const Socket sender;
  sockaddr_in group = address_of(url, 0);
  socklen_t size = sizeof(group);
  // Bound to the group itself, at a port the kernel chooses: nothing else arrives here and nobody else hears
  // it.
  if (::bind(receiver.get(), generic(group), sizeof(group)) != 0 || !join(receiver, group) ||
      ::getsockname(receiver.get(), reinterpret_cast<sockaddr*>(&group), &size) != 0) {
    return false;
  }
  const unsigned char ttl = 0;
  constexpr std::array<char, 4> kProbe = {'p', 'i', 'n', 'g'};
  if (::setsockopt(sender.get(), IPPROTO_IP, IP_MULTICAST_TTL, &ttl, sizeof(ttl)) != 0 ||
      ::sendto(sender.get(), kProbe.data(), kProbe.size(), 0, generic(group), sizeof(group)) !=
          static_cast<ssize_t>(kProbe.size())) {
    return false;
  }
  pollfd waiting{receiver.get(), POLLIN, 0};
  if (::poll(&waiting, 1, 200) != 1) return false;
  std::array<char, 8> back{};
  return ::recv(receiver.get(), back.data(), back.size(), 0) == static_cast<ssize_t>(kProbe.size()) &&
         std::memcmp(back.data(), kProbe.data(), kProbe.size()) == 0;
}

std::string multicast_advice(const LcmUrl& url, std::string_view fault) {
  return "LCM at " + url.spelled + ": " + std::string(fault) +
         "; mend: sudo ip link set lo multicast on; sudo ip route add 224.0.0.0/4 dev lo";
}

std::string multicast_reach_advice(const LcmUrl& url) {
  if (url.ttl == 0) return {};
  if (device_towards(htonl(url.group)) != "lo") return {};
  return "LCM at " + url.spelled +
         ": multicast is routed to the loopback, so nothing reaches other hosts; mend: sudo ip route replace "
         "224.0.0.0/4 dev " +
         outward_device();
}

std::string receive_buffer_advice(const LcmUrl& url, std::size_t needed) {
  if (url.provider != LcmUrl::Provider::udp_multicast) return {};
  const Socket socket;
  if (url.receive_buffer > 0) {
    ::setsockopt(socket.get(), SOL_SOCKET, SO_RCVBUF, &url.receive_buffer, sizeof(url.receive_buffer));
  }
  int bytes = 0;
  socklen_t size = sizeof(bytes);
  if (::getsockopt(socket.get(), SOL_SOCKET, SO_RCVBUF, &bytes, &size) != 0 || bytes < 0 ||
      static_cast<std::size_t>(bytes) >= needed) {
    return {};
  }
  std::size_t enough = std::size_t{1} << 21;
  while (enough < 2 * needed) enough *= 2;
  return "LCM at " + url.spelled + ": subscribers have room for " + std::to_string(bytes / 1000) +
         " kB on their way, a picture of " + std::to_string(needed / 1000) +
         " kB may be lost; mend: sudo sysctl -w net.core.rmem_max=" + std::to_string(enough) +
         " net.core.rmem_default=" + std::to_string(enough);
}

}  // namespace pliant
