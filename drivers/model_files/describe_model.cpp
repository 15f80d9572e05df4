#include "drivers/model_files/describe_model.hpp"

#include <fmt/format.h>

#include "drivers/model_files/characterisability.hpp"

namespace pliant {

const char* describe(ModelHeader::Ambiguity ambiguity) noexcept {
  switch (ambiguity) {
    case ModelHeader::Ambiguity::none:
      return "";
    case ModelHeader::Ambiguity::sphere:
      return "it is round like a sphere and looks the same however it is turned";
    case ModelHeader::Ambiguity::plane:
      return "it is flat like a plane and looks the same wherever it is shifted and turned in it";
    case ModelHeader::Ambiguity::rotation:
      return "it is round about an axis and looks the same however it is turned about it";
    case ModelHeader::Ambiguity::translation:
      return "it looks the same when shifted along itself";
    case ModelHeader::Ambiguity::featureless:
      return "it has too little shape to tell where it is";
  }
  return "";
}

namespace {

template <typename Link>
std::string describe_links(std::span<const Link> links) {
  if (links.empty()) return "none";
  double sum = 0;
  for (const Link& link : links) sum += link.length;
  return fmt::format("{}, {:.1f} mm long on average", links.size(),
                     1000 * sum / static_cast<double>(links.size()));
}

/// Which way the model slips, found from its points: a file holds only the kind.
std::string free_motions_of(const ModelView& model) {
  OrientedCloud cloud;
  for (const Point3f& p : model.positions())
    cloud.points.emplace_back(static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z));
  for (const Normal16& n : model.normals()) cloud.normals.emplace_back(Vector3(n.x, n.y, n.z) / 16384.0);
  const Characterisability shape = characterise(cloud, model.header().spacing);
  return static_cast<std::uint32_t>(shape.ambiguity) == model.header().ambiguity ? shape.motions : "";
}

}  // namespace

std::string describe_model(const ModelView& model) {
  const ModelHeader& h = model.header();
  const auto ambiguity = static_cast<ModelHeader::Ambiguity>(h.ambiguity);
  std::string text;
  text += fmt::format("version: {}\n", h.version);
  text += fmt::format("points: {}\n", h.point_count);
  text += fmt::format("keypoints: {}\n", h.keypoint_count);
  text += fmt::format("bytes: {}\n", h.bytes);
  text += fmt::format("spacing: {:.2f} mm\n", 1000 * h.spacing);
  text += fmt::format("extent: {:.1f} x {:.1f} x {:.1f} mm\n", 1000 * (h.highest[0] - h.lowest[0]),
                      1000 * (h.highest[1] - h.lowest[1]), 1000 * (h.highest[2] - h.lowest[2]));
  text += fmt::format("centre: {:.4f} {:.4f} {:.4f} m\n", h.centre[0], h.centre[1], h.centre[2]);
  text += fmt::format("descriptor radius: {:.1f} mm\n", 1000 * h.support_radius);
  text +=
      fmt::format("patches: {}, {:.1f} mm in radius\n", model.patches().size(), 1000 * model.patch_radius());
  text += fmt::format("links along the surface: {}\n", describe_links(model.surface_links()));
  text += fmt::format("links across the body: {}\n", describe_links(model.body_links()));
  text += fmt::format("material: {:g} (0 stiff, 1 soft)\n", model.material());
  text += fmt::format("surface: {}\n", (h.flags & ModelHeader::kClosedSurface) != 0 ? "closed" : "open");
  if ((h.flags & ModelHeader::kFrontOnly) != 0) text += "back: unknown\n";
  if (model.characterisable())
    return text + fmt::format("characterisable: yes ({:.2f})\n", h.characterisability);
  text += fmt::format("characterisable: no ({:.2f}): {}\n", h.characterisability, describe(ambiguity));
  const std::string motions = free_motions_of(model);
  if (!motions.empty()) text += fmt::format("not noticed: {}\n", motions);
  return text;
}

}  // namespace pliant
