// SPDX-License-Identifier: BSD-3-Clause
#include "tiles/coarse_mesh.h"
#include "views/visible_surface.h"
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <fresco/core/morton.h>
#include <unordered_map>
#include <vector>
namespace fresco::texture {
namespace {
/// Vertices of a cell, relative to the first of them.
struct Cell {
  Eigen::Vector3f first;
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero(); ///< sum of w n n^T over the faces around
  Eigen::Vector3d b = Eigen::Vector3d::Zero(), sum = b;
  double count = 0;

  /// Where |A x - b| is least, next to the mean of the vertices.
  Eigen::Vector3f place(double size) const
  {
    constexpr double flat = 0.02; // of the largest eigenvalue: noise bends a plane as much
    const Eigen::Vector3d mean = sum / count;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(A);
    const Eigen::Vector3d values = solver.eigenvalues(), right = solver.eigenvectors().transpose() * (b - A * mean);
    Eigen::Vector3d step = Eigen::Vector3d::Zero();
    for (int k = 0; k < 3; ++k)
      if (values[k] > flat * values[2])
        step += right[k] / values[k] * solver.eigenvectors().col(k);
    return first + Eigen::Vector3f((step.norm() < size ? Eigen::Vector3d(mean + step) : mean).cast<float>());
  }
};

class VertexGrid {
public:
  VertexGrid(const TriangleMesh& mesh, double size, const Eigen::Vector3f& low) : mesh_(mesh), size_(size), low_(low)
  {
    for (Index f = 0; f < mesh.faceCount(); ++f)
      addFace(f);
  }

  Index faces() const { return faces_.size(); }

  TriangleMesh finish() const
  {
    TriangleMesh out;
    out.origin = mesh_.origin;
    out.vertices.resize(3, cells_.size());
    for (std::size_t c = 0; c < cells_.size(); ++c)
      out.vertices.col(c) = cells_[c].place(size_);
    out.faces.resize(3, faces_.size());
    for (std::size_t f = 0; f < faces_.size(); ++f)
      out.faces.col(f) << faces_[f][0], faces_[f][1], faces_[f][2];
    return out;
  }

private:
  int cellOf(const Eigen::Vector3f& vertex)
  {
    const Eigen::Vector3d at = (vertex - low_).cast<double>() / size_;
    const auto [entry, is_new] =
        numbers_.emplace(mortonCode(static_cast<std::uint32_t>(at.x()), static_cast<std::uint32_t>(at.y()),
                                    static_cast<std::uint32_t>(at.z())),
                         cells_.size());
    if (is_new) {
      cells_.emplace_back();
      cells_.back().first = vertex;
    }
    return entry->second;
  }

  void addFace(Index f)
  {
    std::array<int, 3> cells{};
    const Eigen::Vector3d cross = areaVector(mesh_, f);
    const double area = cross.norm();
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3f vertex = mesh_.vertices.col(mesh_.faces(k, f));
      cells[k] = cellOf(vertex);
      Cell& cell = cells_[cells[k]];
      const Eigen::Vector3d at = (vertex - cell.first).cast<double>();
      cell.sum += at;
      ++cell.count;
      if (area > 0) {
        cell.A += cross * cross.transpose() / area;
        cell.b += cross * cross.dot(at) / area;
      }
    }
    if (cells[0] != cells[1] && cells[1] != cells[2] && cells[2] != cells[0])
      faces_.push_back(cells);
  }

  const TriangleMesh& mesh_;
  double size_;
  Eigen::Vector3f low_;
  std::unordered_map<std::uint64_t, int> numbers_;
  std::vector<Cell> cells_;
  std::vector<std::array<int, 3>> faces_;
};
} // namespace

TriangleMesh coarseMesh(const TriangleMesh& mesh, Index most_faces)
{
  if (mesh.faceCount() <= most_faces)
    return mesh;
  constexpr double faces_per_area = 3; // a surface at a slant to the grid meets more than one cell per square
  constexpr double least_share = 1.0 / (1 << 20); // of the extent: what a code of 21 bits can tell apart
  const Eigen::AlignedBox3f box = boxOf(mesh);
  double size = std::max(std::sqrt(faces_per_area * surfaceArea(mesh) / most_faces),
                         least_share * double(box.sizes().maxCoeff()));
  for (;; size *= 1.2)
    if (const VertexGrid grid(mesh, size, box.min()); grid.faces() <= most_faces)
      return grid.finish();
}
} // namespace fresco::texture
