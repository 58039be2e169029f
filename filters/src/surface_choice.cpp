// SPDX-License-Identifier: BSD-3-Clause
#include "surface_choice.h"
#include "direction_grid.h"
#include "view_direction.h"
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fresco/common/parallel.h>
namespace fresco {
namespace {
constexpr float agreeing = 0.94f;      // cosine between normals of one surface
constexpr float grazing = 0.08f;       // cosine to the beam at least
constexpr float cell_spacings = 64.f;  // edge of the cells in which directions are counted
constexpr float part_at_crease = 0.3f; // that a normal counts for a direction where its neighbours do not agree
constexpr std::size_t nearest = 8;     // neighbours that count apart, the point included

// Thickness of a plane, deviations of the noise: points are held, are looked at to place it, lie behind it.
constexpr float held = 1.f, around_it = 2.f, behind_it = 3.f;
constexpr int placings = 3;
constexpr float least_noise =
    0.05f; // spacings of beams: surfaces between beams are not flatter, however exact these are

// A direction's worth, in logarithms (see docs/filters.md).
constexpr float per_nearest = 1.f, per_neighbor = 1.5f, per_thickness = -1.25f, per_behind = -0.3f;
constexpr float per_spread = 0.5f, least_spread = 0.1f, enough_spread = 0.6f; // two rows of beams have 0.5
constexpr float per_share = 0.3f;                                             // of the directions around
constexpr float turned = -1.6f; // at more than 78 degrees from the normal before

/// Neighbours of a point, relative to it.
struct Offsets {
  Eigen::ArrayXf x, y, z;
  Eigen::ArrayXf across_u, across_v; ///< across the beam
  Eigen::ArrayXf squared_distances;
  float nearest_within; ///< squared distance
  float spacing;        ///< between neighbouring beams, length

  /// @param beam unit
  void set(const PointTree& tree, Index point, const std::vector<int>& list, const Eigen::Vector3f& beam);
  float spread(const Eigen::ArrayXf& weights) const;
};

void Offsets::set(const PointTree& tree, Index point, const std::vector<int>& list, const Eigen::Vector3f& beam)
{
  const auto count = static_cast<Index>(list.size());
  const Eigen::Vector3f here = tree.point(point);
  for (Eigen::ArrayXf* values : {&x, &y, &z})
    values->resize(count);
  for (Index j = 0; j < count; ++j) {
    const Eigen::Vector3f offset = tree.point(list[static_cast<std::size_t>(j)]) - here;
    x[j] = offset.x(), y[j] = offset.y(), z[j] = offset.z();
  }
  squared_distances = x.square() + y.square() + z.square();
  Eigen::ArrayXf sorted = squared_distances;
  float* last = sorted.data() + std::min<Index>(nearest, count) - 1;
  std::nth_element(sorted.data(), last, sorted.data() + count);
  nearest_within = *last;
  const Eigen::Vector3f u = beam.unitOrthogonal(), v = beam.cross(u);
  across_u = u.x() * x + u.y() * y + u.z() * z;
  across_v = v.x() * x + v.y() * y + v.z() * z;
  float inverse = 0, found = 0; // harmonic mean: some of the nearest lie far across the beam
  for (Index j = 0; j < count; ++j) {
    const float distance = std::hypot(across_u[j], across_v[j]);
    if (squared_distances[j] > nearest_within || !(distance > 0))
      continue;
    inverse += 1 / distance;
    ++found;
  }
  spacing = inverse > 0 ? found / inverse : 1.f;
}

/// The smaller deviation of weighted neighbours across the beam, in spacings: 0 for a row of beams, whatever it meets.
float Offsets::spread(const Eigen::ArrayXf& weights) const
{
  const float total = std::max(1.f, weights.sum());
  const float u = (weights * across_u).sum() / total, v = (weights * across_v).sum() / total;
  const float uu = (weights * across_u.square()).sum() / total - u * u;
  const float vv = (weights * across_v.square()).sum() / total - v * v;
  const float uv = (weights * across_u * across_v).sum() / total - u * v;
  const float mean = (uu + vv) / 2, apart = std::hypot((uu - vv) / 2, uv);
  return std::sqrt(std::max(0.f, mean - apart)) / spacing;
}

class SurfaceChoice {
public:
  SurfaceChoice(const SightedField& field, const Points& normals, int threads)
      : field_(field), normals_(normals), grid_(cell_spacings * std::sqrt(typicalArea(field.areas)))
  {
    markCreases(threads);
    grid_.finish(threads);
  }

  Points run(int threads);

private:
  static float typicalArea(const Eigen::VectorXf& areas);
  void markCreases(int threads);
  float noiseAt(Index i, const std::vector<int>& list) const;
  Eigen::Vector3f beam(Index i) const;
  Eigen::Vector3f choose(Index i, const Eigen::Vector3f& ray, const Offsets& near) const;
  float worth(const Eigen::Vector3f& direction, float thickness, const Offsets& near) const;

  const SightedField& field_;
  const Points& normals_;
  DirectionGrid grid_;
  std::vector<char> at_crease_; ///< by position
};

float SurfaceChoice::typicalArea(const Eigen::VectorXf& areas)
{
  std::vector<float> sorted;
  for (const float area : areas)
    if (area > 0 && std::isfinite(area))
      sorted.push_back(area);
  if (sorted.empty())
    return 1.f;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2), sorted.end());
  return sorted[sorted.size() / 2];
}

