// SPDX-License-Identifier: BSD-3-Clause
// Cameras as programs of photogrammetry write them: what is read projects as their documentation says, in its own words below.
#include "common/io/test_io_data.h"
#include <cmath>
#include <fresco/core/require.h>
#include <fresco/io/camera_files.h>
#include <fresco/io/colmap.h>
#include <fresco/io/file.h>
#include <fresco/io/image_io.h>
#include <fresco/io/reading.h>
#include <functional>
#include <iomanip>
namespace {
using namespace fresco;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int width = 640, height = 480;
constexpr double f = 520;

/// Of the middle view: its rotation and its place, camera = R (world - center), axes x right, y down, z forward.
struct Place {
  Matrix3d R;
  Vector3d center;
};

Place placeOf(int view)
{
  return {Eigen::AngleAxisd(0.4 + view, Vector3d(1, -0.3 * view, 2).normalized()).toRotationMatrix(),
          Vector3d(0.5 * view, -1, 2)};
}

std::string text(const Eigen::MatrixXd& m, const char* between = " ")
{
  std::string line;
  for (Eigen::Index r = 0; r < m.rows(); ++r)
    for (Eigen::Index c = 0; c < m.cols(); ++c)
      line += concat(line.empty() ? "" : between, std::setprecision(17), m(r, c));
  return line;
}

std::string rowsText(const Eigen::MatrixXd& m)
{
  std::string rows;
  for (Eigen::Index r = 0; r < m.rows(); ++r)
    rows += (r > 0 ? ", [" : "[") + text(m.row(r), ", ") + "]";
  return "[" + rows + "]";
}

Eigen::Matrix4d worldFromCamera(const Place& place)
{
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  T.topLeftCorner<3, 3>() = place.R.transpose();
  T.topRightCorner<3, 1>() = place.center;
  return T;
}

/// A file of two photographs and how its program says that points are projected.
struct Format {
  const char* file;
  std::string content;
  /// Pixel, the first one's centre being (0.5, 0.5), of a point in the camera's frame (x right, y down, z forward).
  std::function<Vector2d(const Vector3d&)> pixel;
  std::size_t points = 0;
};

// Manual of Metashape, appendix D.
Format metashape()
{
  constexpr double cx = 3.5, cy = -2.25, b1 = 1.5, b2 = -0.4, k1 = -0.1, k2 = 0.03, k3 = -0.01, k4 = 0.004, p1 = 1e-3,
                   p2 = -4e-4;
  const Matrix3d R = Eigen::AngleAxisd(1.1, Vector3d(0, 1, 1).normalized()).toRotationMatrix();
  const Vector3d t(10, 20, -5);
  const double scale = 2.5; // world = scale R chunk + t
  std::string cameras;
  for (int v = 0; v < 2; ++v) {
    Eigen::Matrix4d T = worldFromCamera(placeOf(v));
    T.topLeftCorner<3, 3>() = (R.transpose() * T.topLeftCorner<3, 3>()).eval();
    T.topRightCorner<3, 1>() = (R.transpose() * (T.topRightCorner<3, 1>() - t) / scale).eval();
    cameras +=
        concat("<camera id='", v, "' sensor_id='4' label='photo", v, "'><transform>", text(T), "</transform></camera>");
  }
  const std::string content = concat(
      "<?xml version='1.0'?><document version='2.0.0'><chunk><sensors><sensor id='4' type='frame'><resolution width='",
      width, "' height='", height, "'/><calibration type='frame' class='initial'><f>1</f></calibration>",
      "<calibration type='frame' class='adjusted'><f>", f, "</f><cx>", cx, "</cx><cy>", cy, "</cy><b1>", b1,
      "</b1><b2>", b2, "</b2><k1>", k1, "</k1><k2>", k2, "</k2><k3>", k3, "</k3><k4>", k4, "</k4><p1>", p1, "</p1><p2>",
      p2, "</p2></calibration></sensor></sensors><cameras><group>", cameras,
      "</group><camera id='7' sensor_id='4' label='not aligned'/></cameras><transform><rotation>", text(R),
      "</rotation><translation>", text(t), "</translation><scale>", scale, "</scale></transform></chunk></document>");
  return {"cameras.xml", content, [=](const Vector3d& q) -> Vector2d {
            const double x = q.x() / q.z(), y = q.y() / q.z(), r2 = x * x + y * y;
            const double radial = 1 + k1 * r2 + k2 * r2 * r2 + k3 * std::pow(r2, 3) + k4 * std::pow(r2, 4);
            const double u = x * radial + p1 * (r2 + 2 * x * x) + 2 * p2 * x * y;
            const double v = y * radial + p2 * (r2 + 2 * y * y) + 2 * p1 * x * y;
            return {0.5 * width + cx + u * f + u * b1 + v * b2, 0.5 * height + cy + v * f};
          }};
}

// Manual of Bundler 0.4, section 5: P = R X + t, p = -P / P.z, p' = f r(p) p, from the middle, upwards.
Format bundler()
{
  constexpr double k1 = -0.12, k2 = 0.05;
  const Matrix3d turn = Vector3d(1, -1, -1).asDiagonal(); // x right, y up, z back
  std::string lines = "# Bundle file v0.3\n3 1\n0 0 0\n0 0 0\n0 0 0\n0 0 0\n0 0 0\n";
  for (int v = 0; v < 2; ++v) {
    const Matrix3d R = turn * placeOf(v).R;
    lines += concat(f, " ", k1, " ", k2, "\n", text(R), "\n", text(-(R * placeOf(v).center)), "\n");
  }
  lines += "1 2 3\n255 128 0\n2 1 17 10 20.5 0 3 1 1\n";
  return {"bundle.out", lines,
          [=](const Vector3d& q) -> Vector2d {
            const Vector3d P = turn * q;
            const Vector2d p = -P.head<2>() / P.z();
            const double r2 = p.squaredNorm();
            const Vector2d from_middle = f * (1 + k1 * r2 + k2 * r2 * r2) * p;
            return {0.5 * width + from_middle.x(), 0.5 * height - from_middle.y()};
          },
          1};
}

// VisualSfM: (1 + d (mx^2 + my^2) / f^2) m = f P.xy / P.z for a measured place m from the middle.
Format nvm(bool as_matrix)
{
  constexpr double d = 0.08;
  std::string lines = as_matrix ? "NVM_V3_R9T\n\n2\n" : "NVM_V3\n\n2\n";
  for (int v = 0; v < 2; ++v) {
    const auto [R, center] = placeOf(v);
    const Eigen::Quaterniond q(R);
    lines += concat("/home/some\"one/photo", v, ".jpg\t", f, " ",
                    as_matrix ? text(R) + " " + text(-(R * center))
                              : text(Eigen::Vector4d(q.w(), q.x(), q.y(), q.z())) + " " + text(center),
                    " ", d, " 0\n");
  }
  lines += "1\n1 2 3 255 128 0 2 0 17 10 20.5 1 3 1 1\n\n0\n";
  return {"model.nvm", lines,
          [=](const Vector3d& q) -> Vector2d {
            const Vector2d wanted = q.head<2>() / q.z();
            double r = wanted.norm();
            for (int step = 0; step < 50; ++step) // Newton's method
              r -= ((1 + d * r * r) * r - wanted.norm()) / (1 + 3 * d * r * r);
            return Vector2d(0.5 * width, 0.5 * height) + f * r * wanted.normalized();
          },
          1};
}

// Conventions of nerfstudio: axes of OpenGL, coefficients of OpenCV and k4 of r^8.
Format transforms(bool by_angle)
{
  constexpr double cx = 322.5, cy = 238, k1 = -0.11, k2 = 0.03, k3 = 0.005, k4 = -0.002, p1 = 1e-3, p2 = -5e-4;
  const Matrix3d turn = Vector3d(1, -1, -1).asDiagonal();
  std::string frames;
  for (int v = 0; v < 2; ++v) {
    Eigen::Matrix4d T = worldFromCamera(placeOf(v));
    T.topLeftCorner<3, 3>() = (T.topLeftCorner<3, 3>() * turn).eval();
    frames += concat(v > 0 ? "," : "", "{\"file_path\": \"./photo", v, "\", \"transform_matrix\": ", rowsText(T), "}");
  }
  const std::string lens = by_angle
                               ? concat("\"camera_angle_x\": ", std::setprecision(17), 2 * std::atan(0.5 * width / f))
                               : concat("\"w\": 640, \"h\": 480, \"fl_x\": ", f, ", \"fl_y\": 510, \"cx\": ", cx,
                                        ", \"cy\": ", cy, ", \"k1\": ", k1, ", \"k2\": ", k2, ", \"k3\": ", k3,
                                        ", \"k4\": ", k4, ", \"p1\": ", p1, ", \"p2\": ", p2);
  return {"transforms.json", "{" + lens + ", \"frames\": [" + frames + "]}", [=](const Vector3d& q) -> Vector2d {
            const double x = q.x() / q.z(), y = q.y() / q.z(), r2 = x * x + y * y;
            if (by_angle)
              return {0.5 * width + f * x, 0.5 * height + f * y};
            const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * (k3 + r2 * k4)));
            return {cx + f * (x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x)),
                    cy + 510 * (y * radial + 2 * p2 * x * y + p1 * (r2 + 2 * y * y))};
          }};
}

