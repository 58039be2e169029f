// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "test_data.h"
#include <cmath>
#include <cstdint>
#include <fresco/core/point_set.h>
#include <fresco/core/textured_mesh.h>
#include <fresco/io/file.h>
#include <functional>
#include <limits>
#include <random>
namespace fresco::test {
inline Points randomPoints(Index count, unsigned seed, float scale = 1.f)
{
  std::mt19937 generator(seed);
  std::uniform_real_distribution<float> uniform(-scale, scale);
  return Points::NullaryExpr(3, count, [&] { return uniform(generator); });
}

inline Colors randomColors(Index count, unsigned seed)
{
  std::mt19937 generator(seed);
  return Colors::NullaryExpr(3, count, [&] { return static_cast<std::uint8_t>(generator() & 255); });
}

/// Points with every attribute, one of them not finite.
inline PointSet fullPointSet(Index count)
{
  PointSet set;
  set.points = randomPoints(count, 1, 5.f);
  set.points.col(count / 2).setConstant(std::numeric_limits<float>::quiet_NaN());
  set.normals = randomPoints(count, 2).colwise().normalized();
  set.colors = randomColors(count, 3);
  set.intensities = randomPoints(count, 4).row(0).transpose();
  set.confidences = randomPoints(count, 5).row(0).transpose().cwiseAbs();
  set.viewpoints = randomPoints(count, 6);
  return set;
}

/// Bumpy height field of side x side vertices with every attribute.
inline TriangleMesh fullMesh(int side)
{
  TriangleMesh mesh;
  const Index count = Index{side} * side;
  mesh.vertices = randomPoints(count, 7, 0.3f);
  mesh.faces.resize(3, 2 * (side - 1) * (side - 1));
  for (int y = 0, f = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const int v = y * side + x;
      mesh.vertices.col(v).head<2>() += Eigen::Vector2f(static_cast<float>(x), static_cast<float>(y));
      if (x + 1 == side || y + 1 == side)
        continue;
      mesh.faces.col(f++) << v, v + 1, v + side;
      mesh.faces.col(f++) << v + 1, v + side + 1, v + side;
    }
  mesh.normals = vertexNormals(mesh);
  mesh.colors = randomColors(count, 8);
  mesh.fields["curvature"] = randomPoints(count, 9).row(0).transpose();
  mesh.fields["density"] = randomPoints(count, 10).row(1).transpose();
  return mesh;
}

inline Image randomImage(int width, int height, unsigned seed)
{
  Image image(width, height);
  std::mt19937 generator(seed);
  for (std::uint8_t& value : image.data)
    value = static_cast<std::uint8_t>(generator() & 255);
  return image;
}

/// Mesh with `atlases` atlases in turn; the last two faces have no texture.
inline TexturedMesh fullTexturedMesh(int side, int atlases)
{
  TexturedMesh model;
  model.mesh = fullMesh(side);
  model.mesh.fields.clear();
  const Index faces = model.mesh.faceCount();
  model.texcoords = (randomPoints(faces + 2, 11).topRows<2>().array() * 0.5f + 0.5f).matrix();
  model.texcoord_faces.resize(3, faces);
  model.face_atlas.resize(faces);
  for (Index f = 0; f < faces; ++f) {
    const bool textured = f + 2 < faces;
    const int first = f;
    model.face_atlas[f] = textured ? first * atlases / static_cast<int>(faces) : -1;
    model.texcoord_faces.col(f) = textured ? Eigen::Vector3i(first, first + 1, first + 2) : Eigen::Vector3i(-1, -1, -1);
  }
  for (int i = 0; i < atlases; ++i)
    model.atlases.push_back(randomImage(16 + i, 8, 12U + static_cast<unsigned>(i)));
  return model;
}

/// Equal, NaN at the same places included.
template <typename Matrix>
bool sameValues(const Matrix& a, const Matrix& b)
{
  if (a.rows() != b.rows() || a.cols() != b.cols())
    return false;
  for (Index i = 0; i < a.size(); ++i)
    if (!(a.data()[i] == b.data()[i] || (std::isnan(a.data()[i]) && std::isnan(b.data()[i]))))
      return false;
  return true;
}

/// Largest distance between the places in the world of the points of `a` and `b`.
template <typename Set>
double worldDistance(const Set& a, const Points& a_points, const Set& b, const Points& b_points)
{
  const Eigen::Matrix3Xd difference =
      (a_points.cast<double>().colwise() + a.origin) - (b_points.cast<double>().colwise() + b.origin);
  return difference.colwise().norm().maxCoeff();
}

inline void writeText(const std::string& path, std::string_view text)
{
  OutputFile file(path);
  file.write(text);
  file.commit();
}

/// The folder of the running test, emptied by its first call.
inline std::string testFolder()
{
  static std::string known, folder;
  if (const std::string name = testing::UnitTest::GetInstance()->current_test_info()->name(); name != known)
    known = name, folder = scratchFolder();
  return folder;
}

/// Path of a file with that content in the folder of the running test.
inline std::string stored(const std::string& name, std::string_view content)
{
  const std::string path = testFolder() + "/" + name;
  writeText(path, content);
  return path;
}

/// Text of the exception that `run` throws, "" if it throws none.
inline std::string errorOf(const std::function<void()>& run)
{
  try {
    run();
  } catch (const std::exception& error) {
    return error.what();
  }
  return {};
}
} // namespace fresco::test
