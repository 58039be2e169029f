// SPDX-License-Identifier: BSD-3-Clause
#include "views/visibility.h"
#include "photographs/grid.h"
#include "views/patch_visibility.h"
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel_batches.h>
#include <limits>
namespace fresco::texture {
namespace {
// Octaves by which a view is trusted less, if poses are uncertain.
constexpr float outline_penalty = 5; // near the outline of what stands before: taken where nothing else shows it
constexpr float rim_penalty = 2;     // at its own outline, where pixels mix with what lies behind

/// @param step length by which depth jumps at an outline
bool isNearOutline(const Footprint& patch, const DepthMap& nearest, float radius, float step)
{
  const Eigen::Vector2f center = patch.corners.rowwise().mean();
  const int x = std::clamp<int>(center.x(), 0, nearest.width - 1),
            y = std::clamp<int>(center.y(), 0, nearest.height - 1);
  const float slope = patch.inverse_depth.head<2>().norm(), depth = patch.farthest;
  return nearest.at(x, y) < depth - step - depth * depth * slope * (1.5f * radius + 1);
}

/// Whether the surface ends near one of the patch's corners or its middle.
bool isAtRim(const Footprint& patch, const DepthMap& farthest, float radius, float step)
{
  const float slope = patch.inverse_depth.head<2>().norm(), depth = patch.farthest;
  const float beyond = depth + step + depth * depth * slope * (1.5f * radius + 1);
  for (int k = 0; k < 4; ++k) {
    const Eigen::Vector2f p =
        k < 3 ? Eigen::Vector2f(patch.corners.col(k)) : Eigen::Vector2f(patch.corners.rowwise().mean());
    const int x = std::clamp<int>(p.x(), 0, farthest.width - 1), y = std::clamp<int>(p.y(), 0, farthest.height - 1);
    if (farthest.at(x, y) > beyond)
      return true;
  }
  return false;
}

/// Octaves, 0 inside the image, rising to 1 at its border: there lenses are worst and a better view is likely.
float borderPenalty(const CameraModel& camera, const Eigen::Vector2f& pixel)
{
  const float away = std::min({pixel.x(), pixel.y(), camera.width - pixel.x(), camera.height - pixel.y()});
  return 1 - std::clamp(away / (0.05f * std::min(camera.width, camera.height)), 0.f, 1.f);
}

class ViewTest {
public:
  ViewTest(const PatchMesh& patches, const Projector& view, const VisibilityLimits& limits)
      : patches_(patches), view_(view), limits_(limits), outline_(3.f * limits.tolerance),
        pixels_(3, patches.vertices.cols())
  {
    for (Index v = 0; v < pixels_.cols(); ++v)
      pixels_.col(v) = pixelWithin(view, patches.vertices.col(v));
  }

  /// Whether a vertex lies in the image: else no patch does.
  bool mayShow() const { return (pixels_.row(2).array() > 0).any(); }

  std::vector<SeenPatch> run(const VisibilityInput& input, Index number, const DepthMap& map) const
  {
    std::vector<SeenPatch> seen;
    const std::shared_ptr<const Image> photo = input.views.photos.get(number);
    const float misfit = input.views.misfits.empty() ? 0.f : input.views.misfits[number];
    const float radius = limits_.margin / map.step;
    const float rim = interpolation_reach / map.step;
    const CellBox cells = cellsInUse(map);
    const DepthMap nearest = nearestWithin(map, std::ceil(radius), cells),
                   farthest = farthestWithin(map, std::ceil(rim), cells);
    for (Index i = 0; i < patches_.size(); ++i)
      if (const float cosine = cosineOf(i); cosine >= least_cosine) {
        const Footprint patch = footprintOf(corners(i), map.step);
        const Visibility visibility = visibilityOf(patch, map, limits_.tolerance);
        if (visibility == Visibility::hidden)
          continue;
        float penalty = misfit + borderPenalty(view_.camera(), patch.corners.rowwise().mean() * map.step);
        if (visibility == Visibility::beside)
          penalty += limits_.pose_uncertainty; // a pixel next to it shows something a little nearer
        if (isNearOutline(patch, nearest, radius, outline_))
          penalty += limits_.pose_uncertainty * outline_penalty;
        else if (isAtRim(patch, farthest, rim, outline_))
          penalty += limits_.pose_uncertainty * rim_penalty;
        Candidate candidate = colored(*photo, i);
        candidate.view = number;
        candidate.quality = view_.focal() * cosine / (0.5f * (patch.nearest + patch.farthest)) * std::exp2(-penalty);
        seen.push_back({static_cast<int>(i), candidate});
      }
    return seen;
  }

private:
  Eigen::Matrix3f corners(Index i) const
  {
    Eigen::Matrix3f out;
    for (int k = 0; k < 3; ++k)
      out.col(k) = pixels_.col(patches_.faces(k, i));
    return out;
  }

