// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <fresco/core/constants.h>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <fresco/core/statistics.h>
#include <fresco/rendering/indoor_view.h>
#include <fresco/rendering/room_frame.h>
#include <fresco/search/ray_scene.h>
namespace fresco::rendering {
namespace {
constexpr double inside_angle = 62; // vertical, degrees: with 4:3 about the 77 degrees across of a wide lens
constexpr int rays_x = 20, rays_y = 15;

struct ViewHit {
  double distance = std::numeric_limits<double>::infinity(); ///< in lengths of the direction; infinite: nothing hit
  bool front = false; ///< the face shows its front: its corners are counter-clockwise seen from the ray's start
  bool any() const { return distance < std::numeric_limits<double>::infinity(); }
};

/// The first face hit at `least` or farther.
ViewHit trace(const RayScene& scene, const Eigen::Vector3d& from, const Eigen::Vector3d& direction, float least = 0)
{
  Ray ray{from.cast<float>(), direction.cast<float>()};
  ray.near = least;
  const RayHit hit = scene.intersect(ray);
  if (hit.face < 0)
    return {};
  return {hit.distance, hit.normal.cast<double>().dot(direction) < 0};
}

/// The first face hit whose front is seen, through all others: what a picture without back faces shows.
ViewHit traceFront(const RayScene& scene, const Eigen::Vector3d& from, const Eigen::Vector3d& direction)
{
  constexpr int most_layers = 32;
  float least = 0;
  for (int layer = 0; layer < most_layers; ++layer) {
    const ViewHit hit = trace(scene, from, direction, least);
    if (!hit.any() || hit.front)
      return hit;
    const float distance = hit.distance * (1 + 1e-6);
    least = std::nextafter(distance, std::numeric_limits<float>::max());
  }
  return {};
}

/// A place to stand at and what is around it.
struct Stand {
  Eigen::Vector3d eye = Eigen::Vector3d::Zero();
  double front = 0, back = 0; ///< shares of all directions
  double clearance = 0;       ///< distance that 3 % of the directions end within
};

/// A direction to look into.
struct Look {
  double score = -1e30;
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();
};

Stand examine(const RayScene& scene, const Eigen::Vector3d& eye)
{
  static const std::vector<Eigen::Vector3d> directions = evenDirections(200, 1, -1);
  Stand stand;
  stand.eye = eye;
  std::vector<double> distances;
  for (const Eigen::Vector3d& direction : directions) {
    const ViewHit hit = trace(scene, eye, direction);
    stand.front += hit.any() && hit.front;
    stand.back += hit.any() && !hit.front;
    distances.push_back(hit.distance);
  }
  stand.clearance = rankedValue(distances, distances.size() * 3 / 100);
  stand.front /= directions.size();
  stand.back /= directions.size();
  return stand;
}

/// Stands on a grid, at 0.6 and 0.75 of the room's height.
std::vector<Stand> gridOfStands(const RayScene& scene, const RoomFrame& room, int threads)
{
  constexpr int cells = 20;
  constexpr std::array<double, 2> heights{0.6, 0.75};
  std::vector<Stand> stands(heights.size() * cells * cells);
  parallelFor(stands.size(), threads, [&](Index i) {
    const Index cell = i % (cells * cells);
    const Eigen::Vector3d share((cell % cells + 0.5) / cells, (cell / cells + 0.5) / cells,
                                heights[i / (cells * cells)]);
    const Eigen::Vector3d coordinates = room.low.array() + share.array() * room.size().array();
    stands[i] = examine(scene, room.point(coordinates));
  });
  return stands;
}

/// The stands in free space with the model around them, thinned evenly where there are many.
std::vector<Stand> freeStands(const std::vector<Stand>& stands, double room_size, bool two_sided)
{
  std::vector<Stand> fit;
  for (const Stand& s : stands) {
    const double seen = two_sided ? s.front + s.back : s.front;
    if ((two_sided || s.back <= 0.06) && seen >= 0.3 && s.clearance >= 0.03 * room_size)
      fit.push_back(s);
  }
  constexpr std::size_t most = 200;
  const std::size_t step = (fit.size() + most - 1) / most;
  std::vector<Stand> kept;
  for (std::size_t i = 0; i < fit.size(); i += step)
    kept.push_back(fit[i]);
  return kept;
}

/// Directions through an even grid of the picture's points; columns of `axes`: right, up, backward.
std::vector<Eigen::Vector3d> pictureRays(const Eigen::Matrix3d& axes, double angle, double aspect)
{
  const double half = std::tan(angle * pi / 360);
  std::vector<Eigen::Vector3d> rays;
  for (int y = 0; y < rays_y; ++y)
    for (int x = 0; x < rays_x; ++x) {
      const Eigen::Vector3d ray(half * aspect * ((2 * x + 1.0) / rays_x - 1), half * ((2 * y + 1.0) / rays_y - 1), -1);
      rays.push_back(axes * ray);
    }
  return rays;
}

/// Mean step between neighbouring depths, as a ratio, at most a factor of e each: furniture makes steps,
/// bare walls none.
double relief(const std::vector<double>& depths)
{
  double sum = 0;
  const auto step = [&](int a, int b) {
    const double da = depths[a], db = depths[b];
    return std::isfinite(da) && std::isfinite(db) ? std::min(1.0, std::abs(std::log(da / db))) : 0.0;
  };
  for (int y = 0; y < rays_y; ++y)
    for (int x = 1; x < rays_x; ++x)
      sum += step(y * rays_x + x, y * rays_x + x - 1);
  for (int y = 1; y < rays_y; ++y)
    for (int x = 0; x < rays_x; ++x)
      sum += step(y * rays_x + x, (y - 1) * rays_x + x);
  return sum / (2 * rays_x * rays_y);
}

/// Depth in view is good up to a point, steps are good, holes and things right before the eye are bad.
double scoreInside(const RayScene& scene, const Stand& stand, const std::vector<Eigen::Vector3d>& rays,
                   double room_size)
{
  const double near = 0.14 * room_size, far = 0.6 * room_size;
  double sum = 0;
  std::vector<double> depths;
  for (const Eigen::Vector3d& ray : rays) {
    const double depth = std::max(trace(scene, stand.eye, ray).distance, 1e-9 * room_size);
    depths.push_back(depth);
    if (!std::isfinite(depth))
      sum -= 0.4;
    else
      sum += std::min(1.0, depth / far) - std::max(0.0, 1 - depth / near);
  }
  return sum / rays.size() + 2 * relief(depths);
}

Look bestLook(const RayScene& scene, const Stand& stand, const RoomFrame& room, double aspect)
{
  constexpr int headings = 24;
  constexpr double down = 12 * pi / 180;
  Look best;
  for (int i = 0; i < headings; ++i) {
    const double heading = 2 * pi * i / headings;
    const Eigen::Vector3d level = std::cos(heading) * room.along + std::sin(heading) * room.across;
    const Eigen::Vector3d direction = std::cos(down) * level - std::sin(down) * room.up;
    const auto rays = pictureRays(cameraAxes(-direction, room.up), inside_angle, aspect);
    const double score = scoreInside(scene, stand, rays, room.size().head<2>().norm());
    if (score > best.score)
      best = {score, direction};
  }
  return best;
}

double scoreAbove(const RayScene& scene, const Viewpoint& view, const Eigen::Vector3d& origin, double aspect)
{
  const auto rays = pictureRays(cameraAxes(view.eye - view.look, view.up), view.angle, aspect);
  double hits = 0;
  std::vector<double> depths;
  for (const Eigen::Vector3d& ray : rays) {
    const ViewHit hit = traceFront(scene, view.eye - origin, ray);
    depths.push_back(hit.distance);
    hits += hit.any();
  }
  return hits / rays.size() + 4 * relief(depths);
}

/// A model that is looked at, with where its walls are.
struct Room {
  Room(const TriangleMesh& model, const IndoorOptions& chosen) : mesh(validated(model, chosen)), options(chosen) {}

