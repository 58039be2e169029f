// SPDX-License-Identifier: BSD-3-Clause
#include "scan/self_alignment.h"
#include "refinement/joint_refinement.h"
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <numeric>
namespace fresco::registration {
namespace {
constexpr double least_coverage = 0.4; // of all directions: who saw less knows too little that could refute a twin
constexpr double nearest_twin = 0.5;   // of the scan's size: nearer places that look alike are one place
constexpr int twins_a_feature = 3;     // places that look like a feature's, which may be one of many
constexpr std::size_t most_matches = 2000;
constexpr float least_overlap = 0.1f;    // with itself
constexpr float most_violation = 0.08f;  // twice what a pair may have: the best of a family of poses violates less
constexpr double twin_violation = 0.004; // below, nothing speaks against a twin; noise alone causes 0.002
constexpr double twin_color = 0.6;       // correlation of colours from which two places look alike
constexpr double twin_overlap = 0.5;     // with itself: less, and the scan is laid where it saw nothing

constexpr double far_range = 1.5;         // of the scan's size: what lies beyond may have been seen through an opening
constexpr double next_door = 3.0;         // of the scan's size: a second place further off is seen too badly to be told
constexpr int glimpses_a_feature = 6;     // places of the near part that look like a far feature's
constexpr std::size_t most_glimpses = 15; // hypotheses that are refined
constexpr double glimpse_overlap = 0.1;   // of a scan with itself: less is no evidence of a second place
constexpr double glimpse_violation = 0.002;  // what noise causes: a place of which little is seen must fit
constexpr double same_place = 0.25;          // overlap of two scans taken in the same place
constexpr double refuting_violation = 0.005; // of another scan taken there
constexpr double hopeless_violation = 0.02;  // before the last refinement
constexpr int slides = 4;                    // steps of half a voxel to either side along the weakest direction

// From these features, the most similar `count` of the same scan that lie elsewhere, and apart from each other.
struct SelfMatching {
  std::vector<Index> from;
  float apart;   // from the feature, and
  float between; // from each other, length
  int count;
};

std::vector<Correspondence> matchToSelf(const ScanFeatures& features, const SelfMatching& matching)
{
  struct Ranked {
    float likeness;
    Correspondence match;
  };
  std::vector<Ranked> ranked;
  for (const Index i : matching.from) {
    Eigen::VectorXf likeness = features.descriptors.transpose() * features.descriptors.col(i);
    Index j = i;
    for (int k = 0; k < matching.count; ++k) {
      const float apart = k == 0 ? matching.apart : matching.between;
      for (Index other = 0; other < features.points.cols(); ++other)
        if ((features.points.col(other) - features.points.col(j)).squaredNorm() < apart * apart)
          likeness[other] = -1.f;
      if (!(likeness.maxCoeff(&j) > 0.f))
        break;
      ranked.push_back({likeness[j], {i, j}});
    }
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const Ranked& x, const Ranked& y) { return x.likeness > y.likeness; });
  std::vector<Correspondence> matches;
  for (std::size_t k = 0; k < std::min(most_matches, ranked.size()); ++k)
    matches.push_back(ranked[k].match);
  return matches;
}

std::vector<Index> allOf(const ScanFeatures& features)
{
  std::vector<Index> all(features.points.cols());
  std::iota(all.begin(), all.end(), Index(0));
  return all;
}

// Features that are far from every place the scan was seen from.
std::vector<Index> farOf(const ScanFeatures& features, const PreparedScan& scan)
{
  std::vector<Index> far;
  const auto range = static_cast<float>(far_range * scan.size);
  const Points& viewpoints = scan.levels.front().viewpoints;
  for (Index i = 0; i < features.points.cols(); ++i)
    if ((viewpoints.colwise() - features.points.col(i)).colwise().squaredNorm().minCoeff() > range * range)
      far.push_back(i);
  return far;
}

Eigen::Isometry3d refined(const PreparedScan& scan, const Eigen::Isometry3d& T, int first_level, int last_level)
{
  JointOptions options;
  options.max_distance = 2.f * scan.levels[first_level].voxel;
  options.samples = 2000;
  options.max_iterations = 20;
  options.first_level = first_level;
  options.last_level = last_level;
  options.min_overlap = 0.f;
  options.threads = 1;
  return refineJointly({&scan, &scan}, {Eigen::Isometry3d::Identity(), T}, options, {}).poses[1];
}

// Direction in which the surfaces that a motion brings together say least of it.
Eigen::Vector3d weakestDirection(const ScanLevel& level, const Eigen::Isometry3d& motion)
{
  const Eigen::Isometry3f T = motion.cast<float>();
  Eigen::Matrix3d normals = Eigen::Matrix3d::Zero();
  for (Index i = 0; i < level.points.cols(); ++i) {
    const auto hit = level.tree->nearest(T * level.points.col(i), level.voxel);
    const Eigen::Vector3f n = T.linear() * level.normals.col(i);
    if (hit.index >= 0 && level.normals.col(hit.index).dot(n) > 0.7f)
      normals += (n * n.transpose()).cast<double>();
  }
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(normals).eigenvectors().col(0);
}

// The little that is seen of a second place leaves a direction nearly free, in which refinement drifts: the best place
// along it.
Eigen::Isometry3d settled(const PreparedScan& scan, const Eigen::Isometry3d& T)
{
  const Eigen::Vector3d step = 0.5 * scan.levels[1].voxel * weakestDirection(scan.levels[1], T);
  Eigen::Isometry3d best = T;
  double most = -1.0;
  for (int k = -slides; k <= slides; ++k) {
    const Eigen::Isometry3d shifted = Eigen::Translation3d(k * step) * T;
    const double score = alignmentScore(checkPair(scan, scan, shifted, 1));
    if (score > most) {
      most = score;
      best = shifted;
    }
  }
  return best;
}

bool isGlimpse(const PairCheck& check)
{
  return check.overlap >= glimpse_overlap && check.violation < glimpse_violation &&
         check.color.value_or(1.0) > twin_color;
}

// A second place of which the scan saw little, such as an equal room through two doors: what is far fits to what is
// near, and nothing contradicts it.
SelfMotions findGlimpses(const PreparedScan& scan, const ScanFeatures& features, const ConsensusOptions& consensus)
{
  const auto apart = static_cast<float>(nearest_twin * scan.size);
  Hypotheses hypotheses =
      findConsensus(features, features,
                    matchToSelf(features, {farOf(features, scan), apart, 0.5f * apart, glimpses_a_feature}), consensus);
  hypotheses.erase(std::remove_if(hypotheses.begin(), hypotheses.end(),
                                  [&](const Hypothesis& hypothesis) {
                                    return hypothesis.T_a_b.translation().norm() > next_door * scan.size;
                                  }),
                   hypotheses.end());
  for (Hypothesis& hypothesis : hypotheses)
    hypothesis.score = alignmentScore(checkPair(scan, scan, hypothesis.T_a_b, 0));
  std::stable_sort(hypotheses.begin(), hypotheses.end(),
                   [](const Hypothesis& x, const Hypothesis& y) { return x.score > y.score; });
  hypotheses.resize(std::min(most_glimpses, hypotheses.size()));
  SelfMotions found;
  IsometryVector tried;
  for (const Hypothesis& hypothesis : hypotheses) {
    const Eigen::Isometry3d rough = refined(scan, hypothesis.T_a_b, 0, 1);
    const PairCheck check = checkPair(scan, scan, rough, 1);
    const bool known = std::any_of(tried.begin(), tried.end(), [&](const Eigen::Isometry3d& other) {
      return poseDistance(rough, other, scan.size) < scan.levels[1].voxel;
    });
    if (known || check.violation > hopeless_violation || check.overlap < glimpse_overlap ||
        poseDistance(rough, Eigen::Isometry3d::Identity(), scan.size) <= apart)
      continue;
    tried.push_back(rough);
    for (const Eigen::Isometry3d& start : {rough, settled(scan, rough)}) {
      const Eigen::Isometry3d T = refined(scan, start, check_level, level_count - 1);
      if (poseDistance(T, Eigen::Isometry3d::Identity(), scan.size) > apart &&
          isGlimpse(checkPair(scan, scan, T, check_level))) {
        found.push_back({T, true, 0.0, true});
        break;
      }
    }
  }
  return found;
}

bool isKnown(const PreparedScan& scan, const Eigen::Isometry3d& T)
{
  return std::any_of(scan.twins.begin(), scan.twins.end(), [&](const SelfMotion& own) {
    return own.certain && poseDistance(own.T, T, scan.size) < nearest_twin * scan.size;
  });
}

// A motion of one scan as others have it that were taken in the same place, or in one that looks alike.
class Glimpse {
public:
  Glimpse(const std::vector<PreparedScan>& scans, const std::vector<PairAlignment>& pairs, Index scan,
          const SelfMotion& motion)
  {
    for (const PairAlignment& pair : pairs) {
      if ((pair.a != scan && pair.b != scan) || pair.modes.empty() || pair.modes[0].check.overlap < same_place)
        continue;
      const Eigen::Isometry3d T_a_b = pair.modes[0].T_a_b, T = pair.a == scan ? T_a_b.inverse() : T_a_b;
      const Index other = pair.a == scan ? pair.b : pair.a;
      shared_.push_back({other, motion});
      shared_.back().second.T = T * motion.T * T.inverse();
      const PreparedScan& seen = scans[other];
      refuted_ = refuted_ || checkPair(seen, seen, shared_.back().second.T, check_level).violation > refuting_violation;
    }
  }

