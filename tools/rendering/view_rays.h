// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/mesh.h>
#include <limits>
#include <memory>
namespace fresco::rendering {
struct ViewHit {
  double distance = std::numeric_limits<double>::infinity(); ///< in lengths of the direction; infinite: nothing hit
  bool front = false; ///< the face shows its front: its corners are counter-clockwise seen from the ray's start
  bool any() const { return distance < std::numeric_limits<double>::infinity(); }
};

/// Faces of a mesh for rays, in the mesh's own frame (without origin). May be used from several threads at once.
class ViewRays {
public:
  /// @throws std::runtime_error if memory runs out
  explicit ViewRays(const TriangleMesh& mesh);
  ~ViewRays();
  ViewRays(const ViewRays&) = delete;
  ViewRays& operator=(const ViewRays&) = delete;

  /// The first face hit at `least` or farther.
  ViewHit trace(const Eigen::Vector3d& from, const Eigen::Vector3d& direction, double least = 0) const;

  /// The first face hit whose front is seen, through all others: what a picture without back faces shows.
  ViewHit traceFront(const Eigen::Vector3d& from, const Eigen::Vector3d& direction) const;

private:
  struct Data;
  std::unique_ptr<Data> data_;
};
} // namespace fresco::rendering
