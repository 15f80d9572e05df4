#include "drivers/simulated/truth_writer.hpp"

#include <fmt/format.h>

#include <bit>
#include <cerrno>
#include <cstring>
#include <string>
#include <type_traits>
#include <utility>

namespace pliant {

namespace {

Error failed(const std::filesystem::path& file) {
  return {ErrorKind::write, fmt::format("{}: {}", file.string(), std::strerror(errno))};
}

void put_text(std::vector<std::byte>& bytes, const std::string& text) {
  const auto* first = static_cast<const std::byte*>(static_cast<const void*>(text.data()));
  bytes.insert(bytes.end(), first, first + text.size());
}

/// Little-endian, whatever the machine.
void put(std::vector<std::byte>& bytes, std::uint32_t value) {
  for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::byte>(value >> shift & 255));
}
void put(std::vector<std::byte>& bytes, const Point3f& p) {
  for (const float x : {p.x, p.y, p.z}) put(bytes, std::bit_cast<std::uint32_t>(x));
}

Outcome store(const std::filesystem::path& file, const std::vector<std::byte>& bytes) {
  std::FILE* out = std::fopen(file.c_str(), "wb");
  if (out == nullptr) return failed(file);
  const bool whole = std::fwrite(bytes.data(), 1, bytes.size(), out) == bytes.size();
  const int fault = errno;
  if (const bool closed = std::fclose(out) == 0; whole && closed) return success();
  if (!whole) errno = fault;
  return failed(file);
}

}  // namespace

Result<std::unique_ptr<TruthWriter>> TruthWriter::create(const std::filesystem::path& folder,
                                                         const Geometry& mesh) {
  std::unique_ptr<TruthWriter> writer(new TruthWriter(folder));
  std::error_code fault;
  std::filesystem::create_directories(folder / "truth", fault);
  if (fault)
    return Error{ErrorKind::write, fmt::format("{}: {}", (folder / "truth").string(), fault.message())};

  std::vector<std::byte>& bytes = writer->bytes_;
  put_text(bytes, fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\n"
                              "property float y\nproperty float z\nproperty float nx\nproperty float ny\n"
                              "property float nz\nelement face {}\nproperty list uchar int vertex_indices\n"
                              "end_header\n",
                              mesh.vertices.size(), mesh.triangles.size()));
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    put(bytes, mesh.vertices[i]);
    put(bytes, i < mesh.normals.size() ? mesh.normals[i] : Point3f{});
  }
  for (const auto& triangle : mesh.triangles) {
    bytes.push_back(std::byte{3});
    for (const std::uint32_t corner : triangle) put(bytes, corner);
  }
  if (Outcome stored = store(folder / "model.ply", bytes); !stored) return stored.error();

  const std::filesystem::path poses = folder / "truth" / "poses.txt";
  writer->poses_.reset(std::fopen(poses.c_str(), "wb"));
  if (!writer->poses_) return failed(poses);
  std::fputs("# seconds frame present part tx ty tz qx qy qz qw\n", writer->poses_.get());
  return writer;
}

Outcome TruthWriter::write(std::int64_t position, const SimulatedTruth& truth) {
  bytes_.clear();
  put_text(bytes_, fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\n"
                               "property float y\nproperty float z\nproperty uchar visible\n"
                               "property char part\nend_header\n",
                               truth.vertices.size()));
  for (std::size_t i = 0; i < truth.vertices.size(); ++i) {
    put(bytes_, truth.vertices[i]);
    bytes_.push_back(static_cast<std::byte>(truth.visible[i]));
    bytes_.push_back(static_cast<std::byte>(truth.vertex_part[i]));
  }
  if (Outcome stored = store(folder_ / "truth" / fmt::format("{:06}.ply", position), bytes_); !stored)
    return stored;

  const std::filesystem::path poses = folder_ / "truth" / "poses.txt";
  if (!poses_) return Error{ErrorKind::write, fmt::format("{}: is finished", poses.string())};
  std::string lines;
  for (std::size_t part = 0; part < truth.parts.size(); ++part) {
    const RigidTransform& pose = truth.parts[part];
    const Quaternion q = quaternion_from_rotation(pose.rotation);
    const Vector3& t = pose.translation;
    lines += fmt::format("{}.{:06} {} {} {} {:.7f} {:.7f} {:.7f} {:.9f} {:.9f} {:.9f} {:.9f}\n",
                         truth.utime / 1000000, truth.utime % 1000000, position, truth.present ? 1 : 0, part,
                         t.x(), t.y(), t.z(), q.x, q.y, q.z, q.w);
  }
  if (std::fputs(lines.c_str(), poses_.get()) < 0 || std::fflush(poses_.get()) != 0) return failed(poses);
  return success();
}

Outcome TruthWriter::finish() {
  if (poses_ && std::fclose(poses_.release()) != 0) return failed(folder_ / "truth" / "poses.txt");
  return success();
}

}  // namespace pliant
