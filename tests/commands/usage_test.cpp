// Help, version and words that the program does not know.
#include "tests/commands/program.hpp"

namespace pliant::test {
namespace {

TEST(Usage, EveryCommandHasHelp) {
  const std::vector<std::vector<std::string>> commands = {
      {},      {"model"},    {"model", "build"}, {"model", "info"}, {"model", "export"},
      {"run"}, {"register"}, {"record"},         {"check"}};
  for (std::vector<std::string> words : commands) {
    words.emplace_back("--help");
    const Ended ended = run_pliant(words);
    EXPECT_EQ(ended.code, 0);
    EXPECT_NE(ended.out.find("Usage:"), std::string::npos) << ended.out;
    EXPECT_EQ(ended.err, "");
  }
}

TEST(Usage, VersionIsTold) {
  const Ended ended = run_pliant({"--version"});
  EXPECT_EQ(ended.code, 0);
  EXPECT_EQ(ended.out.rfind("pliant ", 0), 0U) << ended.out;
}

TEST(Usage, UnknownWordsAreRefusedInOneLine) {
  expect_refused(run_pliant({}), 2, {"--help"});
  expect_refused(run_pliant({"fly"}), 2, {"--help"});
  expect_refused(run_pliant({"model"}), 2, {"pliant model --help"});
  expect_refused(run_pliant({"model", "build"}), 2, {"INPUT", "pliant model build --help"});
  expect_refused(run_pliant({"run", "--sorce", "x"}), 2, {"--sorce", "pliant run --help"});
  expect_refused(run_pliant({"run", "--frames", "many"}), 2, {"--frames"});
}

TEST(Usage, AWordThatIsNoCommandIsNamedWithThoseThereAre) {
  expect_refused(run_pliant({"bogus"}), 2, {"'bogus' is no command", "model, ", "run", "export"});
  expect_refused(run_pliant({"--bogus", "run"}), 2, {"--bogus"});
  expect_refused(run_pliant({"model", "biuld", "x", "-o", "y"}), 2,
                 {"'biuld' is no command", "build, capture, info, export", "pliant model --help"});
  expect_refused(run_pliant({"model"}), 2, {"a command is missing", "build"});
  expect_refused(run_pliant({}), 2, {"a command is missing", "register"});
}

TEST(Usage, ValuesOutOfRangeAreRefusedInOneLine) {
  expect_refused(run_pliant({"run", "--frames", "0"}), 2, {"--frames"});
  expect_refused(run_pliant({"run", "--frames", "-3"}), 2, {"--frames"});
  expect_refused(run_pliant({"run", "--threads", "0"}), 2, {"--threads", "1 to 64"});
  expect_refused(run_pliant({"run", "--pace", "slow"}), 2, {"--pace"});
  expect_refused(run_pliant({"run", "--kernels", "mmx"}), 2, {"--kernels"});
  expect_refused(run_pliant({"model", "build", "x.ply", "-o", "y", "--units", "inch"}), 2, {"--units"});
  expect_refused(run_pliant({"model", "build", "x.ply", "-o", "y", "--spacing", "-1"}), 2, {"--spacing"});
}

}  // namespace
}  // namespace pliant::test
