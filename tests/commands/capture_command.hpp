// What the tests of pliant model capture share.
#pragma once

#include <string>
#include <vector>

#include "tests/commands/program.hpp"

namespace pliant::test {

/// Small pictures and coarse voxels: what is written counts here, how good it is in tests/capture.
class CaptureCommand : public CommandTest {
 protected:
  [[nodiscard]] static std::vector<std::string> words(const std::string& source, const std::string& output) {
    return {"model",  "capture", "--source", source,  "-o",        output,
            "--size", "0.4",     "--voxel",  "0.004", "--lcm-url", "none"};
  }
};

inline constexpr const char* kTurned = "simulated:box?motion=turned&frames=70&width=320&height=240";

}  // namespace pliant::test
