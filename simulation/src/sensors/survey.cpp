// SPDX-License-Identifier: BSD-3-Clause
#include "sensors/survey.h"
#include <filesystem>
#include <fresco/core/constants.h>
#include <fresco/core/require.h>
#include <fresco/io/file.h>
#include <fresco/io/image_io.h>
#include <fresco/io/point_io.h>
#include <fresco/simulation/sensors/e57_writer.h>
#include <iomanip>
namespace fresco::simulation {
namespace {
using e57::element;

e57::Scan packed(const PointSet& points, const std::string& name, const Eigen::Isometry3d& T_world_scan)
{
  e57::Scan scan{name, {}, std::size_t(points.size()), e57::poseXml(T_world_scan)};
  const auto add = [&](const char* field, const auto& values) {
    e57::Field next{field};
    next.single = true;
    next.reals.assign(values.begin(), values.end());
    scan.fields.push_back(std::move(next));
  };
  const char* axes[] = {"cartesianX", "cartesianY", "cartesianZ"};
  for (int k = 0; k < 3; ++k)
    add(axes[k], points.points.row(k));
  if (points.intensities.size() > 0)
    add("intensity", points.intensities);
  const char* channels[] = {"colorRed", "colorGreen", "colorBlue"};
  for (int k = 0; k < 3 && points.colors.cols() > 0; ++k) {
    e57::Field next{channels[k], "Integer"};
    next.maximum = 255;
    const auto row = points.colors.row(k);
    next.stored.assign(row.begin(), row.end());
    scan.fields.push_back(std::move(next));
  }
  return scan;
}

/// @param more XML of the representation besides the size
e57::Image packedImage(const std::string& file, const char* kind, const std::string& more)
{
  const Image image = readImage(file);
  return {concat("<", kind, "Representation type=\"Structure\"><jpegImage type=\"Blob\" PICTURE/>",
                 element("imageWidth", image.width), element("imageHeight", image.height), more, "</", kind,
                 "Representation>"),
          readFile(file), ""};
}

e57::Image packedPanorama(const std::string& file, const std::string& scan, const Eigen::Isometry3d& T_world_scan)
{
  const double pixel = pi / readImage(file).height;
  e57::Image image = packedImage(file, "spherical", element("pixelWidth", pixel) + element("pixelHeight", pixel));
  image.more = e57::poseXml(T_world_scan) + "<associatedData3DGuid type=\"String\"><![CDATA[guid of " + scan +
               "]]></associatedData3DGuid>";
  return image;
}

e57::Image packedPhotograph(const std::string& file, const CameraModel& camera, const View& view)
{
  constexpr double focal_length = 0.02; // metres; any, with pixels to match
  e57::Image image =
      packedImage(file, "pinhole",
                  element("focalLength", focal_length) + element("pixelWidth", focal_length / camera.fx) +
                      element("pixelHeight", focal_length / camera.fy) + element("principalPointX", camera.cx) +
                      element("principalPointY", camera.cy));
  const Eigen::Isometry3d T_camera_image(Eigen::Vector3d(1, -1, -1).asDiagonal().toDenseMatrix());
  image.more = e57::poseXml(view.T_camera_world.inverse() * T_camera_image);
  return image;
}
} // namespace

void writeSurvey(const std::string& folder, const std::vector<Pose>& poses, const CameraSet& photographs)
{
  std::vector<e57::Scan> scans;
  std::vector<e57::Image> images;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const std::string name = concat("scan_", std::setfill('0'), std::setw(2), k);
    const Eigen::Isometry3d T_world_scan(*poses[k]);
    scans.push_back(packed(readPoints(folder + "/scans/" + name + ".pcd"), name, T_world_scan));
    const std::string panorama = folder + "/panoramas/" + name + ".jpg";
    if (std::filesystem::exists(panorama))
      images.push_back(packedPanorama(panorama, name, T_world_scan));
  }
  for (const View& view : photographs.views)
    images.push_back(packedPhotograph(folder + "/images/" + view.image, photographs.cameras[view.camera], view));
  writeFile(folder + "/survey.e57", e57::fileOf(scans, images));
}
} // namespace fresco::simulation
