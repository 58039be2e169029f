// SPDX-License-Identifier: BSD-3-Clause
#include "atlas_paint.h"
#include "patch_frame.h"
#include <algorithm>
#include <cmath>
#include <fresco/common/parallel.h>
namespace fresco {
namespace {
void store(const Eigen::Vector3f& color, std::uint8_t* pixel)
{
  for (int c = 0; c < 3; ++c)
    pixel[c] = static_cast<std::uint8_t>(std::clamp(color[c], 0.f, 255.f) + 0.5f);
}

/// Colours of a patch's texels in one photograph.
class PatchSampler {
public:
  /// @param map that looks at the photograph
  PatchSampler(const PaintScene& scene, const PatchMap& map, const Image& photo, Index patch) : map_(map), photo_(photo)
  {
    for (int k = 0; k < 3; ++k)
      least_[k] = goesOn(scene, patch, (k + 1) % 3) ? -far_beyond : inset(k);
    const Eigen::Vector2f middle = map.place(Eigen::Vector3f::Constant(1.f / 3));
    constexpr float most = 16;
    const float pixels_per_texel = map.steps(middle.x(), middle.y()).colwise().norm().maxCoeff();
    steps_ =
        std::isfinite(pixels_per_texel) ? static_cast<int>(std::lround(std::clamp(pixels_per_texel, 1.f, most))) : 1;
  }

  /// Mean over the texel.
  Eigen::Vector3f operator()(const Eigen::Vector2f& center) const
  {
    if (steps_ == 1) {
      const Eigen::Vector2f p = pixel(center);
      return samplePhoto(photo_, p.x(), p.y());
    }
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    const float step = 1.f / static_cast<float>(steps_);
    for (int j = 0; j < steps_; ++j)
      for (int i = 0; i < steps_; ++i) {
        const Eigen::Vector2f p = pixel(center + Eigen::Vector2f((static_cast<float>(i) + 0.5f) * step - 0.5f,
                                                                 (static_cast<float>(j) + 0.5f) * step - 0.5f));
        sum += samplePhoto(photo_, p.x(), p.y());
      }
    return sum * (step * step);
  }

private:
  static constexpr float far_beyond = 1e3f;

  /// Weight of corner k at edge_pixels from the side opposite of it: nearer to an edge, pixels mix with what is beyond.
  float inset(int k) const
  {
    constexpr float edge_pixels = 0.75f, most = 0.2f; // a patch of few pixels keeps its middle
    Eigen::Matrix<float, 2, 3> c;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector2f at = map_.place(Eigen::Vector3f::Unit(i));
      c.col(i) = map_.pixel(at.x(), at.y());
    }
    const Eigen::Vector2f side = c.col((k + 2) % 3) - c.col((k + 1) % 3), to = c.col(k) - c.col((k + 1) % 3);
    const float height = std::abs(side.x() * to.y() - side.y() * to.x()) / std::max(side.norm(), 1e-6f);
    return std::min(most, edge_pixels / std::max(height, 1e-6f));
  }

  Eigen::Vector2f pixel(const Eigen::Vector2f& texel) const
  {
    const Eigen::Vector3f weights = map_.weights(texel.x(), texel.y());
    if (!(weights.array() < least_.array()).any())
      return map_.pixel(texel.x(), texel.y());
    const Eigen::Vector3f inside = weights.cwiseMax(least_); // what lies beyond may be another surface
    const Eigen::Vector2f at = map_.place(inside / inside.sum());
    return map_.pixel(at.x(), at.y());
  }

