// SPDX-License-Identifier: BSD-3-Clause
// What programs of photogrammetry export: a cloud, photographs, and their cameras, which are pinhole cameras here. Formats: see
// common/src/io/cameras/.
#include "sensors/layout_copy.h"
#include <fresco/io/colmap.h>
#include <fresco/io/point_io.h>
namespace fresco::simulation {
namespace {
using Eigen::Vector4d;

struct Cameras {
  CameraSet set;
  SparsePoints points;

  const CameraModel& of(const View& view) const { return set.cameras[view.camera]; }
};

/// Cloud and photographs. @return the cameras
Cameras copyPhotographs(const Copy& copy)
{
  copy.folder("images", "images");
  writePoints(copy.to + "/cloud.ply", mergedCloud(copy));
  Cameras cameras{readColmap(copy.from + "/cameras"), readColmapPoints(copy.from + "/cameras")};
  for (const CameraModel& c : cameras.set.cameras)
    require(!c.hasDistortion() && c.fx == c.fy && c.cx == 0.5 * c.width && c.cy == 0.5 * c.height,
            "layouts of cameras: not a centred pinhole camera");
  return cameras;
}

std::string text(const Eigen::MatrixXd& numbers, const char* between = " ")
{
  std::string line;
  for (Eigen::Index r = 0; r < numbers.rows(); ++r)
    for (Eigen::Index c = 0; c < numbers.cols(); ++c)
      line += concat(line.empty() ? "" : between, std::setprecision(17), numbers(r, c));
  return line;
}

/// "[[1, 0], [0, 1]]".
std::string listText(const Eigen::MatrixXd& numbers)
{
  std::string rows;
  for (Eigen::Index r = 0; r < numbers.rows(); ++r)
    rows += (r > 0 ? ", [" : "[") + text(numbers.row(r), ", ") + "]";
  return "[" + rows + "]";
}

std::string joined(const std::vector<std::string>& entries)
{
  std::string all;
  for (const std::string& entry : entries)
    all += (all.empty() ? "" : ",\n") + entry;
  return "[\n" + all + "]";
}

/// Points as Bundler and NVM have them. @param down as their pixels count
std::string pointLines(const Cameras& cameras, double down)
{
  std::string lines;
  for (const SparsePoint& point : cameras.points) {
    lines += concat(text(point.position), " ", text(point.color.cast<double>()), " ", point.track.size());
    for (const auto& [v, pixel] : point.track) {
      const CameraModel& c = cameras.of(cameras.set.views[v]);
      lines += concat(" ", v, " 0 ", text(Eigen::Vector2d(pixel.x() - c.cx, down * (pixel.y() - c.cy))));
    }
    lines += "\n";
  }
  return lines;
}
} // namespace

/// The chunk is turned, moved and ten times as large as the world.
void writeMetashape(const Copy& copy)
{
  const Cameras cameras = copyPhotographs(copy);
  const Eigen::Matrix3d R = Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  const Eigen::Vector3d t(3, -2, 1);
  const double scale = 0.1; // world = scale R chunk + t
  std::string sensors, photographs;
  for (std::size_t c = 0; c < cameras.set.cameras.size(); ++c) {
    const CameraModel& m = cameras.set.cameras[c];
    sensors += concat("<sensor id=\"", c, "\" type=\"frame\"><resolution width=\"", m.width, "\" height=\"", m.height,
                      "\"/><calibration type=\"frame\" class=\"adjusted\"><f>",
                      text(Eigen::VectorXd::Constant(1, m.fx)), "</f></calibration></sensor>\n");
  }
  for (std::size_t v = 0; v < cameras.set.views.size(); ++v) {
    const View& view = cameras.set.views[v];
    Eigen::Matrix4d T = view.T_camera_world.inverse().matrix();
    T.topLeftCorner<3, 3>() = (R.transpose() * T.topLeftCorner<3, 3>()).eval();
    T.topRightCorner<3, 1>() = (R.transpose() * (T.topRightCorner<3, 1>() - t) / scale).eval();
    photographs +=
        concat("<camera id=\"", v, "\" sensor_id=\"", view.camera, "\" label=\"",
               std::filesystem::path(view.image).stem().string(), "\"><transform>", text(T), "</transform></camera>\n");
  }
  writeFile(
      copy.to + "/cameras.xml",
      concat("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<document version=\"2.0.0\">\n<chunk label=\"Chunk 1\">\n"
             "<sensors>\n",
             sensors, "</sensors>\n<cameras>\n", photographs, "</cameras>\n<transform><rotation>", text(R),
             "</rotation><translation>", text(t), "</translation><scale>", scale,
             "</scale></transform>\n<reference>LOCAL_CS[\"Local Coordinates (m)\"]</reference>\n</chunk>\n"
             "</document>\n"));
}

void writeBundler(const Copy& copy)
{
  const Cameras cameras = copyPhotographs(copy);
  std::string lines = concat("# Bundle file v0.3\n", cameras.set.views.size(), " ", cameras.points.size(), "\n"), names;
  for (const View& view : cameras.set.views) {
    const Eigen::Matrix4d T = Vector4d(1, -1, -1, 1).asDiagonal() * view.T_camera_world.matrix();
    lines += concat(cameras.of(view).fx, " 0 0\n", text(T.topLeftCorner<3, 3>()), "\n", text(T.topRightCorner<3, 1>()),
                    "\n");
    names += concat("C:\\photos\\", view.image, " 0 ", cameras.of(view).fx, "\n");
  }
  writeFile(copy.to + "/bundle.out", lines + pointLines(cameras, -1));
  writeFile(copy.to + "/list.txt", names);
}

void writeNvm(const Copy& copy)
{
  const Cameras cameras = copyPhotographs(copy);
  std::string lines = concat("NVM_V3\n\n", cameras.set.views.size(), "\n");
  for (const View& view : cameras.set.views) {
    const Eigen::Quaterniond q(view.T_camera_world.linear());
    lines += concat("/home/user/", view.image, "\t", cameras.of(view).fx, " ",
                    text(Vector4d(q.w(), q.x(), q.y(), q.z())), " ", text(view.center()), " 0 0\n");
  }
  writeFile(copy.to + "/model.nvm", concat(lines, "\n", cameras.points.size(), "\n", pointLines(cameras, 1), "\n0\n"));
}

void writeTransforms(const Copy& copy)
{
  const Cameras cameras = copyPhotographs(copy);
  std::vector<std::string> frames;
  for (const View& view : cameras.set.views) {
    const CameraModel& c = cameras.of(view);
    const Eigen::Matrix4d T = view.T_camera_world.inverse().matrix() * Vector4d(1, -1, -1, 1).asDiagonal();
    frames.push_back(concat("{\"file_path\": \"./images/", view.image, "\", \"w\": ", c.width, ", \"h\": ", c.height,
                            ", \"fl_x\": ", text(Eigen::VectorXd::Constant(1, c.fx)),
                            ", \"transform_matrix\": ", listText(T), "}"));
  }
  writeFile(copy.to + "/transforms.json",
            concat("{\"camera_model\": \"PINHOLE\", \"frames\": ", joined(frames), "}\n"));
}

void writeOpenMvg(const Copy& copy)
{
  const Cameras cameras = copyPhotographs(copy);
  std::vector<std::string> views, lenses, poses, points;
  const auto entry = [](std::size_t key, const std::string& value) {
    return concat("{\"key\": ", key, ", \"value\": ", value, "}");
  };
  const auto pointer = [](const std::string& data) {
    return "{\"ptr_wrapper\": {\"id\": 1, \"data\": {" + data + "}}}";
  };
  for (std::size_t c = 0; c < cameras.set.cameras.size(); ++c) {
    const CameraModel& m = cameras.set.cameras[c];
    const Eigen::RowVector2d middle(m.cx - 0.5, m.cy - 0.5); // centres of pixels are whole numbers
    lenses.push_back(entry(c, pointer(concat("\"width\": ", m.width, ", \"height\": ", m.height,
                                             ", \"focal_length\": ", text(Eigen::VectorXd::Constant(1, m.fx)),
                                             ", \"principal_point\": [", text(middle, ", "), "]"))));
  }
  for (std::size_t v = 0; v < cameras.set.views.size(); ++v) {
    const View& view = cameras.set.views[v];
    views.push_back(entry(v, pointer(concat("\"local_path\": \"\", \"filename\": \"", view.image,
                                            "\", \"id_intrinsic\": ", view.camera, ", \"id_pose\": ", v))));
    poses.push_back(entry(v, concat("{\"rotation\": ", listText(view.T_camera_world.linear()), ", \"center\": [",
                                    text(view.center(), ", "), "]}")));
  }
  for (const SparsePoint& point : cameras.points) {
    std::vector<std::string> seen;
    for (const auto& [v, pixel] : point.track)
      seen.push_back(
          entry(v, concat("{\"id_feat\": 0, \"x\": [", text(pixel - Eigen::Vector2d(0.5, 0.5), ", "), "]}")));
    points.push_back(entry(
        points.size(), concat("{\"X\": [", text(point.position, ", "), "], \"observations\": ", joined(seen), "}")));
  }
  writeFile(copy.to + "/sfm_data.json",
            concat("{\"sfm_data_version\": \"0.3\", \"root_path\": \"/home/user\", \"views\": ", joined(views),
                   ",\n\"intrinsics\": ", joined(lenses), ",\n\"extrinsics\": ", joined(poses),
                   ",\n\"structure\": ", joined(points), "}\n"));
}
} // namespace fresco::simulation
