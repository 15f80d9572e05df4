#include "drivers/model_files/model_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include "drivers/geometry_files/atomic_file.hpp"

namespace pliant {

namespace {

/// Far above the largest model. No more is read of a file that is none, so that it does not fill the memory.
constexpr std::size_t kMostBytes = std::size_t{64} << 20;

Error fault_at(std::string_view name, std::string_view what) {
  return {ErrorKind::bad_input, fmt::format("{}: {}", name, what)};
}

Error unreadable(std::string_view name, int fault) {
  return fault_at(name, "cannot be read: " + std::generic_category().message(fault));
}

/// Closes a file descriptor at the end of its scope.
class OpenFile {
 public:
  explicit OpenFile(int descriptor) : descriptor_(descriptor) {}
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  ~OpenFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  [[nodiscard]] int get() const { return descriptor_; }

 private:
  int descriptor_;
};

}  // namespace

Result<ModelFile> ModelFile::open(const std::filesystem::path& path) {
  const std::string name = path.string();
  const OpenFile file(::open(name.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (file.get() < 0) return unreadable(name, errno);
  struct stat about = {};
  if (::fstat(file.get(), &about) != 0) return unreadable(name, errno);
  if (S_ISDIR(about.st_mode)) return fault_at(name, "is a folder; name a model file");
  if (!S_ISREG(about.st_mode)) return fault_at(name, "is no regular file; name a model file");
  if (about.st_size == 0) return fault_at(name, describe(ModelFault::too_short));
  const std::size_t size = std::min(static_cast<std::size_t>(about.st_size), kMostBytes);
  // Held, not mapped: a file that is overwritten later must not change what was checked.
  std::vector<std::byte> image(size);
  std::size_t got = 0;
  while (got < size) {
    const ssize_t count = ::read(file.get(), image.data() + got, size - got);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return unreadable(name, errno);
    if (count == 0) break;
    got += static_cast<std::size_t>(count);
  }
  image.resize(got);
  return from_image(std::move(image), name);
}

Result<ModelFile> ModelFile::from_image(std::vector<std::byte> image, std::string_view name) {
  ModelFile model;
  model.image_ = std::move(image);
  const ModelFault fault = ModelView::open(model.image_, model.view_);
  if (fault != ModelFault::none) return fault_at(name, describe(fault));
  return model;
}

// A moved vector keeps its storage, so that views into it hold.
ModelFile::ModelFile(ModelFile&& other) noexcept
    : view_(std::exchange(other.view_, {})), image_(std::exchange(other.image_, {})) {}

ModelFile& ModelFile::operator=(ModelFile&& other) noexcept {
  view_ = std::exchange(other.view_, {});
  image_ = std::exchange(other.image_, {});
  return *this;
}

Outcome write_model(const std::filesystem::path& path, std::span<const std::byte> image) {
  return write_whole_file(path.c_str(), image, true);
}

}  // namespace pliant
