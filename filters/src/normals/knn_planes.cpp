// SPDX-License-Identifier: BSD-3-Clause
#include "normals/knn_planes.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/statistics.h>
namespace fresco::filters {
namespace {
constexpr std::size_t most_leaves = 65536; // around a group; beyond, each point is searched for alone
constexpr float least_width = 6.f;         // radius of a neighbourhood / deviation of the points from the surface
constexpr int spread = 3;                  // times the neighbours of a point are kept in dense parts
constexpr float line_breadth = 3.f;        // of a line at most, variances of the points

/// Deviation of the points from their surfaces: the median of planes through the k nearest.
float surfaceNoise(const PointTree& tree, int k, int threads)
{
  constexpr Index noise_samples = 2048;
  const Index count = std::min(noise_samples, tree.size());
  std::vector<float> deviations(count);
  parallelRanges(count, threads, [&](Index begin, Index end) {
    std::vector<PointTree::Key> keys;
    for (Index s = begin; s < end; ++s) {
      const Eigen::Vector3f here = tree.point(s * tree.size() / count);
      tree.nearestKeys(here, k, keys);
      std::sort(keys.begin(), keys.end()); // so that sums do not depend on the search
      Moments moments;
      for (const auto key : keys)
        moments.add(tree.point(PointTree::position(key)) - here);
      const Plane plane = fitPlane(moments, here);
      const float variance = plane.shape() == Plane::plane ? plane.variance : 0.f;
      deviations[s] = std::sqrt(variance * moments.weight / std::max(1.f, moments.weight - 3));
    }
  });
  return count > 0 ? median(deviations) : 0.f;
}

/// About the sum of the lesser two variances of points, and the least of them.
std::pair<float, float> lesserVariances(const Moments& moments)
{
  const float share = 1 / moments.weight, *s = moments.sums;
  const float x = s[0] * share, y = s[1] * share, z = s[2] * share;
  const float xx = s[3] * share - x * x, xy = s[4] * share - x * y, xz = s[5] * share - x * z;
  const float yy = s[6] * share - y * y, yz = s[7] * share - y * z, zz = s[8] * share - z * z;
  const float yyzz = yy * zz - yz * yz, products = xx * yy - xy * xy + (xx * zz - xz * xz) + yyzz;
  const float determinant = xx * yyzz - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
  return {products / (xx + yy + zz), determinant / products};
}

/// Whether noise tells the direction across the points.
/// @param variance of the points, across their surfaces
bool isLine(const Moments& moments, float variance)
{
  constexpr float thinnest =
      0.1f; // least variance / squared deviation, of what has a thickness: a row of beams has none
  const auto [both, least] = lesserVariances(moments);
  return both < line_breadth * variance || (both < 2 * line_breadth * variance && least < thinnest * variance);
}

/// Search and fit for one group after another.
class GroupFitter {
public:
  GroupFitter(const PointTree& tree, int k, float width, Fits& fits)
      : tree_(tree), k_(k), width_(width), variance_(width * width / (least_width * least_width)), fits_(fits),
        group_(tree), wide_(tree), evenly_(k), batch_([this](Index i, const Plane& plane) { fits_.planes[i] = plane; })
  {}

  /// @param codes of the first point of the tree
  GroupLists fit(Index first_leaf, Index end_leaf, std::uint16_t* codes)
  {
    group_.enter(first_leaf, end_leaf);
    encoder_.begin(group_.begin(), group_.end());
    const float expected = group_.expectedReach(k_);
    group_.gather(std::max(width_, expected), most_leaves);
    const bool dense = expected < width_;
    thinned_ = false;
    lines_.clear();
    for (Index i = group_.begin(); i < group_.end(); ++i)
      if (!dense || !fitKept(i))
        fitNearest(i);
    batch_.finish();
    if (width_ > 0 && !lines_.empty())
      widenLines(first_leaf, end_leaf);
    return encoder_.finish(group_.leaves(), codes + group_.begin() * k_);
  }

private:
  /// With the points kept, if there are enough. Of them, k evenly chosen ones are the list.
  bool fitKept(Index i)
  {
    if (!thinned_)
      group_.thin(width_, spread * k_);
    thinned_ = true;
    const std::size_t found = group_.keptWithin(i, width_), k = evenly_.size();
    if (found < k)
      return false;
    float sums[10];
    const int* codes = group_.sum(sums);
    takeEvenly(codes, found);
    encoder_.add(evenly_.data(), k);
    take(i, found, sums);
    return true;
  }

  void fitNearest(Index i)
  {
    float sums[10];
    group_.nearest(i, k_);
    const int* codes = group_.sum(sums);
    if (sums[9] < width_ * width_ && fitKept(i))
      return;
    if (sums[9] < width_ * width_) {
      group_.nearest(i, k_);
      codes = group_.sum(sums);
    }
    encoder_.add(codes, k_);
    take(i, k_, sums);
  }

