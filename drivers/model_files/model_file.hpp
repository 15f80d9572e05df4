// Model files on disk.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "core/model/model_view.hpp"
#include "drivers/common/result.hpp"

namespace pliant {

/// A checked model image, held in memory. Views stay valid for as long as the ModelFile, or the one that it
/// was moved to, lives.
class ModelFile {
 public:
  /// Errors name the file and the mend in one line.
  [[nodiscard]] static Result<ModelFile> open(const std::filesystem::path& path);
  /// `name` stands in front of errors.
  [[nodiscard]] static Result<ModelFile> from_image(std::vector<std::byte> image, std::string_view name);

  ModelFile() = default;
  ModelFile(ModelFile&& other) noexcept;
  ModelFile& operator=(ModelFile&& other) noexcept;
  ModelFile(const ModelFile&) = delete;
  ModelFile& operator=(const ModelFile&) = delete;
  ~ModelFile() = default;

  [[nodiscard]] const ModelView& view() const { return view_; }
  /// The whole image.
  [[nodiscard]] std::span<const std::byte> image() const { return image_; }

 private:
  ModelView view_;
  std::vector<std::byte> image_;
};

/// Writes `image` so that it appears under `path` only once it is whole and on the disk.
[[nodiscard]] Outcome write_model(const std::filesystem::path& path, std::span<const std::byte> image);

}  // namespace pliant
