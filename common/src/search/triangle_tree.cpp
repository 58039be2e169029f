// SPDX-License-Identifier: BSD-3-Clause
#include <fresco/search/triangle_tree.h>

#include "search/triangle_tree_data.h"
#include <array>
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <fresco/search/closest_on_triangle.h>
#include "search/morton_order.h"
namespace fresco {
namespace {
using Eigen::Vector3d;

Vector3d cornerOf(const TreeTriangle& triangle, int i)
{
  return {triangle.corner[i][0], triangle.corner[i][1], triangle.corner[i][2]};
}

struct Best {
  double squared_distance = std::numeric_limits<double>::infinity();
  std::int32_t triangle = -1, face = -1; // place in leaf order, index in the mesh
  Vector3d point = Vector3d::Zero();
};

// The search for one query point: single-precision boxes rule out, double-precision triangles decide.
class Search {
public:
  Search(const TriangleTreeData& tree, const Vector3d& query)
      : tree_(tree), query_(query), rounded_(query.cast<float>())
  {
    rounding_ = (query - rounded_.cast<double>()).norm();
  }

  void limit(double squared_distance)
  {
    best_.squared_distance = squared_distance;
    updateReach();
  }

  void test(std::int32_t slot)
  {
    const TreeTriangle& triangle = tree_.triangles[slot];
    const PointOnTriangle found = closestOnTriangle(query_, cornerOf(triangle, 0), cornerOf(triangle, 1),
                                                    cornerOf(triangle, 2), best_.squared_distance);
    const bool closer = found.squared_distance < best_.squared_distance;
    const bool tie = found.squared_distance == best_.squared_distance && (best_.face < 0 || triangle.face < best_.face);
    if (!closer && !tie)
      return;
    best_ = {found.squared_distance, slot, triangle.face, found.point};
    if (closer)
      updateReach();
  }

  Best run()
  {
    visit(0);
    while (size_ > 0) {
      const Entry entry = stack_[--size_];
      if (entry.squared_distance > reach_)
        continue;
      for (std::int32_t i = 0; i < entry.count; ++i)
        test(entry.child + i);
      if (entry.count == 0)
        visit(entry.child);
    }
    return best_;
  }

private:
  struct Entry {
    float squared_distance; // from the query to the box
    std::int32_t child, count;
  };

  // Squared box distances up to `reach_` may hold something closer than, or as close as, the best: they carry a
  // relative rounding error below 4e-7 and refer to the query rounded to single precision.
  void updateReach()
  {
    const double distance2 = best_.squared_distance;
    const double widened = rounding_ > 0.0 ? std::pow(std::sqrt(distance2) + rounding_, 2) : distance2;
    const double limit = widened * (1.0 + 1e-6) + std::numeric_limits<float>::min();
    constexpr float most = std::numeric_limits<float>::max();
    reach_ = limit < most ? static_cast<float>(limit) : most;
  }

  // Puts the children within reach on the stack, the closest on top.
  void visit(std::int32_t index)
  {
    const TreeNode& node = tree_.nodes[index];
    Eigen::Array4f distance2 = Eigen::Array4f::Zero();
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Array4f outside = (node.low[axis] - rounded_[axis]).max(rounded_[axis] - node.high[axis]).max(0.f);
      distance2 += outside * outside;
    }
    const int first = size_;
    for (int slot = 0; slot < 4; ++slot) {
      if (!(distance2[slot] <= reach_))
        continue;
      const Entry entry{distance2[slot], node.child[slot], node.count[slot]};
      int at = size_++;
      for (; at > first && stack_[at - 1].squared_distance < entry.squared_distance; --at)
        stack_[at] = stack_[at - 1];
      stack_[at] = entry;
    }
  }

  const TriangleTreeData& tree_;
  Vector3d query_;
  Eigen::Vector3f rounded_;
  double rounding_; // upper bound on |query - rounded|
  float reach_ = std::numeric_limits<float>::max();
  Best best_;
  std::array<Entry, 3 * largest_tree_depth + 4> stack_;
  int size_ = 0;
};

ClosestPoint answer(const Best& best)
{
  if (best.face < 0)
    return {};
  return {std::sqrt(best.squared_distance), best.face, best.point};
}

bool inRange(const Vector3d& point)
{
  return point.allFinite() && point.cwiseAbs().maxCoeff() <= largest_tree_coordinate;
}

void requireInRange(const std::vector<TreeTriangle>& triangles)
{
  for (const TreeTriangle& triangle : triangles)
    for (int corner = 0; corner < 3; ++corner)
      require(inRange(cornerOf(triangle, corner)), "TriangleTree: a coordinate is not finite or exceeds ",
              largest_tree_coordinate);
}

void requireQuery(const Vector3d& query)
{
  require(inRange(query), "TriangleTree: the query is not finite or exceeds ", largest_tree_coordinate);
}

// Triangles of `faces`, corner by corner; face f is column f.
std::vector<TreeTriangle> trianglesOf(const Points& vertices, const Faces& faces, int threads)
{
  std::vector<TreeTriangle> triangles(faces.cols());
  parallelFor(faces.cols(), threads, [&](Index f) {
    TreeTriangle& triangle = triangles[f];
    triangle.face = static_cast<std::int32_t>(f);
    for (int corner = 0; corner < 3; ++corner)
      for (int axis = 0; axis < 3; ++axis)
        triangle.corner[corner][axis] = vertices(axis, faces(corner, f));
  });
  return triangles;
}

std::shared_ptr<const TriangleTreeData> treeOf(const Points& vertices, const Faces& faces, int threads)
{
  std::vector<TreeTriangle> triangles = trianglesOf(vertices, faces, threads);
  requireInRange(triangles);
  return std::make_shared<TriangleTreeData>(buildTriangleTree(std::move(triangles), threads));
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
  const Faces faces =
      Eigen::RowVectorXi::LinSpaced(points.cols(), 0, static_cast<int>(points.cols()) - 1).replicate(3, 1);
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

Index TriangleTree::faceCount() const { return static_cast<Index>(data_->triangles.size()); }

std::size_t TriangleTree::memory() const
{
  return data_->nodes.size() * sizeof(TreeNode) + data_->triangles.size() * sizeof(TreeTriangle);
}

std::vector<ClosestPoint> closestPoints(const TriangleTree& tree, const Eigen::Matrix3Xd& queries, int threads)
{
  for (Index i = 0; i < queries.cols(); ++i)
    requireQuery(queries.col(i));
  const std::vector<std::int32_t> order = search::mortonOrder(queries, threads);
  std::vector<ClosestPoint> answers(order.size());
  parallelRanges(queries.cols(), threads, [&](Index begin, Index end) {
    std::int32_t last = -1; // the previous answer bounds the next one
    for (Index i = begin; i < end; ++i) {
      const std::int32_t column = order[i];
      Search search(*tree.data_, queries.col(column));
      if (last >= 0)
        search.test(last);
      const Best best = search.run();
      last = best.triangle;
      answers[column] = answer(best);
    }
  });
  return answers;
}
} // namespace fresco