  /// Around all vertices in the image.
  CellBox cellsInUse(const DepthMap& map) const
  {
    Eigen::AlignedBox2f box;
    for (Index v = 0; v < pixels_.cols(); ++v)
      if (pixels_(2, v) > 0)
        box.extend(Eigen::Vector2f(pixels_.col(v).head<2>() / map.step));
    return {std::clamp<int>(box.min().x(), 0, map.width - 1), std::clamp<int>(box.max().x(), 0, map.width - 1),
            std::clamp<int>(box.min().y(), 0, map.height - 1), std::clamp<int>(box.max().y(), 0, map.height - 1)};
  }

  /// Cosine between the patch's normal and the direction to the camera; 0 where a corner is out of the image.
  float cosineOf(Index i) const
  {
    for (int k = 0; k < 3; ++k)
      if (!(pixels_(2, patches_.faces(k, i)) > 0))
        return 0;
    return cosineTowards(patches_, i, view_);
  }

  /// What the photograph shows in the middle and halfway to the corners.
  Candidate colored(const Image& photo, Index i) const
  {
    constexpr float clipped = 254; // grey levels: the light may have been any brighter
    const Eigen::Matrix3f at = corners(i);
    const Eigen::Vector2f middle = at.topRows<2>().rowwise().mean();
    Eigen::Vector3f sum = samplePhotoQuickly(photo, middle.x(), middle.y());
    float brightest = sum.maxCoeff(), squares = sum.squaredNorm();
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector2f p = 0.5f * (middle + at.col(k).head<2>());
      const Eigen::Vector3f color = samplePhotoQuickly(photo, p.x(), p.y());
      brightest = std::max(brightest, color.maxCoeff());
      squares += color.squaredNorm();
      sum += color;
    }
    Candidate out{};
    for (int c = 0; c < 3; ++c)
      out.color[c] = sum[c] / 4 + 0.5f;
    out.contrast = std::min(255.f, 2 * std::sqrt(std::max(0.f, squares - sum.squaredNorm() / 4) / 9) + 0.5f);
    out.clipped = brightest >= clipped;
    out.radius = storedRadius(squaredRadius(view_.camera(), middle));
    return out;
  }

  const PatchMesh& patches_;
  const Projector& view_;
  VisibilityLimits limits_;
  float outline_; ///< mesh units by which depth jumps at an outline: more than a surface behind may lie
  Points pixels_; ///< x, y, depth per vertex; depth 0 where out of the image
};

/// The map if it is as fine as can be, else another one.
DepthMap finestDepth(const VisibilityInput& input, Index view, DepthMap map)
{
  const CameraModel& camera = input.views.projectors[view].camera();
  return !map.depth.empty() && map.step == depthStep(camera, most_cells) ? std::move(map)
                                                                         : shownDepth(input, view, most_cells);
}
} // namespace

CandidateTable::CandidateTable(Index patches, Index most) : most_(most) { kept_.begin.assign(patches + 1, 0); }

Index CandidateTable::mostPerPatch(Index patches, Index views)
{
  constexpr Index most = 16'000'000; // of 12 bytes, in all
  constexpr Index least = 8;         // per patch, however many patches there are
  return std::clamp(most / std::max<Index>(patches, 1), least, std::max(views, least));
}

void CandidateTable::add(const std::vector<std::vector<SeenPatch>>& views, int threads)
{
  const Index patches = kept_.begin.size() - 1;
  Candidates all;
  all.begin.assign(patches + 1, 0);
  for (const auto& view : views)
    for (const SeenPatch& seen : view)
      ++all.begin[seen.patch + 1];
  for (Index i = 0; i < patches; ++i)
    all.begin[i + 1] = all.begin[i] + std::min(most_, kept_.count(i) + all.begin[i + 1]);
  all.list.resize(all.begin.back());
  parallelRanges(patches, threads, [&](Index begin, Index end) {
    std::vector<const SeenPatch*> next; // of each view
    for (const auto& view : views)
      next.push_back(std::lower_bound(view.data(), view.data() + view.size(), begin,
                                      [](const SeenPatch& seen, Index patch) { return seen.patch < patch; }));
    for (Index i = begin; i < end; ++i) {
      Index count = kept_.count(i);
      Candidate* first = all.list.data() + all.begin[i];
      std::copy_n(kept_.of(i), count, first);
      for (std::size_t v = 0; v < views.size(); ++v)
        if (next[v] != views[v].data() + views[v].size() && next[v]->patch == i)
          keep((next[v]++)->candidate, first, count);
    }
  });
  kept_ = std::move(all);
}

