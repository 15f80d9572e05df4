// round_trip LOG: decodes every message of a tracker's log with the classes that lcm-gen makes for C++,
// encodes it again, and compares. Prints the number of messages of each type.
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "bot_core/rigid_transform_t.hpp"
#include "drivers/lcm/lcm_log.hpp"
#include "pliant/deformed_t.hpp"
#include "pliant/depth_t.hpp"
#include "pliant/model_t.hpp"
#include "pliant/regions_t.hpp"
#include "pliant/status_t.hpp"

namespace {

template <typename Message>
bool same(const std::vector<std::uint8_t>& body) {
  Message message{};
  const int size = static_cast<int>(body.size());
  if (message.decode(body.data(), 0, size) != size || message.getEncodedSize() != size) return false;
  std::vector<std::uint8_t> again(body.size());
  return message.encode(again.data(), 0, size) == size && again == body;
}

}  // namespace

int main(int argc, char** argv) {
  auto log = pliant::LcmLog::open(argc > 1 ? argv[1] : "");
  if (!log) return 2;
  const std::map<std::string, bool (*)(const std::vector<std::uint8_t>&)> checks = {
      {"PLIANT_POSE", same<bot_core::rigid_transform_t>},
      {"PLIANT_REGIONS", same<pliant::regions_t>},
      {"PLIANT_DEFORMED", same<pliant::deformed_t>},
      {"PLIANT_STATUS", same<pliant::status_t>},
      {"PLIANT_DEPTH", same<pliant::depth_t>},
      {"PLIANT_MODEL", same<pliant::model_t>}};
  std::map<std::string, int> counts;
  pliant::LcmLogEvent event;
  while (log->next(event)) {
    const auto check = checks.find(event.channel);
    if (check == checks.end()) continue;
    if (!check->second(event.body)) {
      std::printf("%s differs\n", event.channel.c_str());
      return 1;
    }
    ++counts[event.channel];
  }
  for (const auto& [channel, count] : counts) std::printf("%s %d\n", channel.c_str(), count);
  return 0;
}
