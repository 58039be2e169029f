// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "scan/farthest_tiles.h"
#include "scan/point_blocks.h"
namespace fresco::registration {
/// Points that a scan is asked about.
struct JudgedPoints {
  const Points& points;                ///< 3xN
  const Points* normals = nullptr;     ///< 3xN, unit length or zero; see ScanFreeSpace::judge()
  const PointBlocks* blocks = nullptr; ///< of the points: makes it faster, the verdicts are the same
};

/// What a scan says of the space along its rays: a cube map of ranges around every place it was seen from.
/// A point well in front of all ranges of its direction lies where the scanner saw through.
class ScanFreeSpace {
public:
  ScanFreeSpace() = default;

  /// @param points     3xN, finite
  /// @param viewpoints 3xN or 3x1
  /// @param grain      viewpoints nearer to each other than this share a map, length
  ScanFreeSpace(const Points& points, const Points& viewpoints, float grain);

  /// What the scan says of one point.
  enum class Verdict : signed char {
    unknown, ///< behind what was measured, or in a direction without measurement
    agrees,  ///< at the depth that was measured in its direction
    violates ///< in space that was seen through
  };

  /// How far in front of the measured ranges a point still agrees with them: absolute + relative * range. Surfaces that
  /// rays graze may send nothing back; only rays of neighbouring cells then pass by them.
  struct Slack {
    float absolute = 0.f; ///< length
    float relative = 0.f;
    bool own_rays = false; ///< a point violates only in a cell of directions that a ray of its own saw through
  };

  /// Where normals are given, surfaces that the rays graze, at 17 degrees or less, violate only if one of the same cell of
  /// directions passed through them. Such surfaces send little back; what their directions hold was then seen beside them.
  /// @param T_scan_points rigid, brings the points into the frame of the scan
  std::vector<Verdict> judge(const JudgedPoints& judged, const Eigen::Isometry3f& T_scan_points,
                             const Slack& slack) const;

  /// Makes judgements of blocks of points faster: some 8 ms a map.
  void prepareManyJudgements();

  bool empty() const { return maps_.empty(); }

  /// Share of all directions in which something was measured, 0..1.
  double coverage() const { return coverage_; }

  /// Share of the directions in which the ranges lie in one narrow band, 0..1: high where the viewpoints are the true
  /// ones.
  double coherence() const { return coherence_; }

  /// See Packer.
  template <typename Archive>
  friend void fields(Archive& archive, ScanFreeSpace& space)
  {
    archive(space.maps_, space.side_, space.grain_, space.coherence_, space.coverage_);
  }

private:
  struct Map {
    Eigen::Vector3f center;
    std::vector<float> nearest, farthest; ///< per cell; nearest = +inf in cells without a measurement
    std::vector<char> has_ray;            ///< per cell, whether a ray of its own measured something
    FarthestTiles tiles;                  ///< of `farthest`; may be empty
    float reach = 0.f;                    ///< the largest of `farthest`, length
  };
  template <typename Archive>
  friend void fields(Archive& archive, Map& map)
  {
    archive(map.center, map.nearest, map.farthest, map.has_ray, map.reach);
  }
  /// What a map says of the direction of a point that violates.
  struct CellRay {
    Eigen::Vector3f from_center;
    float range; ///< of the point
    float gap;   ///< from there to the nearest range of its cell, without the slack; length
    bool is_own; ///< whether a ray of its own measured something in the cell
  };
  template <typename IsGrazed>
  Verdict judgePoint(const Eigen::Vector3f& point, const Slack& slack, const IsGrazed& isGrazed) const;
  bool isOutOfSight(const Eigen::Vector3f& center, float radius, const Slack& slack) const;
  bool isGrazed(const CellRay& ray, const Eigen::Vector3f& normal) const;
  Map buildMap(const Points& points, const std::vector<Index>& members, const Eigen::Vector3f& center, double reach);
  std::vector<Map> maps_;
  int side_ = 0; ///< cells per edge of a cube face
  float grain_ = 0.f;
  double coherence_ = 0.0, coverage_ = 0.0;
};
} // namespace fresco::registration
