#include "drivers/v4l2/v4l2_system.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>

#include "drivers/common/clock.hpp"

namespace pliant {

namespace {

class Kernel final : public V4l2System {
 public:
  std::vector<std::string> nodes() override {
    std::vector<std::string> found;
    std::error_code ignored;
    for (std::filesystem::directory_iterator entry("/dev", ignored), end; entry != end;
         entry.increment(ignored)) {
      if (ignored) break;
      const std::string name = entry->path().filename().string();
      if (name.starts_with("video") && name.find_first_not_of("0123456789", 5) == std::string::npos)
        found.push_back(entry->path().string());
    }
    // /dev/video2 before /dev/video10.
    std::sort(found.begin(), found.end(), [](const std::string& a, const std::string& b) {
      return a.size() != b.size() ? a.size() < b.size() : a < b;
    });
    return found;
  }
  int open(const char* path) override {
    // Opening alone already does something with other files: a watchdog begins to count, a tape winds.
    constexpr unsigned kVideoDevices = 81;  // linux/Documentation/admin-guide/devices.txt
    struct stat about {};
    if (::stat(path, &about) != 0) return -1;
    if (!S_ISCHR(about.st_mode) || major(about.st_rdev) != kVideoDevices) {
      errno = ENOTTY;
      return -1;
    }
    return ::open(path, O_RDWR | O_NONBLOCK | O_CLOEXEC);
  }
  int close(int file) override { return ::close(file); }
  int ioctl(int file, unsigned long request, void* argument) override {
    return ::ioctl(file, request, argument);
  }
  void* map(std::size_t length, int file, std::int64_t offset) override {
    void* memory = ::mmap(nullptr, length, PROT_READ, MAP_SHARED, file, static_cast<off_t>(offset));
    return memory == MAP_FAILED ? nullptr : memory;
  }
  int unmap(void* memory, std::size_t length) override { return ::munmap(memory, length); }
  int poll(int file, int timeout_ms, short& events) override {
    pollfd waiting{file, POLLIN, 0};
    const int ready = ::poll(&waiting, 1, timeout_ms);
    events = waiting.revents;
    return ready;
  }
  std::int64_t monotonic_us() override { return clock_us(CLOCK_MONOTONIC); }
  std::int64_t wall_us() override { return clock_us(CLOCK_REALTIME); }
};

}  // namespace

V4l2System& kernel_v4l2() {
  static Kernel kernel;
  return kernel;
}

}  // namespace pliant
