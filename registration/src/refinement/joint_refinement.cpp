// SPDX-License-Identifier: BSD-3-Clause
#include "refinement/joint_refinement.h"
#include "pair/pair_overlap.h"
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
#include <numeric>
namespace fresco::registration {
namespace {
constexpr Index block_size = 500; // matches that one task handles
constexpr double tukey = 4.685;   // 95 % efficiency on Gaussian noise
constexpr double mad_to_sigma = 1.4826;
constexpr double damping = 1e-4;      // of the mean information: holds directions that no match determines
constexpr float final_distance = 2.f; // voxels of a level: correspondences at its end
constexpr float angle_limit = 1.0f;   // radians between the normals of a match
constexpr float bend_limit = 0.1f;    // of the target's neighbourhood: beyond, its plane means little
constexpr double plain_bend = 0.01;   // of both neighbourhoods together, halves the weight: noisy surfaces say less
constexpr Index fewest_matches = 30;  // of a direction of a pair
constexpr Index overlap_samples = 400;

struct Match {
  Index target = -1;
  float residual = 0.f;
};

struct DirectedPair {
  Index source = 0, target = 0;
  std::vector<Match> matches; // one per sample of the source
  double cutoff = 0.0;        // residual from which the weight is zero
};

// Normal equations of one directed pair in the working frame of its target, J = [x cross n; n].
struct PairSystem {
  Matrix6d G = Matrix6d::Zero();
  Vector6d h = Vector6d::Zero();
  double squares = 0.0;
  Index count = 0;

  PairSystem& operator+=(const PairSystem& other)
  {
    G += other.G;
    h += other.h;
    squares += other.squares;
    count += other.count;
    return *this;
  }
};

struct Block {
  std::size_t pair;
  Index begin, end;
};

Eigen::Matrix3d cross(const Eigen::Vector3d& v)
{
  Eigen::Matrix3d matrix;
  matrix << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return matrix;
}

class Refinement {
public:
  Refinement(const ScanPointers& scans, IsometryVector poses, const JointOptions& options)
      : scans_(scans), options_(options), poses_(std::move(poses)), first_poses_(poses_)
  {}

  JointResult run(const Progress& progress);

private:
  const ScanLevel& level(Index scan) const { return scans_[scan]->levels[level_]; }
  Index scanCount() const { return static_cast<Index>(scans_.size()); }
  Eigen::Isometry3d relative(const DirectedPair& pair) const
  {
    return poses_[pair.target].inverse() * poses_[pair.source];
  }
  bool oriented(const DirectedPair& pair) const
  {
    return scans_[pair.source]->oriented && scans_[pair.target]->oriented;
  }
  void refineLevel();
  void findPairs(float distance);
  void findMatches(float distance);
  void findCutoff(DirectedPair& pair) const;
  std::vector<PairSystem> accumulate() const;
  PairSystem accumulateBlock(const Block& block) const;
  double step(const std::vector<PairSystem>& systems);
  void keepGauge();
  void finish(JointResult& result) const;

