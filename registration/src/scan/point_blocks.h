// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <fresco/core/types.h>
#include <vector>
namespace fresco::registration {
/// Points in groups of up to 16 that lie together, each in a sphere: what is out of sight as a whole need not be looked at
/// point by point. 5 bytes a point.
class PointBlocks {
public:
  PointBlocks() = default;

  /// @param points 3xN, finite
  explicit PointBlocks(const Points& points);

  bool empty() const { return spheres_.empty(); }

  /// body(i) for each point i of the blocks that are not left out.
  /// @param isOut whether to leave out a block, by the centre of its sphere and its radius, length
  template <typename IsOut, typename Body>
  void visit(const IsOut& isOut, const Body& body) const
  {
    for (std::size_t block = 0; block < spheres_.size(); ++block)
      if (!isOut(spheres_[block].center, spheres_[block].radius))
        for (std::size_t k = block * most; k < std::min(order_.size(), (block + 1) * most); ++k)
          body(Index(order_[k]));
  }

private:
  static constexpr std::size_t most = 16; // points of a block
  struct Sphere {
    Eigen::Vector3f center;
    float radius;
  };
  std::vector<std::int32_t> order_; // those of a block one after another
  std::vector<Sphere> spheres_;
};
} // namespace fresco::registration
