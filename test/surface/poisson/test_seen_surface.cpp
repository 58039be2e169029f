// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Geometry>
#include <cmath>
#include <fresco/core/mesh.h>
#include <fresco/surface/core/mesh_trimming.h>
#include <fresco/surface/core/seen_surface.h>
#include <gtest/gtest.h>
namespace fresco::test {
namespace {
constexpr float height = 2.f, step = 0.01f; // of the scanner above the floor, and between its beams, radians

/// A square of side 4 in the plane z = 0, of cells of 2.5 cm.
TriangleMesh floorMesh()
{
  constexpr int n = 161;
  TriangleMesh mesh;
  mesh.vertices.setZero(3, n * n);
  mesh.faces.resize(3, 2 * (n - 1) * (n - 1));
  for (int i = 0; i < n * n; ++i)
    mesh.vertices.col(i) << 0.025f * (i % n) - 2.f, 0.025f * (i / n) - 2.f, 0.f;
  Index f = 0;
  for (int i = 0; i < n * (n - 1); ++i)
    if (i % n < n - 1) {
      mesh.faces.col(f++) << i, i + 1, i + n + 1;
      mesh.faces.col(f++) << i, i + n + 1, i + n;
    }
  return mesh;
}

class Scan : public PointStream {
public:
  /// range(direction), 0 = nothing came back; of directions below the horizon
  template <typename RangeOf>
  explicit Scan(const RangeOf& range)
  {
    std::vector<Eigen::Vector3f> ends;
    for (float down = step / 2; down < 1.57f; down += step)
      for (float turn = 0; turn < 6.283f; turn += step) {
        const Eigen::Vector3f direction(std::cos(down) * std::cos(turn), std::cos(down) * std::sin(turn),
                                        -std::sin(down));
        if (const float length = range(direction); length > 0.f)
          ends.emplace_back(length * direction);
      }
    beams_.points.resize(3, ends.size());
    for (std::size_t i = 0; i < ends.size(); ++i)
      beams_.points.col(i) = ends[i];
    beams_.viewpoints.setZero(3, 1);
    beams_.origin = Eigen::Vector3d(0, 0, height);
  }
  void read(const std::function<void(const PointSet&)>& receive) const override { receive(beams_); }
  PointSet& beams() { return beams_; }

private:
  PointSet beams_;
};

float toFloor(const Eigen::Vector3f& direction) { return -height / direction.z(); }

/// Area of the mesh that was seen, and the greatest error of its border by `distance` to the true one.
template <typename Distance>
std::pair<double, double> seenPart(const Scan& scan, const Distance& distance)
{
  const TriangleMesh mesh = floorMesh(), part = trimMesh(mesh, seenSurface(mesh, scan, 0.02), {0.f, 0.0, 0.0, 0});
  double error = 0;
  for (Index v = 0; v < part.vertexCount(); ++v)
    error = std::max<double>(error, distance(part.vertices.col(v)));
  return {surfaceArea(part), error};
}

TEST(SeenSurface, EndsWhereTheBeamsEnd)
{
  const auto outside = [](const Eigen::Vector3f& p) { return p.head<2>().cwiseAbs().maxCoeff() - 1.f; };
  const Scan scan([&](const Eigen::Vector3f& direction) {
    const float length = toFloor(direction);
    return outside(length * direction) < 0 ? length : 0.f;
  });
  const auto [area, error] = seenPart(scan, outside);
  EXPECT_NEAR(area, 4, 8 * step * height);
  EXPECT_LT(error, 3 * step * height) << "beyond the border";
}

TEST(SeenSurface, HasTheShadowOfWhatStandsBefore)
{
  constexpr float plate = 1.f; // its height; it hides the floor within twice its radius
  const Scan scan([&](const Eigen::Vector3f& direction) {
    const float length = (plate - height) / direction.z();
    return (length * direction).head<2>().norm() < 0.5f ? length : toFloor(direction);
  });
  const auto [area, error] = seenPart(scan, [](const Eigen::Vector3f& p) { return 1.f - p.head<2>().norm(); });
  EXPECT_NEAR(area, 16 - 3.1416, 7 * step * height);
  EXPECT_LT(error, 3 * step * height) << "within the shadow";
}

TEST(SeenSurface, IsNotWhatLooksAwayOrLiesBeside)
{
  const Scan scan(toFloor);
  TriangleMesh turned = floorMesh(), above = floorMesh();
  turned.faces.row(0).swap(turned.faces.row(1));
  EXPECT_LT(seenSurface(turned, scan, 0.02).maxCoeff(), 0.f);
  above.origin.z() = 0.5;
  EXPECT_LT(seenSurface(above, scan, 0.02).maxCoeff(), 0.f);
  EXPECT_GT(seenSurface(floorMesh(), scan, 0.02).minCoeff(), 0.f);
}

TEST(SeenSurface, SameBitsForAnyNumberOfThreads)
{
  Scan scan(toFloor);
  const Eigen::VectorXf once = seenSurface(floorMesh(), scan, 0.02, 1);
  EXPECT_EQ(once, seenSurface(floorMesh(), scan, 0.02, 4));
  EXPECT_THROW(seenSurface(floorMesh(), scan, 0.0), std::invalid_argument);
  scan.beams().points(0, 7) = NAN;
  EXPECT_TRUE(seenSurface(floorMesh(), scan, 0.02).allFinite());
  scan.beams().viewpoints.resize(3, 0);
  EXPECT_THROW(seenSurface(floorMesh(), scan, 0.02), std::invalid_argument);
}
} // namespace
} // namespace fresco::test
