// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "optimization/common/correspondences.h"
namespace fresco::optimization {
/// Which part of the surface each datum stands for, and where there are no data.
struct DataCoverage {
  std::vector<char> vertex;     ///< V, 1 where data are near
  Eigen::VectorXf point_weight; ///< per datum, area that it stands for; 0 where it covers nothing
  double spacing = 0;           ///< between data, median; mean edge lengths
};

/// Every vertex is given to the nearest face that holds points, along the mesh. Vertices much farther from it than it
/// is from its own neighbours are not covered.
DataCoverage findCoverage(const MeshGraph& graph, const Positions& x, const DataPoints& data, const FacePoints& lists,
                          int threads);
} // namespace fresco::optimization
