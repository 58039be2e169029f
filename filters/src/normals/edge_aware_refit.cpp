// SPDX-License-Identifier: BSD-3-Clause
#include "normals/edge_aware_refit.h"
#include "normals/view_direction.h"
#include <algorithm>
#include <cmath>
#include <cstring>
#include <fresco/core/parallel.h>
#include <limits>
#include <utility>
namespace fresco::filters {
namespace {
constexpr int passes = 3, passes_without_rays = 2;
constexpr float same_side = 0.866f; // cosine between planes that form no crease

/// Points with planes of their own, in two arrays for the sake of memory.
struct Updates {
  std::vector<int> points;
  std::vector<Plane> planes;
};

/// Small for a flat plane that holds the point.
float score(const Plane& plane, const Eigen::Vector3f& point)
{
  const float distance = plane.distance(point);
  return plane.variance + 0.5f * distance * distance;
}

Eigen::Vector3f towardsViewer(const Plane& plane, const Eigen::Vector3f& ray)
{
  return plane.normal.dot(ray) > 0 ? Eigen::Vector3f(-plane.normal) : plane.normal;
}

/// Whether the ray to `point` sees `b` and not `a`, if they meet in a crease.
/// @param ray unit, away from the viewer
bool seesSecond(const Plane& a, const Plane& b, const Eigen::Vector3f& point, const Eigen::Vector3f& ray)
{
  const Eigen::Vector3f a_normal = towardsViewer(a, ray), b_normal = towardsViewer(b, ray);
  const float a_over_b = b_normal.dot(a.center - b.center), b_over_a = a_normal.dot(b.center - a.center);
  const float a_facing = a_normal.dot(ray), b_facing = b_normal.dot(ray);
  if (!(a_over_b * b_over_a > 0) || a_facing >= 0 || b_facing >= 0)
    return false; // neither hollow nor ridge, or along the ray
  const bool hollow = a_over_b > 0;
  const float a_depth = a_normal.dot(a.center - point) / a_facing, b_depth = b_normal.dot(b.center - point) / b_facing;
  return (b_depth < a_depth) == hollow;
}

/// One pass over the points of a group.
class GroupPass {
public:
  GroupPass(const PointSet& set, const Neighborhoods& all, const std::vector<Plane>& planes)
      : set_(set), all_(all), planes_(planes)
  {}

  /// @param changed by position, whole leaves: planes that are new; no others can make a difference
  Updates run(const GroupLists& lists, const std::vector<char>& changed)
  {
    Updates updates;
    if (!load(lists, changed))
      return updates;
    PlaneBatch batch([&](Index i, const Plane& plane) {
      updates.points.push_back(i);
      updates.planes.push_back(plane);
    });
    std::vector<int> starts;
    for (Index i = lists.begin; i < lists.end; ++i) {
      const int best = anyChanged(lists, i) ? choose(lists, i) : lists.codeOf(i);
      if (best == lists.codeOf(i))
        continue;
      starts.push_back(best);
      batch.add(i, all_.point(i), nearMoments(i, lists.position(best)));
    }
    batch.finish();
    for (std::size_t u = 0; u < starts.size(); ++u)
      if (updates.planes[u].shape() != Plane::plane)
        updates.planes[u] = near_[starts[u]];
    updates.points.shrink_to_fit();
    updates.planes.shrink_to_fit();
    return updates;
  }

private:
  /// @return whether any of the planes is new
  bool load(const GroupLists& lists, const std::vector<char>& changed)
  {
    near_.resize(8 * lists.leaves.size());
    near_changed_.resize(near_.size());
    std::uint64_t any = 0;
    for (std::size_t l = 0; l < lists.leaves.size(); ++l) {
      std::uint64_t eight;
      std::memcpy(&eight, changed.data() + 8 * Index{lists.leaves[l]}, 8);
      std::memcpy(near_changed_.data() + 8 * l, &eight, 8);
      any |= eight;
    }
    for (std::size_t l = 0; any != 0 && l < lists.leaves.size(); ++l) {
      const std::size_t from = 8 * Index{lists.leaves[l]};
      std::copy_n(planes_.data() + from, std::min<std::size_t>(8, planes_.size() - from), near_.data() + 8 * l);
    }
    return any != 0;
  }

  bool anyChanged(const GroupLists& lists, Index i) const
  {
    const std::uint16_t* list = lists.list(i);
    return std::any_of(list, list + lists.count(i), [&](std::uint16_t code) { return near_changed_[code] != 0; });
  }

