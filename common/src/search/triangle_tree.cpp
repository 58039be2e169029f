// SPDX-License-Identifier: BSD-3-Clause
#include "search/embree_scene.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/morton.h>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <fresco/search/closest_on_triangle.h>
#include <fresco/search/triangle_tree.h>
namespace fresco {
struct TriangleTreeData : search::EmbreeScene {
  using EmbreeScene::EmbreeScene;
};

namespace {
using Eigen::Vector3d;
/// Bound on |coordinate|: squares of differences stay finite in single precision, and Embree takes up to 1.8e18.
constexpr double largest_coordinate = 1e18;

struct Best {
  double squared_distance = std::numeric_limits<double>::infinity();
  int face = -1;
  Vector3d point = Vector3d::Zero();
};

/// The search for one query point. Embree's boxes, in single precision, rule out; triangles in double precision decide.
class Search {
public:
  Search(const TriangleTreeData& tree, const Vector3d& query) : tree_(tree), query_(query)
  {
    const Eigen::Vector3f rounded = query.cast<float>();
    sphere_ = {rounded.x(), rounded.y(), rounded.z(), 0.f, std::numeric_limits<float>::infinity()};
    rounding_ = (query - rounded.cast<double>()).norm();
  }

  void limit(double squared_distance)
  {
    best_.squared_distance = squared_distance;
    shrinkSphere();
  }

  /// @return whether the search has become narrower
  bool test(int face)
  {
    const int* corners = tree_.face(face);
    const PointOnTriangle found =
        closestOnTriangle(query_, corner(corners[0]), corner(corners[1]), corner(corners[2]), best_.squared_distance);
    const bool closer = found.squared_distance < best_.squared_distance;
    const bool tie = found.squared_distance == best_.squared_distance && (best_.face < 0 || face < best_.face);
    if (!closer && !tie)
      return false;
    best_ = {found.squared_distance, face, found.point};
    if (closer)
      shrinkSphere();
    return closer;
  }

  Best run()
  {
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(tree_.scene(), &sphere_, &context, testPrimitive, this);
    return best_;
  }

private:
  static bool testPrimitive(RTCPointQueryFunctionArguments* arguments)
  {
    Search& search = *static_cast<Search*>(arguments->userPtr);
    const bool closer = search.test(arguments->primID);
    if (closer)
      arguments->query->radius = search.sphere_.radius;
    return closer;
  }

  Vector3d corner(int vertex) const { return Eigen::Map<const Eigen::Vector3f>(tree_.vertex(vertex)).cast<double>(); }

  /// Boxes that touch the sphere may hold something closer than, or as close as, the best. Their distances carry a
  /// relative rounding error below 4e-7 and refer to the query rounded to single precision; squares of distances below
  /// 1e-19 vanish in single precision.
  void shrinkSphere()
  {
    const double reach = (std::sqrt(best_.squared_distance) + rounding_) * (1.0 + 1e-6) + 1e-19;
    sphere_.radius = reach < 1e19 ? reach : std::numeric_limits<float>::infinity();
  }

  const TriangleTreeData& tree_;
  Vector3d query_;
  double rounding_; ///< |query - centre of the sphere|
  RTCPointQuery sphere_;
  Best best_;
};

ClosestPoint answer(const Best& best)
{
  if (best.face < 0)
    return {};
  return {std::sqrt(best.squared_distance), best.face, best.point};
}

bool inRange(const Vector3d& point) { return point.allFinite() && point.cwiseAbs().maxCoeff() <= largest_coordinate; }

void requireQuery(const Vector3d& query)
{
  require(inRange(query), "TriangleTree: the query is not finite or exceeds ", largest_coordinate);
}

/// Columns of points along a Morton curve of 1024 cells per axis, each in the lower half of a number: neighbours in the
/// order are neighbours in space.
std::vector<std::uint64_t> mortonOrder(const Eigen::Matrix3Xd& points, int threads)
{
  std::vector<std::uint64_t> order(points.cols());
  if (order.empty())
    return order;
  const Eigen::Array3d low = points.rowwise().minCoeff();
  const double side = (points.rowwise().maxCoeff().array() - low).maxCoeff(), scale = side > 0.0 ? 1024.0 / side : 0.0;
  parallelFor(points.cols(), threads, [&](Index i) {
    const Eigen::Array3d cell = ((points.col(i).array() - low) * scale).max(0.0).min(1023.0);
    order[i] = mortonCode(cell[2], cell[1], cell[0]) << 32 | i;
  });
  std::sort(order.begin(), order.end());
  return order;
}

std::shared_ptr<const TriangleTreeData> treeOf(const Points& vertices, const Faces& faces, int threads)
{
  for (Index f = 0; f < faces.cols(); ++f)
    for (int corner = 0; corner < 3; ++corner)
      require(inRange(vertices.col(faces(corner, f)).cast<double>()),
              "TriangleTree: a coordinate is not finite or exceeds ", largest_coordinate);
  return std::make_shared<TriangleTreeData>(vertices, faces, RTC_SCENE_FLAG_ROBUST, threads);
}
} // namespace

TriangleTree::TriangleTree(const TriangleMesh& mesh, int threads)
{
  require(mesh.faceCount() > 0, "TriangleTree: the mesh has no faces");
  validateMesh(mesh);
  data_ = treeOf(mesh.vertices, mesh.faces, threads);
}

TriangleTree TriangleTree::ofPoints(const Points& points, int threads)
{
  require(points.cols() > 0, "TriangleTree: no points");
  const Faces faces = Eigen::RowVectorXi::LinSpaced(points.cols(), 0, points.cols() - 1).replicate(3, 1);
  return TriangleTree(treeOf(points, faces, threads));
}

ClosestPoint TriangleTree::closest(const Eigen::Vector3d& query, double within) const
{
  requireQuery(query);
  require(within >= 0.0, "TriangleTree: search radius ", within, " is negative or NaN");
  Search search(*data_, query);
  search.limit(within * within);
  return answer(search.run());
}

Index TriangleTree::faceCount() const { return data_->faceCount(); }

std::size_t TriangleTree::memory() const { return data_->memory(); }

std::vector<ClosestPoint> closestPoints(const TriangleTree& tree, const Eigen::Matrix3Xd& queries, int threads)
{
  for (Index i = 0; i < queries.cols(); ++i)
    requireQuery(queries.col(i));
  const std::vector<std::uint64_t> order = mortonOrder(queries, threads);
  std::vector<ClosestPoint> answers(order.size());
  parallelRanges(queries.cols(), threads, [&](Index begin, Index end) {
    int last = -1; // the previous answer bounds the next one
    for (Index i = begin; i < end; ++i) {
      const Index column = order[i] & 0xffffffff;
      Search search(*tree.data_, queries.col(column));
      if (last >= 0)
        search.test(last);
      const Best best = search.run();
      last = best.face;
      answers[column] = answer(best);
    }
  });
  return answers;
}
} // namespace fresco
