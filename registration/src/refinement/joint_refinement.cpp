// SPDX-License-Identifier: BSD-3-Clause
#include "refinement/joint_refinement.h"
#include "overlap/pair_overlap.h"
#include "refinement/point_to_plane_system.h"
#include "scan/lists.h"
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <fresco/core/statistics.h>
#include <fresco/core/union_find.h>
#include <map>
#include <numeric>
namespace fresco::registration {
namespace {
// What one task handles.
struct PairSamples {
  std::size_t pair;
  SampleRange range;
};

class Refinement {
public:
  Refinement(const ScanPointers& scans, IsometryVector poses, const JointOptions& options)
      : scans_(scans), options_(options), poses_(std::move(poses)), first_poses_(poses_)
  {}

  JointResult run(const Progress& progress);

private:
  const ScanLevel& level(Index scan) const { return level(scan, level_); }
  const ScanLevel& level(Index scan, int k) const { return scans_[scan]->levels[k]; }
  // A distance of the present level in as many voxels of another one.
  float onLevel(float distance, int k) const { return distance / level(0).voxel * level(0, k).voxel; }
  Index scanCount() const { return scans_.size(); }
  Eigen::Isometry3d relative(const DirectedPair& pair) const
  {
    return poses_[pair.target].inverse() * poses_[pair.source];
  }
  bool oriented(const DirectedPair& pair) const
  {
    return scans_[pair.source]->oriented && scans_[pair.target]->oriented;
  }
  LevelPair levelPair(const DirectedPair& pair) const
  {
    return {level(pair.source, pair.level), level(pair.target, pair.level), relative(pair).cast<float>(),
            oriented(pair)};
  }
  void refineLevel();
  bool overlap(const DirectedPair& pair, float distance) const;
  std::vector<int> commonLevels(float distance) const;
  void findPairs(float distance);
  void weigh();
  void match(float distance);
  std::vector<PairSystem> accumulateAll() const;
  Eigen::VectorXd solve(const std::vector<PairSystem>& systems) const;
  double move(const Eigen::VectorXd& x);
  void keepGauge();
  std::vector<Index> holders() const;
  bool fixed(Index scan) const { return !options_.fixed.empty() && options_.fixed[scan]; }
  CellSystems systemsByCell(std::size_t pair) const;
  void findCovariances(JointResult& result) const;
  void finish(JointResult& result) const;

