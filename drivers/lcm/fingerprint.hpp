// LCM's fingerprints, computed from the fields at compile time: what lcm-gen computes from the .lcm files.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string_view>

namespace pliant::wire {

/// One dimension of an array: a number, or the name of the field that holds the count.
struct Dimension {
  std::string_view size;
  bool variable = false;
};

/// Builds the fingerprint of one struct from its fields in order. The struct's own name takes no part.
class FingerprintBuilder {
 public:
  constexpr FingerprintBuilder& field(std::string_view type, std::string_view name,
                                      std::initializer_list<Dimension> dimensions = {}) noexcept {
    add_string(name);
    add_string(type);
    add_dimensions(dimensions);
    return *this;
  }
  /// A field of a struct type, whose fingerprint is `nested`.
  constexpr FingerprintBuilder& field(std::uint64_t nested, std::string_view name,
                                      std::initializer_list<Dimension> dimensions = {}) noexcept {
    add_string(name);
    add_dimensions(dimensions);
    nested_ += nested;
    return *this;
  }
  [[nodiscard]] constexpr std::uint64_t value() const noexcept {
    const std::uint64_t sum = hash_ + nested_;
    return (sum << 1) + (sum >> 63);
  }

 private:
  constexpr void add(std::uint64_t c) noexcept {
    // LCM shifts a signed 64-bit number: the sign is carried along.
    const std::uint64_t high = (hash_ >> 55) | ((hash_ >> 63) != 0 ? ~std::uint64_t{0} << 9 : 0);
    hash_ = ((hash_ << 8) ^ high) + c;
  }
  constexpr void add_string(std::string_view text) noexcept {
    add(text.size());
    for (const char c : text) add(static_cast<unsigned char>(c));
  }
  constexpr void add_dimensions(std::initializer_list<Dimension> dimensions) noexcept {
    add(dimensions.size());
    for (const Dimension& dimension : dimensions) {
      add(dimension.variable ? 1 : 0);
      add_string(dimension.size);
    }
  }

  std::uint64_t hash_ = 0x12345678;
  std::uint64_t nested_ = 0;
};

inline constexpr std::uint64_t kPoseFingerprint = FingerprintBuilder()
                                                      .field("int64_t", "utime")
                                                      .field("double", "trans", {{"3"}})
                                                      .field("double", "quat", {{"4"}})
                                                      .value();

inline constexpr std::uint64_t kRegionFingerprint = FingerprintBuilder()
                                                        .field("int8_t", "id")
                                                        .field("int8_t", "parent")
                                                        .field("int32_t", "points")
                                                        .field("float", "rms")
                                                        .field("float", "confidence")
                                                        .field("double", "trans", {{"3"}})
                                                        .field("double", "quat", {{"4"}})
                                                        .field("float", "joint", {{"3"}})
                                                        .value();

inline constexpr std::uint64_t kRegionsFingerprint =
    FingerprintBuilder()
        .field("int64_t", "utime")
        .field("int64_t", "frame")
        .field("int64_t", "model_id")
        .field("int8_t", "state")
        .field("float", "confidence")
        .field("int16_t", "part")
        .field("int16_t", "parts")
        .field("int32_t", "num_regions")
        .field(kRegionFingerprint, "regions", {{"num_regions", true}})
        .field("int32_t", "model_points")
        .field("int32_t", "first_point")
        .field("int32_t", "num_labels")
        .field("int8_t", "labels", {{"num_labels", true}})
        .value();

inline constexpr std::uint64_t kDeformedFingerprint =
    FingerprintBuilder()
        .field("int64_t", "utime")
        .field("int64_t", "frame")
        .field("int64_t", "model_id")
        .field("int16_t", "part")
        .field("int16_t", "parts")
        .field("int32_t", "num_deformed")
        .field("int32_t", "num_points")
        .field("int16_t", "index", {{"num_points", true}})
        .field("float", "position", {{"num_points", true}, {"3"}})
        .field("float", "displacement", {{"num_points", true}, {"3"}})
        .field("float", "strain", {{"num_points", true}})
        .value();

inline constexpr std::uint64_t kStatusFingerprint =
    FingerprintBuilder()
        .field("int64_t", "utime")
        .field("string", "version")
        .field("string", "source")
        .field("int64_t", "model_id")
        .field("int64_t", "frame")
        .field("int8_t", "state")
        .field("int8_t", "device")
        .field("int8_t", "stream_fault")
        .field("float", "rate")
        .field("float", "strain_energy")
        .field("int32_t", "latency_median")
        .field("int32_t", "latency_p99")
        .field("int32_t", "latency_max")
        .field("int32_t", "num_stages")
        .field("string", "stage", {{"num_stages", true}})
        .field("int32_t", "stage_median", {{"num_stages", true}})
        .field("int32_t", "stage_p99", {{"num_stages", true}})
        .field("int32_t", "stage_max", {{"num_stages", true}})
        .field("int64_t", "tracked")
        .field("int64_t", "searching")
        .field("int64_t", "lost")
        .field("int64_t", "dropped")
        .field("int64_t", "bad_frames")
        .field("int64_t", "zero_frames")
        .field("int64_t", "stuck_frames")
        .field("int64_t", "noise_frames")
        .field("int64_t", "wrong_size_frames")
        .field("int64_t", "delayed_frames")
        .field("int64_t", "slow_frames")
        .field("int64_t", "broken_frames")
        .field("int64_t", "stalls")
        .field("int64_t", "reopenings")
        .field("int64_t", "deadline_misses")
        .field("int64_t", "unsent")
        .field("int64_t", "send_failures")
        .field("int64_t", "workspace_bytes")
        .field("int64_t", "rss_bytes")
        .field("int64_t", "heap_calls")
        .field("int64_t", "page_faults")
        .field("string", "last_error")
        .value();

inline constexpr std::uint64_t kDepthFingerprint = FingerprintBuilder()
                                                       .field("int64_t", "utime")
                                                       .field("int64_t", "frame")
                                                       .field("int16_t", "part")
                                                       .field("int16_t", "parts")
                                                       .field("int32_t", "width")
                                                       .field("int32_t", "height")
                                                       .field("double", "fx")
                                                       .field("double", "fy")
                                                       .field("double", "cx")
                                                       .field("double", "cy")
                                                       .field("double", "depth_scale")
                                                       .field("int32_t", "first_row")
                                                       .field("int32_t", "num_rows")
                                                       .field("int32_t", "num_bytes")
                                                       .field("byte", "depth", {{"num_bytes", true}})
                                                       .value();

inline constexpr std::uint64_t kModelFingerprint =
    FingerprintBuilder()
        .field("int64_t", "model_id")
        .field("int16_t", "part")
        .field("int16_t", "parts")
        .field("int32_t", "model_points")
        .field("int32_t", "first_point")
        .field("int32_t", "num_points")
        .field("float", "spacing")
        .field("float", "origin", {{"3"}})
        .field("float", "step")
        .field("int16_t", "position", {{"num_points", true}, {"3"}})
        .field("int8_t", "normal", {{"num_points", true}, {"3"}})
        .value();

}  // namespace pliant::wire
