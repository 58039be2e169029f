// SPDX-License-Identifier: BSD-3-Clause
#include "registration/synthetic_rooms.h"
#include <fresco/alignment/core/camera_alignment.h>
#include <fresco/core/constants.h>
#include <gtest/gtest.h>
#include <string>
namespace {
using namespace fresco;
using Eigen::Vector3d;

constexpr double no_door = std::numeric_limits<double>::quiet_NaN();
constexpr double noise = 0.01; // metres

test::Boxes furnishedRoom()
{
  test::Boxes boxes;
  test::addRoom(boxes, {0, 0, 0}, {5, 4, 2.6}, no_door);
  test::addFurniture(boxes, {0.3, 0.3, 0}, {4.7, 3.7, 0}, 8, 3);
  return boxes;
}

test::Boxes bareRoom()
{
  test::Boxes boxes;
  test::addRoom(boxes, {0, 0, 0}, {5, 4, 2.6}, no_door);
  return boxes;
}

Eigen::Matrix<std::uint8_t, 3, 1> paint(const Vector3d& p)
{
  return (Eigen::Array3d(std::sin(2 * p.x() + p.z()), std::sin(3 * p.y() - p.x()), std::sin(p.z() + 2 * p.y())) * 100 +
          128)
      .cast<std::uint8_t>();
}

PointSet scanned(const test::Boxes& boxes, bool colored)
{
  PointSet all;
  for (const Vector3d& station : {Vector3d(1, 1.2, 1.7), Vector3d(3.6, 2.6, 1.6), Vector3d(2.2, 3.2, 1.8)}) {
    PointSet scan = test::scanBoxes(boxes, Eigen::Isometry3d(Eigen::Translation3d(station)), 8000, 0.002, 5);
    scan.points.colwise() += station.cast<float>();
    scan.viewpoints.resize(3, 0);
    all = all.size() == 0 ? scan : mergePoints(all, scan);
  }
  if (colored) {
    all.colors.resize(3, all.size());
    for (Index i = 0; i < all.size(); ++i)
      all.colors.col(i) = paint(all.points.col(i).cast<double>());
  }
  return all;
}

struct Photographed {
  CameraSet set;
  SparsePoints points;
  std::vector<Vector3d> places = {}; ///< of the points, without noise
};

/// Photographs of a part of the room, x < `end`; `wrong` of the points lie elsewhere on their rays.
Photographed photographed(const test::Boxes& boxes, double end, double wrong, unsigned seed)
{
  Photographed out;
  std::mt19937 random(seed);
  const auto uniform = [&](double a, double b) { return a + (b - a) * (random() / 4294967296.0); };
  std::normal_distribution<double> error(0.0, noise);
  out.set.cameras.resize(1);
  for (int v = 0; v < 12; ++v) {
    View view;
    view.T_camera_world.translation() = -Vector3d(uniform(0.8, 4.2), uniform(0.8, 3.2), uniform(1.4, 2.0));
    out.set.views.push_back(view);
  }
  while (out.points.size() < 2500) {
    const int v = static_cast<int>(uniform(0, 12));
    const Vector3d eye = out.set.views[v].center(),
                   beam = Vector3d(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)).normalized();
    double range = 1e9;
    for (const test::Box& box : boxes)
      range = std::min(range, box.hit(eye, beam));
    const Vector3d place = eye + range * beam;
    if (place.x() > end)
      continue;
    SparsePoint point;
    point.position = place + Vector3d(error(random), error(random), error(random));
    out.places.push_back(place);
    if (uniform(0, 1) < wrong)
      out.places.back() = point.position = eye + std::exp(uniform(-1, 1)) * range * beam;
    point.color = paint(place);
    point.track = {{v, {0, 0}}, {(v + 1) % 12, {0, 0}}};
    out.points.push_back(point);
  }
  return out;
}

Similarity ownFrame(double scale, unsigned seed)
{
  std::srand(seed);
  Similarity T;
  T.scale = scale;
  T.R = Eigen::Quaterniond::UnitRandom().toRotationMatrix();
  T.t = scale * 10 * Vector3d::Random();
  return T;
}

void expectFound(const CameraAlignmentResult& found, const Similarity& T_own_world)
{
  const Similarity rest = found.T_scans_cameras * T_own_world; // identity but for the error
  EXPECT_NEAR(rest.scale, 1, 0.002);                           // noise / room / sqrt of points, tenfold
  EXPECT_LT(Eigen::AngleAxisd(rest.R).angle() * degrees_per_radian, 0.1);
  EXPECT_LT((rest * Vector3d(2.5, 2, 1.3) - Vector3d(2.5, 2, 1.3)).norm(), noise);
}

