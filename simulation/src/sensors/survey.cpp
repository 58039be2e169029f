// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>
#include <fresco/core/constants.h>
#include <fresco/core/require.h>
#include <fresco/io/file.h>
#include <fresco/io/image_io.h>
#include <fresco/io/scan_file.h>
#include <fresco/io/scan_writer.h>
#include <fresco/simulation/sensors/survey.h>
#include <iomanip>
namespace fresco::simulation {
namespace {
ScanPicture pictureOf(const std::string& file, ScanImage::Projection projection)
{
  const Image image = readImage(file);
  ScanPicture picture;
  picture.bytes = readFile(file);
  picture.description.projection = projection;
  picture.description.width = image.width;
  picture.description.height = image.height;
  return picture;
}

ScanPicture panoramaOf(const std::string& file, Index scan, const Eigen::Isometry3d& T_world_scan)
{
  ScanPicture picture = pictureOf(file, ScanImage::Projection::spherical);
  ScanImage& said = picture.description;
  said.pixel_width = said.pixel_height = pi / said.height;
  said.scan = scan;
  said.T_file_image = T_world_scan;
  return picture;
}

ScanPicture photographOf(const std::string& file, const CameraModel& camera, const View& view)
{
  ScanPicture picture = pictureOf(file, ScanImage::Projection::pinhole);
  ScanImage& said = picture.description;
  said.focal_length = 0.02; // metres; any, with pixels to match
  said.pixel_width = said.focal_length / camera.fx;
  said.pixel_height = said.focal_length / camera.fy;
  said.principal_x = camera.cx;
  said.principal_y = camera.cy;
  said.T_file_image = view.T_camera_world.inverse() * cameraAxes(said.projection);
  return picture;
}
} // namespace

void writeSurvey(const std::string& folder, const std::vector<Pose>& poses, const CameraSet& photographs)
{
  std::vector<PlacedCloud> scans;
  std::vector<ScanPicture> pictures;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const std::string name = concat("scan_", std::setfill('0'), std::setw(2), k);
    const Eigen::Isometry3d T_world_scan(*poses[k]);
    scans.push_back({name, T_world_scan, readCloud(folder + "/scans/" + name + ".pcd")});
    const std::string panorama = folder + "/panoramas/" + name + ".jpg";
    if (std::filesystem::exists(panorama))
      pictures.push_back(panoramaOf(panorama, k, T_world_scan));
  }
  for (const View& view : photographs.views)
    pictures.push_back(photographOf(folder + "/images/" + view.image, photographs.cameras[view.camera], view));
  writeScans(folder + "/survey.e57", scans, pictures);
}
} // namespace fresco::simulation
