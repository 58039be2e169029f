// SPDX-License-Identifier: BSD-3-Clause
#include "cameras/camera_adjustment.h"
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/rigid_motion.h>
#include <fresco/core/robust_weights.h>
#include <fresco/core/statistics.h>
#include <map>
namespace fresco::texture {
namespace {
constexpr int shared_count = 11; // mount: 3 turn, 3 shift; focal, cx, cy, k1, k2
constexpr int pose_count = 6;    // 3 turn, 3 shift

using Vector6 = Eigen::Matrix<double, 6, 1>;
using SharedVector = Eigen::Matrix<double, shared_count, 1>;

Eigen::Isometry3d motion(const Vector6& x)
{
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = rotation(x.head<3>());
  T.translation() = x.tail<3>();
  return T;
}

CameraModel corrected(CameraModel camera, const SharedVector& x)
{
  camera.fx *= std::exp(x[6]);
  camera.fy *= std::exp(x[6]);
  camera.cx += x[7] * camera.width;
  camera.cy += x[8] * camera.width;
  camera.k1 += x[9];
  camera.k2 += x[10];
  return camera;
}

/// Pixel of a point and its derivatives.
struct Projection {
  Eigen::Vector2d pixel;
  Eigen::Matrix<double, 2, 3> by_point; ///< of the mesh's frame
  Eigen::Matrix<double, 2, shared_count> by_shared;
};

Projection projectAll(const CameraState& state, int view, const Eigen::Vector3d& point)
{
  Projection out;
  const CameraModel& camera = state.cameras[state.group[view]];
  const Eigen::Isometry3d& T = state.T_camera_mesh[view];
  const Eigen::Vector3d q = T * point;
  out.pixel = project(camera, q);
  Eigen::Matrix<double, 2, 3> by_camera_point;
  const double step = 1e-5 * q.z();
  for (int k = 0; k < 3; ++k)
    by_camera_point.col(k) =
        (project(camera, q + step * Eigen::Vector3d::Unit(k)) - project(camera, q - step * Eigen::Vector3d::Unit(k))) /
        (2 * step);
  out.by_point = by_camera_point * T.linear();
  out.by_shared.leftCols<3>() = -by_camera_point * skew(q) * state.R_part_view[view];
  out.by_shared.middleCols<3>(3) = by_camera_point * state.R_part_view[view];
  for (int k = 6; k < shared_count; ++k) {
    const SharedVector x = 1e-5 * SharedVector::Unit(k);
    out.by_shared.col(k) = (project(corrected(camera, x), q) - project(corrected(camera, -x), q)) / 2e-5;
  }
  return out;
}

/// Where the ray through a pixel meets the match's plane.
Eigen::Vector3d onPlane(const PhotoMatch& match, const CameraModel& camera, const Eigen::Isometry3d& T)
{
  const Eigen::Vector3d center = T.linear().transpose() * -T.translation(),
                        ray = T.linear().transpose() * unproject(camera, match.pixel_from);
  return center + match.normal.dot(match.point - center) / match.normal.dot(ray) * ray;
}

Eigen::Vector2d residual(const PhotoMatch& match, const CameraState& state)
{
  const Eigen::Vector3d point = onPlane(match, state.cameras[state.group[match.from]], state.T_camera_mesh[match.from]);
  const Eigen::Vector3d q = state.T_camera_mesh[match.to] * point;
  constexpr double out_of_sight = 1e3; // pixels
  if (!(q.z() > 1e-6) || !point.allFinite())
    return Eigen::Vector2d::Constant(out_of_sight);
  return project(state.cameras[state.group[match.to]], q) - match.pixel_to;
}

class Adjustment {
public:
  Adjustment(const std::vector<PhotoMatch>& matches, const CameraState& initial, const AdjustmentPrior& prior,
             int threads)
      : matches_(matches), initial_(initial), groups_(initial.cameras.size()),
        poses_(initial.pose.empty() ? 0 : 1 + *std::max_element(initial.pose.begin(), initial.pose.end())),
        threads_(threads)
  {
    SharedVector shared;
    shared << Eigen::Vector3d::Constant(prior.mount_turn), Eigen::Vector3d::Constant(prior.mount_shift), prior.focal,
        prior.center, prior.center, prior.distortion, 0.5 * prior.distortion;
    Vector6 pose;
    pose << Eigen::Vector3d::Constant(prior.pose_turn), Eigen::Vector3d::Constant(prior.pose_shift);
    sigma_.resize(size());
    constexpr double fixed = 1e-6; // far below a pixel
    for (int g = 0; g < groups_; ++g) {
      sigma_.segment<shared_count>(g * shared_count) = shared;
      if (initial.fixed_lens[g])
        sigma_.segment<shared_count - pose_count>(g * shared_count + pose_count).setConstant(fixed);
    }
    sigma_.tail(poses_ * pose_count) = pose.replicate(poses_, 1);
    x_ = Eigen::VectorXd::Zero(size());
  }