  /// The code of the plane that the point lies on, or its own.
  int choose(const GroupLists& lists, Index i) const
  {
    constexpr float clearly_flatter = 2.5f; // ratio of the variances of two fits that tells an edge from chance
    constexpr float flatter = 1.6f; // the same where normals around tell of an edge and rays tell the sides apart
    const int self = lists.codeOf(i);
    const Plane& own = near_[self];
    if (!std::isfinite(own.variance) || lists.count(i) == 0)
      return self;
    const Eigen::Vector3f here = all_.point(i);
    const BestPlane found =
        planeKernels().best(near_.data()->normal.data(), lists.list(i), lists.count(i), own.normal.data(), here.data());
    const bool crease = found.closest < same_side;
    const bool rays = set_.viewpoints.cols() > 0;
    const float ratio = rays && crease ? flatter : clearly_flatter;
    const int best = found.score * ratio < own.variance ? lists.list(i)[found.which] : self;
    const Eigen::Vector3f view = viewDirection(set_.viewpoints, all_.column(i), here);
    if (!crease || !(view.squaredNorm() > 0))
      return best;
    const Plane& first = near_[best];
    const int other = otherSide(lists, i, first);
    const bool seen = other >= 0 && seesSecond(first, near_[other], here, -view.normalized());
    return seen ? other : best;
  }

  /// The code of the best plane to the other side of a crease that is as flat and holds the point; -1 if there is none.
  int otherSide(const GroupLists& lists, Index i, const Plane& first) const
  {
    constexpr float as_flat = 3.f;  // ratio of the variances of the two sides of a crease at most
    constexpr float holding = 16.f; // squared distance of a point that a plane holds / variance at most
    const Eigen::Vector3f here = all_.point(i);
    int second = -1;
    float best_score = std::numeric_limits<float>::infinity();
    for (std::size_t j = 0; j < lists.count(i); ++j) {
      const std::uint16_t code = lists.list(i)[j];
      const Plane& plane = near_[code];
      if (!(plane.variance <= as_flat * first.variance) || std::abs(plane.normal.dot(first.normal)) >= same_side)
        continue;
      const float its_score = score(plane, here);
      if (its_score < best_score && its_score - plane.variance <= 0.5f * holding * plane.variance) {
        second = code;
        best_score = its_score;
      }
    }
    return second;
  }

  /// Of the neighbours of `i` and of `start`, weighted by a Gaussian of the distance to the plane of `start` of twice its
  /// standard deviation.
  Moments nearMoments(Index i, Index start)
  {
    const Eigen::Vector3f here = all_.point(i);
    const Plane& plane = planes_[start];
    const float scale = -0.125f / std::max(plane.variance, std::numeric_limits<float>::min());
    std::size_t count = 0;
    for (const Index point : {i, start}) {
      const GroupLists& lists = all_.groupOf(point);
      const std::uint16_t* list = lists.list(point);
      const std::size_t end = count + lists.count(point);
      for (auto& values : offsets_)
        if (values.size() < end + 8)
          values.resize(2 * end + 8);
      for (; count < end; ++count) {
        const Eigen::Vector3f offset = all_.point(lists.position(*list++)) - here;
        for (int axis = 0; axis < 3; ++axis)
          offsets_[axis][count] = offset[axis];
      }
    }
    const float row[4] = {plane.normal.x(), plane.normal.y(), plane.normal.z(), plane.normal.dot(plane.center - here)};
    float sums[10];
    planeKernels().weightedSums({offsets_[0].data(), offsets_[1].data(), offsets_[2].data(), count}, row, scale, sums);
    return {sums[0], sums + 1};
  }

  const PointSet& set_;
  const Neighborhoods& all_;
  const std::vector<Plane>& planes_;
  std::vector<Plane> near_; ///< planes of the leaves of the group
  std::vector<char> near_changed_;
  std::vector<float> offsets_[3];
};

} // namespace

void refitAtEdges(const PointSet& set, const Neighborhoods& all, std::vector<Plane>& planes, int threads)
{
  std::vector<char> changed((planes.size() + 7) / 8 * 8, 1);
  const int count = set.viewpoints.cols() > 0 ? passes : passes_without_rays;
  for (int pass = 0; pass < count; ++pass) {
    std::vector<Updates> updates(all.groups.size());
    parallelRanges(all.groups.size(), threads, [&](Index begin, Index end) {
      GroupPass work(set, all, planes);
      for (Index g = begin; g < end; ++g)
        updates[g] = work.run(all.groups[g], changed);
    });
    std::fill(changed.begin(), changed.end(), 0);
    for (const Updates& group : updates)
      for (std::size_t u = 0; u < group.points.size(); ++u) {
        planes[group.points[u]] = group.planes[u];
        changed[group.points[u]] = 1;
      }
  }
}
} // namespace fresco::filters