/// @param first of `count` candidates of a patch
void CandidateTable::keep(const Candidate& candidate, Candidate* first, Index& count) const
{
  Candidate* last = first + count;
  if (count == most_) {
    Candidate* worst = first; // of equal ones the last
    for (Candidate* c = first + 1; c < last; ++c)
      worst = c->quality > worst->quality ? worst : c;
    if (!(candidate.quality > worst->quality))
      return;
    std::move(worst + 1, last, worst);
    --last;
  } else {
    ++count;
  }
  *last = candidate;
}

float Candidates::bestQuality(Index patch) const
{
  float best = 0;
  for (Index c = begin[patch]; c < begin[patch + 1]; ++c)
    best = std::max(best, list[c].quality);
  return best;
}

const Candidate* Candidates::find(Index patch, int view) const
{
  const Candidate *first = of(patch), *last = first + count(patch);
  const Candidate* at = std::lower_bound(first, last, view, [](const Candidate& c, int v) { return c.view < v; });
  return at != last && at->view == view ? at : nullptr;
}

DepthMap shownDepth(const VisibilityInput& input, Index view, Index cells)
{
  if (input.whole)
    return input.whole->maps[view];
  DepthMap map = depthMap(*input.scene, input.views.projectors[view], cells);
  hideMasked(input.views.photos.mask(view), map);
  return map;
}

void hideMasked(Image mask, DepthMap& map)
{
  constexpr float before_lens = 1e-3f; // of the distance of what is nearest
  if (mask.empty())
    return;
  const auto cellUnder = [&](int x, int y) -> float& {
    return map.depth[cellAt(std::min<int>(x / map.step, map.width - 1), std::min<int>(y / map.step, map.height - 1),
                            map.width)];
  };
  for (int y = 0; y < mask.height; ++y)
    for (int x = 0; x < mask.width; ++x)
      if (std::uint8_t& used = *mask.pixel(x, y); used == 0 && !std::isfinite(cellUnder(x, y)))
        used = 255;
  mask = withinReach(std::move(mask));
  const float depth = before_lens * *std::min_element(map.depth.begin(), map.depth.end());
  for (int y = 0; y < mask.height; ++y)
    for (int x = 0; x < mask.width; ++x)
      if (*mask.pixel(x, y) == 0)
        cellUnder(x, y) = depth;
}

Candidates findCandidates(const PatchMesh& patches, const VisibilityInput& input, const Progress& progress,
                          std::vector<DepthMap> maps, std::vector<OutlineMask>* outlines)
{
  const ViewList& views = input.views;
  const Index n = views.used.size();
  CandidateTable table(patches.size(), CandidateTable::mostPerPatch(patches.size(), n));
  std::vector<std::vector<SeenPatch>> seen;
  const VisibilityLimits limits = limitsFor(patches, input);
  maps.resize(n);
  if (outlines)
    outlines->resize(n);
  for (Index first = 0; first < n; first += batch_size) {
    report(progress, "visibility", 1.0 * first / n);
    const Index count = std::min(batch_size, n - first);
    seen.assign(count, {});
    const auto test = [&](Index i) {
      const Index v = first + i;
      if (!views.used[v])
        return;
      const ViewTest view(patches, views.projectors[v], limits);
      if (!view.mayShow() && !outlines)
        return;
      const DepthMap map = finestDepth(input, v, std::move(maps[v]));
      if (view.mayShow())
        seen[i] = view.run(input, v, map);
      if (outlines)
        (*outlines)[v] = OutlineMask(map, interpolation_reach, limits.tolerance);
    };
    parallelFor(count, input.options.threads, test, 1);
    table.add(seen, input.options.threads);
  }
  views.photos.dropUnlessAll();
  return table.take();
}
} // namespace fresco::texture