  /// Each pass judges anew which matches are wrong.
  CameraState run()
  {
    constexpr int passes = 3;
    CameraState state = stateOf(x_);
    for (int pass = 0; pass < passes; ++pass) {
      scale_ = std::max(exact_pixels, 1.5 * median(matchErrors(matches_, state)));
      descend(state);
    }
    return state;
  }

private:
  int size() const { return groups_ * shared_count + poses_ * pose_count; }
  int poseAt(int view) const { return groups_ * shared_count + initial_.pose[view] * pose_count; }

  /// Corrections of the initial cameras: turn before shift and mount after pose, T = part * mount * pose * view.
  CameraState stateOf(const Eigen::VectorXd& x) const
  {
    CameraState state = initial_;
    for (int g = 0; g < groups_; ++g)
      state.cameras[g] = corrected(initial_.cameras[g], x.segment<shared_count>(g * shared_count));
    for (std::size_t v = 0; v < initial_.group.size(); ++v) {
      const Eigen::Matrix3d& R = initial_.R_part_view[v];
      state.T_camera_mesh[v] =
          R * (motion(x.segment<pose_count>(initial_.group[v] * shared_count)) *
               motion(x.segment<pose_count>(poseAt(v))) * (R.transpose() * initial_.T_camera_mesh[v]));
    }
    return state;
  }

  double costOf(const CameraState& state, const Eigen::VectorXd& x) const
  {
    const double square = scale_ * scale_;
    const double errors = parallelSum(matches_.size(), threads_, 0.0, [&](Index i) {
      return square * std::log1p(residual(matches_[i], state).squaredNorm() / square);
    });
    return errors + x.cwiseQuotient(sigma_).squaredNorm();
  }

  void descend(CameraState& state)
  {
    constexpr double least_gain = 1e-4; // relative, of the cost: what is left is below the scatter of the matches
    double damping = 1e-4, cost = costOf(state, x_), before = 0;
    do {
      before = cost;
      linearize(state);
      while (damping < 1e6 && !tryStep(damping, state, cost))
        damping *= 10;
      damping = std::max(1e-8, damping / 10);
    } while (before - cost > least_gain * before);
  }

  /// @return false, with nothing changed, if the step does not lower the cost
  bool tryStep(double damping, CameraState& state, double& cost)
  {
    Eigen::SparseMatrix<double> H = H_;
    H.diagonal() += damping * H_.diagonal();
    const Eigen::VectorXd next = x_ - Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(H).solve(gradient_);
    if (!next.allFinite())
      return false;
    const CameraState next_state = stateOf(next);
    const double next_cost = costOf(next_state, next);
    if (!(next_cost < cost))
      return false;
    x_ = next;
    state = next_state;
    cost = next_cost;
    return true;
  }

  /// Derivatives of one match's two errors: mount and lens of the camera it is from and of the one it is found in, then
  /// the poses of both.
  struct Row {
    Eigen::Matrix<double, 2, 2 * (shared_count + pose_count)> J;
    Eigen::Vector2d r;
    double weight = 0; ///< 0 = left out
  };

  void linearize(const CameraState& state)
  {
    std::vector<Row> rows(matches_.size());
    parallelFor(rows.size(), threads_, [&](Index i) { rows[i] = rowOf(matches_[i], state); });
    Blocks blocks;
    gradient_ = x_.cwiseQuotient(sigma_.cwiseAbs2());
    for (std::size_t i = 0; i < rows.size(); ++i)
      if (rows[i].weight > 0)
        addRow(matches_[i], rows[i], blocks);
    assemble(blocks);
  }

