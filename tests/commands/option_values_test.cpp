// Values of options that are no numbers, no whole ones, or nothing at all.
#include "tests/commands/program.hpp"

namespace pliant::test {
namespace {

using Words = std::vector<std::string>;

TEST(OptionValues, WhatIsNotAFiniteNumberIsRefused) {
  for (const char* value : {"nan", "-nan", "inf", "-inf", "1e999", "", "0.1x"}) {
    const std::string text = value;
    expect_refused(run_pliant({"model", "build", "simulated:box", "-o", "m", "--material", text}), 2,
                   {"--material", "from 0 to 1"});
    expect_refused(run_pliant({"model", "build", "simulated:box", "-o", "m", "--spacing", text}), 2,
                   {"--spacing"});
    for (const char* option : {"--material", "--clearance", "--size", "--voxel"})
      expect_refused(run_pliant({"model", "capture", "--source", "simulated:box", "-o", "m", option, text}),
                     2, {option});
    expect_refused(run_pliant({"snapshot", "-o", "p.png", "--wait", text}), 2, {"--wait"});
  }
  for (const char* value : {"nan,nan,nan", "0,0,inf", "1e308,0,0"})
    expect_refused(run_pliant({"register", "--model", "m", "--scene", "s", "-o", "r", "--viewpoint", value}),
                   2, {"--viewpoint"});
}

TEST(OptionValues, APixelIsTwoWholeNumbersFromZero) {
  const auto at = [](const char* u, const char* v) {
    return run_pliant({"model", "capture", "--source", "simulated:box", "-o", "m", "--at", u, v});
  };
  expect_refused(at("-5", "-5"), 2, {"--at", "'-5'", "whole number from 0"});
  expect_refused(at("1.5", "2"), 2, {"--at", "'1.5'"});
  expect_refused(at("nan", "2"), 2, {"--at", "'nan'"});
  expect_refused(at("3", "99999999999"), 2, {"--at"});
}

TEST(OptionValues, AFileWithoutANameIsRefused) {
  const Words run = {"run", "--source", "simulated:box?frames=1&width=160&height=120", "--lcm-url", "none"};
  const Words capture = {"model", "capture", "--source", "simulated:box", "-o", "m"};
  const Words scene = {"register", "--model", "m", "--scene", "s", "-o", "r"};
  const std::vector<std::pair<Words, Words>> cases = {
      {run, {"--stats", "--trajectory", "--points", "--config", "--model", "--sensor"}},
      {capture, {"--ply", "--sensor", "--poses", "--camera"}},
      {scene, {"--report", "--camera"}},
      {{"model", "build", "simulated:box"}, {"--output"}},
      {{"model", "capture", "--source", "simulated:box"}, {"--output"}},
      {{"model", "export", "m"}, {"--output"}},
      {{"register", "--model", "m", "--scene", "s"}, {"--output"}},
      {{"record", "--source", "simulated:box", "--frames", "1"}, {"--output"}},
      {{"record", "--source", "simulated:box", "--frames", "1", "-o", "r"}, {"--sensor"}},
      {{"snapshot"}, {"--output"}},
      {{"snapshot", "-o", "p.png"}, {"--log"}},
      {{"plot", "s.json"}, {"--output", "--truth", "--trajectory"}},
      {{"export", "l", "--tum", "t"}, {"--tum", "--ply", "--csv", "--mcap", "--model"}},
      {{"view"}, {"--config"}}};
  for (const auto& [words, options] : cases)
    for (const std::string& option : options) {
      Words all = words;
      all.insert(all.end(), {option, ""});
      if (option == "--tum") all = {"export", "l", option, ""};
      expect_refused(run_pliant(all), 2, {option + ": names no f"});
    }
}

}  // namespace
}  // namespace pliant::test