  const PatchMap& map_;
  const Image& photo_;
  Eigen::Vector3f least_; ///< of the corners' weights: below 0 where the surface goes on straight and is seen
  int steps_;
};

/// The photographs that one task uses, so that it asks the store for each only once.
class TaskPhotos {
public:
  explicit TaskPhotos(PhotoStore& store) : store_(store) {}
  const Image& operator[](int view)
  {
    constexpr std::size_t most = 4;
    for (auto& [v, photo] : kept_)
      if (v == view)
        return *photo;
    if (kept_.size() >= most)
      kept_.erase(kept_.begin());
    kept_.emplace_back(view, store_.get(view));
    return *kept_.back().second;
  }

private:
  PhotoStore& store_;
  std::vector<std::pair<int, std::shared_ptr<const Image>>> kept_; ///< the newest last
};

/// What one task paints with.
struct PaintDesk {
  TaskPhotos photos;
  std::vector<Eigen::Vector3f> colors; ///< of the texels of a patch
};

void paintPatch(const PaintScene& scene, const PaintSources& sources, PaintDesk& desk, Index patch, Image& atlas)
{
  PatchFrame frame(scene, patch);
  desk.colors.clear();
  for (Index s = sources.blend.begin[patch]; s < sources.blend.begin[patch + 1]; ++s) {
    const BlendShare& share = sources.blend.list[s];
    if (!frame.map.look(sources.views[share.view]))
      continue;
    const PatchSampler sampler(scene, frame.map, desk.photos[share.view], patch);
    const Eigen::Vector3f gain = sources.gains.col(share.view);
    const bool first = desk.colors.empty();
    std::size_t next = 0;
    frame.forTexels([&](const Eigen::Vector2f& center, int, int) {
      if (first)
        desk.colors.emplace_back(Eigen::Vector3f::Zero());
      Eigen::Vector3f& color = desk.colors[next++];
      const Eigen::Vector3f corners = frame.inside(center);
      if (const float weight = share.weights.dot(corners); weight > 0)
        color += weight * (gain.cwiseProduct(sampler(center)) + share.offsets * corners);
    });
  }
  std::size_t next = 0;
  if (!desk.colors.empty())
    frame.forTexels([&](const Eigen::Vector2f&, int x, int y) {
      store(desk.colors[next++], atlas.pixel(frame.chart.x + x, frame.chart.y + y));
    });
}

/// Patches of one view that one task paints.
struct Task {
  int view;
  std::size_t begin, end;
};
} // namespace

void paintSeen(const PaintScene& scene, const PaintSources& sources, std::vector<Image>& atlases)
{
  std::vector<int> order;
  for (Index i = 0; i < scene.patches.size(); ++i)
    if (scene.isSeen(i))
      order.push_back(static_cast<int>(i));
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return scene.view[a] < scene.view[b]; });
  constexpr std::size_t most_patches = 2048;
  std::vector<Task> tasks;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (tasks.empty() || tasks.back().view != scene.view[order[i]] || i - tasks.back().begin >= most_patches)
      tasks.push_back({scene.view[order[i]], i, i});
    tasks.back().end = i + 1;
  }
  parallelFor(
      static_cast<Index>(tasks.size()), scene.threads,
      [&](Index t) {
        PaintDesk desk{TaskPhotos(sources.photos), {}};
        for (std::size_t i = tasks[t].begin; i < tasks[t].end; ++i)
          paintPatch(scene, sources, desk, order[i], atlases[scene.chartOf(order[i])->atlas]);
      },
      1);
}

Points patchColors(const PaintScene& scene, const std::vector<Image>& atlases)
{
  Points colors = Points::Constant(3, scene.patches.size(), -1.f);
  parallelFor(scene.patches.size(), scene.threads, [&](Index i) {
    if (!scene.isSeen(i))
      return;
    const Chart& chart = *scene.chartOf(i);
    int sum[3] = {0, 0, 0}, count = 0;
    chart.texels.forTexels(scene.slots[i], [&](int x, int y) {
      const std::uint8_t* p = atlases[chart.atlas].pixel(chart.x + x, chart.y + y);
      for (int c = 0; c < 3; ++c)
        sum[c] += p[c];
      ++count;
    });
    if (count > 0)
      colors.col(i) = Eigen::Vector3f(sum[0], sum[1], sum[2]) / static_cast<float>(count);
  });
  return colors;
}

void paintUnseen(const PaintScene& scene, const Points& colors, std::vector<Image>& atlases, std::vector<Image>& masks)
{
  parallelFor(scene.patches.size(), scene.threads, [&](Index i) {
    const Chart* chart = scene.chartOf(i);
    if (scene.view[i] >= 0 || scene.slots[i] < 0)
      return;
    Eigen::Matrix3f corners;
    for (int k = 0; k < 3; ++k)
      corners.col(k) = colors.col(scene.patches.faces(k, i));
    const PatchFrame frame(scene, i);
    frame.forTexels([&](const Eigen::Vector2f& center, int x, int y) {
      x += chart->x;
      y += chart->y;
      store(corners * frame.inside(center), atlases[chart->atlas].pixel(x, y));
      *masks[chart->atlas].pixel(x, y) = 255;
    });
  });
}

std::vector<int> texelSlots(const std::vector<Chart>& charts, Index patches)
{
  std::vector<int> slots(static_cast<std::size_t>(patches), -1);
  for (const Chart& chart : charts)
    for (std::size_t s = 0; s < chart.texels.patches.size(); ++s)
      slots[chart.texels.patches[s]] = static_cast<int>(s);
  return slots;
}

bool goesOn(const PaintScene& scene, Index patch, int side)
{
  constexpr float straight = 0.95f; // cosine of 18 degrees
  const int other = scene.patches.neighbors(side, patch);
  return other >= 0 && scene.view[other] >= 0 &&
         scene.patches.normals.col(other).dot(scene.patches.normals.col(patch)) > straight;
}
} // namespace fresco
