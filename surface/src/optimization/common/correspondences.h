// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "optimization/common/mesh_graph.h"
#include <fresco/core/point_set.h>
namespace fresco::optimization {
/// From the world to the frame of Positions: position = (world - center) / unit.
struct WorkingFrame {
  Eigen::Vector3d center = Eigen::Vector3d::Zero(); ///< world
  double unit = 1.0;                                ///< mean edge length
};

/// Points and the faces they correspond to. Sorted by the face they had at the start, so that what is near lies near in
/// memory.
struct DataPoints {
  Points points;          ///< 3xN, working frame
  Points normals;         ///< 3xN or 3x0
  std::vector<int> face;  ///< N, the face that each corresponds to
  std::vector<int> votes; ///< by face: points closest to it that look to its side, less those that look to the other
  Index left_out = 0;     ///< points of the input that are not here

  Index size() const { return points.cols(); }
  bool hasNormals() const { return normals.cols() > 0; }
};

/// The closest face of every point that has one within `reach`, and whose side is the one the point was seen from.
/// @param reach mean edge lengths
DataPoints findCorrespondences(const MeshGraph& graph, const Positions& x, const PointSet& set,
                               const WorkingFrame& frame, double reach, int threads);

/// Finds the faces anew after the mesh has moved: descends from each point's last face to the face around it that is
/// closest. Faces that look away from the normal of the point do not count.
void followFaces(const MeshGraph& graph, const Positions& x, DataPoints& data, int threads);

/// The points of each face: order[begin[f]] .. order[begin[f + 1] - 1], ascending, and what share of them.
struct FacePoints {
  std::vector<int> begin, order;
  std::vector<float> share; ///< as long as `order`; 1 for every point of a face together
  Index count(Index f) const { return begin[f + 1] - begin[f]; }
};

/// Every point belongs to its face, as a whole.
FacePoints pointsOfFaces(const DataPoints& data, Index faces);

/// Points that are about as close to other faces around theirs belong to these in part, so that no point changes its
/// face at once. data.face becomes the face with the greatest share.
FacePoints sharePoints(const MeshGraph& graph, const Positions& x, DataPoints& data, int threads);

/// Barycentric coordinates of the point of triangle f that is closest to p.
Eigen::Vector3d footOn(const MeshGraph& graph, const Positions& x, Index f, const Eigen::Vector3d& p);

/// From the point of triangle f with barycentric coordinates `foot` to p.
Eigen::Vector3d offsetFrom(const MeshGraph& graph, const Positions& x, Index f, const Eigen::Vector3d& foot,
                           const Eigen::Vector3d& p);
} // namespace fresco::optimization
