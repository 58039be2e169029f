// SPDX-License-Identifier: BSD-3-Clause
#include "refinement/joint_covariance.h"
#include "scan/lists.h"
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
namespace fresco::registration {
namespace {
using Block = Eigen::Matrix<double, 6, Eigen::Dynamic>;

// The share of one cell: what its matches pull at the scans that see it.
struct CellPull {
  std::vector<Index> scans;    // that can move
  Eigen::VectorXd pull;        // 6 per scan
  Eigen::MatrixXd information; // 6 x 6 blocks, the cell's part of the normal equations
};

class CovarianceEstimator {
public:
  explicit CovarianceEstimator(const JointSystem& joint);

  PoseUncertainty run(bool with_cuts) const;

private:
  bool held(Index scan) const { return joint_.holders[scan] == scan; }
  Matrix6d scaled(const Matrix6d& M) const { return scale_.asDiagonal() * M; }
  void add(const CellSystem& cell, const std::vector<Index>& at, Eigen::MatrixXd& H, Eigen::VectorXd& g) const;
  void invert();
  CellPull pullOf(Index begin, Index end) const;
  Matrix6d motionAlong(Index scan, Index with) const;
  Matrix6d groupMotion(Index scan) const { return motionAlong(scan, joint_.holders[scan]); }
  Block fitRows(Index holder) const;
  Matrix6d part(Index scan, Index other) const;
  std::vector<char> goingAlong(Index scan, Index against) const;
  Covariances covariances() const;
  Covariances informations() const;
  LooseCuts cuts() const;
  PairInformations pairInformations() const;
  std::map<std::vector<char>, std::pair<Index, Index>> bodies() const;
  Matrix6d unscaled(const Matrix6d& information) const
  {
    const Vector6d back = scale_.cwiseInverse();
    return back.asDiagonal() * information * back.asDiagonal();
  }
  Matrix6d acrossInformation(Index scan, const std::vector<char>& along) const;
  double fewCellsFactor(Index scan, const Vector6d& direction, const std::vector<CellPull>& pulls) const;
  Matrix6d covarianceOf(Index scan, const std::vector<CellPull>& pulls) const;

