// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "optimization/common/correspondences.h"
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fresco/core/parallel.h>
#include <fresco/core/simd.h>
#include <limits>
namespace fresco::optimization {
struct FaceShare {
  int face;
  float share;
};

constexpr float rounding = 1e-3f; ///< of mean edge lengths, and of shares that nothing else tells apart

/// The prisms over all faces, which tell quickly that a point is far from one.
class FacePrisms {
public:
  FacePrisms(const MeshGraph& graph, const Positions& x, int threads) : planes_(graph.faceCount())
  {
    parallelFor(graph.faceCount(), threads, [&](Index f) {
      Eigen::Matrix4f& planes = planes_[f];
      planes.setZero(); // of a face without area: nothing is known
      const Eigen::Vector3d normal = areaVector(graph, x, f).normalized();
      for (int k = 0; k < 3 && !normal.isZero(0.0); ++k) {
        const Eigen::Vector3d a = x.col(graph.faces(k, f)), b = x.col(graph.faces((k + 1) % 3, f));
        const Eigen::Vector3d outward = (b - a).cross(normal).normalized();
        planes.row(k) << outward.cast<float>().transpose(), static_cast<float>(-outward.dot(a));
        planes.row(3) << normal.cast<float>().transpose(), static_cast<float>(-normal.dot(a));
      }
    });
  }

  /// False only if p is farther from face f than `reach`.
  bool mayReach(int f, const Eigen::Vector3f& p, float reach) const
  {
    using namespace simd;
    const float most = reach + rounding, *columns = planes_[f].data();
    const Float4 heights = load<Float4>(columns) * p.x() + load<Float4>(columns + 4) * p.y() +
                           load<Float4>(columns + 8) * p.z() + load<Float4>(columns + 12);
    const Int4 outside = heights > most;
    return (outside[0] | outside[1] | outside[2]) == 0 && std::abs(heights[3]) <= most;
  }

private:
  std::vector<Eigen::Matrix4f> planes_; ///< rows: outward planes of the sides, plane of the face
};

/// The faces around `face` that are closest to p, with shares that fall to nothing where a face is farther off than the
/// closest by `width`. Faces that look away from the normal count as farther off.
class Sharing {
public:
  Sharing(const MeshGraph& graph, const Positions& x, const FacePrisms& prisms) : graph_(graph), x_(x), prisms_(prisms)
  {}

  const std::vector<FaceShare>& shares(int face, const Eigen::Vector3d& p, const Eigen::Vector3d& normal)
  {
    collect(face, p, normal);
    double sum = 0.0;
    for (Candidate& c : candidates_)
      sum += c.counted = ramp(c.counted, least_counted_ + width, least_counted_);
    shares_.clear();
    for (const Candidate& c : candidates_)
      if (c.counted > 0.0)
        shares_.push_back({c.face, static_cast<float>(c.counted / sum)});
    return shares_;
  }

  /// The same face for the same shares, whichever it began with.
  int most() const
  {
    const FaceShare* best = &shares_.front();
    for (const FaceShare& s : shares_)
      if (s.share > best->share + rounding || (s.share > best->share - rounding && s.face < best->face))
        best = &s;
    return best->face;
  }

private:
  struct Candidate {
    int face;
    double distance; ///< infinite where it is known to be too far
    double counted;  ///< with the handicap
  };

  // Faces and their distances: those around the corners of `face` and of all that share p.
  void collect(int face, const Eigen::Vector3d& p, const Eigen::Vector3d& normal)
  {
    constexpr std::size_t most_faces = 64; // where hundreds meet at a point
    candidates_.clear();
    seen_ = 0;
    least_ = least_counted_ = std::numeric_limits<double>::infinity();
    add(face, p, normal);
    for (std::size_t i = 0; i < candidates_.size() && candidates_.size() < most_faces; ++i)
      for (int k = 0; k < 3 && candidates_[i].distance <= least_ + width; ++k)
        for (const int f : facesAround(graph_, graph_.faces(k, candidates_[i].face)))
          if (isNew(f))
            add(f, p, normal);
  }

  bool isNew(int f) const
  {
    return (seen_ & bitOf(f)) == 0 ||
           std::none_of(candidates_.begin(), candidates_.end(), [f](const Candidate& c) { return c.face == f; });
  }

  static std::uint64_t bitOf(int f) { return std::uint64_t{1} << (f & 63); }

  void add(int f, const Eigen::Vector3d& p, const Eigen::Vector3d& normal)
  {
    Candidate next{f, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    if (prisms_.mayReach(f, p.cast<float>(), static_cast<float>(least_counted_ + width))) {
      next.distance = offsetFrom(graph_, x_, f, footOn(graph_, x_, f, p), p).norm();
      next.counted = next.distance + handicap(f, normal);
      least_ = std::min(least_, next.distance);
      least_counted_ = std::min(least_counted_, next.counted);
    }
    candidates_.push_back(next);
    seen_ |= bitOf(f);
  }

  // The more a face is turned away the more it counts as farther off.
  double handicap(int f, const Eigen::Vector3d& normal) const
  {
    constexpr double seen = 0.25; // cosine: at 90 degrees one edge length farther, at 180 five
    if (normal.isZero(0.0))
      return 0.0;
    const Eigen::Vector3d area = areaVector(graph_, x_, f);
    return std::max(0.0, 1 - area.dot(normal) / (area.norm() + small_area) / seen);
  }

  static constexpr double width = 0.05; // mean edge lengths: wide against rounding, narrow against a rounded crease

  const MeshGraph& graph_;
  const Positions& x_;
  const FacePrisms& prisms_;
  std::vector<Candidate> candidates_;
  std::uint64_t seen_ = 0; ///< bits of their faces
  double least_ = 0.0, least_counted_ = 0.0;
  std::vector<FaceShare> shares_;
};

} // namespace fresco::optimization
