// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <fresco/core/point_set.h>
#include <fresco/core/progress.h>
#include <fresco/registration/core/neighbor_search.h>
#include <fresco/registration/core/scan_registration.h>
#include <memory>
#include <optional>
namespace fresco {
namespace registration {
struct PreparedScan;
}

struct PointToPlaneOptions {
  float max_distance = 0.f; ///< between corresponding points at the start, length; 0 = 20 voxels
  int max_iterations = 40;  ///< per resolution, >= 1
  float min_motion = 0.f;   ///< converged once no point at the scan's size moves further, length; 0 = voxel / 500
  Index samples = 6000;     ///< points of each scan that look for a counterpart, >= 100
  int threads = 0;          ///< 0 = all cores; the result does not depend on it
};

struct PointToPlaneResult {
  Eigen::Matrix4d T_target_source = Eigen::Matrix4d::Identity();
  bool converged = false;
  int iterations = 0;                    ///< over all resolutions
  Index matches = 0;                     ///< corresponding points at the end; 0 = the scans do not overlap
  double rms = 0.0;                      ///< of their point-to-plane distances, length
  double overlap = 0.0;                  ///< larger of the shares of points with a counterpart, 0..1
  double violation = 0.0;                ///< share of surfaces in space that the other scan saw through, 0..1
  std::optional<FreeMotion> free_motion; ///< degenerate: arbitrary along it
};

/// Edge of the thinning cells that suits a scan's extent and density, length.
/// @throws std::invalid_argument if it has no finite point
FRESCO_EXPORT float registrationVoxel(const PointSet& scan);

/// A scan thinned to `voxel` and coarser, with normals and search trees: what alignPointToPlane() works on.
/// @param voxel  length, > 0
/// @param search the caller's own search for neighbours, not shared with another scan; null = PointTree
/// @throws std::invalid_argument if the scan is malformed, voxel is out of range or fewer than 50 points are usable
FRESCO_EXPORT std::shared_ptr<const registration::PreparedScan>
prepareForRegistration(const PointSet& scan, float voxel, int threads = 0,
                       const std::shared_ptr<NeighborSearch>& search = nullptr);

/// Two scans that were prepared with the same voxel, and where they lie about.
struct PreparedPair {
  const registration::PreparedScan &source, &target;
  Eigen::Matrix4d guess; ///< 4x4 rigid, target from source
};

/// Local registration of two scans: points of each onto the tangent planes of the other (Chen & Medioni 1992, "Object
/// modelling by registration of multiple range images"), Tukey weights, coarse to fine.
/// @throws std::invalid_argument if an option is out of range or the guess is not finite
/// @throws std::runtime_error if `progress` asks to stop
FRESCO_EXPORT PointToPlaneResult alignPointToPlane(const PreparedPair& pair, const PointToPlaneOptions& options = {},
                                                   const Progress& progress = {});
FRESCO_EXPORT PointToPlaneResult alignPointToPlane(const registration::PreparedScan& source,
                                                   const registration::PreparedScan& target,
                                                   const Eigen::Matrix4d& guess,
                                                   const PointToPlaneOptions& options = {});

/// The same of two point sets, prepared with the larger of their registrationVoxel().
FRESCO_EXPORT PointToPlaneResult alignPointToPlane(const PointSet& source, const PointSet& target,
                                                   const Eigen::Matrix4d& guess,
                                                   const PointToPlaneOptions& options = {});
} // namespace fresco