// OpenMVG: centres of pixels are whole numbers; pinhole_brown_t2 is k1 k2 k3 t1 t2, fisheye k1 k2 k3 k4 of the angle.
Format openMvg(bool fisheye)
{
  constexpr double k1 = -0.05, k2 = 0.02, k3 = 0.01, t1 = 1e-3, t2 = -3e-4, cx = 318, cy = 241;
  std::string views, poses;
  for (int v = 0; v < 2; ++v) {
    const auto [R, center] = placeOf(v);
    views += concat(v > 0 ? "," : "", "{\"key\": ", v,
                    ", \"value\": {\"ptr_wrapper\": {\"data\": {\"local_path\": \"\", \"filename\": "
                    "\"photo",
                    v, ".jpg\", \"id_intrinsic\": 0, \"id_pose\": ", v, "}}}}");
    poses += concat(v > 0 ? "," : "", "{\"key\": ", v, ", \"value\": {\"rotation\": ", rowsText(R), ", \"center\": [",
                    text(center, ", "), "]}}");
  }
  const std::string content = concat(
      "{\"sfm_data_version\": \"0.3\", \"views\": [", views,
      "], \"intrinsics\": [{\"key\": 0, \"value\": {\"ptr_wrapper\": "
      "{\"data\": {\"value0\": {\"width\": 640, \"height\": 480, \"focal_length\": ",
      f, ", \"principal_point\": [", cx, ", ", cy, "]}, ",
      fisheye ? concat("\"fisheye\": [", k1, ", ", k2, ", ", k3, ", 0.002]")
              : concat("\"disto_t2\": [", k1, ", ", k2, ", ", k3, ", ", t1, ", ", t2, "]"),
      "}}}}], \"extrinsics\": [", poses,
      "], \"structure\": [{\"key\": 0, \"value\": {\"X\": [1, 2, 3], \"observations\": "
      "[{\"key\": 0, \"value\": {\"id_feat\": 1, \"x\": [329.5, 260]}}, {\"key\": 9, \"value\": {\"x\": [1, 1]}}]}}]}");
  return {"sfm_data.json", content,
          [=](const Vector3d& q) -> Vector2d {
            const double x = q.x() / q.z(), y = q.y() / q.z(), r2 = x * x + y * y, r = std::sqrt(r2), a = std::atan(r);
            const double bent =
                a * (1 + k1 * a * a + k2 * std::pow(a, 4) + k3 * std::pow(a, 6) + 0.002 * std::pow(a, 8));
            const double radial = 1 + k1 * r2 + k2 * r2 * r2 + k3 * std::pow(r2, 3);
            const Vector2d place = fisheye ? Vector2d(bent / r * Vector2d(x, y))
                                           : Vector2d(x * radial + t2 * (r2 + 2 * x * x) + 2 * t1 * x * y,
                                                      y * radial + t1 * (r2 + 2 * y * y) + 2 * t2 * x * y);
            return Vector2d(cx + 0.5, cy + 0.5) + f * place;
          },
          1};
}

