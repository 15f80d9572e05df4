// SIGINT and SIGTERM end a run with its outputs whole.
#include <signal.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "tests/commands/program.hpp"

namespace pliant::test {
namespace {

class Signals : public CommandTest, public testing::WithParamInterface<int> {};

TEST_P(Signals, EndARunWell) {
  const pid_t process = start_pliant(
      {"run", "--source", "simulated:cushion?frames=100000&width=320&height=240", "--pace", "realtime",
       "--lcm-url", "none", "--stats", at("s.json"), "--trajectory", at("t.txt"), "--points", at("points")},
      folder_);
  // The first points file shows that the run is well under way.
  for (int i = 0; i < 1000; ++i) {
    std::error_code ignored;
    if (std::filesystem::exists(at("points")) && count_files(at("points")) > 3) break;
    usleep(20'000);
  }
  kill(process, GetParam());
  const Ended ended = wait_for(process, folder_);
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_EQ(ended.err, "");
  const nlohmann::json stats = nlohmann::json::parse(read_file(at("s.json")));
  const auto tracked = stats["tracked"].get<std::size_t>();
  EXPECT_GT(tracked, 0U);
  const std::string trajectory = read_file(at("t.txt"));
  EXPECT_EQ(static_cast<std::size_t>(std::count(trajectory.begin(), trajectory.end(), '\n')), tracked);
  EXPECT_EQ(count_files(at("points")), tracked);
}

INSTANTIATE_TEST_SUITE_P(Both, Signals, testing::Values(SIGINT, SIGTERM),
                         [](const auto& about) { return about.param == SIGINT ? "SIGINT" : "SIGTERM"; });

}  // namespace
}  // namespace pliant::test
