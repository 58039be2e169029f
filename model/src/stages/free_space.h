// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <fresco/core/camera.h>
#include <fresco/core/image.h>
#include <fresco/core/mesh.h>
#include <vector>
namespace fresco::model {
/// What sensors saw through: beams that end behind a place say that nothing is there. Surface that a reconstruction
/// invents beside or behind things stands in such places.
class FreeSpace {
public:
  /// @param places    3xN, world
  /// @param tolerance distance by which a beam must end behind a place to have passed it, unit of the places, > 0
  FreeSpace(const Points& places, double tolerance, int threads);

  /// Asks one depth image. Its noise and that of its pose count: the tolerance grows by 2 % of the depth.
  /// @param depth in `unit` (metres); 0 and 65535 = none
  void ask(const Image16& depth, const CameraModel& camera, const Eigen::Isometry3d& T_world_camera,
           double unit = 1e-3);

  /// Asks one laser scan.
  /// @param scan 3xM in the frame of the scanner, which stands at the origin; non-finite points are ignored
  void ask(const Points& scan, const Eigen::Isometry3d& T_world_scan);

  /// N: 1 where at least `least` views saw through the place, and more than twice as many as ended there.
  std::vector<char> empty(int least) const;

private:
  enum class Answer { Unknown, Through, There };
  template <typename Judge>
  void count(const Judge& judge);

  const Points places_;
  double tolerance_;
  int threads_;
  std::vector<std::uint16_t> through_, there_; ///< views
};

/// `mesh` without the surface around vertices that are `removed`, after three rounds in which each vertex joins the
/// majority of its neighbours and itself, so that neither specks stay nor holes come up. Faces are cut along a smooth
/// line between vertices that stay and others.
/// @param removed V
TriangleMesh withoutVertices(const TriangleMesh& mesh, std::vector<char> removed);
} // namespace fresco::model