std::vector<Format> formats()
{
  return {metashape(),       bundler(),        nvm(false),     nvm(true),
          transforms(false), transforms(true), openMvg(false), openMvg(true)};
}

class CameraFiles : public testing::Test {
protected:
  CameraFiles() { makeFolder(images_); }

  /// The file and its photographs. @return path of the file
  std::string written(const Format& format) const
  {
    for (int v = 0; v < 2; ++v)
      writeImage(concat(images_, "/photo", v, ".jpg"), Image(width, height, 3, 90));
    writeFile(folder_ + "/list.txt", concat("not placed.jpg\n.\\photo0.jpg 0 ", f, "\nphoto1.jpg\n"));
    writeFile(folder_ + "/" + format.file, format.content);
    return folder_ + "/" + format.file;
  }

  void expectError(const std::string& path, const std::vector<std::string>& said) const
  {
    const std::string reason = test::errorOf([&] { readCameraFile(path, images_); });
    EXPECT_EQ(reason.find('\n'), std::string::npos) << reason;
    for (const std::string& each : said)
      EXPECT_NE(reason.find(each), std::string::npos) << each << " in: " << reason;
  }

  std::string folder_ = test::scratchFolder(), images_ = folder_ + "/images";
};

TEST_F(CameraFiles, ProjectAsTheirDocumentationSays)
{
  for (const Format& format : formats()) {
    const std::string path = written(format);
    EXPECT_EQ(cameraFileIn(path), path);
    const auto [set, points] = readCameraFile(path, images_);
    ASSERT_EQ(set.views.size(), 2u) << format.file;
    for (int v = 0; v < 2; ++v) {
      const View& view = set.views[v];
      const CameraModel& camera = set.cameras[view.camera];
      EXPECT_EQ(view.image, concat("photo", v, ".jpg")) << format.file;
      EXPECT_EQ(camera.width, width);
      EXPECT_LT((view.center() - placeOf(v).center).norm(), 1e-9) << format.file;
      for (int i = 0; i < 200; ++i) {
        const Vector3d q(std::fmod(0.754877666 * i, 1.0) - 0.5, std::fmod(0.569840296 * i, 0.8) - 0.4, 1);
        const Vector3d world = placeOf(v).R.transpose() * (3 * q) + placeOf(v).center;
        EXPECT_LT((project(camera, view.T_camera_world * world) - format.pixel(3 * q)).norm(), 1e-6)
            << format.file << " " << q.transpose();
      }
    }
    ASSERT_EQ(points.size(), format.points) << format.file;
    for (const SparsePoint& point : points) {
      EXPECT_EQ(point.position, Vector3d(1, 2, 3));
      if (format.file == std::string("sfm_data.json")) { // has no colours
        EXPECT_TRUE(point.color.isZero()) << point.color.transpose().cast<int>();
      }
      ASSERT_FALSE(point.track.empty());
      EXPECT_EQ(point.track[0].view, 0);
      EXPECT_EQ(point.track[0].pixel, Vector2d(330, format.file == std::string("bundle.out") ? 219.5 : 260.5));
    }
  }
}

