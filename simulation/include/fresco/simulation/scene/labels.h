// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/search/triangle_tree.h>
#include <fresco/simulation/sensors/laser.h>
namespace fresco::simulation {
/// What a laser point is.
enum class PointLabel : std::uint32_t {
  surface = 0,      ///< its beam met one surface
  near_surface = 1, ///< it met several, but the point lies where the noise of that beam puts points of a surface too
  mixed_pixel = 2   ///< it met several, and the point lies in the air, farther than this from every surface:
};
constexpr double mixed_pixel_deviations = 4; ///< of the range noise of that beam: one normal value in 16,000

/// @param truth        surfaces of the scene, in the frame of mesh.vertices
/// @param T_truth_scan 4x4 rigid
/// @return one label per point
std::vector<PointLabel> labelPoints(const LaserScan& scan, const TriangleTree& truth,
                                    const Eigen::Matrix4d& T_truth_scan);

/// As writePoints(), with the labels in a field `label` of unsigned integers.
/// @throws std::runtime_error "PATH: reason" if the file cannot be written
void writeLabelledScan(const std::string& path, const PointSet& points, const std::vector<PointLabel>& labels);
} // namespace fresco::simulation
