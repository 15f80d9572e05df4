#include <cstdint>
#include <cstring>
#include <memory>

#include "core/model/model_view.hpp"
#include "core/track/patches.hpp"
#include "drivers/model_files/describe_model.hpp"
#include "drivers/model_files/model_image.hpp"
#include "tests/fuzz/promises.hpp"
#include "tests/fuzz/targets.hpp"

namespace pliant {

namespace {

void walk_network(const ModelView& view) {
  const std::size_t patches = view.patches().size();
  promise(patches > 0 && patches <= limits::kMaxPatches, "patches within the limit");
  promise(view.surface_links().size() <= limits::kMaxBorders, "links along the surface within the limit");
  promise(view.body_links().size() <= limits::kMaxBodyLinks, "links across the body within the limit");
  for (const ModelPatch& patch : view.patches()) promise(patch.points > 0, "patches have points");
  for (std::size_t i = 0; i < view.size(); ++i) {
    promise(view.patch_of()[i] < patches, "points belong to patches");
    for (const std::uint8_t p : view.blends()[i].patch) promise(p < patches, "blends are of patches");
  }
  for (const SurfaceLink& link : view.surface_links())
    promise(link.a < link.b && link.b < patches && link.length > 0, "links join patches");
  for (const BodyLink& link : view.body_links())
    promise(link.a < link.b && link.b < patches && link.length > 0, "links across join patches");
  promise(view.material() >= 0 && view.material() <= 1, "the material is one");
  const auto tables = std::make_unique<PatchTables>();
  tables->start(view);
  promise(tables->count == patches, "the tracker takes the network up");
}

void open_and_walk(Bytes image) {
  ModelView view;
  const ModelFault fault = ModelView::open(image, view);
  promise(view.empty() == (fault != ModelFault::none), "a view exists only of a good image");
  promise(*describe(fault) != '\0', "each fault has words");
  if (view.empty()) return;
  promise(view.size() > 0 && view.size() <= limits::kMaxModelPoints, "points within the limit");
  promise(view.keypoint_count() <= limits::kMaxModelKeypoints, "keypoints within the limit");
  double sum = 0;
  for (std::size_t i = 0; i < view.size(); ++i) {
    sum += static_cast<double>(view.positions()[i].x) + view.normals()[i].z;
    for (const std::uint16_t n : view.neighbours(i))
      promise(n == kNoNeighbour || n < view.size(), "neighbours are points");
  }
  for (const Descriptor& d : view.descriptors())
    for (const std::int8_t bin : d.bins) promise(bin >= 0, "descriptors are not negative");
  for (const LocalFrame& f : view.frames()) sum += f.axes[8];
  promise(sum - sum == 0, "positions are finite");
  walk_network(view);
  promise(!describe_model(view).empty(), "a model can be described");
}

}  // namespace

void fuzz_model(Bytes data) {
  // A copy of just its size, aligned as a mapped file is.
  const std::size_t words = (data.size() + 7) / 8;
  const auto storage = std::make_unique<std::uint64_t[]>(words + 1);
  const std::span<std::byte> image(static_cast<std::byte*>(static_cast<void*>(storage.get())), data.size());
  if (!data.empty()) std::memcpy(image.data(), data.data(), data.size());
  open_and_walk(image);

  // Past the first fences: what a checksum cannot tell must be told by the checks behind it.
  if (image.size() < sizeof(ModelHeader)) return;
  const std::span<std::byte> whole = image.first(image.size() / 8 * 8);
  ModelHeader header;
  std::memcpy(&header, whole.data(), sizeof header);
  header.magic = ModelHeader::kMagic;
  header.byte_order = ModelHeader::kByteOrder;
  header.version = ModelHeader::kVersion;
  header.bytes = whole.size();
  std::memcpy(whole.data(), &header, sizeof header);
  seal_model_image(whole);
  open_and_walk(whole);
}

}  // namespace pliant
