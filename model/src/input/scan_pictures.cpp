// SPDX-License-Identifier: BSD-3-Clause
#include "input/scan_pictures.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/constants.h>
#include <fresco/core/require.h>
#include <fresco/io/image_io.h>
#include <limits>
namespace fresco::model {
namespace {
using Projection = ScanImage::Projection;
using Eigen::Isometry3d;
using Eigen::Vector3d;

/// A scan and where its file says that it was taken.
struct Station {
  Index scan;
  Isometry3d T_file_scan;
  Vector3d sensor; ///< in the frame of the file
};

/// Those of one file, in its order. @param first index into `scans`
std::vector<Station> stationsOf(const std::vector<ScanPath>& scans, std::size_t first)
{
  const std::vector<ScanInfo> infos = readScanInfos(scans[first]);
  std::vector<Station> stations;
  for (std::size_t s = first; s < scans.size() && scans[s].file == scans[first].file; ++s) {
    const ScanInfo& info = infos.at(std::max<Index>(0, scans[s].scan));
    stations.push_back({Index(s), info.T_file_scan, info.T_file_scan * info.sensor.value_or(Vector3d::Zero())});
  }
  return stations;
}

ScanPicture placed(const ScanImage& what, const std::vector<Station>& stations)
{
  const Vector3d center = what.T_file_image->translation();
  const auto closer = [&](const Station& a, const Station& b) {
    return (a.sensor - center).squaredNorm() < (b.sensor - center).squaredNorm();
  };
  const bool has_scan = what.scan >= 0 && what.scan < Index(stations.size());
  const Station& station = has_scan ? stations[what.scan] : *std::min_element(stations.begin(), stations.end(), closer);
  ScanPicture picture;
  picture.what = what;
  picture.scan = station.scan;
  picture.T_camera_scan = cameraAxes(what.projection) * what.T_file_image->inverse() * station.T_file_scan;
  return picture;
}

void addPictures(const std::vector<ScanPath>& scans, std::size_t first, ScanPictures& out)
{
  const std::string& file = scans[first].file;
  const std::vector<ScanImage> images = readScanImages(file);
  if (images.empty())
    return;
  const std::vector<Station> stations = stationsOf(scans, first);
  Index unplaced = 0;
  for (std::size_t i = 0; i < images.size(); ++i) {
    if (images[i].projection == Projection::none || !images[i].T_file_image) {
      ++unplaced;
      continue;
    }
    out.pictures.push_back(placed(images[i], stations));
    out.pictures.back().file = file;
    out.pictures.back().number = i;
  }
  if (unplaced > 0)
    out.warnings.push_back(concat(file, ": ", unplaced, " of ", images.size(),
                                  " pictures are not used: the file does not say where they were taken"));
}

CameraModel pinholeCamera(const ScanPicture& picture, const Image& image)
{
  ScanImage what = picture.what;
  what.width = image.width;
  what.height = image.height;
  const CameraModel camera = cameraOf(what).camera;
  validateCamera(camera);
  return camera;
}

/// Where a panorama of part of the directions shows one: columns and rows from its upper left corner.
struct PartialPanorama {
  const ScanImage& what;
  double width, height;

  Eigen::Vector2d pixel(double longitude, double latitude) const // to the right, upwards; radians
  {
    const double x = width / 2 + longitude / what.pixel_width;
    if (what.projection == Projection::spherical)
      return {x, height / 2 - latitude / what.pixel_height};
    return {x, what.principal_y - what.radius * std::tan(latitude) / what.pixel_height};
  }
};

/// Panorama of all directions from one of some; the nearest pixel is taken, of as many as the given one has.
/// @param known mask of the image, or empty
CameraPicture completed(const ScanImage& what, const Image& image, const Image& known)
{
  const double covered = image.width * what.pixel_width;
  require(covered > 0 && covered < 2.02 * pi && what.pixel_height > 0, "covers ", covered, " radians around");
  require(what.projection == Projection::spherical || what.radius > 0, "a cylinder of radius ", what.radius, " m");
  const int height = std::ceil(pi / what.pixel_width);
  require(height >= 2 && height <= 20000, "a pixel of ", what.pixel_width, " radians");
  CameraPicture out{sphericalCamera(2 * height, height), Image(2 * height, height), Image(2 * height, height, 1),
                    false};
  const PartialPanorama partial{what, double(image.width), double(image.height)};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < 2 * height; ++x) {
      const Eigen::Vector2d at = partial.pixel((x + 0.5 - height) * pi / height, pi / 2 - (y + 0.5) * pi / height);
      if (!(at.x() >= 0 && at.x() < image.width && at.y() >= 0 && at.y() < image.height))
        continue;
      std::copy_n(image.pixel(int(at.x()), int(at.y())), 3, out.image.pixel(x, y));
      *out.mask.pixel(x, y) = known.empty() ? 255 : *known.pixel(int(at.x()), int(at.y()));
    }
  return out;
}

/// Whether it shows all directions; files that do not tell the size of a pixel are trusted by their shape.
bool isComplete(const ScanImage& what, const Image& image)
{
  const double covered = image.width * what.pixel_width;
  return what.projection == Projection::spherical && image.width == 2 * image.height &&
         (what.pixel_width <= 0 || std::abs(covered - 2 * pi) < 0.02 * pi);
}

Image maskOf(const ScanPicture& picture, const Image& image)
{
  const Image colors = decodeImage(readScanImageMask(picture.file, picture.number));
  require(colors.width == image.width && colors.height == image.height, "its mask is ", colors.width, "x",
          colors.height, " pixels, the picture ", image.width, "x", image.height);
  Image mask(image.width, image.height, 1);
  for (std::size_t i = 0; i < mask.data.size(); ++i)
    mask.data[i] = colors.data[3 * i] > 0 ? 255 : 0;
  return mask;
}

CameraPicture decoded(const ScanPicture& picture)
{
  const ScanImage& what = picture.what;
  Image image = decodeImage(readScanImageBytes(picture.file, picture.number));
  Image mask = what.has_mask ? maskOf(picture, image) : Image();
  if (picture.isPanorama() && !isComplete(what, image))
    return completed(what, image, mask);
  const CameraModel camera =
      picture.isPanorama() ? sphericalCamera(image.width, image.height) : pinholeCamera(picture, image);
  return {camera, std::move(image), std::move(mask), true};
}
} // namespace

std::string ScanPicture::name() const { return concat(file, " picture ", number + 1); }

ScanPictures picturesOf(const std::vector<ScanPath>& scans)
{
  ScanPictures out;
  for (std::size_t s = 0; s < scans.size(); ++s)
    if ((s == 0 || scans[s].file != scans[s - 1].file) && holdsScans(scans[s].file))
      try {
        addPictures(scans, s, out);
      } catch (const std::runtime_error&) { // of a file that cannot be read: registration says so
      }
  return out;
}

CameraPicture readPicture(const ScanPicture& picture)
{
  try {
    return decoded(picture);
  } catch (const std::exception& error) {
    const std::string reason = error.what(), known = picture.file + ": ";
    throw std::runtime_error(picture.name() + ": " +
                             (reason.rfind(known, 0) == 0 ? reason.substr(known.size()) : reason));
  }
}
} // namespace fresco::model
