// Typed errors of everything outside the core.
#pragma once

#include <string>
#include <utility>
#include <variant>

namespace pliant {

/// What kind of failure; decides the program's exit code.
enum class ErrorKind {
  bad_input,  ///< something the user named is missing, unreadable, malformed or out of range (exit 2)
  absent,     ///< the device is not there, but may come (exit 3)
  device,     ///< a device failed or was lost for good (exit 3)
  write       ///< an output could not be written (exit 3)
};

/// One line for people: what, where and the mend.
struct Error {
  ErrorKind kind = ErrorKind::bad_input;
  std::string message;
};

/// A value or an error.
template <typename T>
class [[nodiscard]] Result {
 public:
  Result(T value) : content_(std::move(value)) {}      // NOLINT(google-explicit-constructor)
  Result(Error error) : content_(std::move(error)) {}  // NOLINT(google-explicit-constructor)
  explicit operator bool() const { return content_.index() == 0; }
  T& operator*() { return std::get<0>(content_); }
  const T& operator*() const { return std::get<0>(content_); }
  T* operator->() { return &std::get<0>(content_); }
  const T* operator->() const { return &std::get<0>(content_); }
  [[nodiscard]] const Error& error() const { return std::get<1>(content_); }

 private:
  std::variant<T, Error> content_;
};

/// Nothing or an error.
using Outcome = Result<std::monostate>;
inline Outcome success() {
  return std::monostate{};
}

}  // namespace pliant