  const ScanPointers& scans_;
  const JointOptions& options_;
  IsometryVector poses_, first_poses_;
  std::vector<DirectedPair> pairs_;
  std::vector<Block> blocks_;
  int level_ = 0, iterations_ = 0;
  bool converged_ = false;
};

void Refinement::findPairs(float distance)
{
  const Index n = scanCount();
  std::vector<char> overlaps(n * n, 0);
  OverlapTest test;
  test.distance = distance;
  test.most = overlap_samples;
  test.max_angle = angle_limit;
  parallelFor(
      n * n, options_.threads,
      [&](Index k) {
        const DirectedPair pair{k / n, k % n, {}, 0.0};
        if (pair.source == pair.target)
          return;
        OverlapTest own = test;
        own.oriented = oriented(pair);
        overlaps[k] = overlapShare(level(pair.source), level(pair.target), relative(pair).cast<float>(), own) >=
                      options_.min_overlap;
      },
      1);
  for (const auto& [a, b] : options_.excluded)
    overlaps[a * n + b] = overlaps[b * n + a] = 0;
  pairs_.clear();
  for (Index a = 0; a < n; ++a)
    for (Index b = 0; b < n; ++b)
      if (a != b && (overlaps[a * n + b] || overlaps[b * n + a]))
        pairs_.push_back({a, b, {}, 0.0});
  blocks_.clear();
  for (std::size_t p = 0; p < pairs_.size(); ++p) {
    const Index count = std::min(options_.samples, static_cast<Index>(level(pairs_[p].source).samples.size()));
    pairs_[p].matches.resize(count);
    for (Index begin = 0; begin < count; begin += block_size)
      blocks_.push_back({p, begin, std::min(count, begin + block_size)});
  }
}

void Refinement::findMatches(float distance)
{
  const float least_cosine = std::cos(angle_limit);
  parallelFor(
      blocks_.size(), options_.threads,
      [&](Index b) {
        const Block& block = blocks_[b];
        DirectedPair& pair = pairs_[block.pair];
        const Eigen::Isometry3f T = relative(pair).cast<float>();
        const ScanLevel &source = level(pair.source), &target = level(pair.target);
        const bool signs = oriented(pair);
        for (Index k = block.begin; k < block.end; ++k) {
          Match& match = pair.matches[k];
          const Index i = source.samples[k];
          const Eigen::Vector3f x = T * source.points.col(i);
          const auto hit = target.tree->nearest(x, distance);
          match.target = -1;
          if (hit.index < 0)
            continue;
          const Eigen::Vector3f n = target.normals.col(hit.index);
          const float cosine = n.dot(T.linear() * source.normals.col(i));
          if ((signs ? cosine : std::abs(cosine)) < least_cosine || target.bend[hit.index] > bend_limit)
            continue;
          match = {hit.index, n.dot(x - target.points.col(hit.index))};
        }
      },
      1);
  parallelFor(
      pairs_.size(), options_.threads, [&](Index p) { findCutoff(pairs_[p]); }, 1);
}

void Refinement::findCutoff(DirectedPair& pair) const
{
  std::vector<float> residuals;
  for (const Match& match : pair.matches)
    if (match.target >= 0)
      residuals.push_back(std::abs(match.residual));
  pair.cutoff = 0.0;
  if (static_cast<Index>(residuals.size()) < fewest_matches)
    return;
  const auto middle = residuals.begin() + static_cast<std::ptrdiff_t>(residuals.size() / 2);
  std::nth_element(residuals.begin(), middle, residuals.end());
  pair.cutoff = std::max(tukey * mad_to_sigma * *middle, 1e-3 * level(pair.target).voxel);
}

PairSystem Refinement::accumulateBlock(const Block& block) const
{
  const DirectedPair& pair = pairs_[block.pair];
  const Eigen::Isometry3f T = relative(pair).cast<float>();
  const ScanLevel &source = level(pair.source), &target = level(pair.target);
  PairSystem system;
  for (Index k = block.begin; k < block.end; ++k) {
    const Match& match = pair.matches[k];
    const double u = match.target < 0 || pair.cutoff <= 0.0 ? 1.0 : std::abs(match.residual) / pair.cutoff;
    if (u >= 1.0)
      continue;
    const Eigen::Vector3d x = (T * source.points.col(source.samples[k])).cast<double>();
    const Eigen::Vector3d n = target.normals.col(match.target).cast<double>();
    const double bend = source.bend[source.samples[k]] + target.bend[match.target];
    const double weight = (1.0 - u * u) * (1.0 - u * u) * plain_bend / (plain_bend + bend), r = match.residual;
    Vector6d J;
    J << x.cross(n), n;
    system.G.noalias() += weight * J * J.transpose();
    system.h += weight * r * J;
    system.squares += r * r;
    ++system.count;
  }
  return system;
}

std::vector<PairSystem> Refinement::accumulate() const
{
  std::vector<PairSystem> parts(blocks_.size()), systems(pairs_.size());
  parallelFor(
      blocks_.size(), options_.threads, [&](Index b) { parts[b] = accumulateBlock(blocks_[b]); }, 1);
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    systems[blocks_[b].pair] += parts[b];
  return systems;
}

// Jacobians of a pair's residuals with respect to (rotation about the scan's centre, translation) in world axes are
// M_source J and M_target J with J of PairSystem.
struct PairJacobian {
  Matrix6d M_source = Matrix6d::Zero(), M_target = Matrix6d::Zero();

