// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Eigenvalues>
#include <cmath>
#include <cstring>
#include <fresco/core/parallel.h>
#include <fresco/io/file.h>
#include <fresco/search/neighbors.h>
#include <fresco/simulation/sensors/layout_files.h>
namespace fresco::simulation {
namespace {
/// Appends a value as it lies in memory.
template <typename T>
void put(std::string& bytes, T value)
{
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}
} // namespace

Image enlarged(const Image& image, int width, int height)
{
  Image out(width, height, image.channels);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      std::copy_n(image.pixel(x * image.width / width, y * image.height / height), image.channels, out.pixel(x, y));
  return out;
}

Image16 enlarged(const Image16& image, int width, int height)
{
  Image16 out{width, height, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      out.data.push_back(image.data[std::size_t(y * image.height / height) * image.width + x * image.width / width]);
  return out;
}

std::string lasFile(const PointSet& set, const std::vector<double>& times)
{
  constexpr double unit = 1e-4; // metres
  const std::vector<Index> finite = finiteColumns(set.points);
  const Eigen::Vector3d offset = set.origin.array().round();
  Eigen::Array3d low = Eigen::Array3d::Constant(INFINITY), high = -low;
  std::string points;
  for (const Index i : finite) {
    const Eigen::Array3d at = set.origin + set.points.col(i).cast<double>();
    low = low.min(at), high = high.max(at);
    for (int k = 0; k < 3; ++k)
      put(points, std::int32_t(std::lround((at[k] - offset[k]) / unit)));
    put(points,
        std::uint16_t(set.intensities.size() > 0 ? 65535 * std::min(1.f, std::max(0.f, set.intensities[i])) : 0));
    points += std::string("\x09\x01\x00\x00\x00\x00", 6); // first return of one, class 1, angle, user data, source
    if (!times.empty())
      put(points, times[i]);
    for (int k = 0; k < 3; ++k)
      put(points, std::uint16_t(set.colors.cols() > 0 ? 257 * set.colors(k, i) : 0));
  }
  std::string head("LASF", 4);
  head.resize(24, '\0');
  head += std::string("\x01\x02", 2);
  head.resize(94, '\0');
  put(head, std::uint16_t(227)); // bytes of the header
  put(head, std::uint32_t(227)); // where points begin
  put(head, std::uint32_t(0));
  put(head, std::uint8_t(times.empty() ? 2 : 3));    // point format
  put(head, std::uint16_t(times.empty() ? 26 : 34)); // bytes of a point
  put(head, std::uint32_t(finite.size()));
  put(head, std::uint32_t(finite.size()));
  head.resize(131, '\0');
  for (int k = 0; k < 3; ++k)
    put(head, unit);
  for (int k = 0; k < 3; ++k)
    put(head, offset[k]);
  for (int k = 0; k < 3; ++k) {
    put(head, high[k]);
    put(head, low[k]);
  }
  return head + points;
}

Points nearbyNormals(const PointSet& set)
{
  constexpr int neighbors = 10;
  const PointTree tree(set.points, 0);
  Points normals = Points::Constant(3, set.size(), NAN);
  parallelFor(set.size(), 0, [&](Index i) {
    std::vector<Neighbor> near;
    tree.nearest(set.points.col(i), neighbors, near);
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const Neighbor& other : near)
      mean += set.points.col(other.index).cast<double>() / double(near.size());
    for (const Neighbor& other : near) {
      const Eigen::Vector3d arm = set.points.col(other.index).cast<double>() - mean;
      covariance += arm * arm.transpose();
    }
    const Eigen::Vector3f normal =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvectors().col(0).cast<float>();
    normals.col(i) = normal.dot(set.viewpoints.col(0) - set.points.col(i)) < 0 ? Eigen::Vector3f(-normal) : normal;
  });
  return normals;
}
} // namespace fresco::simulation
