#include "tests/commands/program.hpp"

#include <fcntl.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <sstream>

namespace pliant::test {

namespace fs = std::filesystem;

namespace {

void redirect(const fs::path& file, int descriptor) {
  const int opened = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  if (opened < 0 || dup2(opened, descriptor) < 0) _exit(126);
  close(opened);
}

fs::path fresh_folder() {
  std::string name = (fs::path(testing::TempDir()) / "pliant_XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) ADD_FAILURE() << "no folder for the test in " << testing::TempDir();
  return name;
}

}  // namespace

pid_t start_pliant(const std::vector<std::string>& words, const fs::path& folder) {
  std::vector<char*> arguments;
  std::string program = PLIANT_PROGRAM;
  arguments.push_back(program.data());
  std::vector<std::string> copy = words;
  for (std::string& word : copy) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const pid_t child = fork();
  if (child == 0) {
    redirect(folder / "out.txt", STDOUT_FILENO);
    redirect(folder / "err.txt", STDERR_FILENO);
    execv(program.c_str(), arguments.data());
    _exit(127);
  }
  return child;
}

Ended wait_for(pid_t process, const fs::path& folder) {
  int status = 0;
  waitpid(process, &status, 0);
  Ended ended;
  ended.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  ended.out = read_file(folder / "out.txt");
  ended.err = read_file(folder / "err.txt");
  return ended;
}

Ended run_pliant(const std::vector<std::string>& words) {
  const fs::path folder = fresh_folder();
  const Ended ended = wait_for(start_pliant(words, folder), folder);
  fs::remove_all(folder);
  return ended;
}

void expect_refused(const Ended& ended, int code, const std::vector<std::string>& parts) {
  EXPECT_EQ(ended.code, code) << ended.err;
  EXPECT_TRUE(ended.err.starts_with("pliant: ")) << ended.err;
  EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1) << ended.err;
  for (const std::string& part : parts)
    EXPECT_NE(ended.err.find(part), std::string::npos) << part << "\n" << ended.err;
}

std::string read_file(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

void write_file(const fs::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

std::size_t count_files(const fs::path& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

CommandTest::CommandTest() : folder_(fresh_folder()) {}

CommandTest::~CommandTest() {
  fs::remove_all(folder_);
}

std::string CommandTest::small_recording(int frames) const {
  const std::string folder = at("recording");
  const Ended ended =
      run_pliant({"record", "--source", "simulated:box?width=160&height=120&frames=" + std::to_string(frames),
                  "-o", folder});
  EXPECT_EQ(ended.code, 0) << ended.err;
  return folder;
}

void CommandTest::record_until_the_disk_is_full(const std::string& source) const {
  std::filesystem::create_directories(at("disk"));
  if (unshare(CLONE_NEWNS) != 0 || mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0 ||
      mount("none", at("disk").c_str(), "tmpfs", 0, "size=2m") != 0)
    GTEST_SKIP() << "no file system can be mounted here";
  const Ended ended = run_pliant({"record", "--source", source, "-o", at("disk/r")});
  EXPECT_EQ(ended.code, 3);
  EXPECT_NE(ended.err.find("No space left on device"), std::string::npos) << ended.err;
  ASSERT_NE(ended.out.find("recorded "), std::string::npos) << ended.out;
  const std::size_t frames = std::stoul(ended.out.substr(ended.out.find("recorded ") + 9));
  EXPECT_GE(frames, 3U);
  // Every frame that is listed is there and whole, and none more.
  EXPECT_EQ(count_files(at("disk/r/depth")), frames);
  const Ended again = run_pliant({"record", "--source", "recording:" + at("disk/r"), "-o", at("copy")});
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_EQ(again.out.find("bad"), std::string::npos) << again.out;
  EXPECT_EQ(count_files(at("copy/depth")), frames);
  umount(at("disk").c_str());
}

std::string CommandTest::box_model() const {
  const std::string path = at("box.model");
  const Ended ended = run_pliant({"model", "build", "simulated:box", "-o", path});
  EXPECT_EQ(ended.code, 0) << ended.err;
  return path;
}

}  // namespace pliant::test
