#include "drivers/lcm/multicast_probe.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

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

}  // namespace pliant
