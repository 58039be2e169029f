// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "scan/prepared_scan.h"
namespace fresco::registration {
/// Size of the plane that a patch lies on: floors and long walls agree at most wrong places, small things at few.
enum class PatchKind : unsigned char { large, medium, small };
constexpr int patch_kinds = 3;

/// A scan as evidence: points spread evenly over what it saw, one ray each; at most some 2,500, 100 bytes each.
struct ScanPatches {
  float spacing = 0.f; ///< edge of the cells that hold one patch each, length
  Points points;       ///< 3xN, in the scan's working frame, whose origin is the viewpoint
  Points normals;      ///< 3xN, unit length
  std::vector<PatchKind> kinds;
  /// Per patch the room that it is of: 0 = where the scanner stood, k = seen through an opening of the k-th large plane.
  std::vector<unsigned char> rooms;
  int room_count = 1;
  Eigen::Matrix<std::int32_t, 8, Eigen::Dynamic> around; ///< 8xN, the patch itself and others nearby, -1 = fewer

  Index size() const { return points.cols(); }
};

/// Some 20 ms a scan.
ScanPatches makePatches(const PreparedScan& scan);
} // namespace fresco::registration
