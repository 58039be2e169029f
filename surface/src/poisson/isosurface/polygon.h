// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Core>
#include <fresco/core/array.h>
#include <vector>
namespace fresco::poisson {
/// Part of the level set on a cell's face, directed so that the polygons of the cell are counter-clockwise from outside
/// (chi larger).
struct FaceSegment {
  int from, to; ///< vertices
  int face;     ///< 0..5
};

/// Corner positions (bits x, y, z) of face `f` (0 -x, 1 +x, 2 -y, ...), counter-clockwise seen from outside the cell.
extern const int face_corners[6][4];

/// Crossed sides of a face, to be joined; side k runs from corner k to corner k + 1.
struct FaceCrossings {
  int count = 0; ///< of segments, 0..2
  int from[2], to[2];
};

/// Where all four sides are crossed, the bilinear function's saddle point decides, alike for both cells that share the
/// face (Nielson & Hamann 1991, "The Asymptotic Decider").
/// @param chi minus the level set's value, at the face's four corners in order
FaceCrossings crossFace(const float chi[4]);

/// Joins the segments of a cell to closed polygons and divides them into triangles.
class CellPolygons {
public:
  void clear() { segments_.clear(); }
  void add(const FaceSegment& segment) { segments_.push_back(segment); }
  bool empty() const { return segments_.empty(); }

  /// Triangles are appended to `faces`, three vertices each. No diagonal joins two vertices of one cell face, because
  /// the cell beyond might have the same one. Where no such triangulation exists a centre vertex is appended to `extra`
  /// and named by -1 - its index.
  /// @param positions of all vertices
  void triangulate(const Eigen::Matrix3Xf& positions, Array<int>& faces, Array<Eigen::Vector3f>& extra);

private:
  struct Corner {
    int vertex;
    unsigned faces; ///< bits: the cell faces that the vertex lies on
  };
  void nextPolygon(std::size_t first);
  void triangulatePolygon(const Eigen::Matrix3Xf& positions, Array<int>& faces, Array<Eigen::Vector3f>& extra) const;
  bool cheapestTriangles(const Eigen::Matrix3Xf& positions, Array<int>& faces) const;

  std::vector<FaceSegment> segments_;
  std::vector<char> used_; ///< by segment
  std::vector<Corner> polygon_;
};
} // namespace fresco::poisson