/// From the viewer to the point, unit; zero where unknown.
Eigen::Vector3f SurfaceChoice::beam(Index i) const
{
  return -viewDirection(field_.viewpoints, field_.tree.columns()[static_cast<std::size_t>(i)], field_.tree.point(i))
              .normalized();
}

/// Deviation of the neighbours across the plane of a point, along its beam; 0 where the beam grazes.
float SurfaceChoice::noiseAt(Index i, const std::vector<int>& list) const
{
  const Eigen::Vector3f normal = normals_.col(i);
  const float cosine = -normal.dot(beam(i));
  if (cosine < 0.3f || list.size() <= nearest)
    return 0;
  double sum = 0, squares = 0;
  for (const int j : list) {
    const double off = normal.dot(field_.tree.point(j) - field_.tree.point(i));
    sum += off;
    squares += off * off;
  }
  const auto count = static_cast<double>(list.size());
  return static_cast<float>(std::sqrt(std::max(0.0, squares / count - sum * sum / (count * count))) / cosine);
}

void SurfaceChoice::markCreases(int threads)
{
  at_crease_.assign(static_cast<std::size_t>(normals_.cols()), 0);
  std::vector<float> noises(at_crease_.size());
  parallelFor(static_cast<Index>(field_.lists.size()), threads, [&](Index range) {
    const CompactLists& lists = field_.lists[static_cast<std::size_t>(range)];
    CompactReader reader(lists);
    std::vector<int> list;
    for (Index i = lists.begin; i < lists.end; ++i) {
      reader.next(list);
      const Eigen::Vector3f normal = normals_.col(i);
      const bool crease =
          std::any_of(list.begin(), list.end(), [&](int j) { return !(normals_.col(j).dot(normal) > agreeing); });
      at_crease_[static_cast<std::size_t>(i)] = crease;
      noises[static_cast<std::size_t>(i)] = crease ? 0.f : noiseAt(i, list);
    }
  });
  for (Index i = 0; i < normals_.cols(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    const float weight = field_.areas[i] * (at_crease_[at] ? part_at_crease : 1.f);
    grid_.add({field_.tree.point(i), normals_.col(i), weight, noises[at]});
  }
}

/// @param thickness deviation of the noise across the plane
float SurfaceChoice::worth(const Eigen::Vector3f& direction, float thickness, const Offsets& near) const
{
  const Eigen::ArrayXf off = direction.x() * near.x + direction.y() * near.y + direction.z() * near.z;
  float place = 0;
  for (int k = 0; k < placings; ++k) {
    const Eigen::ArrayXf inside = ((off - place).abs() < around_it * thickness).cast<float>();
    const float count = inside.sum();
    if (count < 1)
      break;
    place = (inside * off).sum() / count;
  }
  const auto holds = ((off - place).abs() < held * thickness).eval();
  const Index itself = std::abs(place) < held * thickness ? 1 : 0; // which does not count
  const auto neighbors = static_cast<float>(holds.count() - itself);
  const auto close = static_cast<float>((holds && near.squared_distances <= near.nearest_within).count() - itself);
  const float spread = std::min(near.spread(holds.cast<float>()), enough_spread);
  const auto behind = static_cast<float>((off - place < -behind_it * thickness).count());
  return per_nearest * std::log(close + 0.5f) + per_neighbor * std::log(neighbors + 0.5f) +
         per_behind * std::log(behind + 0.5f) + per_spread * std::log(spread + least_spread);
}

/// @param ray the beam of the point
Eigen::Vector3f SurfaceChoice::choose(Index i, const Eigen::Vector3f& ray, const Offsets& near) const
{
  const Eigen::Vector3f own = normals_.col(i);
  const DirectionGrid::Surroundings& around = grid_.at(field_.tree.point(i));
  if (!(around.noise > 0))
    return own;
  const float noise = std::max(around.noise, least_noise * near.spacing);
  const auto worthOf = [&](const Eigen::Vector3f& direction) {
    const float cosine = -direction.dot(ray);
    return worth(direction, cosine * noise, near) + per_thickness * std::log(cosine);
  };
  float own_worth = worthOf(own), most = own_worth;
  Eigen::Vector3f best = own;
  for (std::size_t k = 0; k < around.directions.size(); ++k) {
    const Eigen::Vector3f& direction = around.directions[k];
    if (-direction.dot(ray) < grazing)
      continue;
    const float alike = direction.dot(own);
    const float its_worth = worthOf(direction) + per_share * std::log(around.shares[k]) + (alike < 0.2f ? turned : 0.f);
    if (alike > agreeing)
      own_worth = std::max(own_worth, its_worth);
    else if (its_worth > most) {
      most = its_worth;
      best = direction;
    }
  }
  return most > own_worth ? best : own;
}

Points SurfaceChoice::run(int threads)
{
  Points chosen = normals_;
  parallelFor(static_cast<Index>(field_.lists.size()), threads, [&](Index range) {
    const CompactLists& lists = field_.lists[static_cast<std::size_t>(range)];
    CompactReader reader(lists);
    std::vector<int> list;
    Offsets near;
    for (Index i = lists.begin; i < lists.end; ++i) {
      reader.next(list);
      if (!at_crease_[static_cast<std::size_t>(i)])
        continue;
      const Eigen::Vector3f ray = beam(i);
      if (-normals_.col(i).dot(ray) < grazing)
        continue;
      near.set(field_.tree, i, list, ray);
      chosen.col(i) = choose(i, ray, near);
    }
  });
  return chosen;
}
} // namespace

Points chooseSurfaces(const SightedField& field, const Points& normals, int threads)
{
  return SurfaceChoice(field, normals, threads).run(threads);
}
} // namespace fresco
