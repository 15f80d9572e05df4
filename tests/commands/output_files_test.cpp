// What stood under an output's name stays there until the new file is whole.
#include <sys/resource.h>

#include "tests/commands/program.hpp"

namespace pliant::test {
namespace {

/// While one lives, programs that are started write no file longer than `bytes`, as if the disk were full.
class LittleRoom {
 public:
  explicit LittleRoom(rlim_t bytes) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit little{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &little);
  }
  LittleRoom(const LittleRoom&) = delete;
  LittleRoom& operator=(const LittleRoom&) = delete;
  ~LittleRoom() { setrlimit(RLIMIT_FSIZE, &before_); }

 private:
  rlimit before_{};
};

class OutputFiles : public CommandTest {
 protected:
  /// A run's log.
  [[nodiscard]] std::string log() const {
    const Ended ended = run_pliant({"run", "--source", "simulated:cushion?frames=30&width=320&height=240",
                                    "--lcm-url", "file://" + at("run.log") + "?mode=w"});
    EXPECT_EQ(ended.code, 0) << ended.err;
    return at("run.log");
  }
};

TEST_F(OutputFiles, AnExportThatCannotBeginLeavesTheOldFile) {
  write_file(at("old.txt"), "what was there");
  expect_refused(run_pliant({"export", log(), "--tum", at("old.txt"), "--mcap", at("nodir/m")}), 3,
                 {"nodir"});
  EXPECT_EQ(read_file(at("old.txt")), "what was there");
}

TEST_F(OutputFiles, AnExportThatDoesNotFitLeavesTheOldFiles) {
  const std::string path = log();
  std::filesystem::create_directories(at("tables"));
  for (const char* name : {"old.txt", "old.mcap", "tables/frames.csv"})
    write_file(at(name), "what was there");
  for (const auto& [option, name, room] :
       {std::tuple{"--tum", "old.txt", 500}, {"--mcap", "old.mcap", 20'000}, {"--csv", "tables", 1000}}) {
    const LittleRoom little(static_cast<rlim_t>(room));
    expect_refused(run_pliant({"export", path, option, at(name)}), 3, {name, "File too large"});
  }
  for (const char* name : {"old.txt", "old.mcap", "tables/frames.csv"})
    EXPECT_EQ(read_file(at(name)), "what was there") << name;
  EXPECT_EQ(count_files(at("tables")), 1U) << "no half table, and nothing beside";
}

TEST_F(OutputFiles, APictureThatDoesNotFitLeavesTheOldOne) {
  const std::string path = log();
  write_file(at("old.png"), "what was there");
  {
    const LittleRoom little(1000);
    expect_refused(run_pliant({"snapshot", "--log", path, "-o", at("old.png")}), 3,
                   {"old.png", "File too large"});
  }
  EXPECT_EQ(read_file(at("old.png")), "what was there");
  EXPECT_EQ(run_pliant({"snapshot", "--log", path, "-o", at("old.png")}).code, 0);
  EXPECT_NE(read_file(at("old.png")), "what was there");
}

TEST_F(OutputFiles, ALimitOfTheFilesSizeEndsALogWell) {
  const LittleRoom little(200'000);
  expect_refused(run_pliant({"run", "--source", "simulated:cushion?frames=60&width=320&height=240",
                             "--lcm-url", "file://" + at("run.log") + "?mode=w"}),
                 3, {"run.log", "File too large", "ulimit"});
  const Ended ended = run_pliant({"export", at("run.log"), "--tum", at("t.txt")});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_EQ(ended.err.find("damaged stretch"), std::string::npos) << ended.err;
}

}  // namespace
}  // namespace pliant::test
