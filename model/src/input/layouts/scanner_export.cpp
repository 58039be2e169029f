// SPDX-License-Identifier: BSD-3-Clause
// Cloud of a mobile scanner with panoramas and a table of their poses, as pano-poses.csv of NavVis: a header that names the
// columns, then a line per panorama. World from panorama: z is up, x looks to the middle of the picture.
#include "input/frame_files.h"
#include "input/parts.h"
#include <algorithm>
#include <fresco/core/require.h>
#include <fresco/io/file.h>
#include <fresco/io/image_io.h>
namespace fresco::model {
namespace {
/// Columns of file, x y z, qx qy qz qw, by the words of the header.
std::vector<int> columnsOf(const std::string& path)
{
  std::string line = readFile(path);
  line.resize(std::min(line.find('\n'), line.size()));
  if (const std::size_t colon = line.find(':'); line[0] == '#' && colon != std::string::npos)
    line.erase(0, colon + 1); // "# pano poses v1.0: ID; filename; ..."
  std::transform(line.begin(), line.end(), line.begin(), [](unsigned char c) { return std::tolower(c); });
  line.erase(0, line.find_first_not_of("# "));
  const std::vector<std::string> names = cellsOf(line);
  std::vector<int> columns;
  for (const auto& wanted : std::vector<std::vector<std::string>>{{"filename", "file", "image", "name"},
                                                                  {"pano_pos_x", "x", "tx"},
                                                                  {"pano_pos_y", "y", "ty"},
                                                                  {"pano_pos_z", "z", "tz"},
                                                                  {"pano_ori_x", "qx"},
                                                                  {"pano_ori_y", "qy"},
                                                                  {"pano_ori_z", "qz"},
                                                                  {"pano_ori_w", "qw"}}) {
    const auto at = std::find_first_of(names.begin(), names.end(), wanted.begin(), wanted.end());
    if (at == names.end())
      throw std::runtime_error(path + ": its first line names no column " + wanted[0] +
                               "; wants filename, pano_pos_x y z, pano_ori_w x y z");
    columns.push_back(int(at - names.begin()));
  }
  return columns;
}
} // namespace

void readScannerExport(const Survey& found, std::optional<Reading>, ModelInput& input)
{
  takeScans(input, found, cloudsIn(found));
  takeAsCloud(input, found);
  const std::string table = found.match("*pano*.csv|pano*/*pano*.csv|info/*pano*.csv|*pano*.txt")[0],
                    path = found.at(table);
  const std::vector<int> columns = columnsOf(path);
  Eigen::Matrix4d T_pano_camera = Eigen::Matrix4d::Identity();
  T_pano_camera.topLeftCorner<3, 3>() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  input.images = found.path();
  for (const auto& row : readTextRows(path)) {
    if (int(row.size()) <= *std::max_element(columns.begin(), columns.end()))
      throw std::runtime_error(path + ": a line of fewer words than its first one names");
    if (row[columns[0]] == "filename" || row[columns[0]] == "file")
      continue;
    const auto number = [&](int k) { return numberIn(path, row[columns[k]]); };
    const std::string& file = row[columns[0]];
    const char* const folders[] = {"", "pano/", "panos/", "panorama/", "panoramas/"};
    const auto folder = std::find_if(std::begin(folders), std::end(folders),
                                     [&](const std::string& each) { return found.holds(each + file); });
    if (folder == std::end(folders))
      throw std::runtime_error(found.at(file) + ": no such panorama, but " + table + " names it");
    const std::string place = *folder + file;
    const Pose pose = poseOf(path, {number(1), number(2), number(3)}, {number(4), number(5), number(6), number(7)});
    if (!pose)
      continue;
    if (input.cameras.cameras.empty()) {
      const ImageSize first = readImageSize(found.at(place));
      if (first.width != 2 * first.height)
        throw std::runtime_error(concat(found.at(place), ": a panorama of ", first.width, "x", first.height,
                                        " pixels is not twice as wide as high"));
      input.cameras.cameras.push_back(sphericalCamera(first.width, first.height));
    }
    View view;
    view.image = place;
    view.T_camera_world = Eigen::Isometry3d(*pose * T_pano_camera).inverse();
    input.sensor_path.push_back(pose->topRightCorner<3, 1>());
    input.cameras.views.push_back(view);
  }
  input.found.push_back(concat(table, ": poses of ", counted(input.cameras.views.size(), "panorama")));
}
} // namespace fresco::model
