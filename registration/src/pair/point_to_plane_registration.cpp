// SPDX-License-Identifier: BSD-3-Clause
#include "overlap/pair_overlap.h"
#include "refinement/free_motion.h"
#include "refinement/joint_refinement.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/require.h>
#include <fresco/registration/core/point_to_plane_registration.h>
namespace fresco {
using namespace registration;
namespace {
void validate(const Eigen::Matrix4d& guess, const PointToPlaneOptions& options)
{
  require(guess.allFinite(), "point-to-plane registration: the guess is not finite");
  require(options.max_distance >= 0.f && std::isfinite(options.max_distance),
          "point-to-plane registration: max_distance ", options.max_distance, " is negative or NaN");
  require(options.max_iterations >= 1, "point-to-plane registration: max_iterations ", options.max_iterations,
          " is below 1");
  require(options.min_motion >= 0.f, "point-to-plane registration: min_motion ", options.min_motion,
          " is negative or NaN");
  require(options.samples >= 100, "point-to-plane registration: samples ", options.samples, " is below 100");
}

void summarize(const JointResult& joint, PointToPlaneResult& result)
{
  double squares = 0.0;
  for (const JointPair& pair : joint.pairs) {
    squares += pair.matches * pair.rms * pair.rms;
    result.matches += pair.matches;
  }
  result.converged = joint.converged && result.matches > 0;
  result.iterations = joint.iterations;
  if (result.matches == 0)
    return;
  result.rms = std::sqrt(squares / result.matches);
  result.free_motion = findFreeMotion(joint.information[1]);
}
} // namespace

float registrationVoxel(const PointSet& scan)
{
  const double size = scanSize(scan);
  require(size > 0.0, "point-to-plane registration: no finite point away from the viewpoint");
  return fittingVoxel(scan, size / voxels_per_size);
}

std::shared_ptr<const PreparedScan> prepareForRegistration(const PointSet& scan, float voxel, int threads,
                                                           const std::shared_ptr<NeighborSearch>& search)
{
  validatePointSet(scan);
  require(voxel > 0.f && std::isfinite(voxel), "point-to-plane registration: voxel ", voxel, " is not positive");
  // Coarse cells also of narrow views: no features are needed, but a wide reach.
  auto prepared = std::make_shared<PreparedScan>(prepareScan(scan, Thinning(voxel), threads, search));
  require(prepared->problem.empty(), "point-to-plane registration: ", prepared->problem);
  return prepared;
}

PointToPlaneResult alignPointToPlane(const PreparedPair& pair, const PointToPlaneOptions& options,
                                     const Progress& progress)
{
  validate(pair.guess, options);
  const PreparedScan &source = pair.source, &target = pair.target;
  JointOptions joint;
  joint.max_distance = options.max_distance > 0.f ? options.max_distance : reach_voxels * target.levels.back().voxel;
  joint.min_overlap = 0.f;
  joint.max_iterations = options.max_iterations;
  joint.min_motion = options.min_motion;
  joint.samples = options.samples;
  joint.threads = options.threads;
  const Eigen::Isometry3d T_source(Eigen::Translation3d(source.center)), T_target(Eigen::Translation3d(target.center));
  const JointResult aligned =
      refineJointly({&target, &source}, {T_target, Eigen::Isometry3d(pair.guess) * T_source}, joint, progress);
  PointToPlaneResult result;
  const Eigen::Isometry3d T_target_source = aligned.poses[1] * T_source.inverse();
  result.T_target_source = T_target_source.matrix();
  summarize(aligned, result);
  const PairCheck check = checkPair(target, source, aligned.poses[0].inverse() * aligned.poses[1], check_level);
  result.overlap = check.overlap;
  result.violation = check.violation;
  return result;
}

PointToPlaneResult alignPointToPlane(const PreparedScan& source, const PreparedScan& target,
                                     const Eigen::Matrix4d& guess, const PointToPlaneOptions& options)
{
  return alignPointToPlane(PreparedPair{source, target, guess}, options);
}

PointToPlaneResult alignPointToPlane(const PointSet& source, const PointSet& target, const Eigen::Matrix4d& guess,
                                     const PointToPlaneOptions& options)
{
  validate(guess, options);
  validatePointSet(source);
  validatePointSet(target);
  const float voxel = std::max(registrationVoxel(source), registrationVoxel(target));
  return alignPointToPlane(*prepareForRegistration(source, voxel, options.threads),
                           *prepareForRegistration(target, voxel, options.threads), guess, options);
}
} // namespace fresco