  const JointSystem& joint_;
  Vector6d scale_; // motions are rotation times size and translation
  Index count_, moving_ = 0;
  std::vector<Index> slots_;                                 // per scan, its place among those that can move, or -1
  Eigen::MatrixXd P_;                                        // inverse of their normal equations
  std::vector<Block, Eigen::aligned_allocator<Block>> fits_; // per scan, of its group
  std::vector<Matrix6d> pairs_;                              // per pair, sum over its cells
};

CovarianceEstimator::CovarianceEstimator(const JointSystem& joint)
    : joint_(joint), count_(joint.poses.size()), pairs_(joint.links.size(), Matrix6d::Zero())
{
  scale_ << Eigen::Vector3d::Constant(1.0 / joint.size), Eigen::Vector3d::Ones();
  for (Index i = 0; i < count_; ++i)
    slots_.push_back(held(i) ? -1 : moving_++);
  invert();
  for (const CellSystem& cell : joint_.cells)
    pairs_[cell.pair] += cell.system.H;
  fits_.resize(count_);
  for (Index i = 0; i < count_ && joint.fit && moving_ > 0; ++i)
    if (held(i))
      fits_[i] = fitRows(i);
}

// Adds the normal equations of a cell to those of the scans at the positions `at`, -1 = left out.
void CovarianceEstimator::add(const CellSystem& cell, const std::vector<Index>& at, Eigen::MatrixXd& H,
                              Eigen::VectorXd& g) const
{
  const PairLink& link = joint_.links[cell.pair];
  const std::array<Index, 2> position = {at[link.source], at[link.target]};
  const std::array<Matrix6d, 2> M = {scaled(link.jacobian.M_source), scaled(link.jacobian.M_target)};
  for (int r = 0; r < 2; ++r) {
    if (position[r] < 0)
      continue;
    g.segment<6>(6 * position[r]) += M[r] * cell.system.b;
    for (int c = 0; c < 2; ++c)
      if (position[c] >= 0)
        H.block<6, 6>(6 * position[r], 6 * position[c]) += M[r] * cell.system.H * M[c].transpose();
  }
}

void CovarianceEstimator::invert()
{
  constexpr double damping = 1e-7; // of the mean information: only what no match determines is held by it
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(6 * moving_, 6 * moving_);
  Eigen::VectorXd g = Eigen::VectorXd::Zero(6 * moving_);
  for (const CellSystem& cell : joint_.cells)
    add(cell, slots_, H, g);
  H.diagonal().array() += damping * std::max(1.0, H.trace() / std::max<Index>(1, H.rows()));
  const Eigen::LLT<Eigen::MatrixXd> solver(H);
  P_.resize(H.rows(), H.cols());
  forEachTask(moving_, joint_.threads, [&](Index k) {
    Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(6 * moving_, 6);
    unit.middleRows<6>(6 * k).setIdentity();
    P_.middleCols<6>(6 * k) = solver.solve(unit);
  });
}

// What changes the solution as leaving out the equations begin .. end - 1 would.
CellPull CovarianceEstimator::pullOf(Index begin, Index end) const
{
  CellPull result;
  std::set<Index> seers;
  for (Index k = begin; k < end; ++k)
    for (const Index scan : {joint_.links[joint_.cells[k].pair].source, joint_.links[joint_.cells[k].pair].target})
      if (!held(scan))
        seers.insert(scan);
  result.scans.assign(seers.begin(), seers.end());
  const Index n = result.scans.size();
  std::vector<Index> at(count_, -1);
  for (Index k = 0; k < n; ++k)
    at[result.scans[k]] = k;
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(6 * n, 6 * n), P(6 * n, 6 * n);
  result.pull = Eigen::VectorXd::Zero(6 * n);
  for (Index k = begin; k < end; ++k)
    add(joint_.cells[k], at, H, result.pull);
  for (Index r = 0; r < n; ++r)
    for (Index c = 0; c < n; ++c)
      P.block<6, 6>(6 * r, 6 * c) = P_.block<6, 6>(6 * slots_[result.scans[r]], 6 * slots_[result.scans[c]]);
  const Eigen::MatrixXd A = Eigen::MatrixXd::Identity(6 * n, 6 * n) - H * P;
  result.information = H;
  result.pull = A.partialPivLu().solve(result.pull).eval();
  return result;
}

// Motion of a scan that goes along with another one, as one body.
Matrix6d CovarianceEstimator::motionAlong(Index scan, Index with) const
{
  Matrix6d G = Matrix6d::Identity();
  G.bottomLeftCorner<3, 3>() = -skew(joint_.poses[scan].translation() - joint_.poses[with].translation()) / joint_.size;
  return G;
}

// From motions of all scans to that of a group, by least squares.
Block CovarianceEstimator::fitRows(Index holder) const
{
  Matrix6d sum = Matrix6d::Zero();
  Block rows = Block::Zero(6, 6 * moving_);
  for (Index i = 0; i < count_; ++i)
    if (joint_.holders[i] == holder) {
      const Matrix6d G = groupMotion(i);
      sum += G.transpose() * G;
      if (!held(i))
        rows.middleCols<6>(6 * slots_[i]) = G.transpose();
    }
  return sum.ldlt().solve(rows * P_);
}

// By how much the deviation along a direction grows because few cells tell the pose along it: what they disagree about
// says little then. Satterthwaite's degrees of freedom nu, and the quantile of Student's t at 99.5 % over that of Gauss,
// exp(2 / nu + 1.3 / nu^2) to 2 %.
double CovarianceEstimator::fewCellsFactor(Index scan, const Vector6d& direction,
                                           const std::vector<CellPull>& pulls) const
{
  double sum = 0.0, squares = 0.0;
  for (const CellPull& cell : pulls) {
    const Index n = cell.scans.size();
    Eigen::VectorXd x(6 * n);
    for (Index k = 0; k < n; ++k)
      x.segment<6>(6 * k) = P_.block<6, 6>(6 * slots_[cell.scans[k]], 6 * slots_[scan]) * direction;
    const double share = x.dot(cell.information * x);
    sum += share;
    squares += share * share;
  }
  const double cells = squares > 0.0 ? sum * sum / squares : 1.0;
  return std::exp(2.0 / cells + 1.3 / (cells * cells));
}

Matrix6d CovarianceEstimator::covarianceOf(Index scan, const std::vector<CellPull>& pulls) const
{
  const Block& fit = fits_[joint_.holders[scan]];
  const Matrix6d G = groupMotion(scan);
  Matrix6d to_holder = Matrix6d::Zero(), to_fit = Matrix6d::Zero();
  for (const CellPull& cell : pulls) {
    Vector6d own = Vector6d::Zero();
    for (std::size_t k = 0; k < cell.scans.size() && !held(scan); ++k)
      own += P_.block<6, 6>(6 * slots_[scan], 6 * slots_[cell.scans[k]]) * cell.pull.segment<6>(6 * k);
    to_holder += own * own.transpose();
    for (std::size_t k = 0; k < cell.scans.size() && joint_.fit; ++k)
      own -= G * (fit.middleCols<6>(6 * slots_[cell.scans[k]]) * cell.pull.segment<6>(6 * k));
    to_fit += own * own.transpose();
  }
  Matrix6d larger = to_holder.trace() > to_fit.trace() ? to_holder : to_fit;
  if (!held(scan)) {
    const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(larger);
    const Vector6d widest = solver.eigenvectors().col(5);
    const double factor = fewCellsFactor(scan, widest, pulls);
    larger += (factor * factor - 1.0) * solver.eigenvalues()[5] * widest * widest.transpose();
  }
  return scale_.asDiagonal() * larger * scale_.asDiagonal();
}

// Of the inverse of the normal equations; zero for holders, which do not move.
Matrix6d CovarianceEstimator::part(Index scan, Index other) const
{
  return held(scan) || held(other) ? Matrix6d(Matrix6d::Zero())
                                   : Matrix6d(P_.block<6, 6>(6 * slots_[scan], 6 * slots_[other]));
}

// Scans that move with the first rather than with the second if these are pulled apart where they are held least.
std::vector<char> CovarianceEstimator::goingAlong(Index scan, Index against) const
{
  const Matrix6d to_scan = motionAlong(scan, against);
  const auto response = [&](Index i) -> Matrix6d { return part(i, scan) - part(i, against) * to_scan.transpose(); };
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(response(scan) - to_scan * response(against));
  const Vector6d pull = solver.eigenvectors().col(5), away = response(against) * pull;
  const Vector6d own = response(scan) * pull - to_scan * away;
  std::vector<char> along(count_, 0);
  for (Index i = 0; i < count_; ++i)
    if (joint_.holders[i] == joint_.holders[scan]) {
      const Vector6d as_one = motionAlong(i, scan) * own,
                     relative = response(i) * pull - motionAlong(i, against) * away;
      along[i] = as_one.dot(relative) >= 0.5 * as_one.squaredNorm();
    }
  return along;
}

// About a scan of those that go along, by the matches between them and the others.
Matrix6d CovarianceEstimator::acrossInformation(Index scan, const std::vector<char>& along) const
{
  const auto seen = [&](Index i, const Matrix6d& M, const Matrix6d& H) -> Matrix6d {
    const Matrix6d rows = motionAlong(i, scan).transpose() * scaled(M);
    return rows * H * rows.transpose();
  };
  Matrix6d information = Matrix6d::Zero();
  for (std::size_t p = 0; p < pairs_.size(); ++p) {
    const PairLink& link = joint_.links[p];
    if (along[link.source] && !along[link.target])
      information += seen(link.source, link.jacobian.M_source, pairs_[p]);
    else if (along[link.target] && !along[link.source])
      information += seen(link.target, link.jacobian.M_target, pairs_[p]);
  }
  return unscaled(information);
}

Covariances CovarianceEstimator::informations() const
{
  Covariances informations(count_, Matrix6d::Zero());
  forEachTask(count_, joint_.threads, [&](Index i) {
    if (!held(i))
      informations[i] = acrossInformation(i, goingAlong(i, joint_.holders[i]));
  });
  return informations;
}

// Per body, the scans that are pulled apart.
std::map<std::vector<char>, std::pair<Index, Index>> CovarianceEstimator::bodies() const
{
  std::set<std::pair<Index, Index>> linked;
  for (const PairLink& link : joint_.links)
    linked.insert(std::minmax(link.source, link.target));
  const std::vector<std::pair<Index, Index>> pulled(linked.begin(), linked.end());
  std::vector<std::vector<char>> along =
      mapTasks(pulled.size(), joint_.threads, [&](Index k) { return goingAlong(pulled[k].first, pulled[k].second); });
  std::map<std::vector<char>, std::pair<Index, Index>> found;
  for (std::size_t k = 0; k < pulled.size(); ++k)
    if (along[k][pulled[k].first] && !along[k][pulled[k].second])
      found.emplace(std::move(along[k]), pulled[k]);
  return found;
}

LooseCuts CovarianceEstimator::cuts() const
{
  const auto found = bodies();
  LooseCuts cuts;
  for (const auto& [along, pulled] : found) {
    std::vector<char> opposite(count_), linked(count_, 0);
    for (Index i = 0; i < count_; ++i)
      opposite[i] = !along[i] && joint_.holders[i] == joint_.holders[pulled.first];
    if (opposite < along && found.find(opposite) != found.end()) // told already
      continue;
    LooseCut& cut = cuts.emplace_back();
    cut.about = pulled.first;
    cut.information = acrossInformation(cut.about, along);
    for (const PairLink& link : joint_.links)
      if (along[link.source] != along[link.target])
        linked[link.source] = linked[link.target] = 1;
    for (Index i = 0; i < count_; ++i) {
      if (along[i])
        cut.body.push_back(i);
      else if (opposite[i])
        cut.rest.push_back(i);
      if (linked[i])
        cut.linked.push_back(i);
    }
  }
  return cuts;
}

Covariances CovarianceEstimator::covariances() const
{
  std::vector<Index> begins;
  const Index n = joint_.cells.size();
  for (Index k = 0; k < n; ++k)
    if (k == 0 || joint_.cells[k].cell != joint_.cells[k - 1].cell)
      begins.push_back(k);
  begins.push_back(n);
  const std::vector<CellPull> pulls =
      mapTasks(begins.size() - 1, joint_.threads, [&](Index c) { return pullOf(begins[c], begins[c + 1]); });
  Covariances covariances(count_);
  forEachTask(count_, joint_.threads, [&](Index i) { covariances[i] = covarianceOf(i, pulls); });
  return covariances;
}

PairInformations CovarianceEstimator::pairInformations() const
{
  // Sums of one pair: of its cells' information, and of the squares of what they pull.
  struct Sums {
    Matrix6d H = Matrix6d::Zero(), squares = Matrix6d::Zero();
    Vector6d pull = Vector6d::Zero(); // of the present cell
    std::array<std::int32_t, 3> cell = {};
    void close()
    {
      squares += pull * pull.transpose();
      pull.setZero();
    }
  };
  std::map<std::pair<Index, Index>, Sums> all;
  for (const CellSystem& cell : joint_.cells) {
    const PairLink& link = joint_.links[cell.pair];
    Sums& sums = all[std::minmax(link.source, link.target)];
    if (sums.cell != cell.cell)
      sums.close();
    sums.cell = cell.cell;
    const Matrix6d M = scaled(link.source > link.target ? link.jacobian.M_source : link.jacobian.M_target);
    sums.H += M * cell.system.H * M.transpose();
    sums.pull += M * cell.system.b;
  }
  PairInformations informations;
  for (auto& [pair, sums] : all) {
    sums.close();
    Matrix6d H = sums.H;
    H.diagonal().array() += 1e-9 * H.trace(); // directions without information say nothing of the variance
    const double variance = H.ldlt().solve(sums.squares).trace() / 6.0; // mean over the six motions
    if (variance > 0.0)
      informations.push_back({pair.first, pair.second, unscaled(sums.H) / variance});
  }
  return informations;
}

PoseUncertainty CovarianceEstimator::run(bool with_cuts) const
{
  return {covariances(), informations(), with_cuts ? cuts() : LooseCuts(), pairInformations()};
}
} // namespace

PoseUncertainty findUncertainty(const JointSystem& joint, bool cuts) { return CovarianceEstimator(joint).run(cuts); }
} // namespace fresco::registration
