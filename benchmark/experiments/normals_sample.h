// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "experiments/scanned_room.h"
#include <fresco/search/neighbors.h>
namespace fresco {
struct NormalMeasure {
  std::string scene = "conference_room";
  int stations = 2, points = 1000000, k = 16;
  bool merged = false;
  float edge = 0.02f;    ///< metres to a crease: "beside an edge"
  float plane = 0.1f;    ///< metres without any bend around: "on planes"
  float bend = 1.f;      ///< degrees between faces of one plane at most
  float crease = 30.f;   ///< degrees between the faces of an edge
  float spread = 0.002f; ///< metres between the places that stand for a crease
};

/// Points of laser scans with their true normals.
struct NormalSample {
  Points points, truth;       ///< sensor frame
  Points exact;               ///< where the beams meet the faces, without noise
  Eigen::VectorXf deviations; ///< of the noise along the beams, metres
  std::vector<char> place;    ///< 0 = beside an edge, 1 = on a plane, 2 = elsewhere: bent surfaces, near edges
  Points viewpoints = Eigen::Vector3f::Zero(); ///< 3x1 or 3xN

  Eigen::Vector3f ray(Index i) const { return points.col(i) - viewpoints.col(viewpoints.cols() == 1 ? 0 : i); }
};

struct Creases {
  Creases(const TriangleMesh& mesh, const NormalMeasure& measure, int threads);
  PointTree sharp, bends;
  float edge, plane; ///< as in NormalMeasure
};

/// The points of the scans from all stations; no true normal where a beam met several surfaces.
/// @param merged all scans as one, in the frame of the room
std::vector<NormalSample> takeSamples(const ScannedRoom& room, const Creases& creases, const LaserOptions& laser,
                                      bool merged);
} // namespace fresco
