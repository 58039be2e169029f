// SPDX-License-Identifier: BSD-3-Clause
#include "filters/clouds.h"
#include <fresco/filters/core/normal_orientation.h>
#include <fresco/filters/core/oriented_normals.h>
#include <random>
namespace fresco {
namespace {
/// Points of the sides of a box with normals inwards or outwards.
void addBox(const Eigen::Vector3f& low, const Eigen::Vector3f& high, bool inwards, std::vector<Eigen::Vector3f>& points,
            std::vector<Eigen::Vector3f>& normals)
{
  std::mt19937 random(points.size() + 1);
  std::uniform_real_distribution<float> uniform;
  std::normal_distribution<float> noise(0, 0.002f);
  const Eigen::Vector3f size = high - low;
  for (int axis = 0; axis < 3; ++axis)
    for (const bool upper : {false, true}) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3, count = int(size[u] * size[v] * 1200);
      for (int k = 0; k < count; ++k) {
        Eigen::Vector3f point = low, normal = Eigen::Vector3f::Zero();
        point[u] += size[u] * uniform(random);
        point[v] += size[v] * uniform(random);
        point[axis] = (upper ? high : low)[axis] + noise(random);
        normal[axis] = upper == inwards ? -1.f : 1.f;
        points.push_back(point);
        normals.push_back(normal);
      }
    }
}

struct Merged {
  Points points, truth;
};

Merged collected(const std::vector<Eigen::Vector3f>& points, const std::vector<Eigen::Vector3f>& normals)
{
  return {Eigen::Map<const Points>(points[0].data(), 3, points.size()),
          Eigen::Map<const Points>(normals[0].data(), 3, normals.size())};
}

/// Two rooms with a wall of 12 cm between them, a cupboard and a lamp that hangs in the air.
Merged rooms()
{
  std::vector<Eigen::Vector3f> points, normals;
  addBox({0, 0, 0}, {4, 3, 2.5f}, true, points, normals);
  addBox({4.12f, 0, 0}, {7, 3, 2.5f}, true, points, normals);
  addBox({1, 1, 0.15f}, {2, 1.6f, 1.6f}, false, points, normals);
  addBox({5, 1, 1.5f}, {5.4f, 1.4f, 1.9f}, false, points, normals);
  return collected(points, normals);
}

double wrongShare(const Points& normals, const Points& truth)
{
  double wrong = 0, all = 0;
  for (Index i = 0; i < normals.cols(); ++i)
    if (std::abs(normals.col(i).dot(truth.col(i))) > 0.5f) { // beside edges the fit has no side
      ++all;
      wrong += normals.col(i).dot(truth.col(i)) < 0;
    }
  return wrong / all;
}

Points fitted(const Points& points)
{
  PointSet set;
  set.points = points;
  return estimateNormals(set).normals;
}

TEST(FreeSide, OfRoomsIsWithinAndOfThingsInThemAround)
{
  const Merged merged = rooms();
  Points normals = fitted(merged.points);
  orientToFreeSide(merged.points, {}, normals);
  EXPECT_LT(wrongShare(normals, merged.truth), 0.01);
}

TEST(FreeSide, DoesNotDependOnSignsFrameOrThreads)
{
  const Merged merged = rooms();
  const Points fits = fitted(merged.points);
  Points one = fits, four = fits, turned = fits;
  orientToFreeSide(merged.points, {}, one, 1);
  orientToFreeSide(merged.points, {}, four, 4);
  EXPECT_EQ(one, four);
  for (Index i = 0; i < turned.cols(); i += 3)
    turned.col(i) *= -1;
  const Eigen::Matrix3f R = Eigen::AngleAxisf(0.7f, Eigen::Vector3f(1, 2, 3).normalized()).toRotationMatrix();
  const Points moved = (R * merged.points).colwise() + Eigen::Vector3f(30, -20, 5);
  turned = R * turned;
  orientToFreeSide(moved, {}, turned, 0);
  EXPECT_LT(wrongShare(turned, R * merged.truth), 0.01);
}

TEST(FreeSide, OfAThingSeenFromAroundIsOutside)
{
  std::vector<Eigen::Vector3f> points, normals;
  addBox({0, 0, 0}, {1, 1, 1}, false, points, normals);
  const Merged thing = collected(points, normals);
  Points found = fitted(thing.points);
  FreeSideHints hints;
  hints.outside = true;
  orientToFreeSide(thing.points, hints, found);
  EXPECT_LT(wrongShare(found, thing.truth), 0.01);
  hints.outside = false;
  hints.sensors.resize(3, 8); // places all around say the same
  for (int k = 0; k < 8; ++k)
    hints.sensors.col(k) << (k & 1 ? 3 : -2), (k & 2 ? 3 : -2), (k & 4 ? 3 : -2);
  found = fitted(thing.points);
  orientToFreeSide(thing.points, hints, found);
  EXPECT_LT(wrongShare(found, thing.truth), 0.01);
}

/// A floor with a thing on it, seen from above, is no room: what stands there tells its side. The thing itself may be taken for one.
TEST(FreeSide, OfAFloorIsWhereThingsStand)
{
  std::vector<Eigen::Vector3f> points, normals, seen;
  addBox({1, 1, -2}, {2, 3, -1.3f}, false, points, normals);
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uniform(0, 6);
  while (seen.size() < 15000) // a third as dense as the box
    if (const Eigen::Vector3f p(uniform(random), uniform(random), -2); p.x() < 1 || p.x() > 2 || p.y() < 1 || p.y() > 3)
      seen.push_back(p);
  const std::size_t floor = seen.size();
  for (std::size_t i = 0; i < points.size(); ++i)
    if (normals[i].z() >= 0) // not what the box stands on
      seen.push_back(points[i]);
  const Points all = Eigen::Map<const Points>(seen[0].data(), 3, seen.size());
  Points found = fitted(all);
  orientToFreeSide(all, {}, found);
  EXPECT_GT((found.row(2).head(floor).array() > 0).count(), 0.99 * floor);
}

TEST(FreeSide, NothingStaysNothing)
{
  Points none(3, 0), normals(3, 0), two = Points::Random(3, 2);
  orientToFreeSide(none, {}, normals);
  EXPECT_EQ(normals.cols(), 0);
  EXPECT_THROW(orientToFreeSide(two, {}, normals), std::invalid_argument);
  FreeSideHints hints;
  hints.sensors = Points::Constant(3, 1, NAN);
  EXPECT_THROW(orientToFreeSide(two, hints, two), std::invalid_argument);
}
} // namespace
} // namespace fresco
