// SPDX-License-Identifier: BSD-3-Clause
#include "atlas_paint.h"
#include "chart_raster.h"
#include <algorithm>
#include <cmath>
#include <fresco/common/parallel.h>
namespace fresco {
namespace {
struct Texel {
  int x, y;                ///< in the atlas
  Eigen::Vector2d center;  ///< in the chart's texels
  Eigen::Vector3d weights; ///< of the patch's corners
};

/// visit(Texel) for each texel that belongs to the patch
template <typename Visit>
void forOwnTexels(const PaintScene& scene, Index patch, const Visit& visit)
{
  const int c = scene.face_chart[scene.patches.parent[patch]];
  if (c < 0)
    return;
  const Chart& chart = scene.charts[c];
  const Eigen::Matrix<double, 2, 3> corners = patchTexels(scene.patches, chart, patch);
  const Eigen::Vector2i low = corners.rowwise().minCoeff().array().floor().cast<int>().matrix(),
                        high = corners.rowwise().maxCoeff().array().floor().cast<int>().matrix();
  const int reach = scene.border + 1;
  for (int y = std::max(0, low.y() - reach); y <= std::min(chart.height - 1, high.y() + reach); ++y)
    for (int x = std::max(0, low.x() - reach); x <= std::min(chart.width - 1, high.x() + reach); ++x)
      if (chart.owner[static_cast<std::size_t>(y) * chart.width + x] == patch) {
        const Eigen::Vector2d center(x + 0.5, y + 0.5);
        visit(Texel{chart.x + x, chart.y + y, center, barycentric(corners, center)});
      }
}

Eigen::Matrix3d cornerPoints(const PatchMesh& patches, Index patch)
{
  Eigen::Matrix3d out;
  for (int k = 0; k < 3; ++k)
    out.col(k) = patches.vertices.col(patches.faces(k, patch)).cast<double>();
  return out;
}

void store(const Eigen::Vector3f& color, std::uint8_t* pixel)
{
  for (int c = 0; c < 3; ++c)
    pixel[c] = static_cast<std::uint8_t>(std::lround(std::clamp(color[c], 0.f, 255.f)));
}

/// Where the chart's texels lie in a photograph, for one patch.
class PatchSampler {
public:
  PatchSampler(const PaintScene& scene, const Projector& view, const Image& photo, Index patch)
      : view_(view), photo_(photo), points_(cornerPoints(scene.patches, patch)),
        corners_(patchTexels(scene.patches, scene.charts[scene.face_chart[scene.patches.parent[patch]]], patch))
  {
    for (int k = 0; k < 3; ++k)
      least_[k] = goesOn(scene, patch, (k + 1) % 3) ? -far_beyond : inset(k);
    const Eigen::Vector2d middle = corners_.rowwise().mean();
    const Eigen::Vector2f at = pixel(middle), dx = pixel(middle + Eigen::Vector2d(1, 0)) - at,
                          dy = pixel(middle + Eigen::Vector2d(0, 1)) - at;
    constexpr float most = 16;
    const float pixels_per_texel = std::max(dx.norm(), dy.norm());
    steps_ =
        std::isfinite(pixels_per_texel) ? static_cast<int>(std::lround(std::clamp(pixels_per_texel, 1.f, most))) : 1;
  }

  /// Mean over the texel.
  Eigen::Vector3f operator()(const Eigen::Vector2d& center) const
  {
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    for (int j = 0; j < steps_; ++j)
      for (int i = 0; i < steps_; ++i) {
        const Eigen::Vector2f p = pixel(center + Eigen::Vector2d((i + 0.5) / steps_ - 0.5, (j + 0.5) / steps_ - 0.5));
        sum += samplePhoto(photo_, p.x(), p.y());
      }
    return sum / static_cast<float>(steps_ * steps_);
  }

private:
  static constexpr double far_beyond = 1e3;

  /// Whether the seen surface goes on straight beyond a side of the patch.
  static bool goesOn(const PaintScene& scene, Index patch, int side)
  {
    constexpr float straight = 0.95f; // cosine of 18 degrees
    const int other = scene.patches.neighbors(side, patch);
    return other >= 0 && scene.view[other] >= 0 &&
           scene.patches.normals.col(other).dot(scene.patches.normals.col(patch)) > straight;
  }