  PairJacobian(const Eigen::Isometry3d& target, const Eigen::Isometry3d& T_target_source)
  {
    const Eigen::Matrix3d R = target.linear();
    M_target.topLeftCorner<3, 3>() = M_target.bottomRightCorner<3, 3>() = -R;
    M_source.topLeftCorner<3, 3>() = M_source.bottomRightCorner<3, 3>() = R;
    M_source.topRightCorner<3, 3>() = -R * cross(T_target_source.translation());
  }
};

double Refinement::step(const std::vector<PairSystem>& systems)
{
  const Index n = 6 * scanCount();
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd b = Eigen::VectorXd::Zero(n), scale(n);
  const auto add = [&](Index row, Index column, const Matrix6d& block) {
    for (Index r = 0; r < 6; ++r)
      for (Index c = 0; c < 6; ++c)
        entries.emplace_back(6 * row + r, 6 * column + c, block(r, c) * scale[6 * row + r] * scale[6 * column + c]);
  };
  for (Index i = 0; i < scanCount(); ++i)
    scale.segment<6>(6 * i) << Eigen::Vector3d::Constant(1.0 / scans_[i]->size), Eigen::Vector3d::Ones();
  Index matches = 0;
  for (std::size_t p = 0; p < pairs_.size(); ++p) {
    const DirectedPair& pair = pairs_[p];
    const PairJacobian M(poses_[pair.target], relative(pair));
    const Matrix6d& G = systems[p].G;
    add(pair.source, pair.source, M.M_source * G * M.M_source.transpose());
    add(pair.target, pair.target, M.M_target * G * M.M_target.transpose());
    add(pair.source, pair.target, M.M_source * G * M.M_target.transpose());
    add(pair.target, pair.source, M.M_target * G * M.M_source.transpose());
    b.segment<6>(6 * pair.source) -= M.M_source * systems[p].h;
    b.segment<6>(6 * pair.target) -= M.M_target * systems[p].h;
    matches += systems[p].count;
  }
  const double least = damping * std::max<double>(1.0, static_cast<double>(matches)) / static_cast<double>(scanCount());
  for (Index k = 0; k < n; ++k)
    entries.emplace_back(k, k, least);
  Eigen::SparseMatrix<double> H(n, n);
  H.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(H);
  const Eigen::VectorXd x = solver.solve(b.cwiseProduct(scale));
  double motion = 0.0;
  for (Index i = 0; i < scanCount(); ++i) {
    const Vector6d scaled = x.segment<6>(6 * i);
    motion = std::max(motion, scaled.norm());
    const Eigen::Vector3d w = scaled.head<3>() / scans_[i]->size;
    Eigen::Isometry3d& pose = poses_[i];
    const double angle = w.norm();
    if (angle > 0.0)
      pose.linear() = Eigen::AngleAxisd(angle, w / angle).toRotationMatrix() * pose.linear();
    pose.linear() = Eigen::Quaterniond(pose.linear()).normalized().toRotationMatrix();
    pose.translation() += scaled.tail<3>();
  }
  return motion;
}

void Refinement::refineLevel()
{
  const float voxel = level(0).voxel, last = final_distance * voxel;
  float distance = level_ == options_.first_level ? std::max(options_.max_distance, last) : 2.f * last;
  const float still = options_.min_motion > 0.f ? options_.min_motion : voxel / 500.f;
  converged_ = false;
  findPairs(distance);
  for (int k = 0; k < options_.max_iterations; ++k) {
    findMatches(distance);
    const double motion = step(accumulate());
    ++iterations_;
    keepGauge();
    if (distance > last) {
      // Correspondences tighten as the scans settle.
      if (motion < 0.25 * distance || k % 4 == 3) {
        distance = std::max(last, 0.7f * distance);
        findPairs(distance);
      }
    } else if (motion < still) {
      converged_ = true;
      return;
    }
  }
}

// Moves each connected group back so that its first anchor, or else its first scan, keeps its pose.
void Refinement::keepGauge()
{
  std::vector<Index> group(scans_.size());
  std::iota(group.begin(), group.end(), Index(0));
  const auto root = [&](Index i) {
    while (group[i] != i)
      i = group[i];
    return i;
  };
  for (const DirectedPair& pair : pairs_) {
    const Index a = root(pair.source), b = root(pair.target);
    group[std::max(a, b)] = std::min(a, b);
  }
  std::vector<Index> holder(group);
  for (auto anchor = options_.anchors.rbegin(); anchor != options_.anchors.rend(); ++anchor)
    holder[root(*anchor)] = *anchor;
  IsometryVector corrections(scans_.size());
  for (std::size_t i = 0; i < scans_.size(); ++i) {
    const auto held = static_cast<std::size_t>(holder[root(static_cast<Index>(i))]);
    corrections[i] = first_poses_[held] * poses_[held].inverse();
  }
  for (std::size_t i = 0; i < scans_.size(); ++i)
    poses_[i] = corrections[i] * poses_[i];
}

void Refinement::finish(JointResult& result) const
{
  const std::vector<PairSystem> systems = accumulate();
  result.information.assign(scans_.size(), Matrix6d::Zero());
  for (std::size_t p = 0; p < pairs_.size(); ++p) {
    const DirectedPair& pair = pairs_[p];
    const PairSystem& system = systems[p];
    result.pairs.push_back({pair.source, pair.target, system.count,
                            system.count > 0 ? std::sqrt(system.squares / static_cast<double>(system.count)) : 0.0});
    const PairJacobian M(poses_[pair.target], relative(pair));
    result.information[pair.source] += M.M_source * system.G * M.M_source.transpose();
    result.information[pair.target] += M.M_target * system.G * M.M_target.transpose();
  }
  result.poses = poses_;
  result.iterations = iterations_;
  result.converged = converged_;
}

JointResult Refinement::run(const Progress& progress)
{
  const int finest = static_cast<int>(scans_[0]->levels.size()) - 1;
  const int last = options_.last_level < 0 ? finest : std::min(options_.last_level, finest);
  for (level_ = options_.first_level; level_ <= last; ++level_) {
    report(progress, "refine", static_cast<double>(level_ - options_.first_level) / (last - options_.first_level + 1));
    refineLevel();
  }
  level_ = last;
  findMatches(final_distance * level(0).voxel);
  JointResult result;
  finish(result);
  return result;
}
} // namespace

JointResult refineJointly(const ScanPointers& scans, IsometryVector poses, const JointOptions& options,
                          const Progress& progress)
{
  if (scans.empty())
    return {};
  return Refinement(scans, std::move(poses), options).run(progress);
}
} // namespace fresco::registration
