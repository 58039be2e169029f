// SPDX-License-Identifier: BSD-3-Clause
// Chang et al. 2017, "Matterport3D": undistorted images with a list of cameras and poses.
#include "input/frame_files.h"
#include <fresco/core/require.h>
#include <fresco/io/image_io.h>
#include <tuple>
namespace fresco::model {
RgbdParts readMatterport(const Survey& found, ModelInput&)
{
  RgbdParts parts;
  parts.folder.depth_unit = 1.0 / 4000;
  parts.camera_file = found.at(found.match("undistorted_camera_parameters/*.conf")[0]);
  const ImageSize any = readImageSize(found.at(found.match("undistorted_color_images/<pictures>")[0]));
  CameraModel camera{any.width, any.height};
  for (const auto& row : readTextRows(parts.camera_file)) {
    const auto number = [&](std::size_t k) { return numberIn(parts.camera_file, row.at(k)); };
    if (row[0] == "intrinsics_matrix" && row.size() == 10)
      camera.fx = number(1), camera.fy = number(5), camera.cx = number(3),
      camera.cy = any.height - number(6); // counted upwards
    if (row[0] != "scan")
      continue;
    if (row.size() != 19)
      throw std::runtime_error(parts.camera_file + ": a line 'scan' wants two files and 16 numbers");
    if (camera.fx == 0)
      throw std::runtime_error(parts.camera_file + ": a line 'scan' before intrinsics_matrix with its nine numbers");
    RgbdFrame frame;
    frame.name = row[1];
    for (const auto& [folder, name, path] : {std::tuple{"undistorted_depth_images/", row[1], &frame.depth},
                                             std::tuple{"undistorted_color_images/", row[2], &frame.color}}) {
      if (!found.holds(folder + name))
        throw std::runtime_error(found.at(folder + name) + ": no such file, but " + parts.camera_file + " names it");
      *path = found.at(folder + name);
    }
    Eigen::Matrix4d T;
    for (int k = 0; k < 16; ++k)
      T(k / 4, k % 4) = number(3 + k);
    parts.poses.push_back(rigidPose(parts.camera_file, lookingAhead(T)));
    frame.color_camera = camera;
    parts.folder.frames.push_back(frame);
  }
  if (parts.folder.frames.empty())
    throw std::runtime_error(parts.camera_file + ": names no image: lines 'scan DEPTH COLOUR MATRIX' are wanted");
  parts.folder.camera = parts.folder.frames[0].color_camera;
  return parts;
}
} // namespace fresco::model
