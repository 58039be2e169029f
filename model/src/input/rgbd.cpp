// SPDX-License-Identifier: BSD-3-Clause
#include "input/rgbd.h"
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <filesystem>
#include <fresco/core/constants.h>
#include <fresco/core/parallel.h>
#include <fresco/core/poses.h>
#include <fresco/core/require.h>
#include <fresco/io/file.h>
#include <fresco/io/image_io.h>
#include <map>
#include <numeric>
#include <sstream>
namespace fresco::model {
namespace {
namespace fs = std::filesystem;

/// `rows` x `columns` numbers, nothing else; "nan" and "inf" are numbers, too.
Eigen::MatrixXd readMatrix(const std::string& path, int rows, int columns)
{
  std::istringstream words(readFile(path));
  Eigen::MatrixXd matrix(rows, columns);
  std::string word;
  for (int i = 0; i < rows * columns; ++i) {
    char* end = nullptr;
    if (!(words >> word) || (matrix(i / columns, i % columns) = std::strtod(word.c_str(), &end), *end != '\0'))
      throw std::runtime_error(concat(path, ": wants ", rows, "x", columns, " numbers"));
  }
  return matrix;
}

CameraModel depthCamera(const std::string& path, const std::string& depth)
{
  const Eigen::MatrixXd K = readMatrix(path, 3, 3);
  const Image16 first = readImage16(depth);
  CameraModel camera{first.width, first.height, K(0, 0), K(1, 1), K(0, 2) + 0.5, K(1, 2) + 0.5, 0, 0, 0, 0};
  try {
    validateCamera(camera);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(path + ": " + error.what());
  }
  return camera;
}

/// 3 x (width * height): what each pixel looks along, z = 1.
Points beamsOf(const CameraModel& camera)
{
  Points beams(3, Index(camera.width) * camera.height);
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x)
      beams.col(Index(y) * camera.width + x) = unproject(camera, {x + 0.5, y + 0.5}).cast<float>();
  return beams;
}

/// One depth image with what a plane fit needs.
struct DepthField {
  const Image16& image;
  const CameraModel& camera;
  const DepthOptions& options;
  const Points beams;

  /// Metres; 0 = none.
  float at(int x, int y) const
  {
    const std::uint16_t raw = image.data[Index(y) * image.width + x];
    const float z = raw == 65535 ? 0.f : 1e-3f * raw;
    return z >= options.nearest && z <= options.farthest ? z : 0.f;
  }

  Eigen::Vector3f point(int x, int y, float z) const { return z * beams.col(Index(y) * image.width + x); }
};

struct Plane {
  Eigen::Vector3f center, normal;
  float thickness; ///< standard deviation across
};

/// Plane through the pixels around (x, y) whose depth is close to `z`; nothing where there are too few.
bool fitPlane(const DepthField& field, int x, int y, Plane& plane)
{
  const float z = field.at(x, y);
  const float share = field.options.radius, radius = share * z + 0.01f;
  const double widest = std::max(field.image.width, field.image.height);
  const int reach = std::max(2, static_cast<int>(std::min(radius * field.camera.fx / z, widest)));
  const int step = std::max(1, reach / 4);
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  Eigen::Matrix3f squares = Eigen::Matrix3f::Zero();
  const Eigen::Vector3f middle = field.point(x, y, z);
  int asked = 0, used = 0;
  for (int v = y - reach; v <= y + reach; v += step)
    for (int u = x - reach; u <= x + reach; u += step) {
      ++asked;
      if (u < 0 || v < 0 || u >= field.image.width || v >= field.image.height)
        continue;
      const float other = field.at(u, v);
      if (other == 0.f || std::abs(other - z) > 2.f * radius)
        continue;
      const Eigen::Vector3f d = field.point(u, v, other) - middle;
      sum += d;
      squares += d * d.transpose();
      ++used;
    }
  if (used < 12 || 2 * used < asked)
    return false;
  const Eigen::Vector3f mean = sum / used;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver;
  solver.computeDirect(squares / used - mean * mean.transpose());
  plane.center = middle + mean;
  plane.normal = solver.eigenvectors().col(0);
  if (plane.normal.dot(middle) > 0.f)
    plane.normal = -plane.normal;
  plane.thickness = std::sqrt(std::max(0.f, solver.eigenvalues()[0]));
  return plane.thickness < 0.3f * radius;
}
} // namespace

