// SPDX-License-Identifier: BSD-3-Clause
#include "io/colmap/colmap_rows.h"
#include "io/colmap/lens_models.h"
#include "io/files/inputs.h"
#include "io/files/remarks.h"
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fresco/core/poses.h>
#include <fresco/io/colmap.h>
#include <limits>
#include <map>
namespace fresco {
namespace {
using io::ColmapRows;
using io::LensModel;

struct ImageEntry {
  std::uint64_t id = 0, camera = 0;
  std::string name;
  Eigen::Isometry3d T_camera_world = Eigen::Isometry3d::Identity();
  std::vector<Eigen::Vector2d> pixels; ///< of its feature points; empty unless asked for
};

/// What follows the id of a camera.
CameraModel readCamera(ColmapRows& rows, const char* wanted)
{
  const LensModel& lens = rows.isBinary() ? io::lensModelNumbered(rows.stored<std::int32_t>(), rows.where())
                                          : io::lensModelNamed(rows.word(), rows.where());
  const auto width = rows.number<std::uint64_t>(wanted), height = rows.number<std::uint64_t>(wanted);
  std::vector<double> p;
  rows.forEachItem(lens.parameters.size(), [&] { p.push_back(rows.number<double>(wanted)); });
  if (p.size() != lens.parameters.size())
    rows.fail(concat("camera model ", lens.name, " has ", lens.parameters.size(), " parameters, not ", p.size()));
  if (!std::all_of(p.begin(), p.end(), [](double value) { return std::isfinite(value); }))
    rows.fail("a camera parameter is not finite");
  if (width < 1 || height < 1 || width > 1000000 || height > 1000000)
    rows.fail(concat("an image of ", width, "x", height, " pixels"));
  CameraModel camera{static_cast<int>(width), static_cast<int>(height)};
  camera.projection = lens.projection;
  for (std::size_t i = 0; i < p.size(); ++i)
    camera.*lens.parameters[i] = p[i];
  if (lens.parameters[1] != &CameraModel::fy)
    camera.fy = camera.fx;
  io::namingFile(rows.where(), [&] { validateCamera(camera); });
  return camera;
}

/// @param q quaternion w x y z, which need not be normalised
Eigen::Isometry3d poseOf(const Eigen::Vector4d& q, const Eigen::Vector3d& translation, const std::string& where)
{
  expect(q.allFinite() && q.norm() > 1e-6 && q.cwiseAbs().maxCoeff() < 1e6 && isInReach(translation), where,
         ": the pose is not finite, too far away or has no rotation");
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
  T.translation() = translation;
  return T;
}

/// In the order of their ids. In text an image has two lines: the pose, then its feature points, empty if there are none.
std::vector<ImageEntry> readImages(const std::string& path, bool with_pixels)
{
  constexpr const char* wanted = "IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME";
  constexpr std::size_t feature_bytes = 2 * sizeof(double) + sizeof(std::uint64_t); // x, y, point
  std::vector<ImageEntry> images;
  for (ColmapRows rows(path); rows.next();) {
    ImageEntry image;
    image.id = rows.number<std::uint64_t, std::uint32_t>(wanted);
    const Eigen::Vector4d q = rows.numbers<4>(wanted);
    const Eigen::Vector3d t = rows.numbers<3>(wanted);
    image.camera = rows.number<std::uint64_t, std::uint32_t>(wanted);
    image.name = rows.name();
    const std::string where = rows.where();
    if (!rows.isBinary())
      rows.next(true);
    const std::uint64_t features = rows.listLength(feature_bytes);
    image.T_camera_world = poseOf(q, t, where);
    if (!with_pixels)
      rows.skip(features * feature_bytes);
    else
      rows.forEachItem(features, [&] {
        const auto x = rows.number<double>("X Y POINT3D_ID"), y = rows.number<double>("Y");
        image.pixels.emplace_back(x, y);
        rows.isBinary() ? rows.skip(sizeof(std::uint64_t)) : void(rows.word()); // its point
      });
    images.push_back(std::move(image));
  }
  std::stable_sort(images.begin(), images.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  return images;
}

/// What the points of a model are joined with: the images by their ids.
class Images {
public:
  explicit Images(const std::string& path) : images_(readImages(path, true))
  {
    for (std::size_t v = 0; v < images_.size(); ++v)
      numbers_[images_[v].id] = static_cast<int>(v);
  }

  Observation readObservation(ColmapRows& rows) const
  {
    const auto image = rows.number<std::uint64_t, std::uint32_t>("IMAGE_ID POINT2D_IDX"),
               feature = rows.number<std::uint64_t, std::uint32_t>("POINT2D_IDX behind IMAGE_ID");
    const auto found = numbers_.find(image);
    if (found == numbers_.end())
      rows.fail(concat("names image ", image, ", which is not there"));
    const auto& pixels = images_[found->second].pixels;
    if (!pixels.empty() && feature >= pixels.size())
      rows.fail(concat("names feature ", feature, " of image ", image, ", which has ", pixels.size()));
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    return {found->second, pixels.empty() ? Eigen::Vector2d(unknown, unknown) : pixels[feature]};
  }

private:
  const std::vector<ImageEntry> images_;
  std::map<std::uint64_t, int> numbers_;
};
} // namespace

std::string io::colmapKind(const std::string& folder)
{
  for (const std::string kind : {".txt", ".bin"})
    if (std::filesystem::exists(folder + "/cameras" + kind) && std::filesystem::exists(folder + "/images" + kind))
      return kind;
  return "";
}

CameraSet readColmap(const std::string& folder)
{
  if (!std::filesystem::is_directory(folder))
    throw std::runtime_error(folder + ": no such folder of cameras");
  const std::string kind = io::colmapKind(folder), path = folder + "/images" + kind;
  if (kind.empty())
    throw std::runtime_error(folder + ": neither cameras.txt and images.txt nor cameras.bin and images.bin in it");
  constexpr const char* wanted = "CAMERA_ID MODEL WIDTH HEIGHT PARAMS";
  CameraSet set;
  std::map<std::uint64_t, int> numbers;
  for (ColmapRows rows(folder + "/cameras" + kind); rows.next();) {
    const auto id = rows.number<std::uint64_t, std::uint32_t>(wanted);
    numbers[id] = static_cast<int>(set.cameras.size());
    set.cameras.push_back(readCamera(rows, wanted));
  }
  const std::vector<ImageEntry> images = readImages(path, false);
  if (images.empty())
    throw std::runtime_error(path + ": no image in it");
  for (const ImageEntry& image : images) {
    const auto camera = numbers.find(image.camera);
    if (camera == numbers.end())
      throw std::runtime_error(
          concat(path, ": image ", image.id, " names camera ", image.camera, ", which is not there"));
    if (image.name.empty())
      throw std::runtime_error(concat(path, ": image ", image.id, " has no name"));
    fileBelow(path, image.name); // photographs lie in the folder that they are looked for in
    set.views.push_back({image.name, camera->second, image.T_camera_world});
  }
  return set;
}

SparsePoints readColmapPoints(const std::string& folder)
{
  const std::string kind = io::colmapKind(folder) == ".txt" ? ".txt" : ".bin", path = folder + "/points3D" + kind;
  SparsePoints points;
  if (!std::filesystem::exists(path))
    return points;
  if (std::error_code error; kind == ".txt" && std::filesystem::file_size(path, error) == 0) {
    io::rememberInput(path); // COLMAP's manual wants an empty one beside known poses
    return points;
  }
  const Images images(folder + "/images" + kind);
  constexpr const char* wanted = "POINT3D_ID X Y Z R G B ERROR TRACK[]";
  for (ColmapRows rows(path); rows.next();) {
    SparsePoint point;
    rows.number<double, std::uint64_t>(wanted); // its id
    point.position = rows.numbers<3>(wanted);
    for (std::uint8_t& channel : point.color) {
      const auto value = rows.number<double, std::uint8_t>(wanted);
      channel = value > 0 ? static_cast<std::uint8_t>(std::min(value, 255.0)) : 0;
    }
    point.error = rows.number<double>(wanted);
    if (!isInReach(point.position) || !std::isfinite(point.error))
      rows.fail("the point is not finite or too far away");
    const std::uint64_t length = rows.listLength(2 * sizeof(std::uint32_t));
    rows.forEachItem(length, [&] { point.track.push_back(images.readObservation(rows)); });
    points.push_back(std::move(point));
  }
  return points;
}
} // namespace fresco
