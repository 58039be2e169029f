// SPDX-License-Identifier: BSD-3-Clause
#include "compact_lists.h"
#include "exponential.h"
#include <Eigen/Geometry>
#include <cmath>
#include <fresco/common/parallel.h>
#include <fresco/common/require.h>
#include <fresco/filters/core/bilateral_normals.h>
#include <fresco/filters/core/local_sampling.h>
namespace fresco {
namespace {
constexpr int most = 256; // neighbours summed

/// The points that count, in the order of a tree, with what does not change from round to round.
struct Field {
  std::vector<int> columns; ///< of the input
  Points points;
  Eigen::VectorXf areas;    ///< a_j, any common factor
  Eigen::VectorXf scales_d; ///< 1 / (2 s_d^2), by point
  float scale_n = 0;        ///< 1 / (2 s_n^2)
  std::vector<CompactLists> lists;
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

bool usable(const Eigen::Vector3f& normal) { return normal.allFinite() && normal.squaredNorm() > 0; }

Field makeField(const Points& points, const Points& normals, const BilateralOptions& options)
{
  Points counted = points;
  for (Index i = 0; i < points.cols(); ++i)
    if (!usable(normals.col(i)))
      counted.col(i).setConstant(NAN); // which the tree leaves out
  const PointTree tree(counted, options.threads);
  Field field;
  field.columns = tree.columns();
  field.points = tree.points();
  field.areas = sampleAreas(tree, 8, options.threads);
  const Eigen::VectorXf sigmas = options.sigma_d > 0 ? Eigen::VectorXf::Constant(tree.size(), options.sigma_d)
                                                     : Eigen::VectorXf(options.spacings * field.areas.cwiseSqrt());
  field.scales_d = 0.5f * sigmas.array().square().inverse();
  const float s_n = 1 - std::cos(options.sigma_n * 0.017453293f);
  field.scale_n = 0.5f / (s_n * s_n);
  field.lists = compactRadiusLists(tree, 2 * sigmas, most, options.threads);
  return field;
}

struct Neighborhood {
  Index point = 0;
  std::vector<int> list;
  Eigen::ArrayXf weights; ///< in the order of the list
};

void weigh(const Field& field, const Points& normals, Neighborhood& around)
{
  const Index i = around.point, count = static_cast<Index>(around.list.size());
  const int* list = around.list.data();
  const Eigen::Vector3f point = field.points.col(i), normal = normals.col(i);
  Eigen::ArrayXf& weights = around.weights;
  weights.resize(count);
  for (Index j = 0; j < count; ++j) {
    const float difference = 1 - normal.dot(normals.col(list[j]));
    weights[j] = -(field.points.col(list[j]) - point).squaredNorm() * field.scales_d[i] -
                 difference * difference * field.scale_n;
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
    const CompactLists& lists = field.lists[static_cast<std::size_t>(range)];
    CompactReader reader(lists);
    Neighborhood around;
    for (around.point = lists.begin; around.point < lists.end; ++around.point) {
      reader.next(around.list);
      weigh(field, normals, around);
      use(around);
    }
  };
  parallelFor(static_cast<Index>(field.lists.size()), threads, search, 1);
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
    const Eigen::Vector3f point = field.points.col(around.point);
    float step = 0;
    for (Index j = 0; j < around.weights.size(); ++j)
      step += around.weights[j] * normals.col(list[j]).dot(field.points.col(list[j]) - point);
    const float total = around.weights.sum();
    moved.col(around.point) = total > 0 ? Eigen::Vector3f(point + step / total * normals.col(around.point)) : point;
  });
  return moved;
}
} // namespace

BilateralResult smoothNormals(const Points& points, const Points& normals, const BilateralOptions& options,
                              const Progress& progress)
{
  validate(points, normals, options);
  BilateralResult result{points, normals};
  if (options.rounds == 0 && options.move_rounds == 0)
    return result;
  report(progress, "find neighbours", 0.0);
  Field field = makeField(points, normals, options);
  Points smooth(3, field.points.cols());
  for (Index i = 0; i < smooth.cols(); ++i)
    smooth.col(i) = normals.col(field.columns[i]).normalized();
  const int rounds = options.rounds + options.move_rounds;
  for (int round = 0; round < rounds; ++round) {
    report(progress, round < options.rounds ? "smooth normals" : "move points", 0.4 + 0.6 * round / rounds);
    if (round < options.rounds)
      smooth = smoothOnce(field, smooth, options.threads);
    else
      field.points = moveOnce(field, smooth, options.threads);
  }
  for (Index i = 0; i < smooth.cols(); ++i) {
    result.normals.col(field.columns[i]) = smooth.col(i);
    if (options.move_rounds > 0)
      result.points.col(field.columns[i]) = field.points.col(i);
  }
  return result;
}
} // namespace fresco
