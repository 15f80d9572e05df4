// LCM's wire format: big-endian, packed, in the order of the type's fields, behind the type's fingerprint.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <string_view>
#include <type_traits>

namespace pliant::wire {

namespace detail {
template <std::size_t Bytes>
using UnsignedOf =
    std::conditional_t<Bytes == 1, std::uint8_t,
                       std::conditional_t<Bytes == 2, std::uint16_t,
                                          std::conditional_t<Bytes == 4, std::uint32_t, std::uint64_t>>>;
}  // namespace detail

/// Writes into a buffer of fixed size. What does not fit is not written and shows in ok().
class Writer {
 public:
  explicit Writer(std::span<std::uint8_t> out) noexcept : out_(out) {}

  /// An integer or floating-point number of LCM's types; `T` is named at the call so that it shows the type.
  template <typename T>
  void put(std::type_identity_t<T> value) noexcept {
    static_assert(std::is_arithmetic_v<T> && sizeof(T) <= 8);
    using Bits = detail::UnsignedOf<sizeof(T)>;
    if (out_.size() - at_ < sizeof(T)) {
      ok_ = false;
      return;
    }
    const auto bits = std::bit_cast<Bits>(value);
    for (std::size_t i = 0; i < sizeof(T); ++i) {
      out_[at_ + i] = static_cast<std::uint8_t>(bits >> (8 * (sizeof(T) - 1 - i)));
    }
    at_ += sizeof(T);
  }
  void put_bytes(std::span<const std::int8_t> bytes) noexcept {
    if (out_.size() - at_ < bytes.size()) {
      ok_ = false;
      return;
    }
    if (!bytes.empty()) std::memcpy(out_.data() + at_, bytes.data(), bytes.size());
    at_ += bytes.size();
  }
  /// Depth readings as bytes, low byte first.
  void put_little_endian(std::span<const std::uint16_t> values) noexcept {
    if (out_.size() - at_ < values.size_bytes()) {
      ok_ = false;
      return;
    }
    if constexpr (std::endian::native == std::endian::little) {
      if (!values.empty()) std::memcpy(out_.data() + at_, values.data(), values.size_bytes());
      at_ += values.size_bytes();
    } else {
      for (const std::uint16_t value : values) {
        out_[at_++] = static_cast<std::uint8_t>(value & 0xFFU);
        out_[at_++] = static_cast<std::uint8_t>(value >> 8);
      }
    }
  }
  /// An LCM string: its length with the closing zero, the characters, the zero. At most `limit` characters;
  /// cut before a zero and never inside a UTF-8 sequence.
  void put_string(std::string_view text, std::size_t limit) noexcept;

  [[nodiscard]] bool ok() const noexcept { return ok_; }
  [[nodiscard]] std::size_t size() const noexcept { return at_; }
  [[nodiscard]] std::span<const std::uint8_t> written() const noexcept { return out_.first(at_); }

 private:
  std::span<std::uint8_t> out_;
  std::size_t at_ = 0;
  bool ok_ = true;
};

/// Reads from a buffer of any content. After the first read beyond its end everything is zero and ok() false.
class Reader {
 public:
  explicit Reader(std::span<const std::uint8_t> in) noexcept : in_(in) {}

  template <typename T>
  [[nodiscard]] T get() noexcept {
    static_assert(std::is_arithmetic_v<T> && sizeof(T) <= 8);
    using Bits = detail::UnsignedOf<sizeof(T)>;
    if (!ok_ || in_.size() - at_ < sizeof(T)) {
      ok_ = false;
      return T{};
    }
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i) bits = (bits << 8) | in_[at_ + i];
    at_ += sizeof(T);
    return std::bit_cast<T>(static_cast<Bits>(bits));
  }
  /// The next `count` bytes, or none when there are fewer.
  [[nodiscard]] std::span<const std::uint8_t> get_bytes(std::size_t count) noexcept {
    if (!ok_ || in_.size() - at_ < count) {
      ok_ = false;
      return {};
    }
    at_ += count;
    return in_.subspan(at_ - count, count);
  }
  /// A string; malformed where its length is below one, beyond the buffer or without a closing zero, or where
  /// a zero stands inside.
  [[nodiscard]] std::string_view get_string() noexcept;
  /// A count of elements of `element_bytes` each that are still to come: malformed when negative, above
  /// `limit` or more than the buffer can hold.
  [[nodiscard]] std::size_t get_count(std::size_t element_bytes, std::size_t limit) noexcept;

  [[nodiscard]] bool ok() const noexcept { return ok_; }
  [[nodiscard]] bool at_end() const noexcept { return at_ == in_.size(); }

 private:
  std::span<const std::uint8_t> in_;
  std::size_t at_ = 0;
  bool ok_ = true;
};

}  // namespace pliant::wire
