// Helpers to write file contents down in tests.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <span>
#include <sstream>
#include <string>
#include <string_view>

#include "drivers/geometry_files/parsers.hpp"
#include "tests/temporary_folder.hpp"

namespace pliant::testing {

inline std::span<const std::byte> bytes_of(std::string_view text) {
  return {static_cast<const std::byte*>(static_cast<const void*>(text.data())), text.size()};
}

/// The object representation of `value`, its bytes turned round on request.
template <typename T>
std::string raw(T value, bool turned = false) {
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &value, sizeof(T));
  return turned ? std::string(bytes.rbegin(), bytes.rend()) : bytes;
}

using Parser = Result<Geometry> (*)(std::span<const std::byte>, std::string_view);

/// The error's line; fails the test when there is none.
inline std::string error_of(Parser parse, std::string_view text) {
  const Result<Geometry> geometry = parse(bytes_of(text), "file");
  EXPECT_FALSE(geometry) << "accepted: " << text.substr(0, 60);
  if (geometry) return {};
  EXPECT_EQ(geometry.error().kind, ErrorKind::bad_input);
  EXPECT_EQ(geometry.error().message.find('\n'), std::string::npos);
  EXPECT_EQ(geometry.error().message.rfind("file: ", 0), 0U) << geometry.error().message;
  return geometry.error().message;
}

/// The parsed contents; fails the test when they are refused.
inline Geometry parsed(Parser parse, std::string_view text) {
  Result<Geometry> geometry = parse(bytes_of(text), "file");
  EXPECT_TRUE(geometry) << geometry.error().message;
  return geometry ? *geometry : Geometry();
}

/// Every beginning of `text` but those the parser may take for a whole: must not crash. Returns how many were
/// accepted.
inline std::size_t accepted_beginnings(Parser parse, std::string_view text) {
  std::size_t accepted = 0;
  for (std::size_t length = 0; length < text.size(); ++length)
    accepted += parse(bytes_of(text.substr(0, length)), "file") ? 1U : 0U;
  return accepted;
}

inline bool mentions(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

using test::TemporaryFolder;

inline std::string contents(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

inline void put(const std::filesystem::path& path, std::string_view text) {
  std::ofstream(path, std::ios::binary).write(text.data(), static_cast<std::streamsize>(text.size()));
}

}  // namespace pliant::testing
