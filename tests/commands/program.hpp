// Runs the program as a user does, and a folder for each test.
#pragma once

#include <gtest/gtest.h>
#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace pliant::test {

struct Ended {
  int code = -1;  ///< exit code, or 128 + the signal that ended it
  std::string out, err;
};

/// Runs `pliant` with these words and waits for its end.
[[nodiscard]] Ended run_pliant(const std::vector<std::string>& words);

/// Starts `pliant`; its output goes to `folder`/out.txt and err.txt.
[[nodiscard]] pid_t start_pliant(const std::vector<std::string>& words, const std::filesystem::path& folder);
[[nodiscard]] Ended wait_for(pid_t process, const std::filesystem::path& folder);

/// The error is one line that begins with "pliant: " and holds all of `parts`.
void expect_refused(const Ended& ended, int code, const std::vector<std::string>& parts);

[[nodiscard]] std::string read_file(const std::filesystem::path& path);
void write_file(const std::filesystem::path& path, const std::string& text);
[[nodiscard]] std::size_t count_files(const std::filesystem::path& folder);

/// A fresh folder, removed after the test.
class CommandTest : public testing::Test {
 protected:
  CommandTest();
  ~CommandTest() override;
  /// A path inside the folder.
  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }
  /// A recording of `frames` frames of the simulated box, 160x120.
  [[nodiscard]] std::string small_recording(int frames = 4) const;
  /// Records the endless or long `source` onto a disk of two megabytes: that ends with an error, and what was
  /// written is a whole recording. Skips the test where nothing can be mounted.
  void record_until_the_disk_is_full(const std::string& source) const;
  /// The model of the simulated box.
  [[nodiscard]] std::string box_model() const;

  std::filesystem::path folder_;
};

}  // namespace pliant::test
