// SPDX-License-Identifier: BSD-3-Clause
// The result moves with its input: shifted, turned or scaled, it differs by no more than rounding does.
#include "surface/optimization/optimization_shapes.h"
#include "test_data.h"
#include <Eigen/Geometry>
#include <fresco/io/mesh_io.h>
#include <gtest/gtest.h>
#include <numeric>
namespace fresco {
namespace {
struct Motion {
  std::string name;
  double scale = 1;
  double angle = 0;                                 // radians, about an axis of no symmetry
  double shift = 0;                                 // extents, of the coordinates
  Eigen::Vector3d origin = Eigen::Vector3d::Zero(); // extents, added in double
};

std::vector<Motion> motions()
{
  std::vector<Motion> all = {{"turned", 1, 0.7}, {"turned further", 1, 2.1}, {"all", 3, 1.3, 0.37, {10, -20, 30}}};
  for (const double scale : {1e-4, 3.0, 1e5, 1e6})
    all.push_back({"scale " + std::to_string(scale), scale});
  for (const double shift : {1e-7, 1e-3, 0.37})
    all.push_back({"shift " + std::to_string(shift), 1, 0, shift});
  for (const double shift : {1e-7, 1.0, 1000.0})
    all.push_back({"origin " + std::to_string(shift), 1, 0, 0, shift * Eigen::Vector3d(0.6, -0.7, 0.4)});
  return all;
}

struct Input {
  TriangleMesh mesh; // its origin and that of the points are zero
  PointSet points;
};

double extentOf(const TriangleMesh& mesh)
{
  return (mesh.vertices.rowwise().maxCoeff() - mesh.vertices.rowwise().minCoeff()).maxCoeff();
}

/// How far the vertices are off after `motion` and back, shares of the extent, ascending.
std::vector<double> differences(const Input& input, const TriangleMesh& expected, const Motion& motion)
{
  const double extent = extentOf(input.mesh);
  const Eigen::Vector3d shift = motion.shift * motion.scale * extent * Eigen::Vector3d(0.6, -0.7, 0.4),
                        origin = motion.scale * extent * motion.origin;
  const Eigen::Matrix3d R = Eigen::AngleAxisd(motion.angle, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const auto moved = [&](const Points& points) -> Points {
    return ((motion.scale * R * points.cast<double>()).colwise() + shift).cast<float>();
  };
  Input other = input;
  other.mesh.vertices = moved(input.mesh.vertices);
  other.points.points = moved(input.points.points);
  other.points.normals = (R * input.points.normals.cast<double>()).cast<float>();
  other.mesh.origin = other.points.origin = origin;
  const TriangleMesh found = filterSurface(other.mesh, other.points).mesh;
  const Eigen::Matrix3Xd back = R.transpose() * (found.vertices.cast<double>().colwise() - shift) / motion.scale;
  const Eigen::RowVectorXd off = (back - expected.vertices.cast<double>()).colwise().norm() / extent;
  std::vector<double> sorted(off.begin(), off.end());
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

/// @param allowed share of the vertices that may differ by more
void expectSame(const Input& input, double allowed)
{
  constexpr double same = 1e-4; // of the extent
  const TriangleMesh expected = filterSurface(input.mesh, input.points).mesh;
  ASSERT_GT((expected.vertices - input.mesh.vertices).cwiseAbs().maxCoeff(), 10 * same * extentOf(input.mesh));
  for (const Motion& motion : motions()) {
    const std::vector<double> off = differences(input, expected, motion);
    const auto count = static_cast<double>(off.size());
    EXPECT_LT(off[static_cast<std::size_t>((1 - allowed) * (count - 1))], same) << motion.name;
    EXPECT_LT(std::accumulate(off.begin(), off.end(), 0.0) / count, 0.2 * same) << motion.name;
  }
}

TEST(OptimizationLaws, CubeMovesWithItsInput)
{
  for (const double noise : {0.0, 0.01})
    expectSame({test::roundedCube(20, 0.15), test::cubePoints(8000, noise)}, 0.0);
}

TEST(OptimizationLaws, FandiskMovesWithItsInput)
{
  FRESCO_NEED_DATA("fandisk.obj");
  Input input;
  TriangleMesh model = readMesh(test::dataFolder() + "/fandisk.obj");
  model.origin.setZero();
  input.points.points = model.vertices;
  input.points.normals = vertexNormals(model);
  VolumetricOptions options;
  options.depth = 6;
  input.mesh = reconstructVolumetric(input.points, options).mesh;
  input.mesh.vertices.colwise() += input.mesh.origin.cast<float>();
  input.mesh.origin.setZero();
  expectSame(input, 0.02); // at some corners of the model no surface fits, and steps that wander magnify rounding
}
} // namespace
} // namespace fresco