TEST_F(CameraFiles, AFolderStandsForTheFileInIt)
{
  const std::string path = written(metashape());
  EXPECT_EQ(cameraFileIn(folder_), path);
  EXPECT_EQ(readCameraFile(folder_, images_).set.views.size(), 2u);
  writeFile(folder_ + "/transforms.json", transforms(true).content);
  EXPECT_EQ(cameraFileIn(folder_), "");
  expectError(folder_, {folder_, "cameras.xml", "transforms.json", "say which"});
}

/// rigs.txt and frames.txt, of COLMAP since 3.12, or the same as .bin.
TEST_F(CameraFiles, RigsAndFramesOfColmapSayNothingNew)
{
  const std::string folder = folder_ + "/model";
  CameraSet set = readCameraFile(written(bundler()), images_).set;
  writeColmap(folder, set);
  const CameraFile alone = readCameraFile(folder, images_);
  for (const char* name : {"/rigs.txt", "/frames.txt", "/rigs.bin", "/frames.bin"})
    writeFile(folder + name, "# RIG_ID, NUM_SENSORS, ...\n1 1 CAMERA 1\n");
  const CameraFile with_rigs = readCameraFile(folder, images_);
  ASSERT_EQ(with_rigs.set.views.size(), 2u);
  for (int v = 0; v < 2; ++v)
    EXPECT_TRUE(with_rigs.set.views[v].T_camera_world.isApprox(alone.set.views[v].T_camera_world, 0));
}

/// Wherever a file ends too early.
TEST_F(CameraFiles, TruncatedOnesAreErrorsOfOneLine)
{
  for (Format format : formats()) {
    const std::string whole = format.content;
    const std::size_t needed = whole.find_last_not_of("\n 0"); // zeros at the end of NVM say that no more comes
    for (std::size_t cut = 1; cut < 12; ++cut) {
      format.content = whole.substr(0, std::max<std::size_t>(20, needed * cut / 12));
      const std::string path = written(format);
      const std::string reason = test::errorOf([&] { readCameraFile(path, images_); });
      EXPECT_EQ(reason.rfind(path + ": ", 0), 0u) << reason;
      EXPECT_EQ(reason.find('\n'), std::string::npos) << reason;
    }
  }
}

