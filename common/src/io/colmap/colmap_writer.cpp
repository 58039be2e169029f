// SPDX-License-Identifier: BSD-3-Clause
#include "io/colmap/lens_models.h"
#include <fresco/core/require.h>
#include <fresco/io/colmap.h>
#include <fresco/io/file.h>
#include <iomanip>
#include <sstream>
namespace fresco {
namespace {
/// Writes the list of points. @return of each view, its line of features
std::vector<std::string> writePoints(std::ostringstream& list, const CameraSet& set, const SparsePoints& points)
{
  std::vector<std::string> features(set.views.size());
  std::vector<int> counts(set.views.size(), 0);
  list << std::setprecision(17) << "# 3D point list with one line of data per point:\n"
       << "#   POINT3D_ID, X, Y, Z, R, G, B, ERROR, TRACK[] as (IMAGE_ID, POINT2D_IDX)\n# Number of points: "
       << points.size() << "\n";
  for (std::size_t i = 0; i < points.size(); ++i) {
    const SparsePoint& p = points[i];
    list << i + 1 << " " << p.position.x() << " " << p.position.y() << " " << p.position.z() << " " << int(p.color[0])
         << " " << int(p.color[1]) << " " << int(p.color[2]) << " " << p.error;
    for (const auto& [view, pixel] : p.track)
      if (pixel.allFinite()) {
        list << " " << view + 1 << " " << counts[view]++;
        features[view] +=
            concat(features[view].empty() ? "" : " ", std::setprecision(8), pixel.x(), " ", pixel.y(), " ", i + 1);
      }
    list << "\n";
  }
  return features;
}
} // namespace

void writeColmap(const std::string& folder, const CameraSet& set, const SparsePoints& points)
{
  makeFolder(folder);
  std::ostringstream cameras, images, list;
  const std::vector<std::string> features = writePoints(list, set, points);
  cameras << std::setprecision(17) << "# Camera list with one line of data per camera:\n"
          << "#   CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n# Number of cameras: " << set.cameras.size() << "\n";
  for (std::size_t c = 0; c < set.cameras.size(); ++c) {
    const CameraModel& m = set.cameras[c];
    const io::LensModel& lens = io::lensModelOf(m);
    cameras << c + 1 << " " << lens.name << " " << m.width << " " << m.height;
    for (double CameraModel::*parameter : lens.parameters)
      cameras << " " << m.*parameter;
    cameras << "\n";
  }
  images << std::setprecision(17) << "# Image list with two lines of data per image:\n"
         << "#   IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME\n#   POINTS2D[] as (X, Y, POINT3D_ID)\n"
         << "# Number of images: " << set.views.size() << "\n";
  for (std::size_t v = 0; v < set.views.size(); ++v) {
    const View& view = set.views[v];
    const Eigen::Quaterniond q(view.T_camera_world.linear());
    const Eigen::Vector3d t = view.T_camera_world.translation();
    images << v + 1 << " " << q.w() << " " << q.x() << " " << q.y() << " " << q.z() << " " << t.x() << " " << t.y()
           << " " << t.z() << " " << view.camera + 1 << " " << view.image << "\n"
           << features[v] << "\n";
  }
  writeFile(folder + "/points3D.txt", list.str());
  writeFile(folder + "/cameras.txt", cameras.str());
  writeFile(folder + "/images.txt", images.str());
}
} // namespace fresco
