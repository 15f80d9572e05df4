// What the mechanical constraints are worth: torn_scenes SCENES MODEL.ply... makes scenes in which a limb of
// an object lies where matter cannot have taken it and counts the groupings that a chain makes of it, with
// and without constraints.
#include <cstdio>
#include <cstdlib>

#include "tests/accuracy/torn_scenes.hpp"

int main(int argc, char** argv) {
  using namespace pliant;
  if (argc < 3) {
    std::fputs("usage: torn_scenes SCENES MODEL...\n", stderr);
    return 2;
  }
  std::vector<std::unique_ptr<BuiltFromFile>> models;
  for (int k = 2; k < argc; ++k) {
    models.push_back(std::make_unique<BuiltFromFile>(std::filesystem::path(argv[k])));
    if (models.back()->good) continue;
    std::fprintf(stderr, "torn_scenes: '%s' makes no model\n", argv[k]);
    return 2;
  }
  int scenes[3] = {}, false_without[3] = {}, false_with[3] = {}, found = 0;
  double tear_without = 0, tear_with = 0;
  const int wanted = std::max(1, std::atoi(argv[1]));
  for (int k = 0; k < wanted; ++k) {
    const ModelView& model = models[static_cast<std::size_t>(k) % models.size()]->view;
    const int kind = k / static_cast<int>(models.size()) % 3;
    const std::vector<Point3f> scene =
        torn_scene(model, static_cast<TornKind>(kind), static_cast<unsigned>(k + 1));
    const TornResult without = register_torn(model, scene, false), with = register_torn(model, scene, true);
    ++scenes[kind];
    found += with.found ? 1 : 0;
    false_without[kind] += without.regions;
    false_with[kind] += with.regions;
    tear_without = std::max(tear_without, without.worst_tear);
    tear_with = std::max(tear_with, with.worst_tear);
  }
  std::puts("| piece | scenes | false groupings, --no-constraints | with constraints |\n|---|---|---|---|");
  for (int kind = 0; kind < 3; ++kind)
    std::printf("| %s | %d | %d | %d |\n", kTornNames[kind], scenes[kind], false_without[kind],
                false_with[kind]);
  std::printf("| together | %d, %d found | %d | %d |\n| widest tear of a joint | | %.1f mm | %.1f mm |\n",
              wanted, found, false_without[0] + false_without[1] + false_without[2],
              false_with[0] + false_with[1] + false_with[2], 1e3 * tear_without, 1e3 * tear_with);
  return 0;
}
