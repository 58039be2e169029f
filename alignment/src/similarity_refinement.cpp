// SPDX-License-Identifier: BSD-3-Clause
#include "similarity_refinement.h"
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <fresco/core/rigid_motion.h>
#include <fresco/core/robust_weights.h>
#include <fresco/core/statistics.h>
#include <optional>
namespace fresco::alignment {
namespace {
using Eigen::Vector3d;
using Vector7 = Eigen::Matrix<double, 7, 1>;

/// The plane of the surface next to a place.
struct Foot {
  Index point = 0;
  Vector3d normal;
  double flatness = 1; ///< 0..1
  double height = 0;   ///< of the place over the plane, length
};

/// @param reach length along the surface and over it
std::optional<Foot> footOf(const ScanSurface& surface, const Vector3d& place, double reach)
{
  constexpr double flat = 0.01; // surface variation of a disc that is off its plane by a tenth of its extent
  const registration::SurfacePoints& level = surface.level();
  const Neighbor nearest =
      level.tree->nearest(place.cast<float>(), static_cast<float>(std::hypot(reach, surface.grain())));
  if (nearest.index < 0 || level.surface_variation[nearest.index] > registration::variation_limit)
    return {};
  const Vector3d normal = level.normals.col(nearest.index).cast<double>();
  if (!(normal.squaredNorm() > 0))
    return {};
  const double height = normal.dot(place - level.points.col(nearest.index).cast<double>());
  const double bend = level.surface_variation[nearest.index] / flat;
  return Foot{nearest.index, normal, 1 / (1 + bend * bend), height};
}

/// One step of Gauss and Newton, at the end of the range.
Similarity improved(const SparseModel& model, const std::vector<Index>& points, const ScanSurface& surface,
                    const RefinementRange& range, const Similarity& T)
{
  Eigen::Matrix<double, 7, 7> H = Eigen::Matrix<double, 7, 7>::Zero();
  Vector7 b = Vector7::Zero();
  const double reach = T.scale * range.end;
  for (const Index i : points) {
    const Vector3d arm = T.scale * (T.R * model.points.col(i));
    const auto foot = footOf(surface, arm + T.t, reach);
    if (!foot || std::abs(foot->height) >= reach)
      continue;
    const double share = foot->height / reach, weight = (range.flat ? foot->flatness : 1) * tukeyWeight(share * share);
    Vector7 J;
    J << arm.cross(foot->normal), foot->normal, foot->normal.dot(arm);
    H += weight * J * J.transpose();
    b += weight * foot->height * J;
  }
  const double unit = T.scale * T.scale;
  Vector7 damping; // where nothing holds a direction it stays
  damping << Vector3d::Constant(unit), Vector3d::Ones(), unit;
  H.diagonal() += 1e-3 * damping;
  const Vector7 x = H.ldlt().solve(-b);
  if (!x.allFinite() || x.head<3>().norm() > 0.5 || std::abs(x[6]) > 0.5)
    return T;
  return {T.scale * std::exp(x[6]), rotation(x.head<3>()) * T.R, T.t + x.segment<3>(3)};
}

double correlation(const Eigen::Matrix3Xf& a, const Eigen::Matrix3Xf& b)
{
  const Eigen::Matrix3Xf x = a.colwise() - a.rowwise().mean(), y = b.colwise() - b.rowwise().mean();
  const double squares = double(x.squaredNorm()) * double(y.squaredNorm());
  return squares > 0 ? x.cwiseProduct(y).sum() / std::sqrt(squares) : 0;
}
} // namespace

Similarity refineSimilarity(const SparseModel& model, const std::vector<Index>& points, const ScanSurface& surface,
                            const RefinementRange& range, const Similarity& T_surface_model)
{
  constexpr double shrink = 0.75;
  Similarity T = T_surface_model;
  for (double tolerance = range.start; tolerance > range.end; tolerance *= shrink)
    T = improved(model, points, surface, {tolerance, tolerance, range.flat}, T);
  for (int step = 0; step < settling; ++step)
    T = improved(model, points, surface, range, T);
  return T;
}

double noiseOf(const SparseModel& model, const ScanSurface& surface, const Similarity& T, double range)
{
  for (;;) {
    std::vector<double> heights;
    for (Index i = 0; i < model.points.cols(); ++i)
      if (const auto foot = footOf(surface, T * model.points.col(i), T.scale * range);
          foot && std::abs(foot->height) < T.scale * range)
        heights.push_back(std::abs(foot->height) / T.scale);
    if (heights.empty())
      return range / 3;
    const double next = 3 * mad_to_sigma * median(heights);
    if (next > 0.98 * range)
      return range / 3;
    range = next;
  }
}

PlaceCheck checkPlace(const SparseModel& model, const ScanSurface& surface, const Similarity& T, double tolerance)
{
  PlaceCheck check;
  const double reach = T.scale * tolerance, behind = reach + 2 * surface.grain();
  std::vector<Index> supported, feet;
  double squares = 0;
  Index blocked = 0;
  for (Index i = 0; i < model.points.cols(); ++i) {
    const Vector3d place = T * model.points.col(i), eye = T * model.eyes.col(i);
    const double distance = (place - eye).norm();
    const Vector3d before = eye + std::max(0.0, 1 - behind / distance) * (place - eye);
    if (surface.isBlocked(eye.cast<float>(), before.cast<float>())) {
      ++blocked;
      continue;
    }
    const auto foot = footOf(surface, place, reach);
    if (!foot || std::abs(foot->height) > reach)
      continue;
    squares += foot->height * foot->height;
    supported.push_back(i);
    feet.push_back(foot->point);
  }
  const double count = model.points.cols();
  check.support = supported.size() / count;
  check.blocked = blocked / count;
  check.rms = supported.empty() ? 0 : std::sqrt(squares / supported.size()) / T.scale;
  if (surface.level().colors.cols() > 0 && supported.size() >= fewest_known)
    check.colors = correlation(model.colors(Eigen::all, supported), surface.level().colors(Eigen::all, feet));
  return check;
}
} // namespace fresco::alignment
