#include "drivers/model_files/model_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "drivers/geometry_files/atomic_file.hpp"

namespace pliant {

namespace {

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
  const auto size = static_cast<std::size_t>(about.st_size);
  void* mapped = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file.get(), 0);
  if (mapped == MAP_FAILED) return unreadable(name, errno);

  ModelFile model;
  model.image_ = {static_cast<const std::byte*>(mapped), size};
  const ModelFault fault = ModelView::open(model.image_, model.view_);
  if (fault != ModelFault::none) return fault_at(name, describe(fault));
  return model;
}

Result<ModelFile> ModelFile::from_image(std::vector<std::byte> image, std::string_view name) {
  ModelFile model;
  model.held_ = std::move(image);
  model.image_ = model.held_;
  const ModelFault fault = ModelView::open(model.image_, model.view_);
  if (fault != ModelFault::none) return fault_at(name, describe(fault));
  return model;
}

// A moved vector keeps its storage, so that views into it hold.
ModelFile::ModelFile(ModelFile&& other) noexcept
    : view_(std::exchange(other.view_, {})),
      image_(std::exchange(other.image_, {})),
      held_(std::exchange(other.held_, {})) {}

ModelFile& ModelFile::operator=(ModelFile&& other) noexcept {
  if (this == &other) return *this;
  release();
  view_ = std::exchange(other.view_, {});
  image_ = std::exchange(other.image_, {});
  held_ = std::exchange(other.held_, {});
  return *this;
}

ModelFile::~ModelFile() {
  release();
}

void ModelFile::release() {
  if (!image_.empty() && held_.empty()) ::munmap(const_cast<std::byte*>(image_.data()), image_.size());
  image_ = {};
  view_ = {};
}

Outcome write_model(const std::filesystem::path& path, std::span<const std::byte> image) {
  return write_whole_file(path.c_str(), image, true);
}

}  // namespace pliant
