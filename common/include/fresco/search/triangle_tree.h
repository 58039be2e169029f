// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <fresco/core/mesh.h>
#include <limits>
#include <memory>
#include <vector>
namespace fresco {
struct TriangleTreeData;

/// The point of a surface that lies closest to a query.
struct ClosestPoint {
  double distance = std::numeric_limits<double>::infinity(); ///< in the unit of the mesh
  Index face = -1;                                 ///< column of TriangleMesh::faces; -1: nothing within reach
  Eigen::Vector3d point = Eigen::Vector3d::Zero(); ///< in the frame of the vertices (TriangleMesh::origin not added)
};

/// Closest-point search over the triangles of a mesh, exact: the least of the distances to all triangles, each computed
/// in double precision. Of several faces at the same distance the one with the smallest index is returned. Triangles
/// without area count as the segment or point that they are. Holds its own copy of the triangles, may be used by many
/// threads at once, and is cheap to copy.
///
/// Embree's point query finds the triangles whose boxes are near (Wald et al. 2014, "Embree: a kernel framework for
/// efficient CPU ray tracing"). A hierarchy of our own took as long:
/// docs/measurements/search.md.
class FRESCO_EXPORT TriangleTree {
public:
  /// @throws std::invalid_argument if the mesh has no face, is not valid, or a coordinate exceeds 1e18
  explicit TriangleTree(const TriangleMesh& mesh, int threads = 0);

  /// Tree over single points instead of triangles; `face` of the answers is the column of `points`.
  /// @throws std::invalid_argument if there is no point, or a coordinate is not finite or exceeds 1e18
  static TriangleTree ofPoints(const Points& points, int threads = 0);

  /// @param query  in the frame of the vertices, finite
  /// @param within search radius: nothing farther away is found
  /// @throws std::invalid_argument if the query is not finite or exceeds 1e18, or `within` is negative or NaN
  ClosestPoint closest(const Eigen::Vector3d& query, double within = std::numeric_limits<double>::infinity()) const;

  Index faceCount() const;
  std::size_t memory() const; ///< bytes held

private:
  friend std::vector<ClosestPoint> closestPoints(const TriangleTree& tree, const Eigen::Matrix3Xd& queries,
                                                 int threads);
  explicit TriangleTree(std::shared_ptr<const TriangleTreeData> data) : data_(std::move(data)) {}
  std::shared_ptr<const TriangleTreeData> data_;
};

/// closest() for many queries, several times faster than one by one: neighbouring queries share what was found.
/// @param queries 3xN, finite, in the frame of the vertices
/// @return N answers; they do not depend on the number of threads
/// @throws std::invalid_argument as closest()
FRESCO_EXPORT std::vector<ClosestPoint> closestPoints(const TriangleTree& tree, const Eigen::Matrix3Xd& queries,
                                                      int threads = 0);
} // namespace fresco
