// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/sharp_shapes.h"
#include <cmath>
#include <fresco/core/constants.h>
#include <functional>
#include <map>
#include <vector>
namespace fresco::benchmark {
namespace {
using Eigen::Vector2d;

struct Builder {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<Eigen::Vector3i> faces;

  int add(double x, double y, double z)
  {
    vertices.emplace_back(Eigen::Vector3d(x, y, z).cast<float>());
    return vertices.size() - 1;
  }
  void quad(int a, int b, int c, int d)
  {
    faces.emplace_back(a, b, c);
    faces.emplace_back(a, c, d);
  }
  TriangleMesh mesh() const
  {
    TriangleMesh mesh;
    mesh.vertices.resize(3, vertices.size());
    for (std::size_t i = 0; i < vertices.size(); ++i)
      mesh.vertices.col(i) = vertices[i];
    mesh.faces.resize(3, faces.size());
    for (std::size_t i = 0; i < faces.size(); ++i)
      mesh.faces.col(i) = faces[i];
    return mesh;
  }
};

// Solid between an inner and an outer closed curve of equally many corners (counter-clockwise), extruded along z.
TriangleMesh extrudeRing(const std::vector<Vector2d>& inner, const std::vector<Vector2d>& outer, double height)
{
  Builder builder;
  const int n = outer.size();
  const auto index = [](int corner, bool is_outer, bool top) {
    return 4 * corner + 2 * (is_outer ? 1 : 0) + (top ? 1 : 0);
  };
  for (int i = 0; i < n; ++i)
    for (const auto* curve : {&inner, &outer})
      for (const double z : {0.0, height})
        builder.add((*curve)[i].x(), (*curve)[i].y(), z);
  for (int i = 0; i < n; ++i) {
    const int j = (i + 1) % n;
    builder.quad(index(i, true, false), index(j, true, false), index(j, true, true), index(i, true, true));
    builder.quad(index(j, false, false), index(i, false, false), index(i, false, true), index(j, false, true));
    builder.quad(index(i, false, true), index(i, true, true), index(j, true, true), index(j, false, true));
    builder.quad(index(j, false, false), index(j, true, false), index(i, true, false), index(i, false, false));
  }
  return builder.mesh();
}

// Boundary of the filled cells of a profile in x and z, extruded along y.
class Profile {
public:
  Profile(std::vector<double> x, std::vector<double> z, double width, std::function<bool(int, int)> filled)
      : x_(std::move(x)), z_(std::move(z)), y_{0.0, width}, filled_(std::move(filled))
  {}

  TriangleMesh mesh()
  {
    for (int i = 0; i < cellsX(); ++i)
      for (int k = 0; k < cellsZ(); ++k)
        if (isFilled(i, k))
          addCell(i, k);
    return builder_.mesh();
  }

private:
  int cellsX() const { return x_.size() - 1; }
  int cellsZ() const { return z_.size() - 1; }
  bool isFilled(int i, int k) const { return i >= 0 && k >= 0 && i < cellsX() && k < cellsZ() && filled_(i, k); }
  int at(int i, int j, int k)
  {
    const auto [place, fresh] = index_.try_emplace({i, j, k}, 0);
    if (fresh)
      place->second = builder_.add(x_[i], y_[j], z_[k]);
    return place->second;
  }
  void addCell(int i, int k)
  {
    builder_.quad(at(i, 0, k), at(i + 1, 0, k), at(i + 1, 0, k + 1), at(i, 0, k + 1));
    builder_.quad(at(i + 1, 1, k), at(i, 1, k), at(i, 1, k + 1), at(i + 1, 1, k + 1));
    if (!isFilled(i - 1, k))
      builder_.quad(at(i, 1, k), at(i, 0, k), at(i, 0, k + 1), at(i, 1, k + 1));
    if (!isFilled(i + 1, k))
      builder_.quad(at(i + 1, 0, k), at(i + 1, 1, k), at(i + 1, 1, k + 1), at(i + 1, 0, k + 1));
    if (!isFilled(i, k - 1))
      builder_.quad(at(i, 1, k), at(i + 1, 1, k), at(i + 1, 0, k), at(i, 0, k));
    if (!isFilled(i, k + 1))
      builder_.quad(at(i, 0, k + 1), at(i + 1, 0, k + 1), at(i + 1, 1, k + 1), at(i, 1, k + 1));
  }

  std::vector<double> x_, z_;
  double y_[2];
  std::function<bool(int, int)> filled_;
  std::map<std::tuple<int, int, int>, int> index_;
  Builder builder_;
};
} // namespace

TriangleMesh boxWithHole()
{
  constexpr int corners = 96; // a multiple of 8, so that the box gets its corners
  std::vector<Vector2d> circle, square;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * pi * i / corners;
    const Vector2d direction(std::cos(angle), std::sin(angle));
    circle.push_back(0.3 * direction);
    square.push_back(0.5 * direction / direction.cwiseAbs().maxCoeff());
  }
  return extrudeRing(circle, square, 0.6);
}

TriangleMesh gear()
{
  constexpr int teeth = 12;
  std::vector<Vector2d> hole, rim;
  for (int i = 0; i < 4 * teeth; ++i) {
    const double angle = 2 * pi * (i + (i % 2 == 0 ? -0.15 : 0.15)) / (4 * teeth);
    const Vector2d direction(std::cos(angle), std::sin(angle));
    rim.push_back((i % 4 < 2 ? 0.5 : 0.4) * direction);
    hole.push_back(0.15 * direction);
  }
  return extrudeRing(hole, rim, 0.25);
}

TriangleMesh staircase()
{
  constexpr int steps = 5;
  std::vector<double> x, z{0.0};
  for (int i = 0; i < steps; ++i) {
    x.push_back(0.2 * i);
    x.push_back(0.2 * i + 0.05); // the plate begins at the first, the step below it at the second
    z.push_back(0.15 * (i + 1) - 0.04);
    z.push_back(0.15 * (i + 1));
  }
  x.push_back(0.2 * steps);
  const auto filled = [](int i, int k) {
    const int step = i / 2, plate = 2 * step + 1; // row of the plate of this step
    return k == plate || (k < plate && (i % 2 == 1 || k < plate - 1));
  };
  return Profile(x, z, 0.6, filled).mesh();
}
} // namespace fresco::benchmark
