#include "drivers/model_files/model_builder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>

#include "core/camera/sensor.hpp"
#include "core/camera/surface.hpp"
#include "core/detect/shot.hpp"
#include "drivers/model_files/characterisability.hpp"
#include "drivers/model_files/cloud_normals.hpp"
#include "drivers/model_files/farthest_point.hpp"
#include "drivers/model_files/mesh_cleaning.hpp"
#include "drivers/model_files/mesh_normals.hpp"
#include "drivers/model_files/mesh_orientation.hpp"
#include "drivers/model_files/model_image.hpp"
#include "drivers/model_files/nearest.hpp"
#include "drivers/model_files/neighbour_graph.hpp"
#include "drivers/model_files/outside_view.hpp"
#include "drivers/model_files/spring_network.hpp"
#include "drivers/model_files/surface_sampling.hpp"
#include "drivers/model_files/symmetry.hpp"

namespace pliant {

namespace {

/// Fewer vertices than this, or gaps wider than this many evenly spread points would leave, make a mesh
/// coarse.
constexpr std::size_t kLeastVertices = 2000;
constexpr std::size_t kLeastEvenPoints = 1500;
/// Fewer points say nothing about a shape.
constexpr std::size_t kLeastPoints = 50;
/// Least distance of a farthest-point sampling as a share of its mean.
constexpr double kLeastOfMean = 0.87;

/// Metres; beyond it floats do not resolve an object.
constexpr double kFarthestCoordinate = 1e5;

double farthest_coordinate(const Geometry& geometry) {
  float farthest = 0;
  for (const Point3f& p : geometry.vertices)
    farthest = std::max({farthest, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
  return static_cast<double>(farthest);
}

Error refuse(std::string_view what) {
  return {ErrorKind::bad_input, std::string(what)};
}

double mean_spacing(std::span<const Vector3> points) {
  const NearestPoints tree(points);
  double sum = 0;
  for (const Vector3& p : points) {
    std::array<std::uint32_t, 2> nearest{};
    std::array<double, 2> squares{};
    tree.nearest(p, nearest, squares);
    sum += std::sqrt(squares[1]) / static_cast<double>(points.size());
  }
  return sum;
}

OrientedCloud in_order(const OrientedCloud& cloud, const std::vector<std::uint32_t>& order) {
  OrientedCloud ordered;
  ordered.points.reserve(order.size());
  ordered.normals.reserve(order.size());
  for (const std::uint32_t i : order) {
    ordered.points.push_back(cloud.points[i]);
    ordered.normals.push_back(cloud.normals[i]);
  }
  return ordered;
}

/// Thins `cloud` out to the wished spacing and the most points a model can have, in farthest-point order.
OrientedCloud thinned(const OrientedCloud& cloud, double spacing, std::size_t most) {
  return in_order(cloud, farthest_point_order(cloud.points, most, kLeastOfMean * spacing));
}

/// Vertices whose triangles' normals cancel out take that of the nearest that has one.
void fill_normals(OrientedCloud& cloud) {
  std::vector<Vector3> known;
  std::vector<Vector3> known_normals;
  for (std::size_t i = 0; i < cloud.points.size(); ++i)
    if (!cloud.normals[i].isZero()) {
      known.push_back(cloud.points[i]);
      known_normals.push_back(cloud.normals[i]);
    }
  if (known.size() == cloud.points.size()) return;
  const NearestPoints tree(known);
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    double square = 0;
    if (cloud.normals[i].isZero())
      cloud.normals[i] =
          known.empty() ? Vector3(0, 0, 1) : known_normals[tree.nearest(cloud.points[i], square)];
  }
}

/// The model's points out of `cloud`, which stands for `given` vertices.
OrientedCloud chosen_points(const OrientedCloud& cloud, std::size_t given, double spacing,
                            BuiltModel& built) {
  const bool all_wanted = given <= limits::kMaxModelPoints || spacing > 0;
  OrientedCloud chosen = thinned(cloud, spacing, all_wanted ? limits::kMaxModelPoints : kUsualPoints);
  built.origin = chosen.points.size() < given ? PointOrigin::reduced_vertices : PointOrigin::input_vertices;
  return chosen;
}

/// The model's points, in farthest-point order.
OrientedCloud points_of_mesh(Mesh& mesh, const ModelBuildSettings& settings, BuiltModel& built) {
  const double spacing = settings.spacing;
  built.closed_surface = settings.wound_outward ? is_closed(mesh) : orient_mesh(mesh, built.warnings);
  const double area = surface_area(mesh);
  const double coarse = spacing > 0 ? spacing : even_spacing(area, kLeastEvenPoints);
  const bool enough = mesh.vertices.size() >= (spacing > 0 ? kLeastPoints : kLeastVertices);
  if (enough && vertices_are_dense(mesh, coarse)) {
    OrientedCloud cloud{mesh.vertices, vertex_normals(mesh)};
    fill_normals(cloud);
    return chosen_points(cloud, mesh.vertices.size(), spacing, built);
  }
  built.origin = PointOrigin::sampled_surface;
  const double wished =
      spacing > 0 ? even_count(area, spacing / kSamplingShare) : static_cast<double>(kUsualPoints);
  const auto count = static_cast<std::size_t>(
      std::clamp(wished, static_cast<double>(kLeastPoints), static_cast<double>(limits::kMaxModelPoints)));
  const OrientedCloud candidates = sample_surface(mesh, 8 * count);
  return in_order(candidates, farthest_point_order(candidates.points, count));
}

OrientedCloud points_of_cloud(const Mesh& mesh, double spacing, BuiltModel& built) {
  // Far more points than a model holds only slow the estimate of normals down.
  constexpr std::size_t kMostLookedAt = 8 * limits::kMaxModelPoints;
  const std::size_t step = (mesh.vertices.size() + kMostLookedAt - 1) / kMostLookedAt;
  OrientedCloud cloud;
  for (std::size_t i = 0; i < mesh.vertices.size(); i += step) {
    cloud.points.push_back(mesh.vertices[i]);
    cloud.normals.push_back(mesh.given_normals.empty() ? Vector3(Vector3::Zero()) : mesh.given_normals[i]);
  }
  const double given_spacing = mean_spacing(cloud.points);
  const bool any =
      std::any_of(cloud.normals.begin(), cloud.normals.end(), [](const Vector3& n) { return !n.isZero(); });
  cloud.normals = any ? complete_normals(cloud.points, cloud.normals, given_spacing, built.warnings)
                      : estimate_normals(cloud.points, given_spacing);
  return chosen_points(cloud, mesh.vertices.size(), spacing, built);
}

std::int16_t to_q14(double x) {
  return static_cast<std::int16_t>(std::floor(x * 16384 + 0.5));
}

/// Bounding box and sphere of the stored points, as the view checks them.
void measure(std::span<const Point3f> positions, ModelHeader& header) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto at = [axis](const Point3f& p) {
      return static_cast<double>(axis == 0 ? p.x : axis == 1 ? p.y : p.z);
    };
    header.lowest[axis] = header.highest[axis] = at(positions[0]);
    for (const Point3f& p : positions) {
      header.lowest[axis] = std::min(header.lowest[axis], at(p));
      header.highest[axis] = std::max(header.highest[axis], at(p));
    }
    header.centre[axis] = 0.5 * (header.lowest[axis] + header.highest[axis]);
  }
  for (const Point3f& p : positions) {
    const Vector3 d(static_cast<double>(p.x) - header.centre[0], static_cast<double>(p.y) - header.centre[1],
                    static_cast<double>(p.z) - header.centre[2]);
    header.radius = std::max(header.radius, d.norm());
  }
}

/// Descriptors and frames of the first points.
struct Keypoints {
  std::vector<Descriptor> descriptors;
  std::vector<LocalFrame> frames;
  std::size_t failed = 0;
};

Keypoints describe_keypoints(const OrientedPoints& points, std::size_t count, double support_radius) {
  PointGrid grid;
  ShotDescriber describer;
  const auto lay_out = [&](Workspace& workspace) {
    grid.lay_out(workspace, points.positions.size());
    describer.lay_out(workspace);
  };
  Workspace measuring;
  lay_out(measuring);
  const std::unique_ptr<void, decltype(&std::free)> block(
      std::aligned_alloc(Workspace::kAlignment, measuring.used()), &std::free);
  Workspace workspace({static_cast<std::byte*>(block.get()), measuring.used()});
  lay_out(workspace);

  Keypoints keypoints{std::vector<Descriptor>(count), std::vector<LocalFrame>(count)};
  if (!grid.build(points.positions, grid_cell_for_support(support_radius))) return keypoints;
  for (std::size_t i = 0; i < count; ++i)
    if (!describer.describe(points, grid, i, support_radius, keypoints.descriptors[i], keypoints.frames[i]))
      ++keypoints.failed;
  return keypoints;
}

/// Whether next to nothing of the inside can be seen, as with a scan that has some holes: there is a body.
bool encloses(const OrientedCloud& cloud, double spacing) {
  constexpr double kNearlyAll = 0.9;
  return outside_share(cloud, spacing) > kNearlyAll;
}

/// A model's places are kept in whole units, up to half a unit's diagonal away from where they were. Of an
/// object of a smaller radius they would not lie about the object any more, and ModelView::open refuses it.
const double kLeastRadius = std::sqrt(3.0) / 2 / kUnitsPerMetre;

const char* unit_advice(double metres_per_unit) {
  return metres_per_unit < 1 ? "its coordinates look like metres: build it without --units mm"
                             : "check its unit (--units m or --units mm)";
}

void warn_about_size(const BuiltModel& built, double metres_per_unit, std::vector<std::string>& warnings) {
  const double largest = std::max({built.extent[0], built.extent[1], built.extent[2]});
  if (largest > 5)
    warnings.push_back(fmt::format(
        "the object is {:.4g} m across; if its coordinates are in millimetres, build it with --units mm",
        largest));
  else if (largest > 2 * limits::kMaxModelHalfExtent)
    warnings.push_back(fmt::format("the object is {:.2f} m across; only up to {:.0f} m can be tracked",
                                   largest, 2 * limits::kMaxModelHalfExtent));
  if (largest < 0.01)
    warnings.push_back(
        fmt::format("the object is {:.4g} mm across; {}", 1000 * largest, unit_advice(metres_per_unit)));
}

}  // namespace