bool isRgbdFolder(const std::string& folder) { return fs::exists(folder + "/camera-intrinsics.txt"); }

RgbdFolder readRgbdFolder(const std::string& folder)
{
  std::map<std::string, RgbdFrame> frames;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string file = entry.path().filename().string();
    const std::size_t end = file.find(".depth.png");
    if (file.rfind("frame-", 0) == 0 && end != std::string::npos && end + 10 == file.size())
      frames[file.substr(0, end)].depth = entry.path().string();
  }
  if (frames.empty())
    throw std::runtime_error(folder + ": no frame-*.depth.png in it");
  RgbdFolder result;
  result.camera = depthCamera(folder + "/camera-intrinsics.txt", frames.begin()->second.depth);
  for (auto& [name, frame] : frames) {
    frame.name = name;
    const std::string stem = folder + "/" + name;
    frame.color = fs::exists(stem + ".color.png") ? stem + ".color.png" : stem + ".color.jpg";
    if (!fs::exists(frame.color))
      throw std::runtime_error(frame.color + ": no such file, but " + frame.depth + " is there");
    const Eigen::MatrixXd T = readMatrix(stem + ".pose.txt", 4, 4);
    if (!T.allFinite())
      continue;
    const Eigen::Matrix3d R = T.topLeftCorner<3, 3>();
    if ((R * R.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() > 0.02 || !(R.determinant() > 0) ||
        !isInReach(T.topRightCorner<3, 1>()))
      throw std::runtime_error(stem + ".pose.txt: not a rigid transform");
    frame.T_world_camera.linear() = Eigen::Quaterniond(R).normalized().toRotationMatrix();
    frame.T_world_camera.translation() = T.topRightCorner<3, 1>();
    result.frames.push_back(frame);
  }
  if (result.frames.empty())
    throw std::runtime_error(folder + ": no frame has a finite pose");
  return result;
}

PointSet depthPoints(const Image16& depth, const CameraModel& camera, const DepthOptions& options, int threads)
{
  require(depth.width == camera.width && depth.height == camera.height, "depth image: ", depth.width, "x", depth.height,
          " pixels, the camera has ", camera.width, "x", camera.height);
  require(options.stride >= 1 && options.nearest > 0 && options.farthest > options.nearest && options.radius > 0,
          "depth image: an option is out of range");
  const DepthField field{depth, camera, options, beamsOf(camera)};
  const int columns = (depth.width + options.stride - 1) / options.stride;
  const int rows = (depth.height + options.stride - 1) / options.stride;
  const float least_cosine = std::cos(options.grazing * pi / 180.0);
  PointSet all;
  all.points.resize(3, Index(columns) * rows);
  all.normals.resize(3, all.size());
  all.confidences.setZero(all.size());
  parallelFor(
      rows, threads,
      [&](Index row) {
        for (int column = 0; column < columns; ++column) {
          const int x = column * options.stride, y = row * options.stride;
          Plane plane;
          if (field.at(x, y) == 0.f || !fitPlane(field, x, y, plane))
            continue;
          const Eigen::Vector3f beam = field.point(x, y, 1.f);
          const float cosine = -plane.normal.dot(beam) / beam.norm();
          const float z = plane.normal.dot(plane.center) / plane.normal.dot(beam);
          if (cosine < least_cosine || !(std::abs(z - field.at(x, y)) < 0.03f * z))
            continue;
          const Index i = row * columns + column;
          all.points.col(i) = z * beam;
          all.normals.col(i) = plane.normal;
          all.confidences[i] = cosine / (z * z);
        }
      },
      1);
  std::vector<Index> kept;
  for (Index i = 0; i < all.size(); ++i)
    if (all.confidences[i] > 0.f)
      kept.push_back(i);
  PointSet result = selectPoints(all, kept);
  result.viewpoints = Points::Zero(3, 1);
  return result;
}
} // namespace fresco::model
