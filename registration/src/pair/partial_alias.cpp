// SPDX-License-Identifier: BSD-3-Clause
#include "pair/partial_alias.h"
#include "pair/feature_matching.h"
#include "refinement/joint_refinement.h"
#include "scan/lists.h"
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <optional>
namespace fresco::registration {
namespace {
constexpr double far_range = 1.5; // of the scan's size: what lies beyond may have been seen through an opening

// Features that are far from every place the scan was seen from.
std::vector<Index> farFeatures(const ScanFeatures& features, const PreparedScan& scan)
{
  std::vector<Index> far;
  const float range = far_range * scan.size;
  const Points& viewpoints = scan.levels.front().viewpoints;
  for (Index i = 0; i < features.points.cols(); ++i)
    if ((viewpoints.colwise() - features.points.col(i)).colwise().squaredNorm().minCoeff() > range * range)
      far.push_back(i);
  return far;
}

Eigen::Isometry3d refined(const PreparedScan& scan, const Eigen::Isometry3d& T, const LevelRange& levels)
{
  constexpr Index samples = 2000;
  return refinePair({scan, scan}, T, levels, samples).poses[1];
}

// Direction in which the surfaces that a motion brings together say least of it.
Eigen::Vector3d weakestDirection(const ScanLevel& level, const Eigen::Isometry3d& motion)
{
  const Eigen::Isometry3f T = motion.cast<float>();
  Eigen::Matrix3d normals = Eigen::Matrix3d::Zero();
  for (Index i = 0; i < level.points.cols(); ++i) {
    const auto hit = level.nearest(T * level.points.col(i), level.voxel);
    const Eigen::Vector3f n = T.linear() * level.normals.col(i);
    if (hit.index >= 0 && level.normals.col(hit.index).dot(n) > 0.7f)
      normals += (n * n.transpose()).cast<double>();
  }
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(normals).eigenvectors().col(0);
}

// The little that is seen of a second place leaves a direction nearly free, in which refinement drifts: the best place
// along it.
Eigen::Isometry3d bestAlongWeakest(const PreparedScan& scan, const Eigen::Isometry3d& T, int level)
{
  constexpr int steps = 4; // of half a voxel to either side: how far refinement drifts
  const Eigen::Vector3d step = 0.5 * scan.levels[1].voxel * weakestDirection(scan.levels[level], T);
  Eigen::Isometry3d best = T;
  double most = -1.0;
  for (int k = -steps; k <= steps; ++k) {
    const Eigen::Isometry3d shifted = Eigen::Translation3d(k * step) * T;
    const double score = alignmentScore(checkPair(scan, scan, shifted, level));
    if (score > most) {
      most = score;
      best = shifted;
    }
  }
  return best;
}

bool fitsPartially(const PreparedScan& scan, const Eigen::Isometry3d& T)
{
  constexpr double most_strays = 0.005;   // of the points that agree, single ones among them
  constexpr double fewest_points = 200.0; // that agree: fewer do so by chance in many a room
  if (!isElsewhere(scan, T))
    return false;
  const PairCheck check = checkPair(scan, scan, T, check_level);
  const double agreeing = check.overlap * static_cast<double>(scan.levels[check_level].points.cols());
  return check.overlap >= VerificationOptions{}.min_overlap && check.violation < noise_violation &&
         agreeing >= fewest_points && static_cast<double>(check.violating_points) <= most_strays * agreeing &&
         check.color.value_or(1.0) > good_color;
}

// The best of those that lead to a place near enough to be told.
void keepLikely(const PreparedScan& scan, PoseHypotheses& hypotheses)
{
  constexpr std::size_t most_refined = 15; // bounds the time
  const auto unlikely = [&](const PoseHypothesis& hypothesis) {
    const double distance = hypothesis.T_a_b.translation().norm();
    return distance < far_range * scan.size || distance > next_door * scan.size;
  };
  removeIf(hypotheses, unlikely);
  for (PoseHypothesis& hypothesis : hypotheses)
    hypothesis.score = alignmentScore(checkPair(scan, scan, hypothesis.T_a_b, 0));
  keepLargest(hypotheses, most_refined, &PoseHypothesis::score);
}

using SharedAliases = std::vector<std::pair<Index, ScanAlias>>; // by scans

bool isKnown(const PreparedScan& scan, const Eigen::Isometry3d& T)
{
  return std::any_of(scan.aliases.begin(), scan.aliases.end(), [&](const ScanAlias& own) {
    return own.certain && poseDistance(own.T, T, scan.size) < alias_distance * scan.size;
  });
}

// A partial alias of one scan as others have it that were taken in the same place, or in one that looks alike; nothing if
// one of these contradicts it.
std::optional<SharedAliases> sharedAlias(const std::vector<PreparedScan>& scans,
                                         const std::vector<PairAlignment>& pairs, Index scan, const ScanAlias& alias)
{
  constexpr double rejecting_violation = 0.005; // of another scan taken there: more than twice what noise causes
  SharedAliases shared;
  for (const PairAlignment& pair : pairs) {
    if ((pair.a != scan && pair.b != scan) || pair.hypotheses.empty() || scans[pair.a].blind || scans[pair.b].blind ||
        pair.hypotheses[0].check.overlap < strong_overlap)
      continue;
    const Eigen::Isometry3d T_a_b = pair.hypotheses[0].T_a_b, T = pair.a == scan ? T_a_b.inverse() : T_a_b;
    const Index other = pair.a == scan ? pair.b : pair.a;
    auto& [seer, of_other] = shared.emplace_back(other, alias);
    of_other.T = T * alias.T * T.inverse();
    if (checkPair(scans[seer], scans[seer], of_other.T, check_level).violation > rejecting_violation)
      return std::nullopt;
  }
  return shared;
}
} // namespace

bool isElsewhere(const PreparedScan& scan, const Eigen::Isometry3d& T)
{
  const float apart = alias_distance * scan.size;
  return poseDistance(T, Eigen::Isometry3d::Identity(), scan.size) > apart;
}

PoseHypotheses matchFarToNear(const PreparedScan& scan, const ScanFeatures& features, const Sc2PcrOptions& sc2_pcr)
{
  constexpr int matches_a_feature = 6; // places of the near part that look like a far feature's
  const float apart = alias_distance * scan.size;
  return runSc2Pcr(features, features,
                   matchToSelf(features, {farFeatures(features, scan), apart, 0.5f * apart, matches_a_feature}),
                   sc2_pcr);
}

ScanAliases findPartialAliases(const PreparedScan& scan, PoseHypotheses starts)
{
  constexpr double hopeless_violation = 10.0 * noise_violation; // before the last refinement
  keepLikely(scan, starts);
  ScanAliases found;
  IsometryVector tried;
  for (const PoseHypothesis& hypothesis : starts) {
    const Eigen::Isometry3d rough = refined(scan, hypothesis.T_a_b, {0, 1}), along = bestAlongWeakest(scan, rough, 1);
    const PairCheck check = checkPair(scan, scan, along, 1);
    const bool known = std::any_of(tried.begin(), tried.end(), [&](const Eigen::Isometry3d& other) {
      return poseDistance(along, other, scan.size) < scan.levels[1].voxel;
    });
    if (known || check.violation > hopeless_violation || check.overlap < VerificationOptions{}.min_overlap ||
        !isElsewhere(scan, along))
      continue;
    tried.push_back(along);
    for (const Eigen::Isometry3d& start : {rough, along}) {
      Eigen::Isometry3d T = refined(scan, start, {check_level, level_count - 1});
      if (!fitsPartially(scan, T))
        T = bestAlongWeakest(scan, T, check_level);
      if (fitsPartially(scan, T)) {
        found.push_back({T, true, true});
        break;
      }
    }
  }
  return found;
}

void sharePartialAliases(std::vector<PreparedScan>& scans, const std::vector<PairAlignment>& pairs)
{
  SharedAliases all;
  for (std::size_t i = 0; i < scans.size(); ++i)
    removeIf(scans[i].aliases, [&](const ScanAlias& alias) {
      const auto shared = alias.partial ? sharedAlias(scans, pairs, i, alias) : SharedAliases();
      if (shared)
        all.insert(all.end(), shared->begin(), shared->end());
      return !shared;
    });
  for (const auto& [scan, alias] : all)
    if (!isKnown(scans[scan], alias.T))
      scans[scan].aliases.push_back(alias);
}
} // namespace fresco::registration
