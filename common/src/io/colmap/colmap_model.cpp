// SPDX-License-Identifier: BSD-3-Clause
#include "io/colmap/colmap_model.h"
#include "io/colmap/byte_reader.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/poses.h>
#include <fresco/core/require.h>
#include <fresco/io/file.h>
#include <map>
namespace fresco::io {
CameraModel makeCamera(const LensModel& lens, std::uint64_t width, std::uint64_t height, const std::vector<double>& p,
                       const std::string& where)
{
  if (p.size() != lens.parameters.size())
    fail(where, concat("camera model ", lens.name, " has ", lens.parameters.size(), " parameters, not ", p.size()));
  if (!std::all_of(p.begin(), p.end(), [](double value) { return std::isfinite(value); }))
    fail(where, "a camera parameter is not finite");
  if (width < 1 || height < 1 || width > 1000000 || height > 1000000)
    fail(where, concat("an image of ", width, "x", height, " pixels"));
  CameraModel camera;
  camera.projection = lens.projection;
  camera.width = static_cast<int>(width);
  camera.height = static_cast<int>(height);
  for (std::size_t i = 0; i < p.size(); ++i)
    camera.*lens.parameters[i] = p[i];
  if (lens.parameters[1] != &CameraModel::fy)
    camera.fy = camera.fx;
  try {
    validateCamera(camera);
  } catch (const std::invalid_argument& error) {
    fail(where, error.what());
  }
  return camera;
}

Eigen::Isometry3d makePose(const double (&q)[4], const double (&t)[3], const std::string& where)
{
  const Eigen::Quaterniond rotation(q[0], q[1], q[2], q[3]);
  const Eigen::Vector3d translation(t[0], t[1], t[2]);
  if (!(rotation.coeffs().allFinite() && rotation.norm() > 1e-6 && rotation.coeffs().cwiseAbs().maxCoeff() < 1e6 &&
        isInReach(translation)))
    fail(where, "the pose is not finite, too far away or has no rotation");
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = rotation.normalized().toRotationMatrix();
  T.translation() = translation;
  return T;
}

CameraSet joinEntries(const std::string& path, const std::vector<CameraEntry>& cameras, std::vector<ImageEntry> images)
{
  CameraSet set;
  std::map<std::uint64_t, int> numbers;
  for (const CameraEntry& camera : cameras) {
    numbers[camera.id] = static_cast<int>(set.cameras.size());
    set.cameras.push_back(camera.model);
  }
  if (images.empty())
    fail(path, "no image in it");
  std::stable_sort(images.begin(), images.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  for (const ImageEntry& image : images) {
    const auto camera = numbers.find(image.camera);
    if (camera == numbers.end())
      fail(path, concat("image ", image.id, " names camera ", image.camera, ", which is not there"));
    if (image.name.empty())
      fail(path, concat("image ", image.id, " has no name"));
    fileBelow(path, image.name); // photographs lie in the folder that they are looked for in
    set.views.push_back({image.name, camera->second, image.T_camera_world});
  }
  return set;
}

std::vector<CameraEntry> readCamerasBinary(const std::string& path)
{
  ByteReader bytes(path);
  std::vector<CameraEntry> cameras;
  for (auto left = bytes.next<std::uint64_t>(); left > 0; --left) {
    const auto id = bytes.next<std::uint32_t>();
    const LensModel& lens = lensModelNumbered(bytes.next<std::int32_t>(), path);
    const auto width = bytes.next<std::uint64_t>(), height = bytes.next<std::uint64_t>();
    std::vector<double> parameters(lens.parameters.size());
    for (double& value : parameters)
      value = bytes.next<double>();
    cameras.push_back({id, makeCamera(lens, width, height, parameters, path)});
  }
  return cameras;
}

std::vector<ImageEntry> readImagesBinary(const std::string& path, bool with_pixels)
{
  ByteReader bytes(path);
  constexpr std::size_t feature_size = 2 * sizeof(double) + sizeof(std::uint64_t); // x, y, point
  std::vector<ImageEntry> images;
  for (auto left = bytes.next<std::uint64_t>(); left > 0; --left) {
    ImageEntry image;
    image.id = bytes.next<std::uint32_t>();
    double q[4], t[3];
    for (double& value : q)
      value = bytes.next<double>();
    for (double& value : t)
      value = bytes.next<double>();
    image.camera = bytes.next<std::uint32_t>();
    image.name = bytes.text();
    const auto features = bytes.next<std::uint64_t>();
    if (with_pixels)
      bytes.requireLeft(features, feature_size);
    for (std::uint64_t i = 0; with_pixels && i < features; ++i) {
      const auto x = bytes.next<double>(), y = bytes.next<double>();
      image.pixels.emplace_back(x, y);
      bytes.next<std::uint64_t>(); // its point
    }
    if (!with_pixels)
      bytes.skip(features, feature_size);
    image.T_camera_world = makePose(q, t, path);
    images.push_back(image);
  }
  return images;
}
} // namespace fresco::io