  /// Weight of corner k at edge_pixels from the side opposite of it: nearer to an edge, pixels mix with what is beyond.
  double inset(int k) const
  {
    constexpr double edge_pixels = 0.75, most = 0.2; // a patch of few pixels keeps its middle
    Eigen::Matrix<double, 2, 3> c;
    for (int i = 0; i < 3; ++i)
      c.col(i) = view_(points_.col(i).cast<float>()).head<2>().cast<double>();
    const Eigen::Vector2d side = c.col((k + 2) % 3) - c.col((k + 1) % 3), to = c.col(k) - c.col((k + 1) % 3);
    const double height = std::abs(side.x() * to.y() - side.y() * to.x()) / std::max(side.norm(), 1e-9);
    return std::min(most, edge_pixels / std::max(height, 1e-9));
  }

  Eigen::Vector2f pixel(const Eigen::Vector2d& texel) const
  {
    const Eigen::Vector3d inside =
        barycentric(corners_, texel).cwiseMax(least_); // what lies beyond may be another surface
    const Eigen::Vector3d point = points_ * (inside / inside.sum());
    return view_(point.cast<float>()).head<2>();
  }

  const Projector& view_;
  const Image& photo_;
  Eigen::Matrix3d points_;
  Eigen::Matrix<double, 2, 3> corners_;
  Eigen::Vector3d least_; ///< of the corners' weights: below 0 where the surface goes on straight and is seen
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

void paintPatch(const PaintScene& scene, const PaintSources& sources, TaskPhotos& photos, Index patch, Image& atlas)
{
  std::vector<Texel> texels;
  forOwnTexels(scene, patch, [&](const Texel& texel) {
    texels.push_back(texel);
    texels.back().weights = texel.weights.cwiseMax(0.0);
    texels.back().weights /= texels.back().weights.sum();
  });
  Points colors = Points::Zero(3, static_cast<Index>(texels.size()));
  for (Index s = sources.blend.begin[patch]; s < sources.blend.begin[patch + 1]; ++s) {
    const BlendShare& share = sources.blend.list[s];
    const PatchSampler sampler(scene, sources.views[share.view], photos[share.view], patch);
    const Eigen::Vector3f gain = sources.gains.col(share.view);
    for (std::size_t t = 0; t < texels.size(); ++t) {
      const Eigen::Vector3f corners = texels[t].weights.cast<float>();
      if (const float weight = share.weights.dot(corners); weight > 0)
        colors.col(static_cast<Index>(t)) +=
            weight * (gain.cwiseProduct(sampler(texels[t].center)) + share.offsets * corners);
    }
  }
  for (std::size_t t = 0; t < texels.size(); ++t)
    store(colors.col(static_cast<Index>(t)), atlas.pixel(texels[t].x, texels[t].y));
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
    if (scene.view[i] >= 0 && scene.face_chart[scene.patches.parent[i]] >= 0)
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
        TaskPhotos photos(sources.photos);
        for (std::size_t i = tasks[t].begin; i < tasks[t].end; ++i)
          paintPatch(scene, sources, photos, order[i],
                     atlases[scene.charts[scene.face_chart[scene.patches.parent[order[i]]]].atlas]);
      },
      1);
}

Points patchColors(const PaintScene& scene, const std::vector<Image>& atlases)
{
  Points colors = Points::Constant(3, scene.patches.size(), -1.f);
  parallelFor(scene.patches.size(), scene.threads, [&](Index i) {
    const int c = scene.face_chart[scene.patches.parent[i]];
    if (scene.view[i] < 0 || c < 0)
      return;
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    int count = 0;
    forOwnTexels(scene, i, [&](const Texel& texel) {
      const std::uint8_t* p = atlases[scene.charts[c].atlas].pixel(texel.x, texel.y);
      sum += Eigen::Vector3f(p[0], p[1], p[2]);
      ++count;
    });
    if (count > 0)
      colors.col(i) = sum / static_cast<float>(count);
  });
  return colors;
}

void paintUnseen(const PaintScene& scene, const Points& colors, std::vector<Image>& atlases, std::vector<Image>& masks)
{
  parallelFor(scene.patches.size(), scene.threads, [&](Index i) {
    const int c = scene.face_chart[scene.patches.parent[i]];
    if (scene.view[i] >= 0 || c < 0)
      return;
    const int atlas = scene.charts[c].atlas;
    Eigen::Matrix3f corners;
    for (int k = 0; k < 3; ++k)
      corners.col(k) = colors.col(scene.patches.faces(k, i));
    forOwnTexels(scene, i, [&](const Texel& texel) {
      const Eigen::Vector3d inside = texel.weights.cwiseMax(0.0);
      store(corners * (inside / inside.sum()).cast<float>(), atlases[atlas].pixel(texel.x, texel.y));
      *masks[atlas].pixel(texel.x, texel.y) = 255;
    });
  });
}
} // namespace fresco
