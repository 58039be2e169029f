// SPDX-License-Identifier: BSD-3-Clause
#include "photographs/view_parts.h"
#include "photographs/distance_field.h"
#include "photographs/photo_store.h"
#include <algorithm>
#include <cmath>
namespace fresco::texture {
namespace {
/// As many pixels per radian in the middle as the panorama has.
CameraModel cubeSide(const CameraModel& panorama)
{
  constexpr double half_width = 1.25; // of the plane z = 1: the next side is met at 1, well inside of the border
  CameraModel camera;
  camera.fx = camera.fy = panorama.fx;
  camera.width = camera.height = std::max<int>(3, std::ceil(2 * half_width * panorama.fx));
  camera.cx = camera.cy = 0.5 * camera.width;
  return camera;
}

/// Axes of the sides' cameras: around, then up and down.
std::vector<Eigen::Matrix3d> cubeRotations()
{
  std::vector<Eigen::Matrix3d> out(6);
  for (int k = 0; k < 4; ++k) {
    const double c = k % 2 == 0 ? 1 - k : 0, s = k % 2 == 1 ? 2 - k : 0;
    out[k] << c, 0, -s, 0, 1, 0, s, 0, c;
  }
  out[4] << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  out[5] << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  return out;
}
} // namespace

std::vector<ViewPart> partsOf(const std::vector<TextureView>& views)
{
  std::vector<ViewPart> parts;
  for (const TextureView& view : views) {
    const int number = &view - views.data();
    if (view.camera.projection != CameraProjection::spherical)
      parts.push_back({&view, number, view.camera});
    else
      for (const Eigen::Matrix3d& R : cubeRotations())
        parts.push_back({&view, number, cubeSide(view.camera), R});
  }
  return parts;
}

Image wrapPanorama(const Image& panorama)
{
  Image out(panorama.width + 2 * interpolation_reach, panorama.height);
  cv::Mat to(out.height, out.width, CV_8UC3, out.data.data());
  cv::copyMakeBorder(matOf(panorama), to, 0, 0, interpolation_reach, interpolation_reach, cv::BORDER_WRAP);
  return out;
}

Image cutPanorama(const Image& wrapped, const ViewPart& part)
{
  const CameraModel& panorama = part.given->camera;
  Image out(part.camera.width, part.camera.height);
  const Eigen::Matrix3d R_view_part = part.R_part_view.transpose();
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) {
      Eigen::Vector3d ray = R_view_part * unproject(part.camera, {x + 0.5, y + 0.5});
      if (part.given->mirrored)
        ray.x() = -ray.x();
      const Eigen::Vector2f at = project(panorama, ray).cast<float>();
      storeColor(samplePhoto(wrapped, at.x() + interpolation_reach, at.y()), out.pixel(x, y));
    }
  return out;
}
} // namespace fresco::texture
