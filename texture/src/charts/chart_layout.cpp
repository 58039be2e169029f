// SPDX-License-Identifier: BSD-3-Clause
#include "charts/chart_layout.h"
#include "charts/chart_raster.h"
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fresco/core/constants.h>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <stdexcept>
namespace fresco::texture {
namespace {
using Extent = Eigen::AlignedBox2d;

Extent extentOf(const std::vector<Eigen::Vector2d>& points, const Eigen::Matrix2d& T)
{
  Extent box;
  for (const Eigen::Vector2d& point : points)
    box.extend(T * point);
  return box;
}

/// Frame of the plane across `axis`. Its second row points down as the rows of an image do, so that the texture is not
/// mirrored.
Eigen::Matrix<double, 2, 3> frameAcross(const Eigen::Vector3f& axis)
{
  const Eigen::Vector3d n = axis.cast<double>(), a = n.unitOrthogonal();
  Eigen::Matrix<double, 2, 3> T;
  T.row(0) = a;
  T.row(1) = a.cross(n);
  return T;
}

class Layout {
public:
  Layout(const PatchMesh& patches, const FaceGraph& graph, const Eigen::VectorXf& density, const LayoutOptions& options)
      : patches_(patches), graph_(graph), density_(density), options_(options),
        first_(patchesOfFaces(patches, graph.areas.size()))
  {}

  std::vector<Chart> run()
  {
    checkSize();
    std::vector<Chart> done;
    std::vector<int> open = graph_.seeds;
    while (!open.empty()) {
      std::vector<Chart> charts = cutToSize(segmentFaces(graph_, open));
      std::vector<std::vector<int>> out(charts.size());
      parallelFor(
          charts.size(), options_.threads,
          [&](Index c) { out[c] = rasterizeChart(patches_, first_, options_.border, charts[c]); }, 1);
      open = inSeedOrder(out);
      std::move(charts.begin(), charts.end(), std::back_inserter(done));
    }
    return done;
  }

private:
  void checkSize() const
  {
    const double texels = graph_.areas.cast<double>().dot(density_.cast<double>().cwiseAbs2());
    if (!(texels <= options_.most_texels))
      throw std::runtime_error(concat("texture: ", std::ceil(texels / 1e6), " megatexels would be needed, at most ",
                                      options_.most_texels / 1e6, " are made: choose larger texels"));
  }

  std::vector<Chart> cutToSize(std::vector<Chart> charts) const
  {
    std::vector<std::vector<Chart>> parts(charts.size());
    parallelFor(
        charts.size(), options_.threads, [&](Index c) { cutToSize(std::move(charts[c]), parts[c]); }, 1);
    std::vector<Chart> out;
    for (std::vector<Chart>& list : parts)
      std::move(list.begin(), list.end(), std::back_inserter(out));
    return out;
  }

  /// Appends the chart, or the parts that are small enough.
  void cutToSize(Chart chart, std::vector<Chart>& out) const
  {
    std::vector<Chart> open;
    open.push_back(std::move(chart));
    while (!open.empty()) {
      Chart next = std::move(open.back());
      open.pop_back();
      const Extent box = place(next);
      if (std::max(next.width, next.height) > options_.largest && next.faces.size() > 1) {
        split(next, box, open);
        continue;
      }
      if (std::max(next.width, next.height) > options_.largest)
        shrink(next, box);
      out.push_back(std::move(next));
    }
  }

  /// The smallest rectangle among those turned by steps of 3 degrees.
  Extent place(Chart& chart) const
  {
    constexpr double density_share =
        0.75; // of the area that gets all the resolution it wants: a small near part does not decide
    std::vector<std::pair<double, double>> densities; // with areas
    for (const int f : chart.faces)
      densities.emplace_back(density_[f], graph_.areas[f]);
    const double density = weightedQuantile(densities, density_share);
    const Eigen::Matrix<double, 2, 3> frame = density * frameAcross(chart.axis);
    const std::vector<Eigen::Vector2d> points = cornersIn(frame, chart);
    constexpr int steps = 30;
    double least = 1e300;
    Extent box;
    for (int i = 0; i < steps; ++i) {
      const Eigen::Matrix2d turn = Eigen::Rotation2Dd(-i * (pi / 2) / steps).toRotationMatrix();
      const Extent turned = extentOf(points, turn);
      const double area = (turned.sizes().array() + 2.0 * options_.border).prod();
      if (area < least * (1 - 1e-9)) {
        least = area;
        box = turned;
        chart.T_texel = turn * frame;
      }
    }
    fit(chart, box);
    return box;
  }

  std::vector<Eigen::Vector2d> cornersIn(const Eigen::Matrix<double, 2, 3>& frame, const Chart& chart) const
  {
    std::vector<Eigen::Vector2d> out;
    for (const int face : chart.faces)
      for (Index i = first_[face]; i < first_[face + 1]; ++i)
        for (int k = 0; k < 3; ++k)
          out.emplace_back(frame * patches_.vertices.col(patches_.faces(k, i)).cast<double>());
    return out;
  }

  void fit(Chart& chart, const Extent& box) const
  {
    const double spare = options_.border + 0.5;
    chart.offset = -box.min().array() + spare;
    const Eigen::Array2d size = (box.sizes().array() + 2 * spare).ceil().min(1e9);
    chart.width = size.x();
    chart.height = size.y();
  }

  void shrink(Chart& chart, const Extent& box) const
  {
    const double scale = (options_.largest - 2 * options_.border - 2) / box.sizes().maxCoeff();
    chart.T_texel *= scale;
    fit(chart, {box.min() * scale, box.max() * scale});
  }

  /// Two charts, to either side of the middle of the longer side.
  void split(const Chart& chart, const Extent& box, std::vector<Chart>& out) const
  {
    const int across = box.sizes().x() >= box.sizes().y() ? 0 : 1;
    const double middle = 0.5 * (box.min()[across] + box.max()[across]);
    Chart half[2];
    for (const int face : chart.faces) {
      const Eigen::Vector2d p = patchTexels(patches_, chart, first_[face]).rowwise().mean() - chart.offset;
      half[p[across] > middle].faces.push_back(face);
    }
    for (int side = 0; side < 2; ++side)
      if (half[side].faces.empty()) { // one huge face holds the box open: it goes by itself
        half[side].faces = {half[1 - side].faces.back()};
        half[1 - side].faces.pop_back();
      }
    for (Chart& part : half) {
      part.axis = chart.axis;
      out.push_back(std::move(part));
    }
  }

  std::vector<int> inSeedOrder(const std::vector<std::vector<int>>& groups) const
  {
    std::vector<char> wanted(graph_.areas.size(), 0);
    for (const auto& group : groups)
      for (const int f : group)
        wanted[f] = 1;
    std::vector<int> out;
    std::copy_if(graph_.seeds.begin(), graph_.seeds.end(), std::back_inserter(out), [&](int f) { return wanted[f]; });
    return out;
  }

  const PatchMesh& patches_;
  const FaceGraph& graph_;
  const Eigen::VectorXf& density_;
  const LayoutOptions& options_;
  std::vector<Index> first_;
};
} // namespace

std::vector<Chart> layOutCharts(const PatchMesh& patches, const FaceGraph& graph, const Eigen::VectorXf& density,
                                const LayoutOptions& options)
{
  return Layout(patches, graph, density, options).run();
}
} // namespace fresco::texture
