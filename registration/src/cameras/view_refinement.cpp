// SPDX-License-Identifier: BSD-3-Clause
#include "cameras/view_refinement.h"
#include "batches.h"
#include "cameras/photograph_matches.h"
#include <Eigen/Cholesky>
#include <cmath>
#include <fresco/core/rigid_motion.h>
#include <fresco/core/statistics.h>
#include <opencv2/imgproc.hpp>
#include <optional>
namespace fresco::registration {
namespace {
using Eigen::Vector2d;
using Eigen::Vector3d;
using Vector7 = Eigen::Matrix<double, 7, 1>;
constexpr int window = 8; // pixels to either side

/// A photograph as a pinhole camera of about the resolution of the scans would have taken it.
struct Pictured {
  Index view = 0;
  CameraModel camera;
  cv::Mat1f gray;
};

/// A place of the surface and where a photograph shows it.
struct Sight {
  Index view = 0;
  Vector3d place;
  Vector2d at; ///< on the plane z = 1
};

Pictured pictured(const CameraSet& set, Index v, const Image& photograph, double focal)
{
  const CameraModel& from = set.cameras[set.views[v].camera];
  Pictured out;
  out.view = v;
  const double scale = std::min(1.0, focal / from.fx);
  out.camera.width = std::max(1, static_cast<int>(from.width * scale));
  out.camera.height = std::max(1, static_cast<int>(from.height * scale));
  out.camera.fx = out.camera.fy = from.fx * scale;
  out.camera.cx = from.cx * scale;
  out.camera.cy = from.cy * scale;
  cv::Mat small;
  cv::resize(cv::Mat(grayOf(photograph)), small, {out.camera.width, out.camera.height}, 0, 0, cv::INTER_AREA);
  cv::Mat1f x(small.size()), y(small.size());
  for (int row = 0; row < small.rows; ++row)
    for (int column = 0; column < small.cols; ++column) {
      const Vector2d at = project(from, unproject(out.camera, {column + 0.5, row + 0.5}));
      x(row, column) = static_cast<float>(at.x() / from.width * small.cols - 0.5);
      y(row, column) = static_cast<float>(at.y() / from.height * small.rows - 0.5);
    }
  cv::Mat straight;
  cv::remap(small, straight, x, y, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  straight.convertTo(out.gray, CV_32F);
  return out;
}

using Patch = Eigen::Matrix<float, 2 * window + 1, 2 * window + 1>;

/// @param at its middle, in the coordinates of cv: (0, 0) is the middle of the first pixel
bool takePatch(const cv::Mat1f& image, const cv::Point2f& at, int border, Patch& patch)
{
  const int x = cvFloor(at.x), y = cvFloor(at.y), reach = window + border + 1;
  if (x < reach || y < reach || x + reach + 1 >= image.cols || y + reach + 1 >= image.rows)
    return false;
  const float a = at.x - x, b = at.y - y;
  for (int r = -window; r <= window; ++r)
    for (int c = -window; c <= window; ++c) {
      const float *const up = &image(y + r, x + c), *const down = &image(y + r + 1, x + c);
      patch(r + window, c + window) = (1 - b) * ((1 - a) * up[0] + a * up[1]) + b * ((1 - a) * down[0] + a * down[1]);
    }
  return true;
}

/// Where `image` shows a patch, from `at` on.
std::optional<cv::Point2f> findPatch(const cv::Mat1f& image, Patch wanted, cv::Point2f at)
{
  constexpr float farthest = 6, least_likeness = 0.8f, small = 0.005f; // pixels, correlation, pixels
  constexpr int rounds = 30;
  const cv::Point2f start = at;
  wanted.array() -= wanted.mean();
  for (int k = 0; k < rounds; ++k) {
    Patch here, left, right, up, down;
    if (!takePatch(image, at, 1, here) || !takePatch(image, at - cv::Point2f(1, 0), 0, left) ||
        !takePatch(image, at + cv::Point2f(1, 0), 0, right) || !takePatch(image, at - cv::Point2f(0, 1), 0, up) ||
        !takePatch(image, at + cv::Point2f(0, 1), 0, down))
      return {};
    here.array() -= here.mean();
    const float product = here.cwiseProduct(wanted).sum(), squares = wanted.squaredNorm();
    const Patch x = 0.5f * (right - left), y = 0.5f * (down - up), rest = here - product / squares * wanted;
    Eigen::Matrix2f H;
    H << x.squaredNorm(), x.cwiseProduct(y).sum(), x.cwiseProduct(y).sum(), y.squaredNorm();
    const Eigen::Vector2f step = H.ldlt().solve(Eigen::Vector2f(x.cwiseProduct(rest).sum(), y.cwiseProduct(rest).sum()));
    if (!step.allFinite())
      return {};
    at -= cv::Point2f(step.x(), step.y());
    if (std::hypot(at.x - start.x, at.y - start.y) > farthest)
      return {};
    if (step.norm() < small)
      return product > least_likeness * std::sqrt(squares * here.squaredNorm()) ? std::optional(at) : std::nullopt;
  }
  return {};
}

std::vector<Sight> findSights(const CameraSet& set, const Pictured& picture, const SurfacePainter& painter,
                              const Similarity& T)
{
  constexpr int most = 150;
  constexpr double quality = 0.02, apart = window;
  Eigen::Isometry3d pose = set.views[picture.view].T_camera_world; // camera from surface, in the surface's unit
  pose.linear() = pose.linear() * T.R.transpose();
  pose.translation() = -(pose.linear() * (T * set.views[picture.view].center()));
  const SurfaceView drawn = painter.draw(picture.camera, pose);
  cv::Mat covered;
  cv::erode(drawn.depth > 0, covered, {}, {-1, -1}, window, cv::BORDER_CONSTANT, cv::Scalar(0));
  std::vector<cv::Point2f> corners;
  cv::goodFeaturesToTrack(drawn.gray, corners, most, quality, apart, covered);
  cv::Mat1f gray;
  drawn.gray.convertTo(gray, CV_32F);
  std::vector<Sight> sights;
  for (const cv::Point2f& corner : corners) {
    Patch patch;
    if (!takePatch(gray, corner, 0, patch))
      continue;
    const auto found = findPatch(picture.gray, patch, corner);
    if (!found)
      continue;
    const Vector3d beam = unproject(picture.camera, {corner.x + 0.5, corner.y + 0.5});
    const float z = drawn.depth(static_cast<int>(corner.y + 0.5f), static_cast<int>(corner.x + 0.5f));
    sights.push_back({picture.view, pose.inverse() * (z * beam),
                      unproject(picture.camera, {found->x + 0.5, found->y + 0.5}).head<2>()});
  }
  return sights;
}

/// One step of Gauss and Newton with Tukey's biweight.
Similarity improved(const CameraSet& set, const std::vector<Sight>& sights, const Similarity& T, const Vector3d& middle)
{
  std::vector<Vector2d> errors;
  std::vector<Eigen::Matrix<double, 2, 7>> slopes;
  std::vector<double> sizes;
  for (const Sight& sight : sights) {
    const Eigen::Isometry3d& pose = set.views[sight.view].T_camera_world;
    const Vector3d own = T.inverse() * sight.place, arm = own - middle, p = pose * own;
    Eigen::Matrix<double, 3, 7> moved; // of the place, in the cameras' frame: turned, shifted, scaled
    moved << 0, arm.z(), -arm.y(), 1, 0, 0, arm.x(), -arm.z(), 0, arm.x(), 0, 1, 0, arm.y(), arm.y(), -arm.x(), 0, 0, 0, 1,
        arm.z();
    Eigen::Matrix<double, 2, 3> seen;
    seen << 1 / p.z(), 0, -p.x() / (p.z() * p.z()), 0, 1 / p.z(), -p.y() / (p.z() * p.z());
    errors.push_back(p.head<2>() / p.z() - sight.at);
    slopes.push_back(seen * pose.linear() * moved);
    sizes.push_back(errors.back().norm());
  }
  const double reach = 4 * median(std::vector<double>(sizes)) + 1e-12;
  Eigen::Matrix<double, 7, 7> H = Eigen::Matrix<double, 7, 7>::Zero();
  Vector7 b = Vector7::Zero();
  for (std::size_t i = 0; i < sights.size(); ++i) {
    const double weight = std::pow(std::max(0.0, 1 - std::pow(sizes[i] / reach, 2)), 2);
    H += weight * slopes[i].transpose() * slopes[i];
    b += weight * slopes[i].transpose() * errors[i];
  }
  const Vector7 x = H.ldlt().solve(-b);
  if (!x.allFinite() || x.head<3>().norm() > 0.1 || std::abs(x[6]) > 0.1)
    return T;
  Similarity step; // own place -> better one
  step.scale = std::exp(x[6]);
  step.R = rotation(x.head<3>());
  step.t = middle + x.segment<3>(3) - step.scale * (step.R * middle);
  return T * step.inverse();
}
} // namespace

ViewedSimilarity refineByViews(const CameraSet& set, const SurfacePainter& painter, const Similarity& T_surface_cameras,
                               const CameraAlignmentOptions& options, const Progress& progress)
{
  constexpr Index most_photographs = 60, fewest = 100; // patches: 15 for each of the seven numbers
  constexpr int rounds = 3, steps = 8;
  const Index count = set.views.size(), used = std::min(count, most_photographs);
  std::vector<Pictured> pictures(used);
  std::vector<std::vector<Sight>> found(used);
  ViewedSimilarity result{T_surface_cameras, 0};
  Vector3d middle = Vector3d::Zero();
  for (Index k = 0; k < used; ++k)
    middle += set.views[k * count / used].center() / used;
  for (int round = 0; round < rounds; ++round) {
    const Progress part = subProgress(progress, double(round) / rounds, (round + 1.0) / rounds);
    parallelBatches(used, options.threads, part, "photographs", [&](Index k) {
      const Index v = k * count / used;
      if (round == 0)
        pictures[k] = pictured(set, v, options.photograph(v), painter.focal());
      found[k] = findSights(set, pictures[k], painter, result.T_surface_cameras);
    });
    std::vector<Sight> sights;
    for (const auto& some : found)
      sights.insert(sights.end(), some.begin(), some.end());
    if (static_cast<Index>(sights.size()) < fewest)
      return {T_surface_cameras, 0};
    for (int step = 0; step < steps; ++step)
      result.T_surface_cameras = improved(set, sights, result.T_surface_cameras, middle);
    result.patches = sights.size();
  }
  return result;
}
} // namespace fresco::registration