std::string refusal(const Photographed& photographs, const PointSet& scans)
{
  try {
    alignCameras(photographs.set, photographs.points, scans);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(CameraAlignment, AnyScaleIsFoundWithHalfOfThePointsWrong)
{
  const PointSet scans = scanned(furnishedRoom(), false);
  for (const double scale : {0.01, 100.0}) {
    Photographed photographs = photographed(furnishedRoom(), scale < 1 ? 5 : 3.2, 0.5, 7);
    const Similarity T = ownFrame(scale, 3);
    transformCameras(T, photographs.set, photographs.points);
    const CameraAlignmentResult found = alignCameras(photographs.set, photographs.points, scans);
    EXPECT_FALSE(found.already_aligned);
    expectFound(found, T);
    EXPECT_NEAR(found.support, 0.45, 0.1); // a few right ones lie at edges and on surface that no scan saw
    if (scale < 1)
      continue;
    CameraAlignmentOptions options;
    options.threads = 1; // does not change the result
    const auto again = alignCameras(photographs.set, photographs.points, scans, options);
    EXPECT_EQ(again.T_scans_cameras.matrix(), found.T_scans_cameras.matrix());
  }
}

/// Worst corner of the room, metres.
double cornersOff(const Photographed& photographs, const PointSet& scans, const Similarity& T_own_world)
{
  const Similarity rest = alignCameras(photographs.set, photographs.points, scans).T_scans_cameras * T_own_world;
  double most = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3d x(corner & 1 ? 5 : 0, corner & 2 ? 4 : 0, corner & 4 ? 2.6 : 0);
    most = std::max(most, (rest * x - x).norm());
  }
  return most;
}

TEST(CameraAlignment, PixelsTellMoreThanThePlacesOfPoints)
{
  const PointSet scans = scanned(furnishedRoom(), false);
  Photographed photographs = photographed(furnishedRoom(), 3.2, 0.5, 7);
  photographs.set.cameras = {sphericalCamera(4000, 2000)};
  for (std::size_t i = 0; i < photographs.points.size(); ++i)
    for (Observation& observation : photographs.points[i].track)
      observation.pixel = project(photographs.set.cameras[0],
                                  photographs.set.views[observation.view].T_camera_world * photographs.places[i]);
  const Similarity T = ownFrame(100, 3);
  transformCameras(T, photographs.set, photographs.points);
  const double by_pixels = cornersOff(photographs, scans, T);
  for (SparsePoint& point : photographs.points)
    for (Observation& observation : point.track)
      observation.pixel.setConstant(std::numeric_limits<double>::quiet_NaN()); // not known
  EXPECT_LT(by_pixels, 0.5 * cornersOff(photographs, scans, T));
  EXPECT_LT(by_pixels, 0.002); // noise of the scans
}

TEST(CameraAlignment, CamerasThatStandRightAreLeft)
{
  const Photographed photographs = photographed(furnishedRoom(), 5, 0.3, 8);
  const CameraAlignmentResult found =
      alignCameras(photographs.set, photographs.points, scanned(furnishedRoom(), false));
  EXPECT_TRUE(found.already_aligned);
  EXPECT_EQ(found.T_scans_cameras.matrix(), Eigen::Matrix4d(Eigen::Matrix4d::Identity()));
}

TEST(CameraAlignment, ColoursTellTheSidesOfABareRoomApart)
{
  Photographed photographs = photographed(bareRoom(), 5, 0.2, 9);
  const Similarity T = ownFrame(3, 4);
  transformCameras(T, photographs.set, photographs.points);
  EXPECT_NE(refusal(photographs, scanned(bareRoom(), false)).find("ambiguous"), std::string::npos);
  expectFound(alignCameras(photographs.set, photographs.points, scanned(bareRoom(), true)), T);
}

TEST(CameraAlignment, AnotherRoomAndWrongPointsAreRefused)
{
  test::Boxes other;
  test::addRoom(other, {0, 0, 0}, {3, 8, 3.5}, no_door);
  test::addFurniture(other, {0.3, 0.3, 0}, {2.7, 7.7, 0}, 10, 11);
  Photographed photographs = photographed(furnishedRoom(), 5, 0.2, 10);
  transformCameras(ownFrame(3, 5), photographs.set, photographs.points);
  const PointSet cameras_elsewhere = scanned(other, false);
  EXPECT_NE(refusal(photographs, cameras_elsewhere), "");
  photographs = photographed(furnishedRoom(), 5, 1.0, 10);
  transformCameras(ownFrame(3, 6), photographs.set, photographs.points);
  const std::string why = refusal(photographs, scanned(furnishedRoom(), false));
  EXPECT_NE(why.find("no place fits"), std::string::npos) << why;
}

TEST(CameraAlignment, BadInputIsNamed)
{
  const PointSet scans = scanned(bareRoom(), false);
  Photographed photographs = photographed(bareRoom(), 5, 0.2, 9);
  SparsePoints few(photographs.points.begin(), photographs.points.begin() + 20);
  EXPECT_NE(refusal({photographs.set, few}, scans).find("20 sparse points"), std::string::npos);
  EXPECT_NE(refusal({photographs.set, {}}, scans).find("0 sparse points"), std::string::npos);
  EXPECT_NE(refusal({photographs.set, SparsePoints(100)}, scans), ""); // without tracks
  for (SparsePoint& point : few)
    point.position = Vector3d(1, 2, 3);
  while (few.size() < 100)
    few.push_back(few[0]);
  EXPECT_NE(refusal({photographs.set, few}, scans), ""); // one place
  CameraAlignmentOptions options;
  options.min_support = 0;
  EXPECT_THROW(alignCameras(photographs.set, photographs.points, scans, options), std::invalid_argument);
  options = {};
  options.max_alias = std::nan("");
  EXPECT_THROW(alignCameras(photographs.set, photographs.points, scans, options), std::invalid_argument);
  photographs.points[7].track[0].view = 12;
  EXPECT_THROW(alignCameras(photographs.set, photographs.points, scans), std::invalid_argument);
  photographs.points[7].track[0].view = 0;
  photographs.points[7].position.x() = std::nan("");
  EXPECT_THROW(alignCameras(photographs.set, photographs.points, scans), std::invalid_argument);
}

} // namespace
