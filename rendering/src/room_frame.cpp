// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <complex>
#include <fresco/core/constants.h>
#include <fresco/core/require.h>
#include <fresco/rendering/room_frame.h>
#include <numeric>
namespace fresco::rendering {
namespace {
/// Some faces of a mesh, evenly picked.
struct FaceSample {
  Eigen::Matrix3Xd normals, centers;
  Eigen::VectorXd areas;
};

FaceSample sampleFaces(const TriangleMesh& mesh)
{
  constexpr Index most = 50000;
  const Index step = std::max<Index>(1, mesh.faceCount() / most);
  FaceSample sample;
  const Index capacity = (mesh.faceCount() + step - 1) / step;
  sample.normals.resize(3, capacity);
  sample.centers.resize(3, capacity);
  sample.areas.resize(capacity);
  Index count = 0;
  for (Index f = 0; f < mesh.faceCount(); f += step) {
    const Eigen::Vector3d normal = areaVector(mesh, f);
    if (!(normal.norm() > 0))
      continue;
    sample.normals.col(count) = normal.normalized();
    sample.centers.col(count) = (faceCorner(mesh, f, 0) + faceCorner(mesh, f, 1) + faceCorner(mesh, f, 2)) / 3;
    sample.areas[count++] = 0.5 * normal.norm();
  }
  require(count > 0, "view: the mesh has no face with an area");
  sample.normals.conservativeResize(3, count);
  sample.centers.conservativeResize(3, count);
  sample.areas.conservativeResize(count);
  return sample;
}

/// Area whose normal is within 12 degrees of +-`direction`.
double parallelArea(const FaceSample& sample, const Eigen::Vector3d& direction)
{
  static const double cosine = std::cos(12 * pi / 180);
  double area = 0;
  for (Index i = 0; i < sample.areas.size(); ++i)
    if (std::abs(sample.normals.col(i).dot(direction)) > cosine)
      area += sample.areas[i];
  return area;
}

/// Main direction of the normals within 12 degrees of +-`direction`, a few times over.
Eigen::Vector3d refine(const FaceSample& sample, Eigen::Vector3d direction)
{
  static const double cosine = std::cos(12 * pi / 180);
  for (int round = 0; round < 4; ++round) {
    Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
    for (Index i = 0; i < sample.areas.size(); ++i)
      if (std::abs(sample.normals.col(i).dot(direction)) > cosine)
        moment += sample.areas[i] * sample.normals.col(i) * sample.normals.col(i).transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moment);
    const Eigen::Vector3d main = solver.eigenvectors().col(2);
    direction = main.dot(direction) < 0 ? Eigen::Vector3d(-main) : main;
  }
  return direction;
}

/// Value that `share` of the area lies below.
double areaQuantile(const Eigen::VectorXd& values, const Eigen::VectorXd& areas, double share)
{
  std::vector<Index> order(values.size());
  std::iota(order.begin(), order.end(), Index(0));
  std::sort(order.begin(), order.end(), [&](Index a, Index b) { return values[a] < values[b]; });
  const double wanted = share * areas.sum();
  double below = 0;
  for (const Index i : order)
    if ((below += areas[i]) >= wanted)
      return values[i];
  return values[order.back()];
}

/// Second moments of where the area lies.
Eigen::Matrix3d spread(const FaceSample& sample)
{
  const Eigen::Vector3d mean = sample.centers * sample.areas / sample.areas.sum();
  const Eigen::Matrix3Xd offsets = sample.centers.colwise() - mean;
  return offsets * sample.areas.asDiagonal() * offsets.transpose() / sample.areas.sum();
}

Eigen::Vector3d upright(const FaceSample& sample)
{
  static const double near_axis = std::cos(15 * pi / 180); // the z of a tilted camera is farther off
  const Eigen::Matrix3d moments = spread(sample);
  Eigen::Vector3d best = Eigen::Vector3d::UnitZ();
  double most = -1;
  for (const Eigen::Vector3d& direction : evenDirections(300, 0, 1)) {
    const double extent = std::sqrt(direction.dot(moments * direction)) + 1e-6 * std::sqrt(moments.trace());
    const double custom = std::abs(direction.z()) > near_axis ? 1.6 : 1.0;
    const double score = custom * parallelArea(sample, direction) / std::sqrt(extent);
    if (score > most) {
      most = score;
      best = direction;
    }
  }
  best = refine(sample, best);
  if (std::abs(best.z()) > near_axis)
    return best.z() < 0 ? Eigen::Vector3d(-best) : best;
  const Eigen::VectorXd heights = (best.transpose() * sample.centers).transpose();
  const double middle = 0.5 * (areaQuantile(heights, sample.areas, 0.01) + areaQuantile(heights, sample.areas, 0.99));
  return heights.dot(sample.areas) / sample.areas.sum() > middle ? Eigen::Vector3d(-best) : best;
}

/// Horizontal direction that most upright surfaces are parallel or orthogonal to:
/// mean of their angles modulo 90 degrees.
Eigen::Vector3d wallDirection(const FaceSample& sample, const Eigen::Vector3d& up)
{
  const Eigen::Vector3d x = up.unitOrthogonal(), y = up.cross(x);
  std::complex<double> sum = 0;
  for (Index i = 0; i < sample.areas.size(); ++i) {
    const Eigen::Vector3d n = sample.normals.col(i);
    if (std::abs(n.dot(up)) < 0.2)
      sum += std::polar(sample.areas[i], 4 * std::atan2(n.dot(y), n.dot(x)));
  }
  const double angle = std::abs(sum) > 0 ? std::arg(sum) / 4 : 0;
  return std::cos(angle) * x + std::sin(angle) * y;
}
} // namespace

std::vector<Eigen::Vector3d> evenDirections(int count, double first_z, double last_z)
{
  std::vector<Eigen::Vector3d> directions;
  for (int i = 0; i < count; ++i) {
    const double z = first_z + (last_z - first_z) * (i + 0.5) / count;
    const double angle = i * pi * (3 - std::sqrt(5.0)), r = std::sqrt(1 - z * z);
    directions.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
  }
  return directions;
}

Eigen::Vector3d guessUp(const TriangleMesh& mesh) { return upright(sampleFaces(mesh)); }

RoomFrame findRoomFrame(const TriangleMesh& mesh, const std::optional<Eigen::Vector3d>& up)
{
  require(!up || (up->allFinite() && up->norm() > 0), "view: the up direction is zero or not finite");
  const FaceSample sample = sampleFaces(mesh);
  RoomFrame frame;
  frame.up = up ? up->normalized() : upright(sample);
  frame.along = wallDirection(sample, frame.up);
  frame.across = frame.up.cross(frame.along);
  const Eigen::Vector3d axes[] = {frame.along, frame.across, frame.up};
  for (int k = 0; k < 3; ++k) {
    const Eigen::VectorXd values = (axes[k].transpose() * sample.centers).transpose();
    frame.low[k] = areaQuantile(values, sample.areas, 0.01);
    frame.high[k] = areaQuantile(values, sample.areas, 0.99);
  }
  return frame;
}
} // namespace fresco::rendering
