// SPDX-License-Identifier: BSD-3-Clause
#include "io/colmap/lens_models.h"
#include "io/points/text_numbers.h"
#include <fresco/io/colmap.h>
#include <fresco/io/file.h>
namespace fresco {
namespace {
/// A text file of numbers that blanks part.
class ListFile {
public:
  ListFile(const std::string& path, const std::string& head) : file_(path) { file_.write(head); }

  template <typename... Values>
  void add(const Values&... values)
  {
    ((file_.write(io::textOf(first_ ? "" : " ", values)), first_ = false), ...);
  }
  void endLine()
  {
    file_.write("\n");
    first_ = true;
  }
  void commit() { file_.commit(); }

private:
  OutputFile file_;
  bool first_ = true;
};

/// Writes the list of points. @return of each view, its line of features
std::vector<std::string> writePoints(ListFile& list, const CameraSet& set, const SparsePoints& points)
{
  std::vector<std::string> features(set.views.size());
  std::vector<int> counts(set.views.size(), 0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const SparsePoint& p = points[i];
    list.add(i + 1, p.position.x(), p.position.y(), p.position.z(), int(p.color[0]), int(p.color[1]), int(p.color[2]),
             p.error);
    for (const auto& [view, pixel] : p.track)
      if (pixel.allFinite()) {
        list.add(view + 1, counts[view]++);
        std::string& line = features[view];
        line += (line.empty() ? "" : " ") + io::numberText(float(pixel.x())) + " " + io::numberText(float(pixel.y())) +
                " " + io::numberText(i + 1);
      }
    list.endLine();
  }
  return features;
}
} // namespace

void requireColmapCameras(const CameraSet& set)
{
  for (const CameraModel& camera : set.cameras)
    io::lensModelOf(camera);
}

void writeColmap(const std::string& folder, const CameraSet& set, const SparsePoints& points)
{
  makeFolder(folder);
  ListFile list(folder + "/points3D.txt",
                "# 3D point list with one line of data per point:\n#   POINT3D_ID, X, Y, Z, R, G, B, ERROR, TRACK[] as "
                "(IMAGE_ID, POINT2D_IDX)\n# Number of points: " +
                    io::numberText(points.size()) + "\n");
  ListFile cameras(folder + "/cameras.txt",
                   "# Camera list with one line of data per camera:\n#   CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n"
                   "# Number of cameras: " +
                       io::numberText(set.cameras.size()) + "\n");
  ListFile images(
      folder + "/images.txt",
      "# Image list with two lines of data per image:\n#   IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, "
      "NAME\n#   POINTS2D[] as (X, Y, POINT3D_ID)\n# Number of images: " +
          io::numberText(set.views.size()) + "\n");
  const std::vector<std::string> features = writePoints(list, set, points);
  for (std::size_t c = 0; c < set.cameras.size(); ++c) {
    const CameraModel& m = set.cameras[c];
    const io::LensModel& lens = io::lensModelOf(m);
    cameras.add(c + 1, std::string(lens.name), m.width, m.height);
    for (double CameraModel::*parameter : lens.parameters)
      cameras.add(m.*parameter);
    cameras.endLine();
  }
  for (std::size_t v = 0; v < set.views.size(); ++v) {
    const View& view = set.views[v];
    const Eigen::Quaterniond q(view.T_camera_world.linear());
    const Eigen::Vector3d t = view.T_camera_world.translation();
    images.add(v + 1, q.w(), q.x(), q.y(), q.z(), t.x(), t.y(), t.z(), view.camera + 1, view.image);
    images.endLine();
    images.add(features[v]);
    images.endLine();
  }
  for (ListFile* file : {&list, &cameras, &images})
    file->commit();
}
} // namespace fresco
