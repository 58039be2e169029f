// SPDX-License-Identifier: BSD-3-Clause
#include "io/colmap/byte_reader.h"
#include "io/colmap/colmap_model.h"
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fresco/core/poses.h>
#include <fresco/io/colmap.h>
#include <limits>
#include <map>
namespace fresco {
namespace io {
/// Every image has two lines: the pose, then its feature points, which may be an empty line.
std::vector<ImageEntry> readImagesText(const std::string& path, bool with_pixels)
{
  std::vector<ImageEntry> images;
  bool points_line = false;
  forEachLine(path, [&](std::string_view line, const std::string& where) {
    const bool skip = points_line;
    points_line = !points_line;
    TextScanner words(line);
    if (skip) {
      while (with_pixels && !words.atLineEnd()) {
        const auto x = nextNumber<double>(words, where, "X Y POINT3D_ID"), y = nextNumber<double>(words, where, "Y");
        words.word();
        images.back().pixels.emplace_back(x, y);
      }
      return;
    }
    if (line.empty()) {
      points_line = false;
      return;
    }
    constexpr const char* wanted = "IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME";
    ImageEntry image;
    double q[4], t[3];
    image.id = nextNumber<std::uint64_t>(words, where, wanted);
    for (double& value : q)
      value = nextNumber<double>(words, where, wanted);
    for (double& value : t)
      value = nextNumber<double>(words, where, wanted);
    image.camera = nextNumber<std::uint64_t>(words, where, wanted);
    image.name = std::string(words.restOfLine());
    image.T_camera_world = makePose(q, t, where);
    images.push_back(image);
  });
  return images;
}

namespace {
/// What the points of a model are joined with: the images by their ids.
class Images {
public:
  explicit Images(std::vector<ImageEntry> images) : images_(std::move(images))
  {
    std::stable_sort(images_.begin(), images_.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
    for (std::size_t v = 0; v < images_.size(); ++v)
      numbers_[images_[v].id] = static_cast<int>(v);
  }

  Observation observation(std::uint64_t image, std::uint64_t feature, const std::string& where) const
  {
    const auto found = numbers_.find(image);
    if (found == numbers_.end())
      fail(where, concat("names image ", image, ", which is not there"));
    const auto& pixels = images_[found->second].pixels;
    if (!pixels.empty() && feature >= pixels.size())
      fail(where, concat("names feature ", feature, " of image ", image, ", which has ", pixels.size()));
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    return {found->second, pixels.empty() ? Eigen::Vector2d(unknown, unknown) : pixels[feature]};
  }

private:
  std::vector<ImageEntry> images_;
  std::map<std::uint64_t, int> numbers_;
};

void requireFinite(const SparsePoint& point, const std::string& where)
{
  if (!isInReach(point.position) || !std::isfinite(point.error))
    fail(where, "the point is not finite or too far away");
}

SparsePoints readPointsText(const std::string& path, const Images& images)
{
  SparsePoints points;
  forEachLine(path, [&](std::string_view line, const std::string& where) {
    if (line.empty())
      return;
    TextScanner words(line);
    double value[8]; // id x y z r g b error
    for (double& number : value)
      number = nextNumber<double>(words, where, "POINT3D_ID X Y Z R G B ERROR TRACK[]");
    SparsePoint point;
    point.position << value[1], value[2], value[3];
    point.error = value[7];
    requireFinite(point, where);
    for (int c = 0; c < 3; ++c)
      point.color[c] = value[4 + c] > 0 ? static_cast<std::uint8_t>(std::min(value[4 + c], 255.0)) : 0;
    while (!words.atLineEnd()) {
      const auto image = nextNumber<std::uint64_t>(words, where, "IMAGE_ID POINT2D_IDX"),
                 feature = nextNumber<std::uint64_t>(words, where, "POINT2D_IDX behind IMAGE_ID");
      point.track.push_back(images.observation(image, feature, where));
    }
    points.push_back(std::move(point));
  });
  return points;
}

SparsePoints readPointsBinary(const std::string& path, const Images& images)
{
  ByteReader bytes(path);
  SparsePoints points;
  for (auto left = bytes.next<std::uint64_t>(); left > 0; --left) {
    SparsePoint point;
    bytes.next<std::uint64_t>(); // its id
    for (double& coordinate : point.position)
      coordinate = bytes.next<double>();
    for (std::uint8_t& channel : point.color)
      channel = bytes.next<std::uint8_t>();
    point.error = bytes.next<double>();
    requireFinite(point, path);
    const auto length = bytes.next<std::uint64_t>();
    bytes.requireLeft(length, 2 * sizeof(std::uint32_t));
    for (std::uint64_t i = 0; i < length; ++i) {
      const auto image = bytes.next<std::uint32_t>(), feature = bytes.next<std::uint32_t>();
      point.track.push_back(images.observation(image, feature, path));
    }
    points.push_back(std::move(point));
  }
  return points;
}
} // namespace
} // namespace io

SparsePoints readColmapPoints(const std::string& folder)
{
  const auto has = [&](const char* name) { return std::filesystem::exists(folder + "/" + name); };
  if (has("cameras.txt") && has("images.txt"))
    return has("points3D.txt") ? io::readPointsText(folder + "/points3D.txt",
                                                    io::Images(io::readImagesText(folder + "/images.txt", true)))
                               : SparsePoints();
  return has("points3D.bin") ? io::readPointsBinary(folder + "/points3D.bin",
                                                    io::Images(io::readImagesBinary(folder + "/images.bin", true)))
                             : SparsePoints();
}
} // namespace fresco