  bool refuted() const { return refuted_; }

  void addTo(std::vector<PreparedScan>& scans) const
  {
    for (const auto& [scan, motion] : shared_)
      if (!isKnown(scans[scan], motion.T))
        scans[scan].twins.push_back(motion);
  }

private:
  std::vector<std::pair<Index, SelfMotion>> shared_;
  bool refuted_ = false;
};
} // namespace

void shareGlimpses(std::vector<PreparedScan>& scans, const std::vector<PairAlignment>& pairs)
{
  std::vector<Glimpse> glimpses;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    SelfMotions kept;
    for (const SelfMotion& motion : scans[i].twins) {
      if (motion.glimpsed)
        glimpses.emplace_back(scans, pairs, static_cast<Index>(i), motion);
      if (!motion.glimpsed || !glimpses.back().refuted())
        kept.push_back(motion);
    }
    scans[i].twins = kept;
  }
  for (const Glimpse& glimpse : glimpses)
    if (!glimpse.refuted())
      glimpse.addTo(scans);
}

SelfMotions findSelfMotions(const PreparedScan& scan, const ScanFeatures& features)
{
  if (scan.free_space.coverage() < least_coverage)
    return {};
  ConsensusOptions consensus;
  consensus.tolerance = 1.5f * scan.levels[1].voxel;
  consensus.size = static_cast<float>(scan.size);
  consensus.exclusive = true;
  PairAlignmentOptions options;
  options.min_overlap = least_overlap;
  options.max_violation = most_violation;
  options.refined = options.checked;
  const auto apart = static_cast<float>(nearest_twin * scan.size);
  SelfMotions motions;
  for (const PairMode& mode :
       acceptedModes(scan, scan,
                     findConsensus(features, features,
                                   matchToSelf(features, {allOf(features), apart, apart, twins_a_feature}), consensus),
                     options)) {
    if (poseDistance(mode.T_a_b, Eigen::Isometry3d::Identity(), scan.size) <= apart)
      continue;
    const bool wide = mode.check.overlap > twin_overlap;
    motions.push_back(
        {mode.T_a_b, wide && mode.check.violation < twin_violation && mode.check.color.value_or(1.0) > twin_color,
         wide && mode.check.violation <= PairAlignmentOptions().max_violation ? mode.check.overlap : 0.0});
  }
  if (std::none_of(motions.begin(), motions.end(), [](const SelfMotion& motion) { return motion.certain; }))
    for (const SelfMotion& glimpse : findGlimpses(scan, features, consensus))
      motions.push_back(glimpse);
  return motions;
}
} // namespace fresco::registration
