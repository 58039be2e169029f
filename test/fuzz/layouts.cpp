// SPDX-License-Identifier: BSD-3-Clause
#include "layouts.h"
#include "targets.h"
#include <cstdio>
#include <filesystem>
#include <fresco/core/require.h>
#include <fresco/io/file.h>
#include <fresco/io/image_io.h>
#include <fstream>
namespace fresco::fuzz {
namespace {
namespace fs = std::filesystem;

using Files = std::vector<std::pair<std::string, std::string>>;

std::string packedFolder(const Files& files)
{
  std::string text;
  for (const auto& [name, content] : files)
    text += (text.empty() ? "" : std::string(separator)) + name + "\n" + content;
  return text;
}

const std::string identity = "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n", matrix = "5 0 1.5\n0 5 1\n0 0 1\n";
const std::string far_points = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                               "property float z\nend_header\n100 90 80\n100.5 90 80\n100 91 80.5\n";
const std::string scan = "3\n1 2 3 7\n4 5 6 8\n1 0 0 9\n";
const std::string cameras = "1 PINHOLE 4 3 5 5 2 1.5\n", images = "1 1 0 0 0 0 0 1 1 a.png\n1 1 7\n",
                  points3d = "7 1 2 3 9 9 9 0.5 1 0\n";

const std::string bundled = "1\n1 2 3 9 9 9 1 0 0 1 1\n";
const std::string bundler = "# Bundle file v0.3\n1 1\n5 0.1 0\n1 0 0\n0 1 0\n0 0 1\n0 0 1\n" + bundled.substr(2);
const std::string metashape =
    "<document><chunk><sensors><sensor id='0'><resolution width='4' height='3'/><calibration "
    "type='frame'><f>5</f><k1>.1</k1>"
    "</calibration></sensor></sensors><cameras><camera id='0' sensor_id='0' label='a'><transform>1 0 0 0 0 1 0 0 0 0 1 "
    "1 0 0 "
    "0 1</transform></camera></cameras><transform><scale>2</scale></transform></chunk></document>";
const std::string transforms = R"({"fl_x": 5, "k1": 0.1, "frames": [{"file_path": "a.png", "transform_matrix":
  [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 1], [0, 0, 0, 1]]}]})";
const std::string openmvg = R"({"sfm_data_version": "0.3",
"views": [{"key": 0, "value": {"ptr_wrapper": {"data": {"filename": "a.png", "id_intrinsic": 0, "id_pose": 0}}}}],
"intrinsics": [{"key": 0, "value": {"ptr_wrapper": {"data": {"width": 4, "height": 3, "focal_length": 5,
"principal_point": [2, 1], "disto_k3": [0.1, 0, 0]}}}}],
"extrinsics": [{"key": 0, "value": {"rotation": [[1, 0, 0], [0, 1, 0], [0, 0, 1]], "center": [0, 0, 1]}}],
"structure": [{"key": 0, "value": {"X": [1, 2, 3], "observations": [{"key": 0, "value": {"x": [1, 1]}}]}}]})";

/// Writes a picture of the size that the text tells. @return false if it tells none
bool writePicture(const std::string& path, const std::string& text)
{
  int width = 0, height = 0;
  if (std::sscanf(text.c_str(), "%2dx%2d", &width, &height) != 2 || width < 1 || height < 1)
    return false;
  if (path.find("depth") != std::string::npos)
    writeImage(path, Image16{width, height, std::vector<std::uint16_t>(std::size_t(width) * height, 1500)});
  else
    writeImage(path, Image(width, height));
  return true;
}
} // namespace