  void take(Index i, float weight, const float* sums)
  {
    const Moments moments(weight, sums);
    fits_.reaches[i] = sums[9];
    if (isLine(moments, variance_))
      lines_.push_back(i);
    batch_.add(i, tree_.point(i), moments);
  }

  /// As many codes as a list has, evenly chosen of those found.
  void takeEvenly(const int* codes, std::size_t found)
  {
    const double step = 1.0 * found / evenly_.size();
    for (std::size_t j = 0; j < evenly_.size(); ++j) {
      const Index at = (j + 0.5) * step;
      evenly_[j] = codes[at];
    }
  }

  void widenLines(Index first_leaf, Index end_leaf)
  {
    constexpr int doublings = 4; // of the radius around a line
    float radius = width_;
    for (const Index i : lines_)
      radius = std::max(radius, std::sqrt(fits_.reaches[i]));
    for (int doubling = 0; doubling < doublings && !lines_.empty(); ++doubling) {
      radius *= 2;
      wide_.enter(first_leaf, end_leaf);
      wide_.gather(radius, most_leaves);
      wide_.thin(radius, spread * k_);
      lines_.erase(std::remove_if(lines_.begin(), lines_.end(), [&](Index i) { return settled(i, radius); }),
                   lines_.end());
    }
  }

  /// Goes over to points spread evenly over `radius` if they have a plane.
  /// @return false if wider ones may have it
  bool settled(Index i, float radius)
  {
    constexpr float thickest = 2.25f; // of a plane that takes the place of a line
    const std::size_t found = wide_.keptWithin(i, radius), k = evenly_.size();
    float sums[10];
    const int* codes = wide_.sum(sums);
    const Moments moments(found, sums);
    if (found < k || lesserVariances(moments).first < 4 * line_breadth * variance_)
      return false;
    const Plane plane = fitPlane(moments, tree_.point(i));
    if (plane.variance > thickest * variance_)
      return plane.variance > 2 * thickest * variance_; // a thin thing and what is around it
    takeEvenly(codes, found);
    for (int& code : evenly_)
      code = group_.codeOf(wide_.position(code));
    encoder_.replace(i, evenly_.data(), k);
    fits_.planes[i] = plane;
    fits_.reaches[i] = sums[9];
    return true;
  }

  const PointTree& tree_;
  int k_;
  float width_;    ///< at least, of a neighbourhood
  float variance_; ///< of the points, across their surfaces
  Fits& fits_;
  BatchKnn group_, wide_;
  std::vector<Index> lines_; ///< points whose neighbours lie on a line but for the noise
  bool thinned_ = false;
  GroupEncoder encoder_;
  std::vector<int> evenly_;
  PlaneBatch<std::function<void(Index, const Plane&)>> batch_;
};

} // namespace

Fits fitNearest(Neighborhoods& all, int k, int threads)
{
  const PointTree& tree = *all.tree;
  const int each = std::min<Index>(k, tree.size());
  Fits fits;
  fits.planes.resize(tree.size());
  fits.reaches.resize(tree.size());
  const float width = tree.size() > k ? least_width * surfaceNoise(tree, k, threads) : 0.f;
  const std::vector<Index> first = tree.subtrees(Neighborhoods::groupLeaves(k));
  all.groups.resize(first.size() - 1);
  all.codes.resize(tree.size() * each);
  parallelRanges(all.groups.size(), threads, [&](Index begin, Index end) {
    GroupFitter fitter(tree, each, width, fits);
    for (Index g = begin; g < end; ++g)
      all.groups[g] = fitter.fit(first[g], first[g + 1], all.codes.data());
  });
  all.numberGroups();
  return fits;
}

Fits fitLists(const Neighborhoods& all, int threads)
{
  Fits fits;
  fits.planes.resize(all.size());
  fits.reaches.resize(all.size());
  parallelFor(all.groups.size(), threads, [&](Index g) {
    const GroupLists& lists = all.groups[g];
    PlaneBatch batch([&](Index i, const Plane& plane) { fits.planes[i] = plane; });
    for (Index i = lists.begin; i < lists.end; ++i) {
      const Eigen::Vector3f here = all.point(i);
      Moments moments;
      float reach = 0;
      for (std::size_t j = 0; j < lists.count(i); ++j) {
        const Eigen::Vector3f offset = all.point(lists.position(lists.list(i)[j])) - here;
        moments.add(offset);
        reach = std::max(reach, offset.squaredNorm());
      }
      fits.reaches[i] = reach;
      batch.add(i, here, moments);
    }
    batch.finish();
  });
  return fits;
}
} // namespace fresco::filters
