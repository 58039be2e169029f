// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <fresco/core/constants.h>
#include <fresco/core/require.h>
#include <fresco/core/statistics.h>
#include <fresco/rendering/viewpoint.h>
#include <limits>
#include <utility>
namespace fresco::rendering {
namespace {

void validateFraming(const Framing& framing)
{
  require(framing.direction.allFinite() && framing.direction.norm() > 0, "view: the direction is zero or not finite");
  require(framing.up.allFinite() && framing.up.norm() > 0, "view: the up direction is zero or not finite");
  require(framing.angle >= 1 && framing.angle <= 170, "view: angle ", framing.angle, " is not in 1..170 degrees");
  require(framing.aspect > 0 && std::isfinite(framing.aspect), "view: aspect ratio ", framing.aspect,
          " is not above 0");
  require(framing.margin >= 0 && framing.margin <= 0.4, "view: margin ", framing.margin, " is not in 0..0.4");
}

/// Largest value of each of four linear functions of the points; each bounds the eye by one side of the view frustum.
struct Extent {
  Eigen::Array4d sides = Eigen::Array4d::Constant(-std::numeric_limits<double>::infinity());
  double near = -std::numeric_limits<double>::infinity(), far = std::numeric_limits<double>::infinity();
};

/// The finite points in camera axes: x right, y up, z backward.
Eigen::Matrix3Xd inCameraAxes(const Points& points, const Eigen::Matrix3d& axes)
{
  const std::vector<Index> finite = finiteColumns(points);
  Eigen::Matrix3Xd seen(3, finite.size());
  for (Index i = 0; i < seen.cols(); ++i)
    seen.col(i) = axes.transpose() * points.col(finite[i]).cast<double>();
  return seen;
}

/// With t the tangent of half the opening angle, a point is between the left and right side seen from eye e if
/// x + t z <= e_x + t e_z  and  -x + t z <= -e_x + t e_z; likewise in y.
Extent measure(const Eigen::Matrix3Xd& points, const Eigen::Array2d& tangent)
{
  Extent extent;
  for (Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3d p = points.col(i);
    const double tx = tangent.x() * p.z(), ty = tangent.y() * p.z();
    extent.sides = extent.sides.max(Eigen::Array4d(p.x() + tx, -p.x() + tx, p.y() + ty, -p.y() + ty));
    extent.near = std::max(extent.near, p.z());
    extent.far = std::min(extent.far, p.z());
  }
  return extent;
}

/// Moves the eye along `axis` until the outermost points lie equally far from the middle of the picture on both sides.
void centre(Eigen::Vector3d& eye, const Eigen::Matrix3Xd& points, int axis)
{
  for (int round = 0; round < 4; ++round) { // the outermost points seldom change after the first
    const Eigen::ArrayXd depths = eye.z() - points.row(2).transpose().array();
    const Eigen::ArrayXd seen = (points.row(axis).transpose().array() - eye[axis]) / depths;
    Index low = 0, high = 0;
    seen.minCoeff(&low);
    seen.maxCoeff(&high);
    eye[axis] = (points(axis, high) * depths[low] + points(axis, low) * depths[high]) / (depths[low] + depths[high]);
  }
}

Viewpoint frame(const Points& given, const Eigen::Vector3d& origin, const Framing& framing)
{
  validateFraming(framing);
  const Eigen::Matrix3d axes = cameraAxes(framing.direction, framing.up);
  const Eigen::Matrix3Xd points = inCameraAxes(given, axes);
  require(points.cols() > 0, "view: the model has no finite point");
  const double half = std::tan(0.5 * framing.angle * radians_per_degree) * (1 - 2 * framing.margin);
  const Eigen::Array2d tangent(half * framing.aspect, half);
  const Extent e = measure(points, tangent);
  const double depth = e.near - e.far;
  const double least =
      e.near + std::max(0.05 * depth, 1e-3 * std::max(1e-3, std::abs(e.near))); // a point, a flat model
  const double width = (e.sides[0] + e.sides[1]) / (2 * tangent.x());
  const double height = (e.sides[2] + e.sides[3]) / (2 * tangent.y());
  Eigen::Vector3d eye(0.5 * (e.sides[0] - e.sides[1]), 0.5 * (e.sides[2] - e.sides[3]),
                      std::max({least, width, height}));
  centre(eye, points, 0);
  centre(eye, points, 1);
  const Eigen::Vector3d look(eye.x(), eye.y(), 0.5 * (e.near + e.far));
  return {origin + axes * eye, origin + axes * look, axes.col(1), framing.angle};
}

/// The points without stray ones: within the box that holds all but 0.5 % of the points at each of its sides, enlarged
/// by a fifth of its size to each side.
Points usualPoints(const Points& points)
{
  std::vector<Index> kept = finiteColumns(points);
  for (int axis = 0; axis < 3 && !kept.empty(); ++axis) {
    std::vector<float> values;
    for (const Index i : kept)
      values.push_back(points(axis, i));
    const auto cut = values.size() / 200;
    const float low = rankedValue(values, cut);
    const float high = rankedValue(values, values.size() - 1 - cut), rim = 0.2f * (high - low);
    kept.erase(
        std::remove_if(kept.begin(), kept.end(),
                       [&](Index i) { return !(points(axis, i) >= low - rim && points(axis, i) <= high + rim); }),
        kept.end());
  }
  return points(Eigen::all, kept);
}

/// For z up. `top` and `bottom` show x to the right and y upwards.
const std::array<std::pair<const char*, Eigen::Vector3d>, 7>& directions()
{
  static const std::array<std::pair<const char*, Eigen::Vector3d>, 7> all{{{"corner", Framing{}.direction},
                                                                           {"front", {0, -1, 0}},
                                                                           {"back", {0, 1, 0}},
                                                                           {"left", {-1, 0, 0}},
                                                                           {"right", {1, 0, 0}},
                                                                           {"top", {0, 0, 1}},
                                                                           {"bottom", {0, 0, -1}}}};
  return all;
}
} // namespace

Viewpoint frameView(const TriangleMesh& mesh, const Framing& framing)
{
  validateMesh(mesh);
  return frame(mesh.faceCount() > 0 ? removeUnreferencedVertices(mesh).vertices : mesh.vertices, mesh.origin, framing);
}

Viewpoint frameView(const PointSet& set, const Framing& framing)
{
  return frame(usualPoints(set.points), set.origin, framing);
}

Eigen::Vector3d viewDirection(const std::string& name, const Eigen::Vector3d& up)
{
  require(up.allFinite() && up.norm() > 0, "view: the up direction is zero or not finite");
  const auto turn = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), up);
  for (const auto& [known, direction] : directions())
    if (name == known)
      return turn * direction;
  throw std::invalid_argument("view: '" + name + "' is not known");
}

const std::vector<std::string>& viewNames()
{
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const auto& entry : directions())
      list.emplace_back(entry.first);
    return list;
  }();
  return names;
}

void validateViewpoint(const Viewpoint& view)
{
  require(view.eye.allFinite() && view.look.allFinite() && view.up.allFinite(), "view: a coordinate is not finite");
  require((view.eye - view.look).norm() > 0, "view: eye and look are the same point");
  require(view.up.norm() > 0, "view: the up direction is zero");
  require(view.angle >= 1 && view.angle <= 170, "view: angle ", view.angle, " is not in 1..170 degrees");
}

Eigen::Matrix3d cameraAxes(const Eigen::Vector3d& backward, const Eigen::Vector3d& up)
{
  Eigen::Matrix3d axes;
  axes.col(2) = backward.normalized();
  Eigen::Vector3d right = up.normalized().cross(axes.col(2));
  if (right.norm() < 1e-3) {
    const Eigen::Vector3d other =
        std::abs(up.normalized().y()) < 0.9 ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitZ();
    right = other.cross(axes.col(2));
  }
  axes.col(0) = right.normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return axes;
}
} // namespace fresco::rendering