const Files& layouts()
{
  static const Files all = {
      {"tum", packedFolder({{"rgb/1.png", "4x3"},
                            {"depth/1.png", "4x3"},
                            {"rgb.txt", "# time file\n1.5 rgb/1.png\n"},
                            {"depth.txt", "1.51 depth/1.png\n"},
                            {"groundtruth.txt", "1.5 1 2 3 0 0 0 1\n"},
                            {"camera-intrinsics.txt", matrix}})},
      {"tum_pairs", packedFolder({{"rgb/1.png", "4x3"},
                                  {"depth/1.png", "4x3"},
                                  {"associations.txt", "1.5 rgb/1.png 1.51 depth/1.png\n"},
                                  {"camera-intrinsics.txt", matrix}})},
      {"open3d", packedFolder({{"color/0.png", "4x3"},
                               {"depth/0.png", "4x3"},
                               {"camera_intrinsic.json",
                                R"({"width": 4, "height": 3, "intrinsic_matrix": [5, 0, 0, 0, 5, 0, 1.5, 1, 1]})"},
                               {"trajectory.log", "0 0 1\n" + identity}})},
      {"scannet", packedFolder({{"color/0.png", "8x6"},
                                {"depth/0.png", "4x3"},
                                {"pose/0.txt", identity},
                                {"intrinsic/intrinsic_depth.txt", "5 0 1.5 0\n0 5 1 0\n0 0 1 0\n0 0 0 1\n"}})},
      {"stray",
       packedFolder({{"rgb/000000.png", "8x6"},
                     {"depth/000000.png", "4x3"},
                     {"confidence/000000.png", "4x3"},
                     {"odometry.csv", "timestamp, frame, x, y, z, qx, qy, qz, qw\n0.1, 000000, 1, 2, 3, 0, 0, 0, 1\n"},
                     {"camera_matrix.csv", "10, 0, 4\n0, 10, 3\n0, 0, 1\n"}})},
      {"polycam",
       packedFolder(
           {{"keyframes/images/1.jpg", "8x6"},
            {"keyframes/depth/1.png", "4x3"},
            {"keyframes/confidence/1.png", "4x3"},
            {"keyframes/cameras/1.json",
             R"({"width": 8, "height": 6, "fx": 10, "fy": 10, "cx": 4, "cy": 3, "t_00": 1, "t_01": 0, "t_02": 0,
"t_03": 1, "t_10": 0, "t_11": 1, "t_12": 0, "t_13": 2, "t_20": 0, "t_21": 0, "t_22": 1, "t_23": 3})"}})},
      {"matterport", packedFolder({{"undistorted_color_images/a_i0_0.jpg", "4x3"},
                                   {"undistorted_depth_images/a_d0_0.png", "4x3"},
                                   {"undistorted_camera_parameters/a.conf",
                                    "dataset matterport\nintrinsics_matrix 5 0 2 0 5 1.5 0 0 1\n"
                                    "scan a_d0_0.png a_i0_0.jpg 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n"}})},
      {"seven_scenes", packedFolder({{"frame-000000.color.png", "4x3"},
                                     {"frame-000000.depth.png", "4x3"},
                                     {"frame-000000.pose.txt", identity},
                                     {"camera-intrinsics.txt", matrix}})},
      {"panoramas", packedFolder({{"cloud.ply", far_points},
                                  {"pano/0.jpg", "8x4"},
                                  {"pano-poses.csv", "# pano poses v1.0: ID; filename; pano_pos_x; pano_pos_y; "
                                                     "pano_pos_z; pano_ori_w; pano_ori_x; pano_ori_y; pano_ori_z\n"
                                                     "0; 0.jpg; 1; 2; 3; 1; 0; 0; 0\n"}})},
      {"cloud", packedFolder({{"cloud.ply", far_points}, {"trajectory.txt", "0.5 1 2 3\n0.6 2 2 3\n"}})},
      {"scans", packedFolder({{"scans/a.pts", scan},
                              {"scans/b.pts", scan},
                              {"poses.txt", "none\n1 0 0 1 0 1 0 2 0 0 1 3 0 0 0 1\n"},
                              {"panoramas/a.jpg", "8x4"},
                              {"images/a.png", "4x3"},
                              {"masks/a.png", "4x3"},
                              {"cameras/cameras.txt", cameras},
                              {"cameras/images.txt", images},
                              {"cameras/points3D.txt", points3d}})},
      {"colmap", packedFolder({{"images/a.png", "4x3"},
                               {"sparse/0/cameras.txt", cameras},
                               {"sparse/0/images.txt", images},
                               {"sparse/0/points3D.txt", points3d},
                               {"dense/fused.ply", far_points}})},
      {"metashape", packedFolder({{"images/a.png", "4x3"}, {"cloud.ply", far_points}, {"cameras.xml", metashape}})},
      {"bundler", packedFolder({{"a.png", "4x3"}, {"list.txt", "x/a.png 0 5\n"}, {"bundle.out", bundler}})},
      {"nvm",
       packedFolder({{"images/a.png", "4x3"}, {"model.nvm", "NVM_V3\n1\na.png\t5 1 0 0 0 0 0 1 .1 0\n" + bundled}})},
      {"transforms",
       packedFolder({{"images/a.png", "4x3"}, {"cloud.ply", far_points}, {"transforms.json", transforms}})},
      {"openmvg", packedFolder({{"images/a.png", "4x3"}, {"sfm_data.json", openmvg}})},
      {"photographs", packedFolder({{"images/left/a.png", "4x3"}, {"images/right/a.png", "4x3"}})},
      {"exported", packedFolder({{"a.obj", "mtllib a.mtl\nv 1 2 3\nv 2 2 3\nv 2 3 3\nf 1 2 3\n"},
                                 {"a.mtl", "newmtl a\n"},
                                 {"a.jpg", "4x3"}})},
  };
  return all;
}

void writeFolder(std::string_view input, const std::string& folder)
{
  constexpr int most_files = 30;
  for (int k = 0; k < most_files && !input.empty(); ++k) {
    std::string content(takePart(input)), path;
    const std::string name = content.substr(0, content.find('\n'));
    content.erase(0, name.size() + 1);
    try {
      path = fileBelow(folder, name);
      fs::create_directories(fs::path(path).parent_path());
      if (const std::string kind = extension(name); (kind == ".png" || kind == ".jpg") && writePicture(path, content))
        continue;
    } catch (const std::runtime_error&) { // a name of a folder, or of another one
      continue;
    }
    std::ofstream(path, std::ios::binary) << content;
  }
}

GeneratedFile layout(Dice& dice)
{
  std::string_view input = dice.of(layouts()).second;
  GeneratedFile file;
  for (; !input.empty(); input.remove_prefix(file.parts.back().size()))
    file.parts.emplace_back(input.substr(0, std::min(input.find('\n'), input.size() - 1) + 1));
  return file;
}
} // namespace fresco::fuzz
