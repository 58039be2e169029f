// SPDX-License-Identifier: BSD-3-Clause
#include "fusion/pose_refinement.h"
#include "fusion/surface_points.h"
#include <Eigen/SVD>
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/poses.h>
#include <fresco/core/require.h>
#include <utility>
namespace fresco {
namespace {
using namespace fusion;

void validate(const DepthFrames& frames, const DepthFusionOptions& options)
{
  require(!frames.T_world_camera.empty() && frames.depth, "depth fusion: no frames");
  const CameraModel& camera = frames.camera;
  require(camera.width > 1 && camera.height > 1 && camera.fx > 0 && camera.fy > 0 && !camera.hasDistortion(),
          "depth fusion: the camera is not a pinhole camera");
  for (const Eigen::Isometry3d& T : frames.T_world_camera)
    require(isRigid(T.matrix(), 1e-6), "depth fusion: a pose is not rigid");
  require(options.cell > 0 && std::isfinite(options.cell), "depth fusion: cell ", options.cell, " is not positive");
  require(options.truncation >= 2 && options.truncation <= 16, "depth fusion: truncation ", options.truncation,
          " is not in 2..16");
  require(options.free_weight > 0 && std::isfinite(options.free_weight), "depth fusion: weight of free space ",
          options.free_weight, " is not positive");
  threadCount(options.threads);
}

/// The frames with poses that change.
class Fusion {
public:
  Fusion(const DepthFrames& frames, const DepthFusionOptions& options)
      : frames_(frames), options_(options), poses_(frames.T_world_camera)
  {}

  /// Rounds of: common surface of all frames, every frame moved onto it.
  void refinePoses(const Progress& progress)
  {
    constexpr int rounds = 3;
    constexpr double coarse = 2; // cells of these rounds: what poses are off by is wider than a cell
    for (int round = 0; round < rounds; ++round) {
      DistanceGrid grid(coarse * options_.cell, coarse * options_.cell * options_.truncation);
      const Progress part = subProgress(progress, double(round) / rounds, double(round + 1) / rounds);
      forEachFrame("poses", subProgress(part, 0.0, 0.7), [&](const DepthFrame& frame, Index) {
        grid.allocate(frame, options_.threads);
        grid.integrate(frame, nullptr, 1.f, options_.threads);
      });
      grid.finish(nullptr, options_.threads);
      forEachFrame("poses", subProgress(part, 0.7, 1.0), [&](const DepthFrame& frame, Index f) {
        poses_[f] = alignToGrid(grid, frame, poses_[f], frames_.T_world_camera[f], options_.threads);
      });
    }
    keepFrame();
  }

  /// All frames' distances, a mean at first, then a robust mean about it.
  DistanceGrid fuse(const Progress& progress) const
  {
    DistanceGrid mean(options_.cell, options_.cell * options_.truncation);
    forEachFrame("fusion", subProgress(progress, 0.0, 0.1),
                 [&](const DepthFrame& frame, Index) { mean.allocate(frame, options_.threads); });
    forEachFrame("fusion", subProgress(progress, 0.1, 0.5), [&](const DepthFrame& frame, Index) {
      mean.integrate(frame, nullptr, options_.free_weight, options_.threads);
    });
    mean.finish(nullptr, options_.threads);
    DistanceGrid robust = mean.emptied();
    forEachFrame("fusion", subProgress(progress, 0.5, 1.0), [&](const DepthFrame& frame, Index) {
      robust.integrate(frame, &mean, options_.free_weight, options_.threads);
    });
    robust.finish(&mean, options_.threads);
    return robust;
  }

  const std::vector<Eigen::Isometry3d>& poses() const { return poses_; }

private:
  /// The frames' common surface may have drifted as a whole: moves all poses back by what they moved on the average.
  void keepFrame()
  {
    Eigen::Matrix3d turns = Eigen::Matrix3d::Zero();
    Eigen::Vector3d center = Eigen::Vector3d::Zero(), given_center = center;
    for (std::size_t f = 0; f < poses_.size(); ++f) {
      turns += frames_.T_world_camera[f].linear() * poses_[f].linear().transpose();
      center += poses_[f].translation() / poses_.size();
      given_center += frames_.T_world_camera[f].translation() / poses_.size();
    }
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(turns, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Eigen::Isometry3d T(svd.matrixU() * svd.matrixV().transpose()); // of turns that are all close to none: a rotation
    T.translation() = given_center - T.linear() * center;
    for (Eigen::Isometry3d& pose : poses_)
      pose = T * pose;
  }

  template <typename Visit>
  void forEachFrame(const char* step, const Progress& progress, const Visit& visit) const
  {
    const Index count = poses_.size();
    for (Index f = 0; f < count; ++f) {
      report(progress, step, double(f) / count);
      DepthImage depth = frames_.depth(f);
      require(depth.rows() == frames_.camera.height && depth.cols() == frames_.camera.width, "depth fusion: frame ", f,
              " has ", depth.cols(), "x", depth.rows(), " pixels, the camera ", frames_.camera.width, "x",
              frames_.camera.height);
      visit(DepthFrame(frames_.camera, std::move(depth), poses_[f], options_.threads), f);
    }
  }

  const DepthFrames& frames_;
  const DepthFusionOptions& options_;
  std::vector<Eigen::Isometry3d> poses_;
};
} // namespace

DepthFusionResult fuseDepthImages(const DepthFrames& frames, const DepthFusionOptions& options,
                                  const Progress& progress)
{
  validate(frames, options);
  Fusion fusion(frames, options);
  const double begin = options.refine_poses ? 0.5 : 0.0;
  if (options.refine_poses)
    fusion.refinePoses(subProgress(progress, 0.0, begin));
  const DistanceGrid grid = fusion.fuse(subProgress(progress, begin, 0.95));
  report(progress, "points", 0.95);
  return {surfacePoints(grid, options.threads), fusion.poses()};
}
} // namespace fresco
