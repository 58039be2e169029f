// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <boost/functional/hash.hpp>
#include <cmath>
#include <fresco/core/constants.h>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <fresco/simulation/sensors/lighting.h>
#include <unordered_map>
namespace fresco::simulation {
using Eigen::Vector3f;

namespace {
constexpr float gamma_power = 2.2f, single_pi = pi;
constexpr float lift = 1e-3f; // metres that rays start above a surface

Vector3f linear(const Vector3f& display) { return display.array().pow(gamma_power); }

/// A place on a surface with its normals: of the facet (for shadows) and of the smooth shape (for the cosine).
struct Place {
  Vector3f position, facet, normal;
};

Vector3f facetNormal(const Scene& scene, const Cell& cell)
{
  const auto p = [&](std::size_t k) -> Vector3f { return scene.mesh.vertices.col(cell.corners[k]); };
  const Vector3f normal = p(3) == p(2) ? (p(1) - p(0)).cross(p(2) - p(0)) : (p(2) - p(0)).cross(p(3) - p(1));
  return normal.normalized();
}

Place placeOn(const Scene& scene, const Cell& cell, const CellPoint& at)
{
  const auto weights = cornerWeights(at);
  Vector3f normal = Vector3f::Zero();
  for (std::size_t k = 0; k < 4; ++k)
    normal += weights[k] * cell.normals[k];
  const Vector3f facet = facetNormal(scene, cell);
  return {cellPosition(scene, cell, at) + lift * facet, facet, normal.normalized()};
}

constexpr int packet_size = 16;      // rays traced together
constexpr std::size_t lamp_rays = 8; // a lamp is seen through a grid of 4x2 points; a packet serves two lamps

/// Rays to two lamps, and the light that each brings if nothing is in the way.
struct LampRays {
  RayPacket<packet_size> rays;
  std::array<float, packet_size> light{};
};

/// Fills the half of the packet that begins at `first`.
void aimAtLamp(const Lamp& lamp, const Place& place, LampRays& to, std::size_t first)
{
  const Vector3f cross = lamp.half_u.cross(lamp.half_v);
  const Vector3f shines = cross.normalized();
  for (std::size_t k = 0; k < lamp_rays; ++k) {
    const float u = k % 2 - 0.5f, v = (k / 2 - 1.5f) / 2.f;
    const Vector3f way = lamp.center + u * lamp.half_u + v * lamp.half_v - place.position;
    const float square = way.squaredNorm(), towards = way.dot(place.normal), from = -way.dot(shines);
    const bool lit = towards > 0.f && from > 0.f && way.dot(place.facet) > 0.f;
    to.light[first + k] = lit ? towards * from / (square * square) * (4.f * cross.norm() / lamp_rays) : 0.f;
    to.rays[first + k] = {place.position, way, lit ? 0.999f : 0.f};
  }
}

/// Light straight from the lamps, with soft shadows.
Vector3f directLight(const Scene& scene, const RayScene& rays, const Place& place)
{
  Vector3f sum = Vector3f::Zero();
  for (std::size_t first = 0; first < scene.lamps.size(); first += 2) {
    const std::size_t count = std::min<std::size_t>(2, scene.lamps.size() - first);
    LampRays to;
    for (std::size_t k = 0; k < count; ++k)
      aimAtLamp(scene.lamps[first + k], place, to, k * lamp_rays);
    if (*std::max_element(to.light.begin(), to.light.end()) <= 0.f)
      continue;
    const unsigned blocked = rays.occluded(to.rays, count * lamp_rays);
    for (std::size_t i = 0; i < count * lamp_rays; ++i)
      if (!(blocked >> i & 1u))
        sum += to.light[i] * scene.lamps[first + i / lamp_rays].color;
  }
  return sum;
}

/// What a place receives from other surfaces, and how much of its surroundings are the insides of solids.
struct Gathered {
  Vector3f light = Vector3f::Zero();
  float buried = 0.f;
};

/// Cosine-distributed directions (golden-ratio lattice on the disc, lifted to the hemisphere about z).
std::vector<Vector3f> hemisphere(int count)
{
  std::vector<Vector3f> directions;
  for (int i = 0; i < count; ++i) {
    const float r = std::sqrt((i + 0.5f) / count);
    const float angle = 2.399963230f * i;
    directions.push_back({r * std::cos(angle), r * std::sin(angle), std::sqrt(1.f - r * r)});
  }
  return directions;
}

struct GatherInput {
  const Scene& scene;
  const RayScene& rays;
  const std::vector<Vector3f>& radiance; ///< per cell
  const std::vector<Vector3f>& facets;   ///< per cell
  const std::vector<Vector3f>& directions;
};

Gathered gather(const GatherInput& in, const Place& place)
{
  Eigen::Matrix3f frame;
  frame.col(2) = place.normal;
  frame.col(0) =
      (std::fabs(place.normal.z()) < 0.9f ? Vector3f::UnitZ() : Vector3f::UnitX()).cross(place.normal).normalized();
  frame.col(1) = place.normal.cross(frame.col(0));
  Gathered sum;
  for (std::size_t first = 0; first < in.directions.size(); first += packet_size) {
    RayPacket<packet_size> packet;
    for (std::size_t i = 0; i < packet_size; ++i)
      packet[i] = {place.position, frame * in.directions[first + i]};
    const HitPacket<packet_size> hits = in.rays.intersect(packet, RayOrder::incoherent);
    for (std::size_t i = 0; i < packet_size; ++i) {
      if (hits[i].face < 0)
        continue;
      const std::size_t cell = in.scene.face_cell[hits[i].face] / 2;
      if (in.facets[cell].dot(packet[i].direction) > 0.f)
        sum.buried += 1.f;
      else
        sum.light += in.radiance[cell];
    }
  }
  const float count = in.directions.size();
  return {sum.light * (single_pi / count), sum.buried / count};
}

/// Display albedo on a cell.
Vector3f cellAlbedo(const Scene& scene, const Cell& cell, const CellPoint& at, float footprint)
{
  if (scene.mesh.colors.cols() > 0) {
    const auto weights = cornerWeights(at);
    Vector3f color = Vector3f::Zero();
    for (std::size_t k = 0; k < 4; ++k)
      color += weights[k] / 255.f * scene.mesh.colors.col(cell.corners[k]).cast<float>();
    return color;
  }
  const Part& part = scene.parts[cell.part];
  return albedo(scene.materials[part.material], {part.scale * (part.T_part_world * cellPosition(scene, cell, at)),
                                                 part.T_part_world.linear() * cell.normals[0], part.scale * footprint});
}

/// Radiance of every cell after two bounces; lamps themselves are left out, for they are counted as lamps.
std::vector<Vector3f> cellRadiance(const Scene& scene, const RayScene& rays, const std::vector<Vector3f>& facets,
                                   int threads)
{
  const Index count = scene.cells.size();
  std::vector<Vector3f> reflectance(scene.cells.size()), direct(scene.cells.size()), radiance(scene.cells.size());
  const auto middle = [&](Index c) { return placeOn(scene, scene.cells[c], {0.5f, 0.5f}); };
  parallelFor(count, threads, [&](Index c) {
    reflectance[c] = linear(cellAlbedo(scene, scene.cells[c], {0.5f, 0.5f}, 0.05f)) / single_pi;
    direct[c] = directLight(scene, rays, middle(c));
    radiance[c] = reflectance[c].cwiseProduct(direct[c]);
  });
  const std::vector<Vector3f> directions = hemisphere(2 * packet_size);
  for (int bounce = 0; bounce < 2; ++bounce) {
    std::vector<Vector3f> next(scene.cells.size());
    parallelFor(count, threads, [&](Index c) {
      const Gathered from = gather({scene, rays, radiance, facets, directions}, middle(c));
      next[c] = reflectance[c].cwiseProduct(direct[c] + from.light);
    });
    radiance = std::move(next);
  }
  return radiance;
}

/// Nodes inside solids (where furniture stands on the floor) take the mean of their cell's other nodes.
void fillBuried(std::vector<Vector3f>& light, const std::vector<bool>& buried)
{
  Vector3f sum = Vector3f::Zero();
  float count = 0.f;
  for (std::size_t i = 0; i < light.size(); ++i)
    if (!buried[i])
      sum += light[i], count += 1.f;
  if (count > 0.f)
    for (std::size_t i = 0; i < light.size(); ++i)
      if (buried[i])
        light[i] = sum / count;
}

/// A little away from the cell's borders, so that a place in a corner of the room does not lie in the other wall.
CellPoint inset(const Scene& scene, const Cell& cell, const CellPoint& at)
{
  const auto p = [&](std::size_t k) -> Vector3f { return scene.mesh.vertices.col(cell.corners[k]); };
  const auto margin = [](float a, float b) { return std::min(0.3f, 0.003f / std::max({a, b, 1e-6f})); };
  const float s = margin((p(1) - p(0)).norm(), (p(2) - p(3)).norm()),
              t = margin((p(2) - p(1)).norm(), (p(3) - p(0)).norm());
  return {std::clamp(at.s, s, 1 - s), std::clamp(at.t, t, 1 - t)};
}

/// Nodes of neighbouring cells fall together: each place is computed once.
struct SharedPlaces {
  std::vector<Place> places;
  std::vector<int> place_of_node;
};

std::array<int, 6> placeKey(const Place& place)
{
  std::array<int, 6> key;
  for (int axis = 0; axis < 3; ++axis) {
    key[axis] = std::lround(1e4f * place.position[axis]);
    key[axis + 3] = std::lround(100.f * place.normal[axis]);
  }
  return key;
}

SharedPlaces sharePlaces(const Scene& scene, const std::vector<Lightmap::Lattice>& lattices)
{
  std::unordered_map<std::array<int, 6>, int, boost::hash<std::array<int, 6>>> known;
  SharedPlaces shared;
  for (std::size_t c = 0; c < lattices.size(); ++c)
    for (int i = 0; i < lattices[c].columns * lattices[c].rows; ++i) {
      const Lightmap::Lattice& lattice = lattices[c];
      const CellPoint at{static_cast<float>(i % lattice.columns) / (lattice.columns - 1),
                         static_cast<float>(i / lattice.columns) / (lattice.rows - 1)};
      const Place place = placeOn(scene, scene.cells[c], at);
      const std::array<int, 6> key = placeKey(place);
      const auto [found, fresh] = known.try_emplace(key, shared.places.size());
      if (fresh)
        shared.places.push_back(placeOn(scene, scene.cells[c], inset(scene, scene.cells[c], at)));
      shared.place_of_node.push_back(found->second);
    }
  return shared;
}

/// Light at every node from the light at the shared places.
void spread(const SharedPlaces& shared, const std::vector<Gathered>& light,
            const std::vector<Lightmap::Lattice>& lattices, std::vector<Vector3f>& nodes)
{
  for (const Lightmap::Lattice& lattice : lattices) {
    std::vector<Vector3f> values;
    std::vector<bool> buried;
    for (std::size_t i = lattice.first; i < lattice.first + lattice.columns * lattice.rows; ++i) {
      const Gathered& from = light[shared.place_of_node[i]];
      values.push_back(from.light);
      buried.push_back(from.buried > 0.5f);
    }
    fillBuried(values, buried);
    std::copy(values.begin(), values.end(), nodes.begin() + lattice.first);
  }
}
} // namespace

Vector3f Lightmap::at(int cell, const CellPoint& where) const
{
  const Lattice& lattice = lattices_[cell];
  const float x = std::clamp(where.s, 0.f, 1.f) * (lattice.columns - 1);
  const float y = std::clamp(where.t, 0.f, 1.f) * (lattice.rows - 1);
  const int x0 = std::min<int>(x, lattice.columns - 2), y0 = std::min<int>(y, lattice.rows - 2);
  const float tx = x - x0, ty = y - y0;
  const Vector3f* row = &nodes_[lattice.first + y0 * lattice.columns + x0];
  const Vector3f* next = row + lattice.columns;
  return (1 - ty) * ((1 - tx) * row[0] + tx * row[1]) + ty * ((1 - tx) * next[0] + tx * next[1]);
}

void Lightmap::layOut(const Scene& scene, float spacing)
{
  lattices_.resize(scene.cells.size());
  std::size_t nodes = 0;
  for (std::size_t c = 0; c < scene.cells.size(); ++c) {
    const auto p = [&](std::size_t k) -> Vector3f { return scene.mesh.vertices.col(scene.cells[c].corners[k]); };
    const auto along = [&](float a, float b) {
      return std::clamp<int>(std::ceil(std::max(a, b) / spacing - 1e-3f), 1, 64) + 1;
    };
    lattices_[c] = {nodes, along((p(1) - p(0)).norm(), (p(2) - p(3)).norm()),
                    along((p(2) - p(1)).norm(), (p(3) - p(0)).norm())};
    nodes += lattices_[c].columns * lattices_[c].rows;
  }
  nodes_.resize(nodes);
}

/// Brings the mean to `brightness` and takes the display power.
void Lightmap::expose(const LightingOptions& options)
{
  const Index count = nodes_.size();
  const double sum = parallelSum(count, options.threads, 0.0, [&](Index n) -> double { return nodes_[n].mean(); });
  const double mean = std::max(sum / std::max<Index>(count, 1), 1e-9);
  const float exposure = std::pow(options.brightness, gamma_power) / mean;
  parallelFor(count, options.threads, [&](Index n) {
    Vector3f& node = nodes_[n];
    node = (node * exposure).array().max(0.f).pow(1.f / gamma_power);
  });
}

Lightmap bakeLight(const Scene& scene, const RayScene& rays, const LightingOptions& options, const Progress& progress)
{
  require(options.spacing > 0.f, "lighting: spacing ", options.spacing, " is not positive");
  require(options.gather_packets >= 1 && options.gather_packets <= 64, "lighting: gather_packets is not in 1..64");
  const bool sky = scene.lamps.empty(); // a mesh: light by direction only
  Lightmap map;
  map.layOut(scene, sky ? 1e30f : options.spacing);
  const SharedPlaces shared = sharePlaces(scene, map.lattices_);
  const Index count = shared.places.size();
  std::vector<Gathered> light(shared.places.size());
  if (sky) {
    parallelFor(count, options.threads, [&](Index i) {
      const Vector3f n = shared.places[i].normal;
      light[i].light = Vector3f(1.f, 0.98f, 0.94f) * (0.7f + 0.25f * n.z() + 0.15f * n.x() - 0.1f * n.y());
    });
  } else {
    std::vector<Vector3f> facets;
    for (const Cell& cell : scene.cells)
      facets.push_back(facetNormal(scene, cell));
    const std::vector<Vector3f> radiance = cellRadiance(scene, rays, facets, options.threads);
    report(progress, "light", 0.3);
    const std::vector<Vector3f> directions = hemisphere(options.gather_packets * packet_size);
    parallelFor(count, options.threads, [&](Index i) {
      const Place& place = shared.places[i];
      Gathered& from = light[i];
      from = gather({scene, rays, radiance, facets, directions}, place);
      if (from.buried <= 0.5f)
        from.light += directLight(scene, rays, place);
    });
  }
  spread(shared, light, map.lattices_, map.nodes_);
  map.expose(options);
  return map;
}

Vector3f toneCurve(const Vector3f& x)
{
  constexpr float knee = 0.62f, top = 0.82f;
  return x.unaryExpr([](float value) {
    return value <= knee ? value : knee + (top - knee) * (1.f - std::exp((knee - value) / (top - knee)));
  });
}

Vector3f surfaceAlbedo(const Scene& scene, const RayHit& hit, float footprint)
{
  const int code = scene.face_cell[hit.face];
  return cellAlbedo(scene, scene.cells[code / 2], cellPoint(code % 2, hit.beta, hit.gamma), footprint);
}

const Material& materialAt(const Scene& scene, int face)
{
  const Cell& cell = scene.cells[scene.face_cell[face] / 2];
  return scene.materials[scene.parts[cell.part].material];
}

Vector3f surfaceColor(const LitScene& lit, const RayHit& hit, float footprint)
{
  const Vector3f color = surfaceAlbedo(lit.scene, hit, footprint);
  const float emission = materialAt(lit.scene, hit.face).emission;
  if (emission > 0.f)
    return toneCurve(emission * color);
  const int code = lit.scene.face_cell[hit.face];
  return toneCurve(color.cwiseProduct(lit.light.at(code / 2, cellPoint(code % 2, hit.beta, hit.gamma))));
}
} // namespace fresco::simulation
