// SPDX-License-Identifier: BSD-3-Clause
#include <fresco/surface/core/seen_surface.h>

#include "free_space/direction_bins.h"
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <map>
#include <numeric>
#include <vector>
namespace fresco {
namespace {
using Beams = std::vector<Eigen::Vector3f>; ///< from the viewpoint to where they ended

/// The beams of a viewpoint by direction.
class BeamGrid {
public:
  explicit BeamGrid(const Beams& beams)
  {
    constexpr double enough = 4, beams_a_bin = 12; // to tell bins without a beam between beams from those beside them
    constexpr int first_side = 64, coarsest = 4, finest = 1024;
    double in_a_bin = 0;
    for (side_ = 2 * first_side; side_ > coarsest && in_a_bin < enough;) {
      side_ /= 2;
      count(beams);
      in_a_bin = double(beams.size()) / filled();
    }
    side_ = std::clamp(int(side_ * std::sqrt(in_a_bin / beams_a_bin)), coarsest, finest);
    count(beams);
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    directions_.resize(beams.size());
    lengths_.resize(beams.size());
    for (auto beam = beams.rbegin(); beam != beams.rend(); ++beam) {
      const Index at = --first_[binOf(*beam, side_)];
      lengths_[at] = beam->norm();
      directions_[at] = *beam / lengths_[at];
    }
  }

  /// Chord within which beams are asked: about nine, and no more than a bin where bins are narrowest.
  float reach() const { return 1.f / side_; }

  /// visit(direction, length) for the beams within reach of a direction.
  template <typename Visit>
  void forEachAround(const Eigen::Vector3f& direction, const Visit& visit) const
  {
    const float squared_reach = reach() * reach();
    forEachBinAround<float>(binOf(direction, side_), side_, [&](Index bin) {
      for (Index i = first_[bin]; i < first_[bin + 1]; ++i)
        if ((directions_[i] - direction).squaredNorm() < squared_reach)
          visit(directions_[i], lengths_[i]);
    });
  }

private:
  void count(const Beams& beams)
  {
    first_.assign(6 * Index(side_) * side_ + 1, 0);
    for (const Eigen::Vector3f& beam : beams)
      ++first_[binOf(beam, side_)];
  }
  Index filled() const
  {
    return std::count_if(first_.begin(), first_.end(), [](Index n) { return n > 0; });
  }

  int side_ = 0;
  std::vector<Index> first_; ///< beam of each bin, and the number of all
  std::vector<Eigen::Vector3f> directions_;
  std::vector<float> lengths_;
};

/// @param place of a vertex, from the viewpoint; its normal is a unit vector
float seenAt(const BeamGrid& grid, const Eigen::Vector3f& place, const Eigen::Vector3f& normal, float tolerance)
{
  constexpr float least_facing = 0.1f; // cosine: beams that graze a surface do not tell where it lies
  constexpr float slope = 0.08f;       // of the surface within reach against the tangent plane
  constexpr float border = 0.4244f;    // 4 / (3 pi): centre of gravity of a half disk, radii
  constexpr float outvoted = 0.25f;    // share of confirming beams
  constexpr int least = 3;             // confirming beams
  const float distance = place.norm(), facing = -place.dot(normal) / distance;
  if (!(facing > least_facing))
    return -1.f;
  const Eigen::Vector3f direction = place / distance;
  const float most = tolerance + slope * grid.reach() * distance / facing;
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  int confirming = 0, all = 0;
  grid.forEachAround(direction, [&](const Eigen::Vector3f& beam, float length) {
    ++all;
    if (std::abs((length * beam - place).dot(normal)) <= most) {
      ++confirming;
      sum += beam - direction;
    }
  });
  if (confirming < least)
    return -1.f;
  const float to_one_side = sum.norm() / (confirming * grid.reach());
  const float share = float(confirming) / all;
  return std::max(-1.f, std::min(1.f - to_one_side / border, (share - outvoted) / outvoted));
}
} // namespace

Eigen::VectorXf seenSurface(const TriangleMesh& mesh, const PointStream& beams, double tolerance, int threads)
{
  require(tolerance > 0, "seen surface: a tolerance of ", tolerance, " is not positive");
  validateMesh(mesh);
  const Points normals = vertexNormals(mesh, threads);
  Eigen::VectorXf seen = Eigen::VectorXf::Constant(mesh.vertexCount(), -1.f);
  beams.read([&](const PointSet& set) {
    validatePointSet(set);
    require(set.viewpoints.cols() > 0 || set.size() == 0, "seen surface: the points have no viewpoints");
    std::map<std::array<float, 3>, Beams> by_viewpoint;
    for (Index i = 0; i < set.size(); ++i) {
      const Eigen::Vector3f from = set.viewpoints.col(set.viewpoints.cols() == 1 ? 0 : i);
      const Eigen::Vector3f beam = set.points.col(i) - from;
      if (beam.allFinite() && beam.squaredNorm() > 0.f)
        by_viewpoint[{from.x(), from.y(), from.z()}].push_back(beam);
    }
    for (const auto& [from, ends] : by_viewpoint) {
      const BeamGrid grid(ends);
      const Eigen::Vector3f shift =
          (mesh.origin - set.origin).cast<float>() - Eigen::Vector3f(from[0], from[1], from[2]);
      parallelFor(mesh.vertexCount(), threads, [&](Index v) {
        const Eigen::Vector3f normal = normals.col(v);
        if (seen[v] < 1.f && normal.squaredNorm() > 0.f)
          seen[v] = std::max(seen[v], seenAt(grid, mesh.vertices.col(v) + shift, normal, tolerance));
      });
    }
  });
  return seen;
}
} // namespace fresco