  static const TriangleMesh& validated(const TriangleMesh& mesh, const IndoorOptions& options)
  {
    validateMesh(mesh);
    require(options.aspect > 0 && std::isfinite(options.aspect), "view: aspect ratio ", options.aspect,
            " is not above 0");
    return mesh;
  }

  const TriangleMesh& mesh;
  const IndoorOptions& options;
  RoomFrame frame = findRoomFrame(mesh, options.up);
  RayScene scene{mesh, false};
};

std::optional<Viewpoint> insideOf(const Room& room)
{
  const double room_size = room.frame.size().head<2>().norm();
  const std::vector<Stand> grid = gridOfStands(room.scene, room.frame, room.options.threads);
  std::vector<Stand> stands = freeStands(grid, room_size, false);
  if (stands.empty())
    stands = freeStands(grid, room_size, true);
  if (stands.empty())
    return {};
  std::vector<Look> looks(stands.size());
  parallelFor(stands.size(), room.options.threads,
              [&](Index i) { looks[i] = bestLook(room.scene, stands[i], room.frame, room.options.aspect); });
  const auto best =
      std::max_element(looks.begin(), looks.end(), [](const Look& a, const Look& b) { return a.score < b.score; });
  const Eigen::Vector3d eye = room.mesh.origin + stands[best - looks.begin()].eye;
  return Viewpoint{eye, eye + 0.5 * room_size * best->direction, room.frame.up, inside_angle};
}

Viewpoint above(const Room& room)
{
  constexpr std::array<double, 8> headings{30, 60, 120, 150, 210, 240, 300, 330}; // degrees from the walls
  constexpr double elevation = 52 * pi / 180;
  Viewpoint best;
  double best_score = -1;
  for (const double degrees : headings) {
    const double heading = degrees * pi / 180;
    const Eigen::Vector3d level = std::cos(heading) * room.frame.along + std::sin(heading) * room.frame.across;
    Framing framing;
    framing.direction = std::cos(elevation) * level + std::sin(elevation) * room.frame.up;
    framing.up = room.frame.up;
    framing.aspect = room.options.aspect;
    const Viewpoint view = frameView(room.mesh, framing);
    const double score = scoreAbove(room.scene, view, room.mesh.origin, room.options.aspect);
    if (score > best_score) {
      best_score = score;
      best = view;
    }
  }
  return best;
}
} // namespace

std::optional<Viewpoint> insideView(const TriangleMesh& mesh, const IndoorOptions& options)
{
  return insideOf(Room(mesh, options));
}

Viewpoint aboveView(const TriangleMesh& mesh, const IndoorOptions& options) { return above(Room(mesh, options)); }

IndoorViews indoorViews(const TriangleMesh& mesh, const IndoorOptions& options)
{
  const Room room(mesh, options);
  return {insideOf(room), above(room)};
}
} // namespace fresco::rendering
