// SPDX-License-Identifier: BSD-3-Clause
#include "input/frame_files.h"
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fresco/core/require.h>
#include <fresco/io/image_io.h>
namespace fresco::model {
Index numberOfName(const std::string& name)
{
  const std::string stem = stemOf(name);
  const auto digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
  auto begin = stem.begin(), end = std::find_if_not(stem.begin(), stem.end(), digit);
  if (begin == end) {
    end = stem.end();
    begin = std::find_if_not(stem.rbegin(), stem.rend(), digit).base();
  }
  return begin == end || end - begin > 15 ? -1 : std::stoll(std::string(begin, end));
}

std::vector<RgbdFrame> pairedFrames(const Survey& found, const std::string& color, const std::string& depth,
                                    ModelInput& input)
{
  const std::vector<std::string> colors = found.match(color), depths = found.match(depth);
  std::map<std::string, std::string> by_name;
  std::map<Index, std::string> by_number;
  for (const std::string& name : colors) {
    by_name[stemOf(name)] = name;
    by_number[numberOfName(name)] = name;
  }
  std::vector<RgbdFrame> frames;
  for (const std::string& name : depths) {
    const auto same = by_name.find(stemOf(name));
    const auto number = by_number.find(numberOfName(name));
    if (same == by_name.end() && (number == by_number.end() || number->first < 0))
      continue;
    RgbdFrame frame;
    frame.name = stemOf(name);
    frame.color = found.at(same != by_name.end() ? same->second : number->second);
    frame.depth = found.at(name);
    frames.push_back(frame);
  }
  const std::size_t alone =
      depths.size() - frames.size() + (colors.size() > frames.size() ? colors.size() - frames.size() : 0);
  if (2 * frames.size() < std::max(depths.size(), colors.size()) || frames.empty())
    throw std::runtime_error(concat(found.path(), ": ", counted(colors.size(), "colour image"), " (", color, ") and ",
                                    counted(depths.size(), "depth image"), " (", depth, "), but only ", frames.size(),
                                    " of the same name or number: name both images of a frame alike"));
  if (alone > 0)
    input.warnings.push_back(concat(counted(alone, "image"), " without a partner of the same name or number left out"));
  return frames;
}

void takeFrames(ModelInput& input, RgbdParts parts, double depth_unit)
{
  if (depth_unit > 0)
    parts.folder.depth_unit = depth_unit;
  const std::size_t count = parts.folder.frames.size();
  require(parts.poses.empty() || parts.poses.size() == count, "model: ", parts.poses.size(), " poses of ", count,
          " frames");
  input.rgbd = assembleRgbd(std::move(parts));
  const RgbdFolder& rgbd = *input.rgbd;
  if (rgbd.frames.empty())
    throw std::runtime_error(input.folder + ": no frame has a finite pose");
  if (rgbd.without_pose > 0)
    input.warnings.push_back(concat(rgbd.without_pose, " frames without a pose are left out: others have one"));
  if (rgbd.has_poses)
    for (const RgbdFrame& frame : rgbd.frames)
      input.poses.emplace_back(frame.T_world_camera.matrix());
  const RgbdFrame& first = rgbd.frames[0];
  input.found.insert(input.found.begin(),
                     concat(counted(count, "depth image"), ", ", rgbd.camera.width, "x", rgbd.camera.height, ", ",
                            rgbd.in_metres ? "metres" : concat("a unit is ", 1000 * rgbd.depth_unit, " mm"),
                            first.confidence.empty() ? "" : ", of least confidence left out"));
  input.found.insert(input.found.begin() + 1, concat(counted(count, "colour image"), ", ", first.color_camera.width,
                                                     "x", first.color_camera.height));
  input.found.push_back(rgbd.has_poses ? concat("poses of ", rgbd.frames.size(), " frames")
                                       : "no poses: the frames are one video, which is tracked");
}

Pose poseOf(const std::string& path, const Eigen::Vector3d& t, const Eigen::Vector4d& q)
{
  if (!t.allFinite() || !q.allFinite())
    return {};
  if (!(q.norm() > 0))
    throw std::runtime_error(path + ": a quaternion of zeros is no rotation");
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::Quaterniond(q).normalized().toRotationMatrix();
  T.translation() = t;
  return rigidPose(path, T.matrix());
}

CameraModel readCameraMatrix(const std::string& path, int side)
{
  const Eigen::MatrixXd K = readMatrix(path, side, side);
  return {0, 0, K(0, 0), K(1, 1), K(0, 2) + 0.5, K(1, 2) + 0.5};
}

Eigen::Matrix4d lookingAhead(const Eigen::Matrix4d& T_world_camera)
{
  return T_world_camera * Eigen::Vector4d(1, -1, -1, 1).asDiagonal();
}

CameraModel usualCamera(const std::string& depth, const std::string& wanted)
{
  const ImageSize image = readImageSize(depth);
  if (image.width != 640 || image.height != 480)
    throw std::runtime_error(
        concat(wanted, ": no such file, and images of ", image.width, "x", image.height,
               " pixels are of no usual camera: write the 3x3 intrinsics of the depth camera into it"));
  return {640, 480, 525, 525, 320, 240};
}
} // namespace fresco::model
