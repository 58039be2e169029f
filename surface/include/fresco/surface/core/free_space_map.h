// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Core>
#include <fresco/core/export.h>
#include <fresco/core/point_stream.h>
#include <vector>
namespace fresco {
/// What laser scans saw through. A beam that ends behind a place says that nothing is there. For each station the
/// shortest and the longest of the beams in each direction are kept, in a map over the faces of a cube; its bins are as
/// small as the beams fill half of them.
class FRESCO_EXPORT FreeSpaceMap {
public:
  /// Reads the points once. The result does not depend on their order and windows.
  /// @param beams where beams ended, with the viewpoints they came from; non-finite points are left out
  /// @throws std::invalid_argument if points have no viewpoints, or more than 1000 different ones: no stations
  explicit FreeSpaceMap(const PointStream& beams);

  /// Whether more than twice as many stations saw through a place as found something there, or before it to the eye:
  /// beams of unlike lengths around. Beams that end before the place say nothing, unless another station saw through
  /// their ends: what they met was moved, and may have reached to the place. Then they found something there.
  /// @param place     in the frame of the points, origin included
  /// @param tolerance by which all beams around it must end behind it, unit of the points
  bool isFree(const Eigen::Vector3d& place, double tolerance) const;

  Index stations() const { return stations_.size(); }

private:
  /// Lengths of the beams in a bin and those around it; none: too few of these bins have beams.
  struct Lengths {
    float shortest, longest;
  };
  struct Station {
    Eigen::Vector3d viewpoint;
    int side = 0;              ///< bins a side of a face of the cube
    std::vector<Lengths> bins; ///< 6 side^2
  };
  enum class Answer { Through, There, Hidden, Unknown };
  static Station stationOf(const Eigen::Vector3d& viewpoint, std::vector<Lengths>&& bins);
  static Answer ask(const Station& station, const Eigen::Vector3d& place, double tolerance);
  bool hidesByWhatMoved(const Station& station, const Eigen::Vector3d& place, double tolerance) const;

  std::vector<Station> stations_;
};
} // namespace fresco