  const ScanPointers& scans_;
  const JointOptions& options_;
  IsometryVector poses_, first_poses_;
  std::vector<DirectedPair> pairs_;
  std::vector<PairSamples> blocks_;
  int level_ = 0, iterations_ = 0;
  bool converged_ = false;
};

// Whether enough of the source is on the target, at the pair's level.
bool Refinement::overlap(const DirectedPair& pair, float distance) const
{
  OverlapTest test;
  test.distance = distance;
  test.most = 400; // in each of many rounds: the share is known to 2.5 %
  test.max_angle = match_angle;
  test.oriented = oriented(pair);
  const LevelPair level = levelPair(pair);
  return overlapShare(level.source, level.target, level.T_target_source, test) >= options_.min_overlap;
}

// For each pair of scans, n x n, the level on which enough of the first is on the second, or -1. Far from a scanner points
// may lie so far apart that only coarser levels have surfaces there.
std::vector<int> Refinement::commonLevels(float distance) const
{
  const Index n = scanCount();
  std::vector<int> levels(n * n, -1);
  forEachTask(n * n, options_.threads, [&](Index k) {
    DirectedPair pair;
    pair.source = k / n;
    pair.target = k % n;
    if (pair.source == pair.target || (fixed(pair.source) && fixed(pair.target)))
      return;
    pair.level = level_;
    if (options_.min_overlap <= 0.f || overlap(pair, distance)) {
      levels[k] = level_;
      return;
    }
    pair.level = check_level;
    if (options_.coarse_pairs && level_ > check_level && !level(pair.target).search &&
        overlap(pair, onLevel(distance, check_level)))
      levels[k] = check_level;
  });
  for (const auto& [a, b] : options_.excluded)
    levels[a * n + b] = levels[b * n + a] = -1;
  return levels;
}

void Refinement::findPairs(float distance)
{
  constexpr Index block_size = 500; // matches that one task handles: long against the cost of a task
  const Index n = scanCount();
  const std::vector<int> levels = commonLevels(distance);
  pairs_.clear();
  blocks_.clear();
  for (Index a = 0; a < n; ++a)
    for (Index b = 0; b < n; ++b) {
      const int common = std::max(levels[a * n + b], levels[b * n + a]);
      if (a == b || common < 0)
        continue;
      const Index count = std::min<Index>(options_.samples, level(a, common).samples.size());
      for (Index begin = 0; begin < count; begin += block_size)
        blocks_.push_back({pairs_.size(), {begin, std::min(count, begin + block_size)}});
      pairs_.push_back({a, b, common, std::vector<Match>(count)});
    }
}

// What pairs on a coarser level weigh: as the noise of their residuals says, and that of most pairs.
void Refinement::weigh()
{
  std::vector<double> cutoffs;
  for (const DirectedPair& pair : pairs_)
    if (pair.level == level_ && pair.cutoff > 0.0)
      cutoffs.push_back(pair.cutoff);
  if (cutoffs.empty())
    return;
  const double usual = median(cutoffs);
  for (DirectedPair& pair : pairs_)
    if (pair.level < level_ && pair.cutoff > 0.0)
      pair.weight = std::min(1.0, usual * usual / (pair.cutoff * pair.cutoff));
}

void Refinement::match(float distance)
{
  forEachTask(blocks_.size(), options_.threads, [&](Index b) {
    DirectedPair& pair = pairs_[blocks_[b].pair];
    findMatches(levelPair(pair), blocks_[b].range, onLevel(distance, pair.level), pair);
  });
  forEachTask(pairs_.size(), options_.threads,
              [&](Index p) { findCutoff(level(pairs_[p].target, pairs_[p].level).voxel, pairs_[p]); });
  weigh();
}

std::vector<PairSystem> Refinement::accumulateAll() const
{
  std::vector<PairSystem> parts(blocks_.size()), systems(pairs_.size());
  forEachTask(blocks_.size(), options_.threads, [&](Index b) {
    const DirectedPair& pair = pairs_[blocks_[b].pair];
    parts[b] = accumulate(levelPair(pair), blocks_[b].range, pair);
  });
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    systems[blocks_[b].pair] += parts[b];
  return systems;
}

// Motions of all scans, rotations times the scan's size: the normal equations of all pairs, slightly damped.
Eigen::VectorXd Refinement::solve(const std::vector<PairSystem>& systems) const
{
  constexpr double damping = 1e-4; // of the mean information: holds directions that no match determines
  const Index n = 6 * scanCount();
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd b = Eigen::VectorXd::Zero(n), scale(n);
  const auto add = [&](Index row, Index column, const Matrix6d& block) {
    if (fixed(row) || fixed(column))
      return;
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
    const Matrix6d& H = systems[p].H;
    add(pair.source, pair.source, M.M_source * H * M.M_source.transpose());
    add(pair.target, pair.target, M.M_target * H * M.M_target.transpose());
    add(pair.source, pair.target, M.M_source * H * M.M_target.transpose());
    add(pair.target, pair.source, M.M_target * H * M.M_source.transpose());
    b.segment<6>(6 * pair.source) -= M.M_source * systems[p].b;
    b.segment<6>(6 * pair.target) -= M.M_target * systems[p].b;
    matches += systems[p].count;
  }
  for (Index i = 0; i < scanCount(); ++i)
    if (fixed(i))
      b.segment<6>(6 * i).setZero();
  const double least = damping * std::max<double>(1.0, matches) / scanCount();
  for (Index k = 0; k < n; ++k)
    entries.emplace_back(k, k, least);
  Eigen::SparseMatrix<double> H(n, n);
  H.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(H);
  return solver.solve(b.cwiseProduct(scale));
}

// The largest motion, length.
double Refinement::move(const Eigen::VectorXd& x)
{
  double motion = 0.0;
  for (Index i = 0; i < scanCount(); ++i) {
    const Vector6d scaled = x.segment<6>(6 * i);
    motion = std::max(motion, scaled.norm());
    const Eigen::Vector3d w = scaled.head<3>() / scans_[i]->size;
    Eigen::Isometry3d& pose = poses_[i];
    if (w.norm() > 0.0)
      pose.linear() = rotation(w) * pose.linear();
    pose.linear() = normalized(pose.linear());
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
  for (Index i = 0; i < scanCount(); ++i)
    level(i).prepareSearch();
  findPairs(distance);
  for (int k = 0; k < options_.max_iterations; ++k) {
    match(distance);
    const double motion = move(solve(accumulateAll()));
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

// Per scan, the first anchor of its connected group, or else the group's first scan; a fixed scan holds itself.
std::vector<Index> Refinement::holders() const
{
  UnionFind groups(scanCount());
  std::vector<Index> holder(scans_.size());
  std::iota(holder.begin(), holder.end(), Index(0));
  for (const DirectedPair& pair : pairs_)
    groups.join(pair.source, pair.target);
  for (auto anchor = options_.anchors.rbegin(); anchor != options_.anchors.rend(); ++anchor)
    holder[groups.root(*anchor)] = *anchor;
  for (Index i = scanCount() - 1; i >= 0; --i)
    if (fixed(i))
      holder[groups.root(i)] = i;
  for (Index i = scanCount() - 1; i >= 0; --i) // a root comes before the rest of its group
    holder[i] = fixed(i) ? i : holder[groups.root(i)];
  return holder;
}

// Moves each connected group back so that its holder keeps its pose.
void Refinement::keepGauge()
{
  const std::vector<Index> held = holders();
  IsometryVector corrections(scans_.size());
  for (Index i = 0; i < scanCount(); ++i)
    corrections[i] = first_poses_[held[i]] * poses_[held[i]].inverse();
  for (Index i = 0; i < scanCount(); ++i)
    if (!fixed(i))
      poses_[i] = fixed(held[i]) ? poses_[i] : corrections[i] * poses_[i];
}

CellSystems Refinement::systemsByCell(std::size_t pair) const
{
  // Of the scans' sizes: a wall of a room. What a scanner misreads of it depends on itself all over.
  constexpr double cell_share = 1.5;
  const double edge = cell_share * scans_[0]->size;
  const DirectedPair& directed = pairs_[pair];
  const LevelPair level = levelPair(directed);
  const Eigen::Isometry3d& T_world_target = poses_[directed.target];
  std::map<std::array<std::int32_t, 3>, PairSystem> systems;
  const Index n = directed.matches.size();
  for (Index k = 0; k < n; ++k) {
    if (directed.matches[k].target < 0)
      continue;
    const Eigen::Vector3d y = level.target.points.col(directed.matches[k].target).cast<double>();
    const Eigen::Array3i cell = ((T_world_target * y - poses_[0].translation()).array() / edge).floor().cast<int>();
    addMatch(level, directed, k, systems[{cell[0], cell[1], cell[2]}]);
  }
  CellSystems result;
  for (const auto& [cell, system] : systems)
    if (system.count > 0)
      result.push_back({cell, static_cast<Index>(pair), system});
  return result;
}

void Refinement::findCovariances(JointResult& result) const
{
  const std::vector<Index> held = holders();
  JointSystem joint{poses_, held, {}, {}};
  joint.fit = options_.fixed.empty();
  joint.size = scans_[0]->size;
  joint.threads = options_.threads;
  const auto parts = mapTasks(pairs_.size(), options_.threads, [&](Index p) { return systemsByCell(p); });
  for (std::size_t p = 0; p < pairs_.size(); ++p) {
    const DirectedPair& pair = pairs_[p];
    joint.links.push_back({pair.source, pair.target, PairJacobian(poses_[pair.target], relative(pair))});
    joint.cells.insert(joint.cells.end(), parts[p].begin(), parts[p].end());
  }
  std::stable_sort(joint.cells.begin(), joint.cells.end(),
                   [](const CellSystem& x, const CellSystem& y) { return x.cell < y.cell; });
  static_cast<PoseUncertainty&>(result) = findUncertainty(joint, options_.cuts);
}

void Refinement::finish(JointResult& result) const
{
  const std::vector<PairSystem> systems = accumulateAll();
  result.information.assign(scans_.size(), Matrix6d::Zero());
  for (std::size_t p = 0; p < pairs_.size(); ++p) {
    const DirectedPair& pair = pairs_[p];
    const PairSystem& system = systems[p];
    const double rms = system.count > 0 ? std::sqrt(system.squares / system.count) : 0.0;
    result.pairs.push_back({pair.source, pair.target, system.count, rms, pair.level < level_});
    const PairJacobian M(poses_[pair.target], relative(pair));
    result.information[pair.source] += M.M_source * system.H * M.M_source.transpose();
    result.information[pair.target] += M.M_target * system.H * M.M_target.transpose();
  }
  if (options_.covariances)
    findCovariances(result);
  result.poses = poses_;
  result.iterations = iterations_;
  result.converged = converged_;
}

JointResult Refinement::run(const Progress& progress)
{
  const int last = options_.last_level < 0 ? level_count - 1 : options_.last_level;
  for (level_ = options_.first_level; level_ <= last; ++level_) {
    report(progress, "refine", 1.0 * (level_ - options_.first_level) / (last - options_.first_level + 1));
    refineLevel();
  }
  level_ = last;
  match(final_distance * level(0).voxel);
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

JointResult refinePair(const std::pair<const PreparedScan&, const PreparedScan&>& pair, const Eigen::Isometry3d& T_a_b,
                       const LevelRange& levels, Index samples)
{
  const auto& [a, b] = pair;
  JointOptions options;
  options.first_level = levels.first;
  options.last_level = levels.last;
  options.max_distance = 2.f * a.levels[levels.first].voxel;
  options.samples = samples;
  options.max_iterations = 20;
  options.min_overlap = 0.f;
  options.threads = 1;
  return refineJointly({&a, &b}, {Eigen::Isometry3d::Identity(), T_a_b}, options, {});
}
} // namespace fresco::registration
