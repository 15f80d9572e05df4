// What the fuzzers call: each gives bytes to one parser and aborts when its answer breaks a promise.
#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace pliant {

using Bytes = std::span<const std::byte>;

void fuzz_camera(Bytes data);
void fuzz_config(Bytes data);
void fuzz_depth_list(Bytes data);
void fuzz_export(Bytes data);
void fuzz_lcm_log(Bytes data);
void fuzz_message(Bytes data);
void fuzz_model(Bytes data);
void fuzz_obj(Bytes data);
void fuzz_off(Bytes data);
void fuzz_oni(Bytes data);
void fuzz_pcd(Bytes data);
void fuzz_ply(Bytes data);
void fuzz_png(Bytes data);
void fuzz_sensor(Bytes data);
void fuzz_stl(Bytes data);
void fuzz_v4l2(Bytes data);

/// A target and the folder of its corpus.
struct FuzzTarget {
  const char* name;
  void (*run)(Bytes data);
};
inline constexpr std::array<FuzzTarget, 16> kFuzzTargets = {{{"camera", fuzz_camera},
                                                             {"config", fuzz_config},
                                                             {"depth_list", fuzz_depth_list},
                                                             {"export", fuzz_export},
                                                             {"lcm_log", fuzz_lcm_log},
                                                             {"message", fuzz_message},
                                                             {"model", fuzz_model},
                                                             {"obj", fuzz_obj},
                                                             {"off", fuzz_off},
                                                             {"oni", fuzz_oni},
                                                             {"pcd", fuzz_pcd},
                                                             {"ply", fuzz_ply},
                                                             {"png", fuzz_png},
                                                             {"sensor", fuzz_sensor},
                                                             {"stl", fuzz_stl},
                                                             {"v4l2", fuzz_v4l2}}};

}  // namespace pliant