std::string replaced(std::string text, const std::string& what, const std::string& by)
{
  const std::size_t at = text.find(what);
  return at == std::string::npos ? "" : text.replace(at, what.size(), by);
}

TEST_F(CameraFiles, WhatIsMissingIsNamedWithTheCure)
{
  struct Case {
    Format format;
    std::string what, by;
    std::vector<std::string> said;
  };
  const std::vector<Case> cases = {
      {metashape(), "<f>520</f>", "", {"sensor 4", "f", "Export Cameras"}},
      {metashape(), "sensor_id='4'", "sensor_id='5'", {"photo0", "sensor 5", "Export Cameras"}},
      {metashape(), "label='photo0'", "", {"camera 0", "label"}},
      {metashape(), "<p1>", "<p3>1e-5</p3><p1>", {"p3", "without them"}},
      {metashape(),
       "label='photo0'",
       "label='photo9'",
       {"photo9", "no such photograph in " + images_, "copy it there"}},
      {bundler(), "3 1\n", "4 1\n", {"4 cameras", "list.txt", "3 names"}},
      {nvm(false), "photo0.jpg", "photo9.jpg", {"photo9.jpg", "no such photograph"}},
      {transforms(false), "transform_matrix", "matrix", {"photo0", "transform_matrix"}},
      {transforms(false), "fl_x", "f", {"photo0", "fl_x", "camera_angle_x"}},
      {transforms(false), "photo0", "photo9", {"photo9", "no such photograph"}},
      {openMvg(false), "focal_length", "focal", {"focal_length"}},
      {openMvg(false), "\"id_intrinsic\": 0", "\"id_intrinsic\": 8", {"photo0.jpg", "intrinsic"}},
      {openMvg(false), "photo0", "photo9", {"photo9", "no such photograph"}},
  };
  for (Case each : cases) {
    each.format.content = replaced(each.format.content, each.what, each.by);
    ASSERT_FALSE(each.format.content.empty()) << each.what;
    const std::string path = written(each.format);
    each.said.insert(each.said.begin(), path);
    expectError(path, each.said);
  }
}

TEST_F(CameraFiles, SizesThatTheFileDoesNotTellWantThePhotographs)
{
  const std::string untold = test::errorOf([&] { readCameraFile(written(bundler()), ""); });
  EXPECT_NE(untold.find("-images"), std::string::npos) << untold;
  EXPECT_EQ(readCameraFile(written(metashape()), "").set.views[0].image, "photo0");
  expectError(images_ + "/photo0.jpg", {"photo0.jpg: no cameras", "Metashape"});
  expectError(images_ + "/none", {"none: no such file"});
  expectError(images_, {images_ + ": no cameras", "COLMAP"});
  const std::string path = written(metashape());
  images_ += "/none";
  expectError(path, {"cameras.xml", images_});
}

TEST_F(CameraFiles, GeoreferencedChunksAndUnalignedPhotographsAreTold)
{
  std::vector<std::string> remarks;
  listenToReaders([&](const std::string& remark) { remarks.push_back(remark); });
  Format format = metashape();
  format.content = replaced(format.content, "</chunk>", "<reference>GEOGCS[\"WGS 84\"]</reference></chunk>");
  readCameraFile(written(format), images_);
  listenToReaders({});
  ASSERT_EQ(remarks.size(), 2u);
  EXPECT_NE(remarks[0].find("geocentric"), std::string::npos);
  EXPECT_NE(remarks[1].find("1 photographs"), std::string::npos);
}

TEST_F(CameraFiles, PhotographsMayLieDeeperAndHaveAnotherExtensionButNotTwice)
{
  const std::string path = written(openMvg(false));
  makeFolder(images_ + "/day 1");
  std::filesystem::rename(images_ + "/photo0.jpg", images_ + "/day 1/photo0.JPG");
  EXPECT_EQ(readCameraFile(path, images_).set.views[0].image, "day 1/photo0.JPG");
  makeFolder(images_ + "/masks"); // of the same names
  writeImage(images_ + "/masks/photo0.png", Image(width, height));
  EXPECT_EQ(readCameraFile(path, images_).set.views[0].image, "day 1/photo0.JPG");
  writeImage(images_ + "/photo0.png", Image(width, height));
  expectError(path, {path, "photo0.png", "day 1/photo0.JPG", "move one"});
}
} // namespace
