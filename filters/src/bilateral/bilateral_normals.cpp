// SPDX-License-Identifier: BSD-3-Clause
#include "bilateral/crease_normals.h"
#include "bilateral/smoothing_field.h"
#include "normals/exponential.h"
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <fresco/filters/core/bilateral_normals.h>
#include <utility>
namespace fresco {
using namespace filters;
namespace {

/// With what changes from round to round.
struct Field : SmoothingField {
  Points moved;             ///< points that were moved, else none
  Eigen::VectorXf scales_d; ///< 1 / (2 s_d^2), by point, or one for all
  float scale_n = 0;        ///< 1 / (2 s_n^2)

  Eigen::Vector3f point(Index i) const
  {
    if (moved.cols() > 0)
      return moved.col(i);
    return tree->point(i);
  }
};

void validate(const Points& points, const Points& normals, const BilateralOptions& options)
{
  require(points.cols() == normals.cols(), "bilateral filter: ", points.cols(), " points, ", normals.cols(),
          " normals");
  require(options.rounds >= 0, "bilateral filter: ", options.rounds, " rounds");
  require(options.move_rounds >= 0, "bilateral filter: ", options.move_rounds, " rounds of moving");
  require(options.sigma_d >= 0 && std::isfinite(options.sigma_d), "bilateral filter: sigma_d ", options.sigma_d,
          " is negative or not finite");
  require(options.spacings > 0 && std::isfinite(options.spacings), "bilateral filter: ", options.spacings,
          " spacings are not above 0");
  require(options.sigma_n > 0 && options.sigma_n <= 180, "bilateral filter: sigma_n ", options.sigma_n,
          " degrees is not in 0..180");
}

Field makeField(const Points& points, const Points& normals, const BilateralOptions& options)
{
  Field field{makeSmoothingField(points, normals, options), {}, {}, 0};
  field.scales_d = 2 * field.radii.array().square().inverse();
  const float s_n = 1 - std::cos(options.sigma_n * 0.017453293f);
  field.scale_n = 0.5f / (s_n * s_n);
  return field;
}

struct Neighborhood {
  Index point = 0;
  std::vector<int> list;
  Eigen::ArrayXf weights; ///< in the order of the list
};

void weigh(const Field& field, const Points& normals, Neighborhood& around)
{
  const Index i = around.point, count = around.list.size();
  const int* list = around.list.data();
  const Eigen::Vector3f point = field.point(i), normal = normals.col(i);
  const float scale_d = field.scales_d[field.scales_d.size() == 1 ? 0 : i];
  Eigen::ArrayXf& weights = around.weights;
  weights.resize(count);
  for (Index j = 0; j < count; ++j) {
    const float difference = 1 - normal.dot(normals.col(list[j]));
    weights[j] = -(field.point(list[j]) - point).squaredNorm() * scale_d - difference * difference * field.scale_n;
  }
  exponential(weights.data(), count);
  for (Index j = 0; j < count; ++j)
    weights[j] *= field.areas[list[j]];
}

/// use(neighborhood) for each point.
template <typename Use>
void forNeighborhoods(const Field& field, const Points& normals, int threads, const Use& use)
{
  const auto search = [&](Index range) {
    const CompressedLists& lists = field.lists[range];
    CompressedReader reader(lists);
    Neighborhood around;
    for (around.point = lists.begin; around.point < lists.end; ++around.point) {
      reader.next(around.list);
      weigh(field, normals, around);
      use(around);
    }
  };
  parallelFor(field.lists.size(), threads, search, 1);
}

Points smoothOnce(const Field& field, const Points& normals, int threads)
{
  Points smooth(3, normals.cols());
  forNeighborhoods(field, normals, threads, [&](const Neighborhood& around) {
    const int* list = around.list.data();
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    for (Index j = 0; j < around.weights.size(); ++j)
      sum += around.weights[j] * normals.col(list[j]);
    const float length = sum.norm();
    smooth.col(around.point) = length > 0 ? Eigen::Vector3f(sum / length) : Eigen::Vector3f(normals.col(around.point));
  });
  return smooth;
}

/// p_i' = p_i + n_i sum_j w_ij n_j . (p_j - p_i) / sum_j w_ij
Points moveOnce(const Field& field, const Points& normals, int threads)
{
  Points moved(3, normals.cols());
  forNeighborhoods(field, normals, threads, [&](const Neighborhood& around) {
    const int* list = around.list.data();
    const Eigen::Vector3f point = field.point(around.point);
    float step = 0;
    for (Index j = 0; j < around.weights.size(); ++j)
      step += around.weights[j] * normals.col(list[j]).dot(field.point(list[j]) - point);
    const float total = around.weights.sum();
    moved.col(around.point) = total > 0 ? Eigen::Vector3f(point + step / total * normals.col(around.point)) : point;
  });
  return moved;
}
BilateralResult smooth(const Points& points, const Points& viewpoints, const Points& normals,
                       const BilateralOptions& options, const Progress& progress)
{
  constexpr int comparisons = 2; // after the first rounds; a third changes hardly anything
  validate(points, normals, options);
  if (options.rounds == 0 && options.move_rounds == 0)
    return {points, normals};
  report(progress, "find neighbours", 0.0);
  Field field = makeField(points, normals, options);
  Points smooth = std::move(field.normals);
  const int rounds = options.rounds + options.move_rounds;
  for (int round = 0; round < rounds; ++round) {
    report(progress, round < options.rounds ? "smooth normals" : "move points", 0.4 + 0.6 * round / rounds);
    if (round < options.rounds)
      smooth = smoothOnce(field, smooth, options.threads);
    else
      field.moved = moveOnce(field, smooth, options.threads);
    if (round < std::min(options.rounds, comparisons) && options.edges && viewpoints.cols() > 0)
      smooth = selectCreaseNormals(field, viewpoints, smooth, options.threads);
  }
  const std::vector<int> columns = field.tree->columns();
  const Points moved = std::move(field.moved);
  field = {}; // frees memory
  BilateralResult result{points, normals};
  for (Index i = 0; i < smooth.cols(); ++i) {
    result.normals.col(columns[i]) = smooth.col(i);
    if (moved.cols() > 0)
      result.points.col(columns[i]) = moved.col(i);
  }
  return result;
}
} // namespace

BilateralResult smoothNormals(const Points& points, const Points& normals, const BilateralOptions& options,
                              const Progress& progress)
{
  return smooth(points, Points(3, 0), normals, options, progress);
}

BilateralResult smoothNormals(const PointSet& set, const Points& normals, const BilateralOptions& options,
                              const Progress& progress)
{
  validatePointSet(set);
  return smooth(set.points, set.viewpoints, normals, options, progress);
}
} // namespace fresco