Result<BuiltModel> build_model(const Geometry& geometry, const ModelBuildSettings& settings) {
  if (!(settings.metres_per_unit >= 1e-6 && settings.metres_per_unit <= 1e3))
    return refuse(fmt::format("{} metres per unit is out of range [1e-6, 1e3]", settings.metres_per_unit));
  if (!(settings.spacing >= 0 && settings.spacing <= 1))
    return refuse(fmt::format("a spacing of {} m is out of range (0, 1]", settings.spacing));
  if (!(settings.material >= 0 && settings.material <= 1))
    return refuse(fmt::format("a material of {} is out of range [0, 1]", settings.material));

  const double farthest = farthest_coordinate(geometry) * settings.metres_per_unit;
  if (farthest > kFarthestCoordinate)
    return refuse(
        fmt::format("its points lie up to {:.3g} m from the origin; check the file and --units", farthest));

  BuiltModel built;
  Mesh mesh = clean_mesh(geometry, settings.metres_per_unit, built.warnings);
  if (mesh.triangles.empty() && mesh.vertices.size() < kLeastPoints)
    return refuse(fmt::format("holds {} different points; a cloud needs {} or more to be a model",
                              mesh.vertices.size(), kLeastPoints));
  const OrientedCloud cloud = mesh.triangles.empty() ? points_of_cloud(mesh, settings.spacing, built)
                                                     : points_of_mesh(mesh, settings, built);
  if (cloud.points.size() < kLeastPoints)
    return refuse(fmt::format("a spacing of {} m leaves {} points of it; {} or more are needed",
                              settings.spacing, cloud.points.size(), kLeastPoints));

  ModelHeader header;
  header.spacing = mean_spacing(cloud.points);
  std::vector<Point3f> positions;
  std::vector<Normal16> normals;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const Vector3 &p = cloud.points[i], &n = cloud.normals[i];
    positions.push_back(to_point(p));
    normals.push_back({to_q14(n.x()), to_q14(n.y()), to_q14(n.z()), 0});
  }
  measure(positions, header);
  if (!(header.spacing > 0 && header.radius > 0))
    return refuse("its points coincide as far as numbers tell; check the file and --units");
  if (header.radius < kLeastRadius)
    return refuse(fmt::format("is {:.2g} mm across, and a model can be no smaller than {:.2g} mm; {}",
                              2000 * header.radius, 2000 * kLeastRadius,
                              unit_advice(settings.metres_per_unit)));
  header.material = settings.material;
  header.support_radius = support_radius_for(header.spacing, header.radius);

  const Characterisability shape = characterise(cloud, header.spacing);
  header.characterisability = shape.measure;
  header.ambiguity = static_cast<std::uint32_t>(shape.ambiguity);
  built.characterisable = shape.ambiguity == ModelHeader::Ambiguity::none;
  header.flags = (built.characterisable ? static_cast<std::uint32_t>(ModelHeader::kCharacterisable) : 0U) |
                 (built.closed_surface ? static_cast<std::uint32_t>(ModelHeader::kClosedSurface) : 0U) |
                 (settings.front_only ? static_cast<std::uint32_t>(ModelHeader::kFrontOnly) : 0U);

  const std::vector<std::uint16_t> neighbours = neighbour_graph(cloud, header.spacing);
  const std::size_t keypoint_count = std::min(cloud.points.size(), limits::kMaxModelKeypoints);
  const Keypoints keypoints = describe_keypoints({positions, normals}, keypoint_count, header.support_radius);
  const SpringNetwork network = spring_network({positions,
                                                normals,
                                                neighbours,
                                                header.spacing,
                                                {header.centre[0], header.centre[1], header.centre[2]},
                                                built.closed_surface || encloses(cloud, header.spacing)});
  built.image = make_model_image(
      {header, positions, normals, neighbours, keypoints.descriptors, keypoints.frames, network});

  built.points = positions.size();
  built.keypoints = keypoint_count;
  built.spacing = header.spacing;
  for (int axis = 0; axis < 3; ++axis) built.extent[axis] = header.highest[axis] - header.lowest[axis];
  built.characterisability = shape.measure;
  built.reason = shape.reason;
  warn_about_size(built, settings.metres_per_unit, built.warnings);
  if (settings.spacing > 0 && built.spacing > 1.2 * settings.spacing)
    built.warnings.push_back(fmt::format(
        "{:g} mm between points were asked for, {:.2f} mm came about: a model holds {} points at most, and "
        "a cloud cannot be made denser",
        1000 * settings.spacing, 1000 * built.spacing, limits::kMaxModelPoints));
  if (built.characterisable) {
    const double tolerance = std::max(header.spacing, 2 * SensorDescription().sigma(0.8));
    const std::string symmetry = describe_symmetries(find_symmetries(cloud, tolerance));
    if (!symmetry.empty()) built.warnings.push_back(symmetry);
  }
  return built;
}

}  // namespace pliant
