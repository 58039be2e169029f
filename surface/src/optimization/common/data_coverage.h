// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "optimization/common/correspondences.h"
namespace fresco::optimization {
/// Which part of the surface each datum stands for, and where there are no data.
struct DataCoverage {
  std::vector<char> vertex;     ///< V, 1 where data are near
  Eigen::VectorXf nearness;     ///< V, 1 near data; falls to 0 where `vertex` does
  std::vector<int> nearest;     ///< V, the nearest datum along the mesh; -1 = none
  Eigen::VectorXd rate;         ///< V, area of a datum there
  Eigen::VectorXf point_weight; ///< per datum, area that it stands for; 0 where it covers nothing
  double spacing = 0;           ///< between data, median; mean edge lengths
};

constexpr int most_rings = 24; ///< data so sparse that they are farther apart say nothing of what lies between

/// Every datum gets a part of the area of the vertices of its face; vertices without data on the faces around them are
/// given to the nearest datum, along the mesh, or shared by those that are about as near. Vertices much farther from it
/// than it is from its own neighbours are not covered.
/// @param lists of sharePoints()
DataCoverage findCoverage(const MeshGraph& graph, const Positions& x, const DataPoints& data, const FacePoints& lists,
                          int threads);
} // namespace fresco::optimization