  /// Of the normal equations, by their first row and column: few pairs of photographs show the same places.
  using Blocks = std::map<std::pair<int, int>, Eigen::MatrixXd>;

  void assemble(const Blocks& blocks)
  {
    std::vector<Eigen::Triplet<double>> entries;
    for (int i = 0; i < size(); ++i)
      entries.emplace_back(i, i, 1 / (sigma_[i] * sigma_[i]));
    for (const auto& [at, block] : blocks)
      for (Index j = 0; j < block.cols(); ++j)
        for (Index i = 0; i < block.rows(); ++i)
          entries.emplace_back(at.first + i, at.second + j, block(i, j));
    H_.resize(size(), size());
    H_.setFromTriplets(entries.begin(), entries.end());
  }

  /// The corrections of a pose stand before those of the mount; both are small, so that their derivatives agree to
  /// first order.
  Row rowOf(const PhotoMatch& match, const CameraState& state) const
  {
    Row row;
    row.r = residual(match, state);
    if (!(row.r.norm() < 100))
      return row;
    const int from = state.group[match.from];
    const Eigen::Vector3d point = onPlane(match, state.cameras[from], state.T_camera_mesh[match.from]);
    const Projection a = projectAll(state, match.from, point), b = projectAll(state, match.to, point);
    Eigen::Matrix3d M;
    M << a.by_point, match.normal.transpose();
    const Eigen::Matrix<double, 2, 3> transfer = b.by_point * M.inverse();
    const Eigen::Matrix<double, 2, shared_count> by_from = -transfer.leftCols<2>() * a.by_shared;
    row.J << by_from, b.by_shared, by_from.leftCols<pose_count>(), b.by_shared.leftCols<pose_count>();
    row.weight = row.J.allFinite() ? cauchyWeight(row.r.squaredNorm() / (scale_ * scale_)) : 0;
    return row;
  }

  void addRow(const PhotoMatch& match, const Row& row, Blocks& blocks)
  {
    const int at[4] = {initial_.group[match.from] * shared_count, initial_.group[match.to] * shared_count,
                       poseAt(match.from), poseAt(match.to)};
    const int column[4] = {0, shared_count, 2 * shared_count, 2 * shared_count + pose_count};
    const int count[4] = {shared_count, shared_count, pose_count, pose_count};
    const Eigen::Matrix<double, 2 * (shared_count + pose_count), 2> weighted = row.weight * row.J.transpose();
    const Eigen::Matrix<double, 2 * (shared_count + pose_count), 2 * (shared_count + pose_count)> JTJ =
        weighted * row.J;
    const Eigen::Matrix<double, 2 * (shared_count + pose_count), 1> JTr = weighted * row.r;
    for (int i = 0; i < 4; ++i) {
      gradient_.segment(at[i], count[i]) += JTr.segment(column[i], count[i]);
      for (int j = 0; j < 4; ++j) {
        const auto entry = blocks.try_emplace({at[i], at[j]}, Eigen::MatrixXd::Zero(count[i], count[j])).first;
        entry->second += JTJ.block(column[i], column[j], count[i], count[j]);
      }
    }
  }

  const std::vector<PhotoMatch>& matches_;
  const CameraState& initial_;
  int groups_, poses_, threads_;
  double scale_ = 1; ///< pixels: errors beyond count less and less
  Eigen::VectorXd sigma_, x_, gradient_;
  Eigen::SparseMatrix<double> H_;
};
} // namespace

std::vector<double> matchErrors(const std::vector<PhotoMatch>& matches, const CameraState& state)
{
  std::vector<double> errors;
  for (const PhotoMatch& match : matches)
    errors.push_back(residual(match, state).norm());
  return errors;
}

CameraState adjustCameras(const std::vector<PhotoMatch>& matches, const CameraState& initial,
                          const AdjustmentPrior& prior, int threads)
{
  return Adjustment(matches, initial, prior, threads).run();
}
} // namespace fresco::texture
